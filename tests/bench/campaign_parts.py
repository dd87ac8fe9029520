# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Processor time per run of the parts of a campaign of linear runs, as ratios to its computation.

    python tests/bench/campaign_parts.py [RUNS]

Planning makes the settings of the runs, rows and bytes what a shard contains. The computation is
`run_batch`. The last line is the whole program beside the computation of its runs, with start,
merging, summary and page; for this the program is run once with one worker.
"""

import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

from ddct_bringup.batch import run_batch as batch
from ddct_bringup.campaign import scored
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import schema_of, shard_bytes
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.campaign.spec import read_spec
from ddct_bringup.verdict.limits import packaged_limits

RUNS, SHARD = 20_000, 400
_SPEC = """\
controllers: [pi, ls8]
random:
  samples: {samples}
  vary:
    wear_gain: {{distribution: uniform, low: 0.7, high: 1.3}}
    vehicle.mass_kg: {{distribution: uniform, low: 1200, high: 1800}}
    actuator.delay_s: {{distribution: uniform, low: 0.005, high: 0.02, step: 0.001}}
"""


def measure(runs: int = RUNS) -> Mapping[str, float]:
    """Return the processor times per run in us, by part."""
    with tempfile.TemporaryDirectory() as folder:
        spec = Path(folder) / 'linear.yaml'
        spec.write_text(_SPEC.format(samples=runs // 2), encoding='utf-8')
        return {**_parts(spec, runs), 'program': _program(spec, runs)}


def _parts(spec: Path, runs: int) -> dict[str, float]:
    read = read_spec(spec)
    campaign, scorer = Campaign(read), Scorer(packaged_limits())
    computation = _Timed(batch.run_batch)
    scored.run_batch = computation  # type: ignore[assignment]
    shard_bytes(schema_of(read), [each.row() for each in scorer.scored(campaign.planned(0, 9))])
    found = dict.fromkeys(('planning', 'computation', 'rows', 'bytes'), 0.0)
    for first, last in pairwise((*range(0, runs, SHARD), runs)):
        started, computation.seconds = time.process_time(), 0.0
        planned = [*campaign.planned(first, last)]
        built = time.process_time()
        rows = [each.row() for each in scorer.scored(planned)]
        made = time.process_time()
        shard_bytes(schema_of(read), rows)
        found['planning'] += built - started
        found['computation'] += computation.seconds
        found['rows'] += made - built - computation.seconds
        found['bytes'] += time.process_time() - made
    return {part: 1e6 * seconds / runs for part, seconds in found.items()}


class _Timed:
    """Function with the processor time of its calls, in s."""

    def __init__(self, function: Any) -> None:
        self._function = function
        self.seconds = 0.0

    def __call__(self, *arguments: Any) -> Any:
        started = time.process_time()
        result = self._function(*arguments)
        self.seconds += time.process_time() - started
        return result


def _program(spec: Path, runs: int) -> float:
    """Return the processor time per run in us of the program with one worker."""
    before = _children_s()
    subprocess.run(
        [
            *(sys.executable, '-m', 'ddct_bringup.programs.campaign'),
            *(spec, '--out', spec.parent / 'out', '--workers', '1'),
        ],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    return 1e6 * (_children_s() - before) / runs


def _children_s() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def print_table(times: Mapping[str, float]) -> None:
    """Print the results of `measure`."""
    computation = times['computation']
    beside = sum(times[part] for part in ('planning', 'rows', 'bytes'))
    for part, each in (*times.items(), ('planning, rows, bytes', beside)):
        print(f'{part:22} {each:7.1f} us a run, {each / computation:5.2f} of the computation')


if __name__ == '__main__':
    print_table(measure(*(int(each) for each in sys.argv[1:])))

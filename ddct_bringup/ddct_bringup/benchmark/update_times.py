# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Update times of judged controllers as ratios to that of `pi`, in turn with it on this machine.

They are wall-clock times, so they differ each time, and stand in a file of their own.
"""

import statistics
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.timing_and_failure import TIMING_FILE, RunTiming
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import FOREIGN_FAILURES
from ddct_plant.files.input_file import parse_json, read_text_file
from ddct_plant.files.output_file import write_json
from ddct_plant.scenario.settings import RunSettings

REFERENCE = 'pi'
_ROUNDS = 3
"""Number of runs of each, in turn, so that a busy machine slows both alike."""


def write_update_times(judged: Sequence[Judged], cases: Cases, out: Path) -> None:
    """Measure the update times and write them into a folder, unless they are there."""
    if (out / TIMING_FILE).exists():
        return
    settings = cases.planned.run(0).settings
    found = {each.name: _update_time(each, settings) for each in judged}
    write_json(str(out / TIMING_FILE), {'reference': REFERENCE, 'controllers': found})


def read_update_times(out: Path) -> Mapping[str, Any]:
    """Return the content of the file in a folder."""
    content = parse_json(read_text_file(out / TIMING_FILE))
    return content if isinstance(content, dict) else {}


def _update_time(judged: Judged, settings: RunSettings) -> dict[str, float | str | None]:
    """Return the median update times in us, and the median of their ratios over the rounds."""
    ours, theirs = [], []
    try:
        for _ in range(_ROUNDS):
            theirs.append(_median_us(REFERENCE, settings))
            ours.append(_median_us(judged.path, settings))
    except FOREIGN_FAILURES as error:
        return {'ratio_to_pi': None, 'reason': f'{type(error).__name__}: {error}'}
    ratios = [mine / other for mine, other in zip(ours, theirs, strict=True)]
    return {
        'ratio_to_pi': statistics.median(ratios),
        'lowest_ratio': min(ratios),
        'highest_ratio': max(ratios),
        'update_time_median_us': statistics.median(ours),
        'pi_update_time_median_us': statistics.median(theirs),
    }


def _median_us(chosen: str, settings: RunSettings) -> float:
    timing = RunTiming()
    run_headless(settings, make_controller(chosen, settings), timing)
    return statistics.median(timing.update_times_us)

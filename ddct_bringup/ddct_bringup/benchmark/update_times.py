# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Update times of judged controllers as ratios to that of `pi`, in turn with it on this machine.

They are wall-clock times, so they differ each time, and stand in a file of their own.
"""

import statistics
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Literal, TypedDict, cast, get_args

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.timing_and_failure import TIMING_FILE, RunTiming
from ddct_controllers.registry import Chosen
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError, ParameterError, require_number
from ddct_plant.files.input_file import read_text_file
from ddct_plant.files.json_records import parse_json, write_json
from ddct_plant.scenario.settings import RunSettings

REFERENCE = 'pi'
_Time = Literal[
    'ratio_to_pi',
    'lowest_ratio',
    'highest_ratio',
    'update_time_median_us',
    'pi_update_time_median_us',
]
_TIMES: tuple[_Time, ...] = get_args(_Time)
_ROUNDS = 3
"""Number of runs of each, in turn, so that a busy machine slows both alike."""


class UpdateTime(TypedDict, total=False):
    """Update time of a controller; without a ratio there is the reason alone."""

    ratio_to_pi: float | None
    reason: str
    lowest_ratio: float
    highest_ratio: float
    update_time_median_us: float
    pi_update_time_median_us: float


class UpdateTimesFile(TypedDict):
    """Content of the file: the controller of the denominator, and the update times by name."""

    reference: str
    controllers: Mapping[str, UpdateTime]


def write_update_times(judged: Sequence[Judged], cases: Cases, out: Path) -> None:
    """Measure the update times and write them into a folder, unless they are there."""
    if (out / TIMING_FILE).exists():
        return
    settings = cases.planned.run(0).settings
    found = {each.name: _update_time(each, settings) for each in judged}
    content: UpdateTimesFile = {'reference': REFERENCE, 'controllers': found}
    write_json(str(out / TIMING_FILE), content)


def read_update_times(out: Path) -> UpdateTimesFile:
    """Return the content of the file in a folder; raise DdctError for one that is damaged."""
    path = out / TIMING_FILE
    try:
        content = parse_json(read_text_file(path))
        for name, found in content['controllers'].items():
            _require_complete(name, found)
    except (OSError, ParameterError, LookupError, TypeError, AttributeError) as error:
        raise DdctError(
            f'it has no update times ({error}): delete it, and the same command measures them '
            'again',
            place=path,
        ) from error
    return cast(UpdateTimesFile, content)


def _require_complete(name: str, found: UpdateTime) -> None:
    """Raise ParameterError or LookupError unless there are all times, or a reason for none."""
    if found['ratio_to_pi'] is not None:
        for key in _TIMES:
            require_number(f'{name}.{key}', found[key])
    elif not isinstance(found['reason'], str):
        raise ParameterError(f'{name}.reason is no text', key='reason')


def median_ratio(chosen: Chosen, reference: str, settings: RunSettings) -> float:
    """Return the ratio of two controllers' update times, the median over runs in turn."""
    ratios = []
    for _ in range(_ROUNDS):
        other = _median_us(reference, settings)
        ratios.append(_median_us(chosen, settings) / other)
    return statistics.median(ratios)


def _update_time(judged: Judged, settings: RunSettings) -> UpdateTime:
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


def _median_us(chosen: Chosen, settings: RunSettings) -> float:
    timing = RunTiming()
    run_headless(settings, chosen, timing)
    return statistics.median(timing.update_times_us)

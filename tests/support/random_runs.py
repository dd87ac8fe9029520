# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Random runs of all controllers against their floors: no run may lie below.

    python tests/support/random_runs.py --runs 4000
    python tests/support/random_runs.py --runs 1000 --shifts

takes some ten minutes; with --shifts they are gear shifts with random handovers. Each run is a
point of the program that bounds it: its residual in all constraints and its distance to its floor
are checked. The exit code is 1 where one fails.
"""

import argparse
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ddct_bringup.floor.bound import bound_of
from ddct_bringup.floor.case import case_of_run
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.lock import lock_of
from ddct_bringup.floor.objectives import OBJECTIVES, Signals
from ddct_bringup.floor.point import point_of
from ddct_bringup.floor.values import value_of
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.handover.laws import HANDOVERS
from ddct_controllers.interface import Controller
from ddct_controllers.registry import controller_names, make_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.settings import RunSettings

RESIDUAL = 1e-7
"""Largest residual of a run in a constraint, in rad/s or N m."""
BELOW = 1e-6
"""How far a run may lie below its floor, as a share of the floor."""
SCENARIOS = ('launch', 'launch_hot', 'launch_gentle', 'thesis_sticking', 'thesis')
SHIFTS = ('upshift', 'upshift_2_3', 'upshift_hot', 'upshift_light', 'upshift_full')
QUICK = ('peak_jerk', 'peak_acceleration', 'acceleration_std_m_s2')
"""Metrics whose bound takes about a tenth of a second; every tenth run has another one."""
SLOW = tuple(name for name in OBJECTIVES if name not in QUICK)


@dataclass(frozen=True)
class Outcome:
    """Comparison of one random run with its floor."""

    run: str
    """Description of the run."""
    covered: bool
    """Whether the run has a floor: it locks once and stays locked."""
    residual: float = 0.0
    """Largest violation of a constraint by the run."""
    below: float = 0.0
    """How far the run is below its floor, as a share of it; not positive for a true floor."""

    @property
    def wrong(self) -> bool:
        """Whether the run contradicts its floor."""
        return self.covered and (self.residual > RESIDUAL or self.below > BELOW)


def outcomes(runs: int, seed: int, first: int = 0, *, shifts: bool = False) -> Iterator[Outcome]:
    """Yield the comparison of random runs from `first` on; run i depends on seed and i alone."""
    for index in range(first, runs):
        yield outcome(np.random.default_rng((seed, index)), index, shifts=shifts)


def outcome(random: np.random.Generator, index: int, *, shifts: bool = False) -> Outcome:
    """Return the comparison of one random run, or gear shift, with its floor."""
    scenarios = SHIFTS if shifts else SCENARIOS
    scenario = scenarios[random.integers(len(scenarios))]
    names = controller_names()
    name = names[random.integers(len(names))]
    changes = {
        'reference.slope_rad_s2': float(random.uniform(60.0, 250.0)),
        'load.slope_rad': float(random.uniform(-0.02, 0.04)),
        'actuator.bandwidth_factor': float(random.uniform(0.7, 1.5)),
        'actuator.delay_s': float(random.integers(5, 25)) / 1000.0,
    }
    wear = float(random.uniform(0.7, 1.3))
    of_shift: dict[str, Any] = {}
    if shifts:
        changes |= random_shift(random)
        of_shift['handover'] = list(HANDOVERS)[random.integers(len(HANDOVERS))]
        of_shift['off_going_wear_gain'] = float(random.uniform(0.7, 1.3))
    text = f'{index}: {name} in {scenario}, wear gain {wear:.3f}, {changes}, {of_shift}'
    file = ScenarioFile.read(scenario)
    try:
        loaded = file.scenario(changes)
        settings = RunSettings.of(loaded, {**of_shift, 'wear_gain': wear})
        controller = make_controller(name, settings.known)
        assert isinstance(controller, Controller)
        run = run_headless(settings, controller)
        start = control_start(settings)
    except DdctError:
        return Outcome(text, covered=False)
    lock = lock_of(run, start.step, packaged_limits().rules)
    if lock is not None and start.off_going and lock.time_s <= start.off_going.open_s:
        return Outcome(text, covered=False)
    case = None
    if lock is not None and run.steps == settings.scenario.steps:
        case = case_of_run(settings, start, lock, run)
    if case is None:
        return Outcome(text, covered=False)
    point = point_of(case, run)
    rows, limits = case.inequalities.rows, case.inequalities.limits
    columns = case.motion.columns
    residual = max(
        float(np.max(rows @ point - limits, initial=0.0)),
        float(np.max(np.abs(case.equations @ point), initial=0.0)),
        float(np.max(columns.low - point[1:], initial=0.0)),
        float(np.max(point[1:] - columns.high, initial=0.0)),
    )
    pool = SLOW if index % 10 == 0 else QUICK
    metric = pool[random.integers(len(pool))]
    signals = Signals.of_motion(case.motion, settings.scenario)
    bound = bound_of(case, OBJECTIVES[metric], signals)
    value = value_of(settings, metric, run, start.scored_from)
    if bound is None or value is None:
        return Outcome(f'{text}, {metric}', covered=True, residual=residual)
    least = np.inf if bound.least is None else bound.least
    below = (least - value) / max(value, 1e-9)
    return Outcome(f'{text}, {metric} {value:.6g}, least {least:.6g}', True, residual, below)


def random_shift(random: np.random.Generator) -> dict[str, float]:
    """Return random values of keys that only a gear shift has; every other one has a cut."""
    return {
        'shift.handover_s': float(random.integers(8, 30)) / 100.0,
        'shift.handover_slip_rad_s': float(random.uniform(2.0, 8.0)),
        'shift.torque_cut_n_m': max(float(random.uniform(-40.0, 40.0)), 0.0),
    }


def main() -> int:
    """Compare the runs, print what contradicts its floor, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--runs', type=int, default=4000)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--shifts', action='store_true', help='gear shifts, not launches')
    parser.add_argument('--first', type=int, default=0, help='index of the first run')
    options = parser.parse_args()
    started = time.monotonic()
    done: list[Outcome] = []
    for each in outcomes(options.runs, options.seed, options.first, shifts=options.shifts):
        done.append(each)
        if each.wrong:
            print(f'WRONG residual {each.residual:.3g}, below by {each.below:.3g}: {each.run}')
        if len(done) % 100 == 0:
            print(f'{len(done)} runs, {time.monotonic() - started:.0f} s', file=sys.stderr)
    covered = [each for each in done if each.covered]
    wrong = sum(each.wrong for each in done)
    print(
        f'{len(done)} runs, {len(covered)} with a floor, {wrong} wrong; largest residual '
        f'{max((each.residual for each in covered), default=0.0):.2e}, nearest to its floor '
        f'{0.0 - max((each.below for each in covered), default=0.0):.2e} above it'
    )
    return 1 if wrong else 0


if __name__ == '__main__':
    raise SystemExit(main())

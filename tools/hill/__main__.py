# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Why `launch_hill` has no floor: the brake as a variable, and the breakaway at a given period.

    tools/run hill --lock-times 0.8,1.0

A wheel at rest has any friction up to that of brake and rolling resistance, and a wheel that turns
has all of it. For each lock time this prints the least peak jerk of two larger sets, in which the
friction of each period is any number up to that: with another number at the end of each period,
which contains every run, and without, which does not. Below are the least where the wheel is at
rest up to a given period and has all of the friction afterwards, and at last the runs of some
controllers. Air resistance and the limits of the engine are left out.
"""

import argparse
from dataclasses import replace

import numpy as np

from ddct_bringup.floor.case import MOST_REQUESTS, Case
from ddct_bringup.floor.dynamics.capacity import capacity_range
from ddct_bringup.floor.dynamics.engine_laws import demand_law
from ddct_bringup.floor.dynamics.laws import Law
from ddct_bringup.floor.dynamics.start import Start, start_of
from ddct_bringup.floor.dynamics.tube import rigid_tube
from ddct_bringup.floor.lock import Lock, lock_of
from ddct_bringup.floor.objectives import OBJECTIVES, Signals
from ddct_bringup.floor.program.peak import peak_program
from ddct_bringup.floor.program.solve import solve
from ddct_bringup.floor.values import value_of
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.timebase import time_of_step
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.plant import holding_torque, make_load
from ddct_plant.scenario.settings import KnownSettings, RunSettings

METRIC = 'peak_jerk'
BREAKAWAYS = (5, 8, 10, 15, 25, 40)
"""Periods after control start at whose end the wheel breaks loose."""


def hill_case(settings: RunSettings, start: Start, lock_s: float, breakaway: int | None) -> Case:
    """Return the case with the brake as a variable, up to the breakaway where there is one."""
    steps = range(start.step, settings.scenario.steps + 1)
    grade = np.full(len(steps), make_load(settings).torque(0.0, 0.0))
    held = np.array([holding_torque(settings).capacity(time_of_step(step)) for step in steps])
    free = np.arange(len(steps)) < (len(steps) if breakaway is None else breakaway)
    load = Law(grade, np.zeros(len(steps)), np.where(free, -held, held), held)
    return Case(
        settings,
        start,
        Lock(lock_s),
        rigid_tube(settings, start, lock_s),
        False,
        capacity_range(settings, start.temperature_c),
        packaged_limits().rules,
        MOST_REQUESTS * settings.scenario.friction.worn_request,
        (demand_law(settings, start.step, len(steps)), load),
    )


def least_peak(case: Case, breakaway: int | None, *, within: bool = False) -> float | None:
    """
    Return the least peak jerk of a case whose wheel does not turn before the breakaway.

    The friction of a period is its mean; with `within` that at its end is another variable, as the
    friction of a wheel at rest changes with the shaft.
    """
    motion, columns = case.motion, case.motion.columns
    signals = Signals.of_motion(motion, case.settings.scenario)
    periods = columns.load.stop - columns.load.start if within else 0
    ends = np.zeros((periods, signals.acceleration.shape[1]))
    steps, held = np.arange(periods), case.load.high[:periods]
    scenario = case.settings.scenario
    scale = scenario.vehicle.wheel_radius_m / scenario.driveline.vehicle_inertia
    ends[steps, case.start.step + 1 + steps] = -scale
    wider = replace(signals, acceleration=np.vstack([signals.acceleration, ends]))
    mapped = OBJECTIVES[METRIC].of(wider)
    assert mapped is not None
    resting = motion.wheel_speed[1 : 1 + (breakaway or 0)]
    turning = -motion.wheel_speed[1 + len(resting) :]
    every = np.vstack([case.clutch_limits.rows, turning])
    values = np.append(case.clutch_limits.limits, np.zeros(len(turning))) - every[:, 0]
    equal = np.vstack([case.equations, resting])
    friction = np.zeros((periods, columns.count - 1 + periods))
    friction[steps, columns.load.start - 1 + steps] = 1.0
    friction[steps, columns.count - 1 + steps] = 1.0
    program = peak_program(
        np.ascontiguousarray(mapped.T)[:, 1:],
        mapped[0],
        np.vstack([np.pad(every[:, 1:], ((0, 0), (0, periods))), friction, -friction]),
        np.concatenate([values, held, held]),
        np.pad(equal[:, 1:], ((0, 0), (0, periods))),
        -equal[:, 0],
        np.append(columns.low, -2.0 * held),
        np.append(columns.high, 2.0 * held),
    )
    none = np.zeros(len(program.cost), dtype=bool)
    deferred = np.ones(len(program.limits), dtype=bool)
    deferred[: program.peaks] = False
    deferred[len(deferred) - 2 * periods :] = False
    solution = solve(program, none, np.zeros(len(none)), deferred)
    return None if solution is None else solution.certificate.claim


def main() -> int:
    """Print the values for each lock time."""
    parser = argparse.ArgumentParser(prog='tools/run hill', description=__doc__.splitlines()[1])
    parser.add_argument('--lock-times', default='1.0')
    parser.add_argument('--controllers', default='pi,ls8,hinf_sampled')
    options = parser.parse_args()
    settings = RunSettings(KnownSettings(load_scenario('launch_hill')))
    start = start_of(settings, run_headless(settings, 'pi'))
    for lock_s in map(float, options.lock_times.split(',')):
        any_friction = hill_case(settings, start, lock_s, None)
        print(
            f'lock at {lock_s:g} s: friction that changes within a period '
            f'{_text(least_peak(any_friction, None, within=True))}, that is constant '
            f'{_text(least_peak(any_friction, None))}',
            flush=True,
        )
        for breakaway in BREAKAWAYS:
            case = hill_case(settings, start, lock_s, breakaway)
            print(f'  at rest for {breakaway} periods {_text(least_peak(case, breakaway))}')
    for name in options.controllers.split(','):
        run = run_headless(settings, name)
        lock = lock_of(run, start.step, packaged_limits().rules)
        turns = int(np.argmax(run.wheel_speed > 0.0)) - start.step
        value = value_of(settings, METRIC, run, start.step)
        print(
            f'{name}: turns after {turns} periods, lock at '
            f'{_text(lock.time_s if lock else None)} s, peak {_text(value)}'
        )
    return 0


def _text(value: float | None) -> str:
    return 'none' if value is None else f'{value:.3g}'


if __name__ == '__main__':
    raise SystemExit(main())

"""How a pull towards the driver's demand closes the torque level that MPC4's cost leaves open."""

import math

import numpy as np

from ddct_bringup.reproduction.runs import THESIS_SCENARIO, THESIS_SETTINGS, headless_run
from ddct_bringup.reproduction.studies.study import TWO_INPUTS, Study, cells, headers
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import TwoInputCost
from ddct_controllers.mpc.estimate.observer import Observer
from ddct_controllers.mpc.estimators import make_observer
from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    REQUEST,
    STATES,
    TransmissionModel,
    transmission_model,
)
from ddct_controllers.mpc.program.horizon import CondensedProgram
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine import EngineAuthority

PULLS = (0.0, 0.01, 0.05, 0.1, 0.14, 0.2, 0.5, 1.0, 2.0)
NEAR_WEAR = (0.95, 1.05)
ALL_BUT_ONE = 1.0 - 1e-6
"""Beyond this a mode is as good as an integrator."""
COASTING_S = 170


def torque_level() -> Study:
    """Return figures and slowest modes of MPC4 for each weight of the pull."""
    driveline = THESIS_SCENARIO.driveline
    model = transmission_model(driveline)
    worn = [transmission_model(driveline, gain) for gain in NEAR_WEAR]
    rows = []
    for pull in PULLS:
        observer = make_observer(THESIS_SETTINGS, model)
        settings = TwoInputCost(demand_weight=pull).settings()
        mpc4 = MpcController(model, observer, settings, EngineAuthority())
        run = headless_run(THESIS_SETTINGS, mpc4)
        left = run.trajectory.engine_torque[-1] - run.trajectory.torque_demand[-1]
        rows.append(
            (
                f'{pull:g}',
                *cells(TWO_INPUTS, run),
                f'{left:.1f}',
                ', '.join(f'{time:.3g}' for time in slow_times_s(mpc4.program, observer)),
                *(f'{growth(mpc4.program, observer, plant):.3f}' for plant in worn),
            )
        )
    return Study(
        'MPC4 in the thesis scenario, by its pull towards the demand',
        (
            'pull per N m',
            *headers(TWO_INPUTS),
            'left at end N m',
            'slowest modes s',
            *(f'growth at K_usura {gain:g}' for gain in NEAR_WEAR),
        ),
        rows,
        (f'One of the slowest modes, {COASTING_S:g} s, is the vehicle that coasts.',),
    )


def closed_loop(
    program: CondensedProgram, observer: Observer, plant: TransmissionModel
) -> np.ndarray:
    """
    Return the matrix (2 STATES, 2 STATES) of `plant` and filter within limits.

    Without weights on the moves the inputs follow from the estimate alone.
    """
    feedback = -np.linalg.solve(program.structure.hessian, program.gradient[:, :STATES])
    inputs, measured = [REQUEST, ENGINE_TORQUE], np.eye(observer.gain.shape[1], STATES)
    correction = observer.gain @ measured
    estimate = np.hstack([correction, np.eye(STATES) - correction])
    moves, model = feedback @ estimate, observer.model
    return np.vstack(
        [
            np.hstack([plant.a, np.zeros_like(plant.a)]) + plant.b[:, inputs] @ moves,
            model.a @ estimate + model.b[:, inputs] @ moves,
        ]
    )


def growth(program: CondensedProgram, observer: Observer, plant: TransmissionModel) -> float:
    """Return the factor by which the fastest growing mode grows per period; below 1 none does."""
    return float(np.abs(np.linalg.eigvals(closed_loop(program, observer, plant))).max())


def slow_times_s(program: CondensedProgram, observer: Observer) -> list[float]:
    """Return the three longest time constants with the plant that the observer expects."""
    sizes = np.abs(np.linalg.eigvals(closed_loop(program, observer, observer.model)))
    times = [
        PERIOD_S / -math.log(size) if 0.0 < size < ALL_BUT_ONE else math.inf for size in sizes
    ]
    return sorted(times, reverse=True)[:3]

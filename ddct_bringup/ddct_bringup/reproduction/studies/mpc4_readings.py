# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""MPC4 under the readings that Section 4.3 allows, and with a pull towards the demand."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.reproduction.studies.changed_loops import (
    LoopWithMeasuredState,
    LoopWithoutActuator,
    MeasuredState,
    growth,
    model_without_actuator,
    slow_times_s,
)
from ddct_bringup.reproduction.studies.study import (
    AS_PRINTED,
    TWO_INPUT_WEIGHTS,
    TWO_INPUTS,
    WEAR_GAINS,
    Study,
    cells,
    headers,
    identified_by,
)
from ddct_bringup.reproduction.study_run import (
    THESIS_SCENARIO,
    THESIS_SETTINGS,
    StaticControllerAlone,
    StudyRun,
    study_run,
    thesis_run,
)
from ddct_bringup.run.headless import run_loop
from ddct_bringup.thesis.table_5_1 import ROW_OF
from ddct_controllers.loop import ClosedLoop
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import TwoInputCost
from ddct_controllers.mpc.estimate.observer import Observer
from ddct_controllers.mpc.estimators import make_observer
from ddct_controllers.mpc.model.transmission_model import TransmissionModel, transmission_model
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.models.actuator import PRINTED_ACTUATOR
from ddct_plant.models.engine import EngineAuthority
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.settings import KnownSettings, RunSettings

PULLS = (0.0, 0.01, 0.05, 0.1, 0.14, 0.2, 0.5, 1.0, 2.0)
NEAR_WEAR = (0.95, 1.05)
COASTING_S = 170
STIFFER_PULL = 0.05
"""Pull r of the readings with less weight on dw_d/dt, by the argument used in the registry."""
Model = Callable[[DrivelineParameters, float], TransmissionModel]
"""Function from the driveline and the wear gain to the model."""


@dataclass(frozen=True)
class Mpc4Reading:
    """Settings and models of MPC4 under one reading, and the plant."""

    settings: MpcSettings
    model: Model = transmission_model
    """Model in the controller."""
    plant: Model = transmission_model
    observer: Callable[[KnownSettings, TransmissionModel], Observer] = make_observer

    def controller(self, run: RunSettings) -> MpcController[Any]:
        """Return the controller of a run."""
        model = self.model(run.scenario.driveline, 1.0)
        observer = self.observer(run.known, model)
        return MpcController(model, observer, self.settings, run.scenario.engine_authority)

    def run(self) -> Trajectory:
        """Return the run of the reading in the thesis scenario."""
        settings = THESIS_SETTINGS
        loop: type[ClosedLoop] = ClosedLoop
        if self.observer is MeasuredState:
            loop = LoopWithMeasuredState
        elif self.plant is not transmission_model:
            # The same initial slip, which a run without actuator does not reach.
            start = thesis_run('pi', 'detailed', 1.0)
            speed = THESIS_SCENARIO.initial.shaft_speed_rad_s
            slip = float(start.trajectory.slip_speed[start.start])
            initial = replace(THESIS_SCENARIO.given_initial, engine_speed_rad_s=speed + slip)
            settings = RunSettings(KnownSettings(replace(THESIS_SCENARIO, given_initial=initial)))
            loop = LoopWithoutActuator
        return run_loop(loop(settings, self.controller(settings)), settings.scenario.steps)

    def growth(self, wear_gain: float) -> float:
        """Return the growth factor per period of the loop with a worn clutch, see `growth`."""
        mpc4 = self.controller(THESIS_SETTINGS)
        return growth(
            mpc4.program, mpc4.observer, self.plant(THESIS_SCENARIO.driveline, wear_gain)
        )


def _no_delay(driveline: DrivelineParameters, wear_gain: float) -> TransmissionModel:
    return transmission_model(driveline, wear_gain, replace(PRINTED_ACTUATOR, delay_s=0.0))


_SETTINGS = TwoInputCost().settings()
_SQUARED = TwoInputCost(0.05, STIFFER_PULL).settings()
_MIXED = TwoInputCost(rad_s_from_rpm(math.sqrt(0.05)), STIFFER_PULL).settings()
_NOWHERE = model_without_actuator, model_without_actuator
"""Models without an actuator, for the controller and for the plant."""
READINGS: Mapping[str, Mpc4Reading] = {
    "x'Qx, reference along its tangent": Mpc4Reading(_SETTINGS),
    "x'Qx, coming reference": Mpc4Reading(replace(_SETTINGS, preview=True)),
    "x'Qx, reference held": Mpc4Reading(replace(_SETTINGS, along_tangent=False)),
    'state measured': Mpc4Reading(_SETTINGS, observer=MeasuredState),
    'weights squared': Mpc4Reading(_SQUARED),
    'weights squared, coming reference': Mpc4Reading(replace(_SQUARED, preview=True)),
    'weights squared, reference held': Mpc4Reading(replace(_SQUARED, along_tangent=False)),
    'w_d in rpm, dw_d/dt in rad/s^2': Mpc4Reading(_MIXED),
    'no delay in its model': Mpc4Reading(_SETTINGS, _no_delay),
    'no actuator in its model': Mpc4Reading(_SETTINGS, model_without_actuator),
    'no actuator in its model, state measured': Mpc4Reading(
        _SETTINGS, model_without_actuator, observer=MeasuredState
    ),
    'no actuator at all': Mpc4Reading(_SETTINGS, *_NOWHERE),
    'no actuator at all, coming reference': Mpc4Reading(
        replace(_SETTINGS, preview=True), *_NOWHERE
    ),
    'no actuator at all, weights squared': Mpc4Reading(_SQUARED, *_NOWHERE),
}
"""Readings by name; the first is that of the registry."""


def mpc4_readings() -> Study:
    """Return the metrics of MPC4 under each reading."""
    rows = [
        (
            name,
            *cells(TWO_INPUTS, StudyRun(THESIS_SETTINGS, 'mpc4', reading.run())),
            *(f'{reading.growth(gain):.3f}' for gain in WEAR_GAINS),
        )
        for name, reading in READINGS.items()
    ]
    alone = cells(TWO_INPUTS, study_run(THESIS_SETTINGS, StaticControllerAlone()))
    time, torsion, acceleration = ROW_OF['mpc4'].cells()
    none = ('-',) * len(WEAR_GAINS)
    return Study(
        'MPC4 in the thesis scenario, by reading',
        (
            'reading',
            *headers(TWO_INPUTS),
            *(f'growth at K_usura {gain:g}' for gain in WEAR_GAINS),
        ),
        [
            *rows,
            ('C_fOL alone, C_m as demanded', *alone, *none),
            (f'MPC4 {AS_PRINTED}', time, '-', torsion, acceleration, '-', '-', *none),
        ],
        ('Growth is that of the fastest mode of plant, filter and feedback per period of 10 ms.',),
        weights=(*identified_by(1), *TWO_INPUT_WEIGHTS),
    )


def torque_level() -> Study:
    """Return the effect of a pull towards the demand on the free torque level."""
    driveline = THESIS_SCENARIO.driveline
    model = transmission_model(driveline)
    worn = [transmission_model(driveline, gain) for gain in NEAR_WEAR]
    rows = []
    for pull in PULLS:
        observer = make_observer(THESIS_SETTINGS.known, model)
        settings = TwoInputCost(demand_weight=pull).settings()
        mpc4 = MpcController(model, observer, settings, EngineAuthority())
        run = study_run(THESIS_SETTINGS, mpc4)
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
        weights=(*identified_by(1), *TWO_INPUT_WEIGHTS),
    )

"""MPC4 under the readings that Section 4.3 of the thesis leaves open."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.reproduction.runs.runs import THESIS_SCENARIO, thesis_run
from ddct_bringup.reproduction.studies.static_controller import StaticControllerAlone
from ddct_bringup.reproduction.studies.study import Study
from ddct_bringup.reproduction.studies.two_input.actuator_left_out import (
    LoopWithoutActuator,
    model_without_actuator,
)
from ddct_bringup.reproduction.studies.two_input.measured_state import (
    LoopWithMeasuredState,
    MeasuredState,
)
from ddct_bringup.reproduction.studies.two_input.torque_level import growth
from ddct_bringup.reproduction.studies.two_input.two_input_figures import HEADERS, cells
from ddct_bringup.run.headless import run_headless, run_loop
from ddct_bringup.thesis.table_5_1 import thesis_row
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import mpc4_settings
from ddct_controllers.mpc.estimate.observer import Observer
from ddct_controllers.mpc.estimators import make_observer
from ddct_controllers.mpc.model.transmission_model import TransmissionModel, transmission_model
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.settings import RunSettings

SETTINGS = RunSettings(THESIS_SCENARIO)
WEAR_GAINS = (0.7, 1.0, 1.3)
"""At which growth is shown: the ends of the thesis's Table 5.2, and a new clutch."""
GROWTH_HEADERS = tuple(f'growth at K_usura {gain:g}' for gain in WEAR_GAINS)
STIFFER_PULL = 0.05
"""Of the readings with less weight on dw_d/dt, by the same argument as the registry's."""
Model = Callable[[DrivelineParameters, float], TransmissionModel]
"""From the driveline and the wear gain."""


@dataclass(frozen=True)
class Reading:
    """What one reading makes of MPC4, and of the plant."""

    settings: MpcSettings
    model: Model = transmission_model
    """In the controller."""
    plant: Model = transmission_model
    observer: Callable[[RunSettings, TransmissionModel], Observer] = make_observer

    def controller(self, run: RunSettings) -> MpcController:
        """Return the controller of a run."""
        model = self.model(run.scenario.driveline, 1.0)
        observer = self.observer(run, model)
        return MpcController(model, observer, self.settings, run.scenario.engine_authority)

    def run(self) -> Trajectory:
        """Return its run in the thesis scenario."""
        if self.observer is MeasuredState:
            loop = LoopWithMeasuredState(SETTINGS, self.controller(SETTINGS))
            return run_loop(loop, SETTINGS.scenario.steps)
        if self.plant is transmission_model:
            return run_headless(SETTINGS, self.controller(SETTINGS))
        # From the same slip, which without an actuator does not come about by itself.
        slip = thesis_run('pi', 'detailed', 1.0).slip_speed[THESIS_SCENARIO.control_start_step]
        speeds = THESIS_SCENARIO.initial
        initial = replace(speeds, engine_speed_rad_s=speeds.shaft_speed_rad_s + float(slip))
        run = RunSettings(replace(THESIS_SCENARIO, initial=initial))
        return run_loop(LoopWithoutActuator(run, self.controller(run)), run.scenario.steps)

    def growth(self, wear_gain: float) -> float:
        """Return the growth per period of its loop with a worn clutch, see `torque_level`."""
        mpc4 = self.controller(SETTINGS)
        return growth(
            mpc4.program, mpc4.observer, self.plant(THESIS_SCENARIO.driveline, wear_gain)
        )


_DEFAULT = Reading(mpc4_settings())
_SQUARED = Reading(mpc4_settings(0.05, STIFFER_PULL))
_MIXED = Reading(mpc4_settings(rad_s_from_rpm(math.sqrt(0.05)), STIFFER_PULL))


_NO_ACTUATOR = replace(_DEFAULT, model=model_without_actuator)


def _no_delay(driveline: DrivelineParameters, wear_gain: float) -> TransmissionModel:
    return transmission_model(driveline, wear_gain, delay=False)


def _held(reading: Reading) -> Reading:
    return replace(reading, settings=replace(reading.settings, along_tangent=False))


def _measured(reading: Reading) -> Reading:
    return replace(reading, observer=MeasuredState)


def _previewed(reading: Reading) -> Reading:
    return replace(reading, settings=replace(reading.settings, preview=True))


def _without_actuator(reading: Reading) -> Reading:
    return replace(reading, model=model_without_actuator, plant=model_without_actuator)


READINGS: Mapping[str, Reading] = {
    "x'Qx, reference along its tangent": _DEFAULT,
    "x'Qx, coming reference": _previewed(_DEFAULT),
    "x'Qx, reference held": _held(_DEFAULT),
    'state measured': _measured(_DEFAULT),
    'weights squared': _SQUARED,
    'weights squared, coming reference': _previewed(_SQUARED),
    'weights squared, reference held': _held(_SQUARED),
    'w_d in rpm, dw_d/dt in rad/s^2': _MIXED,
    'no delay in its model': replace(_DEFAULT, model=_no_delay),
    'no actuator in its model': _NO_ACTUATOR,
    'no actuator in its model, state measured': _measured(_NO_ACTUATOR),
    'no actuator at all': _without_actuator(_DEFAULT),
    'no actuator at all, coming reference': _previewed(_without_actuator(_DEFAULT)),
    'no actuator at all, weights squared': _without_actuator(_SQUARED),
}
"""The first is what the registry has."""


def mpc4_readings() -> Study:
    """Return the figures of MPC4 under each reading."""
    rows = [
        (
            name,
            *cells(SETTINGS, reading.run()),
            *(f'{reading.growth(gain):.3f}' for gain in WEAR_GAINS),
        )
        for name, reading in READINGS.items()
    ]
    alone = cells(SETTINGS, run_headless(SETTINGS, StaticControllerAlone()))
    printed = thesis_row('mpc4')
    assert printed is not None
    time, torsion, acceleration = (format(value, 'g') for value in printed.figures().values())
    none = ('-',) * len(WEAR_GAINS)
    return Study(
        'MPC4 in the thesis scenario, by reading',
        ('reading', *HEADERS, *GROWTH_HEADERS),
        [
            *rows,
            ('C_fOL alone, C_m as demanded', *alone, *none),
            ('MPC4 as the thesis prints it', time, '-', torsion, acceleration, '-', '-', *none),
        ],
        ('Growth is that of the fastest mode of plant, filter and feedback per period of 10 ms.',),
    )

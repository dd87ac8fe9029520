"""MPC4 under the readings that Section 4.3 of the thesis leaves open."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.headless import run_headless, run_loop
from ddct_bringup.scores.thesis_table import thesis_row
from ddct_bringup.studies.actuator_left_out import LoopWithoutActuator, model_without_actuator
from ddct_bringup.studies.two_input_figures import HEADERS, cells
from ddct_bringup.thesis.runs import THESIS_SCENARIO, thesis_run
from ddct_controllers.design.study import Study
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.mpc.build import make_observer
from ddct_controllers.mpc.predictive_controller import PredictiveController
from ddct_controllers.mpc.settings import MpcSettings
from ddct_controllers.mpc.thesis_mpc4 import mpc4_settings
from ddct_controllers.mpc.transmission_model import TransmissionModel, transmission_model
from ddct_controllers.mpc.two_input_mpc import TwoInputController
from ddct_plant.run_settings import RunSettings
from ddct_plant.units import rad_s_from_rpm

SETTINGS = RunSettings(THESIS_SCENARIO)
MODEL = transmission_model(THESIS_SCENARIO.driveline)
STIFFER_PULL = 0.05
"""Of the readings with less weight on dw_d/dt, by the same argument as the registry's."""


def mpc4_readings() -> Study:
    """Return the figures of MPC4 under each reading; the first is what the registry has."""
    rows = [(reading, *cells(SETTINGS, run())) for reading, run in _READINGS.items()]
    printed = thesis_row('mpc4')
    assert printed is not None
    time, torsion, acceleration = (format(value, 'g') for value in printed.figures().values())
    thesis = ('MPC4 as the thesis prints it', time, '-', torsion, acceleration, '-', '-')
    return Study('MPC4 in the thesis scenario, by reading', ('reading', *HEADERS), [*rows, thesis])


class _HeldReference(TwoInputController):
    """Holds both references over the horizon, although the one is the other's derivative."""

    def _references(self, measurement: Measurement) -> np.ndarray:
        return PredictiveController._references(self, measurement)


class _StaticControllerAlone(Controller):
    """Leaves the clutch to C_fOL and the engine to the driver."""

    def reset(self) -> None:
        """There is nothing to forget."""

    def update(self, measurement: Measurement) -> Command:
        """Return no torque."""
        return Command(0.0)


def _run(
    settings: MpcSettings,
    model: TransmissionModel = MODEL,
    kind: type[TwoInputController] = TwoInputController,
) -> Trajectory:
    return run_headless(SETTINGS, _controller(SETTINGS, settings, model, kind))


def _controller(
    run: RunSettings,
    settings: MpcSettings,
    model: TransmissionModel,
    kind: type[TwoInputController],
) -> TwoInputController:
    return kind(model, make_observer(run, model), settings, run.scenario.engine_authority)


def _without_actuator(settings: MpcSettings) -> Trajectory:
    """Run from the same slip, which without an actuator does not come about by itself."""
    slip = thesis_run('pi', 'detailed', 1.0).slip_speed[THESIS_SCENARIO.control_start_step]
    speeds = THESIS_SCENARIO.initial
    initial = replace(speeds, engine_speed_rad_s=speeds.shaft_speed_rad_s + float(slip))
    run = RunSettings(replace(THESIS_SCENARIO, initial=initial))
    model = model_without_actuator(run.scenario.driveline)
    controller = _controller(run, settings, model, TwoInputController)
    return run_loop(LoopWithoutActuator(run, controller), run.scenario.steps)


_DEFAULT = mpc4_settings()
_SQUARED = mpc4_settings(0.05, STIFFER_PULL)
_MIXED = mpc4_settings(rad_s_from_rpm(math.sqrt(0.05)), STIFFER_PULL)
_READINGS: Mapping[str, Callable[[], Trajectory]] = {
    "x'Qx, reference along its tangent": lambda: _run(_DEFAULT),
    "x'Qx, coming reference": lambda: _run(replace(_DEFAULT, preview=True)),
    "x'Qx, reference held": lambda: _run(_DEFAULT, kind=_HeldReference),
    'weights squared': lambda: _run(_SQUARED),
    'weights squared, coming reference': lambda: _run(replace(_SQUARED, preview=True)),
    'weights squared, reference held': lambda: _run(_SQUARED, kind=_HeldReference),
    'w_d in rpm, dw_d/dt in rad/s^2': lambda: _run(_MIXED),
    'no actuator in its model': lambda: _run(
        _DEFAULT, model_without_actuator(THESIS_SCENARIO.driveline)
    ),
    'no actuator at all': lambda: _without_actuator(_DEFAULT),
    'no actuator at all, coming reference': lambda: _without_actuator(
        replace(_DEFAULT, preview=True)
    ),
    'no actuator at all, weights squared': lambda: _without_actuator(_SQUARED),
    'C_fOL alone, C_m as demanded': lambda: run_headless(SETTINGS, _StaticControllerAlone()),
}

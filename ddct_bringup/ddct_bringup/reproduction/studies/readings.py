"""MPC1-3 under the readings that Table 4.1 and Section 4.2 of the thesis leave open."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from ddct_bringup.reproduction.runs import THESIS_SCENARIO, HeadlessRun, headless_run
from ddct_bringup.reproduction.studies.changed_loops import model_without_actuator
from ddct_bringup.reproduction.studies.study import (
    TABLE_5_1,
    Study,
    cells,
    headers,
    metric_column,
)
from ddct_bringup.thesis.table_5_1 import ROW_OF
from ddct_bringup.verdict.metric_figures import METRICS
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import BASIS, TABLE_4_1, TableRow
from ddct_controllers.mpc.estimators import AS_DRAWN, FULL, ObserverInputs
from ddct_controllers.mpc.model.transmission_model import SLIP_SPEED, TransmissionModel
from ddct_controllers.mpc.program.settings import InputTerms, MpcSettings, OutputTerms
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings

Change = Callable[[MpcSettings], MpcSettings]


@dataclass(frozen=True)
class Reading:
    """What one reading makes of a row of Table 4.1."""

    change: Change = lambda settings: settings
    """Change of what the row means by itself."""
    knowledge: ObserverInputs = AS_DRAWN
    model: TransmissionModel | None = None
    """In place of the one that is known of."""
    noise_rpm: float = 1.0
    """Noise of the measured w_d."""
    beside: Callable[[MpcController], Controller] = lambda controller: controller
    """What becomes of C_fOL beside the controller."""
    architecture: str = 'detailed'

    def run(self, row: TableRow, scenario: Scenario = THESIS_SCENARIO) -> HeadlessRun:
        """Return its run in a scenario with the thesis's driveline."""
        run = RunSettings(scenario, self.architecture)
        settings = self.change(row.settings())
        parts = self.knowledge.parts(run, self.model, noise_rpm=self.noise_rpm)
        return headless_run(run, self.beside(MpcController(*parts, settings)))


def readings() -> Study:
    """Return the figures of MPC1-3 under each reading; the first is what the registry has."""
    columns = (
        *TABLE_5_1,
        metric_column(METRICS['slip_final_rpm'], 'z.1f', 'w_d at the end rpm'),
    )
    rows = [
        (name, label, *cells(columns, reading.run(row)))
        for name, row in TABLE_4_1.items()
        for label, reading in READINGS.items()
    ]
    return Study(
        'MPC1-3 in the thesis scenario, by reading of Section 4.2',
        ('controller', 'reading', *headers(columns)),
        [*rows, ('MPC3', 'as the thesis prints it', *ROW_OF['mpc3'].cells(), '-')],
    )


class OpenLoopUnknown(Controller):
    """The MPC takes its own torque for all there is, while C_fOL acts beside it."""

    def __init__(self, controller: MpcController) -> None:
        self._controller = controller
        self.preview_steps = controller.preview_steps

    def reset(self) -> None:
        """Reset the MPC."""
        self._controller.reset()

    def hold(self, measurement: Measurement) -> None:
        """Hold the MPC, which believes that the clutch is open."""
        self._controller.hold(replace(measurement, open_loop_torque=0.0))

    def update(self, measurement: Measurement) -> Command:
        """Return the MPC's answer, to which the architecture adds C_fOL."""
        return self._controller.update(replace(measurement, open_loop_torque=0.0))


class OpenLoopOff(Controller):
    """
    C_fOL is taken off at control start, and the MPC gives the whole torque.

    With `from_zero` its moves are counted from no torque at all, so the first has to bring it all;
    otherwise from the torque that there was.
    """

    def __init__(self, controller: MpcController, *, from_zero: bool = False) -> None:
        self._controller = controller
        self._from_zero = from_zero
        self.preview_steps = controller.preview_steps
        self._taken_over = 0.0

    def reset(self) -> None:
        """Reset the MPC and forget the torque."""
        self._controller.reset()
        self._taken_over = 0.0

    def hold(self, measurement: Measurement) -> None:
        """Note the torque to go on from."""
        self._controller.hold(measurement)
        self._taken_over = 0.0 if self._from_zero else measurement.open_loop_torque

    def update(self, measurement: Measurement) -> Command:
        """Return the MPC's whole request less the C_fOL that the architecture adds."""
        command = self._controller.update(replace(measurement, open_loop_torque=self._taken_over))
        whole = command.clutch_torque + self._taken_over
        return replace(command, clutch_torque=whole - measurement.open_loop_torque)


def _coming(settings: MpcSettings) -> MpcSettings:
    return replace(settings, preview=True)


def _per_rad_s(settings: MpcSettings) -> MpcSettings:
    """Take Q per rad/s."""
    return replace(settings, outputs=(OutputTerms(SLIP_SPEED, BASIS.output_weight),))


def _not_squared(settings: MpcSettings) -> MpcSettings:
    """Take Q e^2 + R du^2, the norm of Section 4.1: the weights that are squared are roots."""
    # What is weighted stays in rpm: 0.26 becomes its root, the rpm per rad/s do not.
    weight = settings.outputs[0].weight / math.sqrt(BASIS.output_weight)
    return replace(
        settings,
        outputs=(OutputTerms(SLIP_SPEED, weight),),
        inputs=(InputTerms(move_weight=math.sqrt(BASIS.move_weight)),),
    )


def _torque_weighed(settings: MpcSettings) -> MpcSettings:
    """Take R as the weight of the controller's torque, not of its moves."""
    return replace(settings, inputs=(InputTerms(target_weight=BASIS.move_weight),))


READINGS: Mapping[str, Reading] = {
    'as Figure 4.2 draws it': Reading(),
    'coming reference': Reading(_coming),
    'w_m, w_p and w_r measured': Reading(knowledge=replace(AS_DRAWN, measured='speeds')),
    'C_load known': Reading(knowledge=replace(AS_DRAWN, load_known=True)),
    'delay in its model': Reading(knowledge=replace(AS_DRAWN, delay_in_model=True)),
    'no actuator in its model': Reading(model=model_without_actuator(THESIS_SCENARIO.driveline)),
    'w_d in rad/s, its weight and its noise': Reading(_per_rad_s, noise_rpm=rpm_from_rad_s(1.0)),
    'Q per rad/s, noise as it is': Reading(_per_rad_s),
    'weights not squared': Reading(_not_squared),
    'R on u': Reading(_torque_weighed),
    'C_fOL off from 0.6 s, its torque taken over': Reading(beside=OpenLoopOff),
    'C_fOL off from 0.6 s, moves from 0': Reading(
        beside=lambda controller: OpenLoopOff(controller, from_zero=True)
    ),
    'C_fOL on, unknown to it': Reading(beside=OpenLoopUnknown),
    'base architecture': Reading(architecture='base'),
    'as mpc_preview': Reading(_coming, FULL),
    'as mpc_preview, reference held': Reading(knowledge=FULL),
    'as mpc_preview, Q per rad/s': Reading(lambda settings: _coming(_per_rad_s(settings)), FULL),
    'as mpc_preview, Q per rad/s, reference held': Reading(_per_rad_s, FULL),
}
"""The first is what the registry has as `mpc1` to `mpc3`."""

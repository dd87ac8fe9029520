"""MPC1-3 under the readings that Table 4.1 and Section 4.2 of the thesis leave open."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from ddct_bringup.reproduction.runs.runs import THESIS_SCENARIO
from ddct_bringup.reproduction.studies.open_loop_readings import OpenLoopOff, OpenLoopUnknown
from ddct_bringup.reproduction.studies.scored_run import FIGURE_HEADERS, figures, scored_run
from ddct_bringup.reproduction.studies.study import Study
from ddct_bringup.scores.metrics import Metrics
from ddct_bringup.thesis.table_5_1 import thesis_row
from ddct_controllers.interface import Controller
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import BASIS, TABLE_4_1, TableRow, thesis_settings
from ddct_controllers.mpc.estimators import stationary_filter
from ddct_controllers.mpc.knowledge import AS_DRAWN, FULL, Knowledge
from ddct_controllers.mpc.model.transmission_model import (
    REQUEST,
    SLIP_SPEED,
    TransmissionModel,
    transmission_model,
)
from ddct_controllers.mpc.program.settings import InputTerms, MpcSettings, OutputTerms
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.program.table import text_or_dash
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings

Change = Callable[[MpcSettings], MpcSettings]


@dataclass(frozen=True)
class Reading:
    """What one reading makes of a row of Table 4.1."""

    change: Change = lambda settings: settings
    """Of what the row means by itself."""
    knowledge: Knowledge = AS_DRAWN
    model: TransmissionModel | None = None
    """In place of the one that is known of."""
    noise_rpm: float = 1.0
    """Of the measured w_d."""
    beside: Callable[[MpcController], Controller] = lambda controller: controller
    """What becomes of C_fOL beside the controller."""
    architecture: str = 'detailed'

    def score(self, row: TableRow, scenario: Scenario = THESIS_SCENARIO) -> Metrics:
        """Return the metrics of its run in a scenario with the thesis's driveline."""
        run = RunSettings(scenario, self.architecture)
        settings = self.change(thesis_settings(row))
        parts = stationary_filter(run, self.knowledge, self.model, noise_rpm=self.noise_rpm)
        return scored_run(run, self.beside(MpcController(*parts, settings)))


def readings() -> Study:
    """Return the figures of MPC1-3 under each reading; the first is what the registry has."""
    rows = []
    for name, row in TABLE_4_1.items():
        for label, reading in READINGS.items():
            metrics = reading.score(row)
            left = text_or_dash(metrics.slip_final_rpm, 'z.1f')
            rows.append((name, label, *figures(metrics), left))
    printed = thesis_row('mpc3')
    assert printed is not None
    print_out = tuple(format(value, 'g') for value in printed.figures().values())
    return Study(
        'MPC1-3 in the thesis scenario, by reading of Section 4.2',
        ('controller', 'reading', *FIGURE_HEADERS, 'w_d at the end rpm'),
        [*rows, ('MPC3', 'as the thesis prints it', *print_out, '-')],
    )


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


def _without_actuator() -> TransmissionModel:
    """Return a model whose clutch transmits the request at once: P_1, P_2 and P_3 alone."""
    model = transmission_model(THESIS_SCENARIO.driveline)
    a, b = model.a.copy(), model.b.copy()
    a[:4, 4:] = 0.0
    b[:, REQUEST] += model.clutch
    return TransmissionModel(a, b, model.c, model.d, model.clutch)


READINGS: Mapping[str, Reading] = {
    'as Figure 4.2 draws it': Reading(),
    'coming reference': Reading(_coming),
    'w_m, w_p and w_r measured': Reading(knowledge=replace(AS_DRAWN, measured='speeds')),
    'C_load known': Reading(knowledge=replace(AS_DRAWN, load_known=True)),
    'delay in its model': Reading(knowledge=replace(AS_DRAWN, delay_in_model=True)),
    'no actuator in its model': Reading(model=_without_actuator()),
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

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""MPC1-3 under the readings that Table 4.1 and Section 4.2 of the thesis allow."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.reproduction.studies.changed_loops import model_without_actuator
from ddct_bringup.reproduction.studies.study import (
    AS_PRINTED,
    TABLE_5_1,
    Study,
    cells,
    headers,
    identified_by,
    metric_column,
)
from ddct_bringup.reproduction.study_run import THESIS_SCENARIO, StudyRun, study_run
from ddct_bringup.thesis.table_5_1 import ROW_OF
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import BASIS, TABLE_4_1, TableRow
from ddct_controllers.mpc.estimators import AS_DRAWN, FULL, ObserverInputs
from ddct_controllers.mpc.model.transmission_model import SLIP_SPEED, TransmissionModel
from ddct_controllers.mpc.program.settings import InputTerms, MpcSettings, OutputTerms
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.settings import KnownSettings, RunSettings

Change = Callable[[MpcSettings], MpcSettings]


@dataclass(frozen=True)
class Reading:
    """Meaning of a row of Table 4.1 under one reading."""

    change: Change = lambda settings: settings
    """Change of the settings from the meaning in the registry."""
    knowledge: ObserverInputs = AS_DRAWN
    model: TransmissionModel | None = None
    """Model in place of that of `knowledge`."""
    noise_rpm: float = 1.0
    """Standard deviation of the noise of the measured w_d in rpm."""
    beside: Callable[[MpcController[Any]], Controller] = lambda controller: controller
    """Function that wraps the controller to change C_fOL."""
    architecture: str = 'detailed'

    def run(self, row: TableRow) -> StudyRun:
        """Return the run of a row in the thesis scenario."""
        run = RunSettings(KnownSettings(THESIS_SCENARIO, self.architecture))
        settings = self.change(row.settings())
        parts = self.knowledge.parts(run.known, self.model, noise_rpm=self.noise_rpm)
        return study_run(run, self.beside(MpcController(*parts, settings)))


def readings() -> Study:
    """Return the metrics of MPC1-3 under each reading; the first is that of the registry."""
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
        [*rows, ('MPC3', AS_PRINTED, *ROW_OF['mpc3'].cells(), '-')],
        weights=identified_by(2),
    )


class OpenLoopNotModelled(Controller):
    """The MPC models its own torque alone, while C_fOL is added to it."""

    def __init__(self, controller: MpcController[Any]) -> None:
        self._controller = controller
        self.preview_steps = controller.preview_steps

    def reset(self) -> None:
        """Reset the MPC."""
        self._controller.reset()

    def hold(self, measurement: Measurement) -> None:
        """Hold the MPC, whose model has an open clutch."""
        self._controller.hold(replace(measurement, open_loop_torque=0.0))

    def update(self, measurement: Measurement) -> Command:
        """Return the MPC's command, to which the architecture adds C_fOL."""
        return self._controller.update(replace(measurement, open_loop_torque=0.0))


class OpenLoopOff(Controller):
    """
    C_fOL is switched off at control start, and the MPC requests the whole torque.

    With `from_zero` its moves start from zero torque, so the first has to request all of it;
    otherwise from the last torque.
    """

    def __init__(self, controller: MpcController[Any], *, from_zero: bool = False) -> None:
        self._controller = controller
        self._from_zero = from_zero
        self.preview_steps = controller.preview_steps
        self._taken_over = 0.0

    def reset(self) -> None:
        """Reset the MPC and the stored torque."""
        self._controller.reset()
        self._taken_over = 0.0

    def hold(self, measurement: Measurement) -> None:
        """Store the torque at which the MPC starts."""
        self._controller.hold(measurement)
        self._taken_over = 0.0 if self._from_zero else measurement.open_loop_torque

    def update(self, measurement: Measurement) -> Command:
        """Return the MPC's whole request minus C_fOL, which the architecture adds."""
        command = self._controller.update(replace(measurement, open_loop_torque=self._taken_over))
        whole = command.clutch_torque + self._taken_over
        return replace(command, clutch_torque=whole - measurement.open_loop_torque)


def _coming(settings: MpcSettings) -> MpcSettings:
    return replace(settings, preview=True)


def _per_rad_s(settings: MpcSettings) -> MpcSettings:
    """Return the settings with Q per rad/s."""
    return replace(settings, outputs=(OutputTerms(SLIP_SPEED, BASIS.output_weight),))


def _not_squared(settings: MpcSettings) -> MpcSettings:
    """Return the settings for Q e^2 + R du^2, the norm of Section 4.1: weights become roots."""
    # The weighted output stays in rpm: 0.26 becomes its root, the factor from rad/s does not.
    weight = settings.outputs[0].weight / math.sqrt(BASIS.output_weight)
    return replace(
        settings,
        outputs=(OutputTerms(SLIP_SPEED, weight),),
        inputs=(InputTerms(move_weight=math.sqrt(BASIS.move_weight)),),
    )


def _torque_weighed(settings: MpcSettings) -> MpcSettings:
    """Return the settings with R as the weight of the controller's torque, not of its moves."""
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
    'C_fOL on, unknown to it': Reading(beside=OpenLoopNotModelled),
    'base architecture': Reading(architecture='base'),
    'as mpc_preview': Reading(_coming, FULL),
    'as mpc_preview, reference held': Reading(knowledge=FULL),
    'as mpc_preview, Q per rad/s': Reading(lambda settings: _coming(_per_rad_s(settings)), FULL),
    'as mpc_preview, Q per rad/s, reference held': Reading(_per_rad_s, FULL),
}
"""Readings by name; the first is that of `mpc1` to `mpc3` in the registry."""

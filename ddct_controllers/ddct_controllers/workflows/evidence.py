# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Robustness of the sampled loops of controllers: frequency-domain evidence for JSON."""

from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np

from ddct_controllers.design.analysis.driveline_mode import driveline_mode
from ddct_controllers.design.analysis.loops import sampled_loop
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.design.analysis.worst_corner import (
    PARAMETER_SPREAD,
    WEAR_GAINS,
    PlantCorners,
    plant_corners,
    worst_corner,
)
from ddct_controllers.interface import Controller
from ddct_controllers.places import place_of_method
from ddct_controllers.registry import Chosen, compiled_code, controller_label, make_controller
from ddct_controllers.workflows.evidence_types import (
    ActuatorConditions,
    ControllerEntry,
    CornersEntry,
    EntryWithoutEvidence,
    EvidenceConditions,
    FrequencyEvidence,
    LinearEntry,
    PointEntry,
    WearInterval,
    WorstCornerEntry,
)
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.models.actuator import ActuatorParameters
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.file import scenario_digest
from ddct_plant.scenario.settings import RunSettings


class UnusableModelError(DdctError):
    """The `linear_model` of a controller cannot be used; its runs need none."""


def frequency_evidence(
    controllers: Sequence[Chosen],
    settings: RunSettings,
    report: Callable[[UnusableModelError], None] | None = None,
) -> FrequencyEvidence:
    """
    Return `conditions` and one entry per controller, in their order.

    Driveline and actuator are the scenario's; the wear gain of the settings joins 0.7, 1 and 1.3.
    A controller that is not linear has an entry that says so. One whose `linear_model` cannot be
    used has such an entry if there is a `report`, which gets the error; else that is raised. Raise
    DdctError for a controller that cannot be built.
    """
    scenario = settings.scenario
    corners = plant_corners(scenario.driveline, scenario.actuator)

    def entry_of(chosen: Chosen) -> ControllerEntry:
        try:
            return _controller_evidence(chosen, settings, corners)
        except UnusableModelError as error:
            if report is None:
                raise
            report(error)
            return _without_evidence(controller_label(chosen), linear=None)

    return FrequencyEvidence(
        conditions=EvidenceConditions(
            scenario=scenario.name,
            scenario_digest=scenario_digest(scenario),
            period_s=PERIOD_S,
            actuator=actuator_conditions(scenario.actuator),
            wear_gain_range=[WEAR_GAINS[0], WEAR_GAINS[-1]],
            corners=len(corners.plants),
            corner_spread=PARAMETER_SPREAD,
            corner_parameters=corners.varied,
        ),
        controllers=[entry_of(each) for each in controllers],
    )


def actuator_conditions(actuator: ActuatorParameters) -> ActuatorConditions:
    """Return the entries of `conditions` that describe the actuator."""
    return ActuatorConditions(actuator.delay_s, actuator.bandwidth_factor)


def _controller_evidence(
    chosen: Chosen, settings: RunSettings, corners: PlantCorners
) -> ControllerEntry:
    name = controller_label(chosen)
    found = linear_model(chosen, settings)
    if found is None:
        return _without_evidence(name, linear=False)
    controller, model = found
    scenario = settings.scenario
    try:
        wear = {
            gain: loop_evidence(model, scenario.driveline, gain, scenario.actuator)
            for gain in sorted({*WEAR_GAINS, settings.case.wear_gain})
        }
        worst = _corner_evidence(model, corners)
    except (DdctError, np.linalg.LinAlgError) as error:
        raise _unusable(name, controller, error) from error
    return LinearEntry(
        controller=name,
        linear=True,
        nominal=wear[1.0],
        stable_wear_gain=_stable_wear_gain(wear[1.0]),
        wear=list(wear.values()),
        corners=worst,
    )


def _without_evidence(name: str, linear: Literal[False] | None) -> EntryWithoutEvidence:
    return EntryWithoutEvidence(
        controller=name,
        linear=linear,
        nominal=None,
        stable_wear_gain=None,
        wear=None,
        corners=None,
    )


def linear_model(chosen: Chosen, settings: RunSettings) -> tuple[Controller, StateSpace] | None:
    """
    Return a controller and its model, None where it is not linear.

    Raise UnusableModelError for a model with which no loop can be closed, DdctError for a
    controller that cannot be built.
    """
    if compiled_code(chosen):
        return None
    name, controller = controller_label(chosen), make_controller(chosen, settings.known)
    try:
        model: object = controller.linear_model()
    except FOREIGN_FAILURES as error:
        raise _unusable(name, controller, f'{type(error).__name__}: {error}') from error
    if model is None:
        return None
    if not isinstance(model, StateSpace):
        kind = f'it is of type {type(model).__name__}, not ddct_plant.linear.lti.StateSpace'
        raise _unusable(name, controller, kind)
    if model.d.shape != (1, 1):
        outputs, inputs = model.d.shape
        reason = f'it has {inputs} inputs and {outputs} outputs: give one of each'
        raise _unusable(name, controller, reason)
    return controller, model


def _unusable(name: str, controller: Controller, reason: object) -> UnusableModelError:
    place = place_of_method(controller, 'linear_model')
    return UnusableModelError(
        f'controller {name!r}: its linear_model cannot be used: {reason}: mend {place}'
    )


def loop_evidence(
    controller: StateSpace,
    driveline: DrivelineParameters,
    wear_gain: float,
    actuator: ActuatorParameters,
) -> PointEntry:
    """Return margins and driveline mode of the sampled loop at one wear gain."""
    loop = sampled_loop(controller, driveline, wear_gain, actuator)
    mode = driveline_mode(loop, driveline)
    return PointEntry(
        wear_gain=wear_gain,
        margins=loop_margins(loop).limited(),
        driveline_mode_hz=mode.frequency_hz if mode else None,
        driveline_mode_damping=mode.damping if mode else None,
        driveline_mode_torsion_rpm=mode.torsion_amplitude_rpm if mode else None,
    )


def _corner_evidence(controller: StateSpace, corners: PlantCorners) -> CornersEntry:
    found = worst_corner(controller, corners)
    driveline = corners.parameters[found.index]
    worst = loop_evidence(controller, driveline, found.wear_gain, corners.actuator)
    return CornersEntry(
        unstable_corners=found.unstable_corners,
        sensitivity_peak=found.sensitivity_peak,
        least_driveline_mode_damping=found.least_mode_damping,
        worst=WorstCornerEntry(
            factors=dict(zip(corners.varied, corners.factors[found.index], strict=True)),
            point=worst,
        ),
    )


def _stable_wear_gain(nominal: PointEntry) -> WearInterval | None:
    """Return the wear gains between which the loop is stable: its gain margins, both ways."""
    margins = nominal.margins
    if not margins.stable:
        return None
    less, more = margins.gain_reduction_margin_db, margins.gain_margin_db
    return WearInterval(
        lowest=0.0 if less is None else 10.0 ** (-less / 20.0),
        highest=None if more is None else 10.0 ** (more / 20.0),
    )

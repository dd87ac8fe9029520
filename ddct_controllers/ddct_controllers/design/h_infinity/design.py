# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The H-infinity workflow of Chapter 3: from weights to a verified controller."""

import math
from dataclasses import dataclass, replace

from ddct_controllers.design.analysis.loops import (
    IDENTIFIED_DRIVELINE,
    ContinuousLoop,
    continuous_loop,
    plant_in_rpm,
    sampled_loop,
    sampled_plant,
)
from ddct_controllers.design.analysis.margins import closed_loop_stable
from ddct_controllers.design.h_infinity.cleaning import CleaningStep, clean
from ddct_controllers.design.h_infinity.problem import mixed_sensitivity, sampled_sensitivity
from ddct_controllers.design.h_infinity.recipes import HinfWeights
from ddct_controllers.design.h_infinity.synthesis.gamma_iteration import (
    Synthesis,
    synthesise,
)
from ddct_controllers.design.h_infinity.synthesis.generalised_plant import GeneralisedPlant
from ddct_controllers.design.h_infinity.synthesis.lmi import synthesise_by_lmi
from ddct_controllers.design.state_space import factored_form
from ddct_plant.base.errors import DdctError, ParameterError, require_choice
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.bilinear import from_w_plane, to_w_plane
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.parameters import DrivelineParameters

METHODS = ('riccati', 'lmi')
_ROLL_OFF = 10.0
"""
Corner at which W_t levels out in the sampled problem, relative to w_2.

That problem needs a proper W_t.
"""


@dataclass(frozen=True, eq=False)
class HinfDesign:
    """A verified controller, with weights and intermediate results of its design."""

    weights: HinfWeights
    synthesis: Synthesis
    raw: FactoredTransferFunction
    """Controller from the synthesis: in s, or in w for a sampled design."""
    cleaning: tuple[CleaningStep, ...]
    cleaned: FactoredTransferFunction
    """Controller after cleaning, in the same variable as `raw`."""
    sampled: StateSpace
    """Controller G_c(z) from slip error in rpm to torque in N m, as it runs."""
    parameters: DrivelineParameters
    """Driveline that it is designed for."""
    actuator: ActuatorParameters
    """Actuator with which it is verified, and for which a sampled design is made."""


def design_h_infinity(
    weights: HinfWeights,
    parameters: DrivelineParameters = IDENTIFIED_DRIVELINE,
    method: str = METHODS[0],
    actuator: ActuatorParameters = PRINTED_ACTUATOR,
) -> HinfDesign:
    """
    Synthesise, clean, discretise and verify a controller.

    Only a sampled plant has the actuator: the others are as the thesis prints them. Raise
    ParameterError when no controller meets both requirements, DdctError when no controller
    verifies or the cleaned one does not keep the loop stable.
    """
    require_choice('method', method, METHODS)
    problem = generalised_plant(weights, parameters, actuator)
    if method == 'lmi':
        synthesis = synthesise_by_lmi(problem)
    else:
        synthesis = synthesise(problem, weights.back_off)
    _require_attainable(weights, synthesis, parameters, actuator)
    raw = factored_form(synthesis.controller)
    cleaned, steps = clean(raw, weights.sensitivity.offset_rad_s)
    realised = cleaned.to_state_space()
    if weights.sampled:
        sampled = from_w_plane(realised)
    else:
        sampled = discretise_zoh(realised, PERIOD_S)
        _require_stable(weights, 'without hold and delay', continuous_loop(cleaned, parameters))
    as_run = sampled_loop(sampled, parameters, actuator=actuator)
    _require_stable(weights, 'with hold and delay', as_run)
    return HinfDesign(weights, synthesis, raw, steps, cleaned, sampled, parameters, actuator)


def generalised_plant(
    weights: HinfWeights,
    parameters: DrivelineParameters = IDENTIFIED_DRIVELINE,
    actuator: ActuatorParameters = PRINTED_ACTUATOR,
) -> GeneralisedPlant:
    """Return the generalised plant of a design, with the actuator if it is sampled."""
    w_s, w_t = weights.sensitivity.shifted(), weights.complementary
    if not weights.sampled:
        return mixed_sensitivity(plant_in_rpm(parameters), w_s, w_t.transfer_function())
    effort = weights.effort.transfer_function() if weights.effort else None
    plant = to_w_plane(sampled_plant(parameters, actuator=actuator))
    return sampled_sensitivity(plant, w_s, w_t.rolled_off(_ROLL_OFF), effort)


def _require_attainable(
    weights: HinfWeights,
    synthesis: Synthesis,
    parameters: DrivelineParameters,
    actuator: ActuatorParameters,
) -> None:
    """
    Raise ParameterError when the bounds on S and T exclude each other.

    A controller with ||W_s S|| <= 1 and ||W_t T|| <= 1 has a stack of at most sqrt(2).
    """
    bound = synthesis.lower_bound
    if weights.effort:
        alone = replace(weights, effort=None)
        bound = synthesise(generalised_plant(alone, parameters, actuator)).lower_bound
    if bound > math.sqrt(2.0):
        raise ParameterError(
            f'no controller meets the bounds on S and T: the least norm of their stack is '
            f'{bound:.2f}, above sqrt(2): allow a longer rise time, more overshoot, '
            'a larger K or a larger w_2',
            key='rise time',
        )


def _require_stable(weights: HinfWeights, which: str, loop: ContinuousLoop | StateSpace) -> None:
    if not closed_loop_stable(loop):
        other = '' if weights.sampled else ', or take --weights sampled'
        raise DdctError(
            f'the cleaned controller makes the loop {which} unstable: allow a longer rise '
            f'time{other}'
        )

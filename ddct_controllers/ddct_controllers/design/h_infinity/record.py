# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Results of `design h-infinity` as a record for JSON and tables."""

from functools import cache

from ddct_controllers.design.analysis.loops import (
    IDENTIFIED_DRIVELINE,
    ContinuousLoop,
    continuous_loop,
    plant_in_rpm,
    sampled_loop,
)
from ddct_controllers.design.analysis.margins import closed_loop_stable, loop_margins
from ddct_controllers.design.analysis.step_response import rise_time_and_overshoot
from ddct_controllers.design.analysis.worst_corner import (
    PARAMETER_SPREAD,
    WEAR_GAINS,
    plant_corners,
    worst_corner,
)
from ddct_controllers.design.h_infinity.design import HinfDesign
from ddct_controllers.design.h_infinity.recipes import HinfWeights
from ddct_controllers.design.h_infinity.record_types import (
    HinfCorners,
    HinfProvenance,
    HinfRecord,
    HinfSpecifications,
    LoopEntry,
    LoopsEntry,
    StableLoopEntry,
    SynthesisEntry,
    UncertaintyRecord,
    UnstableLoopEntry,
    WeightEntry,
)
from ddct_controllers.design.h_infinity.uncertainty import (
    OMEGA,
    PRINTED_W_U,
    fit_first_order,
    relative_error,
    shortfall_from_rad_s,
    wear_family,
    weighted_norms,
)
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.design.state_space import factored_form
from ddct_plant.linear.lti import StateSpace
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.choices.scenarios import DEFAULT_SCENARIO

_STEP_RISE_TIMES = 20.0
"""Length of the step responses in specified rise times."""


def design_record(
    name: str,
    recipe: str,
    specifications: TimeSpecifications,
    design: HinfDesign,
    scenario: str = DEFAULT_SCENARIO,
) -> HinfRecord:
    """
    Return a design and its verified quantities, over wear and the corners of its driveline too.

    `scenario` is the name of that whose driveline and actuator it is designed for.
    """
    found = design.synthesis
    corners = plant_corners(design.parameters, design.actuator)
    worst = worst_corner(design.sampled, corners)
    return HinfRecord(
        name=name,
        provenance=provenance(recipe, specifications, design, scenario),
        synthesis=SynthesisEntry(
            method=found.method,
            optimum=found.optimum,
            lower_bound=found.lower_bound,
            gamma=found.gamma,
        ),
        raw_controller=design.raw,
        controller=design.cleaned,
        pulse_transfer_function=factored_form(design.sampled),
        corners=HinfCorners(
            corners=len(corners.plants),
            unstable_corners=worst.unstable_corners,
            sensitivity_peak=worst.sensitivity_peak,
            wear_gain=worst.wear_gain,
            factors=dict(zip(corners.varied, corners.factors[worst.index], strict=True)),
        ),
    )


def shortfalls(record: HinfRecord) -> list[str]:
    """Return the specifications that a design with its corners does not meet, empty if none."""
    given, corners = record.provenance, record.corners
    specified, loop = given.specifications, given.loops.sampled_loop
    if isinstance(loop, UnstableLoopEntry):
        return ['its sampled loop is unstable']
    found = []
    if loop.rise_time_s is None or loop.rise_time_s > specified.rise_time_s:
        reached = 'never' if loop.rise_time_s is None else f'in {loop.rise_time_s:.3g} s'
        found.append(f'it rises {reached}, {specified.rise_time_s:g} s are specified')
    if loop.overshoot > specified.overshoot:
        found.append(
            f'it overshoots by {100.0 * loop.overshoot:.3g} %, '
            f'{100.0 * specified.overshoot:g} % are allowed'
        )
    if corners.unstable_corners:
        found.append(
            f'its loop is unstable at {corners.unstable_corners} of {corners.corners} corners '
            f'(driveline +-{100.0 * PARAMETER_SPREAD:g} %, wear {WEAR_GAINS[0]:g} to '
            f'{WEAR_GAINS[-1]:g})'
        )
    return found


def provenance(
    recipe: str, specifications: TimeSpecifications, design: HinfDesign, scenario: str
) -> HinfProvenance:
    """Return the provenance of a design for the controller's file."""
    weights = design.weights
    w_s, w_t, effort = weights.sensitivity, weights.complementary, weights.effort
    return HinfProvenance(
        method=f'h-infinity, {design.synthesis.method}',
        scenario=scenario,
        specifications=HinfSpecifications(
            rise_time_s=specifications.rise_time_s,
            overshoot=specifications.overshoot,
            damping=specifications.damping,
            sensitivity_peak=specifications.sensitivity_peak,
            complementary_peak=specifications.complementary_peak,
            natural_frequency_rad_s=specifications.natural_frequency_rad_s,
        ),
        weights=WeightEntry(
            recipe=recipe,
            low_frequency_gain=w_s.low_frequency_gain,
            sensitivity_corner_rad_s=w_s.corner_rad_s,
            offset_rad_s=w_s.offset_rad_s,
            bandwidth_rad_s=w_t.corner_rad_s,
            complementary_damping=w_t.damping,
            effort_n_m_per_rpm=effort.torque_n_m_per_rpm if effort else None,
            effort_corner_rad_s=effort.corner_rad_s if effort else None,
            hold_and_delay_in_plant=weights.sampled,
            back_off=weights.back_off,
        ),
        gamma=design.synthesis.gamma,
        cleaning=design.cleaning,
        loops=LoopsEntry(
            continuous_loop=None
            if weights.sampled
            else loop_record(
                continuous_loop(design.cleaned, design.parameters), weights, specifications
            ),
            sampled_loop=loop_record(
                sampled_loop(design.sampled, design.parameters, actuator=design.actuator),
                weights,
                specifications,
            ),
        ),
    )


def loop_record(
    loop: ContinuousLoop | StateSpace, weights: HinfWeights, specifications: TimeSpecifications
) -> LoopEntry:
    """Return weighted norms, step response and margins of a loop; only `stable` if unstable."""
    if not closed_loop_stable(loop):
        return UnstableLoopEntry(stable=False)
    norms = weighted_norms(loop, weights.sensitivity, weights.complementary, PRINTED_W_U)
    rise_time, exceeds = rise_time_and_overshoot(
        loop, _STEP_RISE_TIMES * specifications.rise_time_s
    )
    return StableLoopEntry(
        margins=loop_margins(loop).limited(),
        rise_time_s=rise_time,
        overshoot=exceeds,
        meets_specifications=rise_time is not None
        and rise_time <= specifications.rise_time_s
        and exceeds <= specifications.overshoot,
        norms=norms,
    )


@cache
def uncertainty_record(
    parameters: DrivelineParameters = IDENTIFIED_DRIVELINE,
) -> UncertaintyRecord:
    """Return the fitted and the printed W_u, and the shortfall of the printed one, kept by car."""
    error = relative_error(plant_in_rpm(parameters), wear_family(parameters), OMEGA)
    largest = float(error.max())
    printed = abs(PRINTED_W_U.frequency_response(OMEGA))
    return UncertaintyRecord(
        largest_error=largest,
        fitted=fit_first_order(OMEGA, error),
        printed=PRINTED_W_U,
        printed_falls_short_by=float((1.0 - printed / error).max()),
        printed_falls_short_above_rad_s=shortfall_from_rad_s(PRINTED_W_U, largest),
    )

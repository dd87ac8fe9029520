# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Results of `design loop-shaping` as records for JSON and tables."""

from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import (
    WEAR_RANGE,
    ContinuousLoop,
    continuous_loop,
    plant_in_rpm,
    sampled_loop,
)
from ddct_controllers.design.analysis.margins import loop_margins, unstable_poles
from ddct_controllers.design.analysis.step_response import rise_time_and_overshoot
from ddct_controllers.design.loop_shaping.design import (
    NETWORK_SPECIFICATIONS,
    PLACEMENT_CROSSOVER_RAD_S,
    PLACEMENT_SPECIFICATIONS,
    largest_zero_rad_s,
    network_steps,
    placement,
    with_crossover,
)
from ddct_controllers.design.loop_shaping.record_types import (
    LoopEntry,
    LoopShapingProvenance,
    LoopShapingRecord,
    LoopShapingSpecifications,
    PlacementEntry,
    SampledLoopEntry,
    StepEntry,
    ThesisLoopEntry,
    ThesisRecord,
)
from ddct_controllers.design.loop_shaping.search import LoopShapingDesign
from ddct_controllers.design.loop_shaping.verification import contours
from ddct_controllers.printed import LOOP_SHAPING_CONTROLLERS
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.parameters import DrivelineParameters

G_C1, G_C2 = LOOP_SHAPING_CONTROLLERS['ls2'], LOOP_SHAPING_CONTROLLERS['ls7']
"""Controllers of equations (2.1) and (2.2)."""
_STEP_DURATION_S = 6.0


def thesis_record() -> ThesisRecord:
    """Return the steps to G_c1 and to G_c2, and both loops in three versions."""
    return ThesisRecord(
        network_steps=[
            StepEntry(step, _loop_entry(continuous_loop(controller)))
            for step, controller in network_steps().items()
        ],
        placement=[
            _placement_entry(version, controller) for version, controller in _placements().items()
        ],
        loops=[
            ThesisLoopEntry(name, label, _loop_entry(loop))
            for name, controller in (('G_c1', G_C1), ('G_c2', G_C2))
            for label, loop in _versions(controller).items()
        ],
    )


def design_record(name: str, design: LoopShapingDesign, scenario: str) -> LoopShapingRecord:
    """Return a design and its verified quantities; `scenario` has the driveline's name."""
    found = design.verification
    return LoopShapingRecord(
        name=name,
        controller=design.controller,
        provenance=provenance(design, scenario),
        contours=list(found.contours),
    )


def provenance(design: LoopShapingDesign, scenario: str) -> LoopShapingProvenance:
    """Return the provenance of a design for the controller's file."""
    found = design.verification
    specifications = found.specifications
    return LoopShapingProvenance(
        method='loop-shaping',
        scenario=scenario,
        structure=design.structure,
        integrators=design.integrators,
        specifications=LoopShapingSpecifications(
            rise_time_s=specifications.rise_time_s,
            overshoot=specifications.overshoot,
            sensitivity_peak=specifications.sensitivity_peak,
            complementary_peak=specifications.complementary_peak,
            crossover_rad_s=specifications.crossover_rad_s,
        ),
        sampled_loop=SampledLoopEntry(
            rise_time_s=found.rise_time_s,
            overshoot=found.overshoot,
            margins=found.margins.limited(),
            stable_with_wear_gain={
                str(gain): stable
                for gain, stable in zip(WEAR_RANGE, found.stable_when_worn, strict=True)
            },
        ),
    )


def _placements() -> dict[str, FactoredTransferFunction]:
    """Return G_c2 as printed, with the gain for w_c, and by the rule of `placement`."""
    driveline, crossover = DrivelineParameters(), PLACEMENT_CROSSOVER_RAD_S
    zero = largest_zero_rad_s(crossover, PLACEMENT_SPECIFICATIONS.overshoot, driveline)
    return {
        'printed': G_C2,
        'printed, gain for w_c': with_crossover(G_C2, plant_in_rpm(driveline), crossover),
        'ours': placement(crossover, zero, driveline),
    }


def _placement_entry(version: str, controller: FactoredTransferFunction) -> PlacementEntry:
    loop = continuous_loop(controller)
    rise_time_s, overshoot = rise_time_and_overshoot(loop, _STEP_DURATION_S)
    margins = loop_margins(loop)
    return PlacementEntry(
        version=version,
        controller=controller,
        crossover_rad_s=margins.crossover_rad_s,
        complementary_peak=margins.complementary_peak,
        rise_time_s=rise_time_s,
        overshoot=overshoot,
    )


def _versions(controller: FactoredTransferFunction) -> dict[str, ContinuousLoop | StateSpace]:
    sampled = discretise_zoh(controller.to_state_space(), PERIOD_S)
    return {
        'continuous': continuous_loop(controller),
        'with the delay': continuous_loop(controller, delay_s=PERIOD_S),
        'sampled, hold and delay': sampled_loop(sampled),
    }


def _loop_entry(loop: ContinuousLoop | StateSpace) -> LoopEntry:
    found = contours(LoopCurve(loop), NETWORK_SPECIFICATIONS)
    return LoopEntry(
        unstable_poles=unstable_poles(loop),
        margins=loop_margins(loop).limited(),
        contours=list(found),
    )

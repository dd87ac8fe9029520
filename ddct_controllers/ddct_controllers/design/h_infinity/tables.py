# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The tables of `design h-infinity`, the same for the terminal and the documentation page."""

from collections.abc import Mapping, Sequence

from ddct_controllers.design.analysis.loop_quantities import DESIGN_QUANTITY_OF
from ddct_controllers.design.h_infinity.record_types import (
    HinfProvenance,
    HinfRecord,
    LoopEntry,
    LoopsEntry,
    UncertaintyRecord,
    UnstableLoopEntry,
    WeightEntry,
)
from ddct_controllers.design.state_space import factors_text
from ddct_plant.files.json_records import to_json
from ddct_plant.program.table import TextTable, Weight, text_or_dash, with_reasons

_LOOP_QUANTITIES = [
    DESIGN_QUANTITY_OF[name]
    for name in (
        *('crossover_rad_s', 'sensitivity_peak', 'complementary_peak'),
        *('phase_margin_deg', 'gain_margin_db', 'delay_margin_s'),
    )
]
_LOOP_HEADERS = (
    *('controller', 'loop', 'W_s S', 'W_t T', 'W_u T', 't_r s', 's^ %', 'met'),
    *(quantity.heading for quantity in _LOOP_QUANTITIES),
)

_WEIGHTS = (
    ('K', 'low_frequency_gain', '.4g'),
    ('w_1 rad/s', 'sensitivity_corner_rad_s', '.3f'),
    ('epsilon rad/s', 'offset_rad_s', '.4f'),
    ('w_2 rad/s', 'bandwidth_rad_s', '.4g'),
    ('zeta of W_t', 'complementary_damping', '.4g'),
    ('effort N m/rpm', 'effort_n_m_per_rpm', '.4g'),
    ('from rad/s', 'effort_corner_rad_s', '.4g'),
)
"""Heading, key of `WeightEntry` and format of each number of the weights."""


def design_tables(
    records: Sequence[HinfRecord], uncertainty: UncertaintyRecord
) -> dict[str, TextTable]:
    """Return the tables of designs for one specification, by their names on the page."""
    tables = {
        'specifications': _specification_table(records[0].provenance),
        'weights': _weight_table(records),
        'uncertainty': _uncertainty_table(uncertainty),
        'synthesis': _synthesis_table(records),
        'cleaning': TextTable(
            'Cleaning, in the order of the rules',
            ('controller', 'rule', 'taken out'),
            [
                (record.name, step.rule, step.removed)
                for record in records
                for step in record.provenance.cleaning
            ],
        ),
        'controllers': _controller_table(records),
        'loops': loop_table({record.name: record.provenance.loops for record in records}),
        'corners': _corner_table(records),
    }
    return {name: with_reasons(table, _dash_reason) for name, table in tables.items()}


def _dash_reason(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash by its column."""
    if header.startswith(('effort', 'from')):
        return 'the recipe has no weight of the effort'
    if row[1].startswith(('continuous', 'sampled')):
        return 'the loop has no such value: nothing makes it unstable, or it never gets there'
    return 'the loop is unstable at a corner'


def loop_table(loops: Mapping[str, LoopsEntry]) -> TextTable:
    """Return norms, step response and margins of the loops of named controllers."""
    return TextTable(
        'Loops: norms by the weights, step response and whether it meets both, margins',
        _LOOP_HEADERS,
        [
            (name, label, *_loop_cells(loop))
            for name, record in loops.items()
            for label, loop in (
                ('continuous', record.continuous_loop),
                ('sampled, hold and delay', record.sampled_loop),
            )
            if loop
        ],
        weights=(
            *(Weight.IDENTIFYING, Weight.IDENTIFYING, *[Weight.NEEDED] * 6),
            *[Weight.USEFUL] * len(_LOOP_QUANTITIES),
        ),
        complete='--json FILE',
    )


def _specification_table(given: HinfProvenance) -> TextTable:
    specified = given.specifications
    return TextTable(
        f'Specifications, translated by the second-order prototype; scenario {given.scenario}',
        ('t_r s', 's^ %', 'zeta', 'S_p', 'T_p', 'w_n rad/s'),
        [
            (
                f'{specified.rise_time_s:g}',
                f'{100.0 * specified.overshoot:g}',
                f'{specified.damping:.4f}',
                f'{specified.sensitivity_peak:.3f}',
                f'{specified.complementary_peak:.3f}',
                f'{specified.natural_frequency_rad_s:.2f}',
            )
        ],
    )


def _weight_table(records: Sequence[HinfRecord]) -> TextTable:
    return TextTable(
        'Weights',
        ('controller', 'recipe', *(heading for heading, _, _ in _WEIGHTS), 'hold, delay in plant'),
        [
            (
                record.name,
                record.provenance.weights.recipe,
                *_weight_cells(record.provenance.weights),
                'yes' if record.provenance.weights.hold_and_delay_in_plant else 'no',
            )
            for record in records
        ],
    )


def _weight_cells(weights: WeightEntry) -> list[str]:
    return [text_or_dash(getattr(weights, key), form) for _, key, form in _WEIGHTS]


def _uncertainty_table(found: UncertaintyRecord) -> TextTable:
    above = found.printed_falls_short_above_rad_s
    short = f'by {100.0 * found.printed_falls_short_by:.2f} % above {above:.3g} rad/s'
    return TextTable(
        f'W_u; the relative error of K_usura is {found.largest_error:.3f} at most',
        ('W_u', 'gain', 'zero rad/s', 'pole rad/s', 'falls short'),
        [
            (
                which,
                f'{function.gain:.4f}',
                f'{function.numerator[0]:.4g}',
                f'{function.denominator[0]:.4g}',
                'nowhere' if which == 'fitted' or above is None else short,
            )
            for which, function in (('fitted', found.fitted), ('printed', found.printed))
        ],
    )


def _synthesis_table(records: Sequence[HinfRecord]) -> TextTable:
    return TextTable(
        'Synthesis: norms of the closed loop with the weights',
        ('controller', 'method', 'optimum', 'lower bound', 'taken'),
        [
            (
                record.name,
                record.synthesis.method,
                f'{record.synthesis.optimum:.5f}',
                f'{record.synthesis.lower_bound:.5f}',
                f'{record.synthesis.gamma:.4f}',
            )
            for record in records
        ],
    )


def _controller_table(records: Sequence[HinfRecord]) -> TextTable:
    sampled = any(record.provenance.weights.hold_and_delay_in_plant for record in records)
    rule = '; the sampled design is discretised by the bilinear transform' if sampled else ''
    return TextTable(
        f'Controllers in N m/rpm{rule}',
        ('controller', 'form', 'gain', 'numerator', 'denominator'),
        [
            (
                record.name,
                f'G_c({variable})',
                f'{function.gain:.4g}',
                factors_text(function.numerator, variable, digits),
                factors_text(function.denominator, variable, digits),
            )
            for record in records
            # With 4 digits in z a slow pole would read as an integrator.
            for variable, digits, function in (
                ('s', 4, record.controller),
                ('z', 5, record.pulse_transfer_function),
            )
        ],
    )


def _corner_table(records: Sequence[HinfRecord]) -> TextTable:
    return TextTable(
        'Worst of wear 0.7 to 1.3 and all driveline parameters +-20 %, sampled loop',
        ('controller', 'corners', 'unstable', 'M_s', 'K_usura', 'at'),
        [
            (
                record.name,
                str(record.corners.corners),
                str(record.corners.unstable_corners),
                DESIGN_QUANTITY_OF['sensitivity_peak'].cell(to_json(record.corners)),
                f'{record.corners.wear_gain:.2f}',
                ', '.join(f'{name} {x:g}' for name, x in record.corners.factors.items()),
            )
            for record in records
        ],
    )


def _loop_cells(loop: LoopEntry) -> tuple[str, ...]:
    if isinstance(loop, UnstableLoopEntry):
        return ('unstable', *[''] * (len(_LOOP_HEADERS) - 3))
    norms, margins = loop.norms, to_json(loop.margins)
    return (
        *(f'{norm:.3f}' for norm in (norms.sensitivity, norms.complementary, norms.uncertainty)),
        text_or_dash(loop.rise_time_s, '.3f'),
        f'{100.0 * loop.overshoot:.1f}',
        'yes' if loop.meets_specifications else 'no',
        *(quantity.cell(margins) for quantity in _LOOP_QUANTITIES),
    )

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The tables of `design loop-shaping`, the same for the terminal and the documentation page."""

from collections.abc import Sequence

from ddct_controllers.design.analysis.loop_quantities import DESIGN_QUANTITY_OF
from ddct_controllers.design.loop_shaping.record_types import (
    LoopEntry,
    LoopShapingRecord,
    PlacementEntry,
    ThesisRecord,
)
from ddct_controllers.design.loop_shaping.specifications import (
    TimeSpecifications,
    rise_time_crossover_product,
)
from ddct_controllers.design.loop_shaping.verification import Contour
from ddct_plant.files.json_records import to_json
from ddct_plant.program.table import TextTable, Weight, text_or_dash, with_reasons

_LOOP_QUANTITIES = [
    DESIGN_QUANTITY_OF[name]
    for name in (
        *('crossover_rad_s', 'phase_margin_deg', 'gain_margin_db'),
        *('sensitivity_peak', 'complementary_peak'),
    )
]
_LOOP_HEADERS = (
    'unstable poles',
    *(quantity.heading for quantity in _LOOP_QUANTITIES),
    *('S_p curve', 'T_p curve'),
)
_TRANSLATED = (
    ('2.2, G_c1', TimeSpecifications(rise_time_s=0.25, overshoot=0.14)),
    ('2.2, G_c2', TimeSpecifications(rise_time_s=0.6, overshoot=0.14)),
    ('3.2', TimeSpecifications(rise_time_s=0.3, overshoot=0.08)),
)


def thesis_tables(record: ThesisRecord) -> dict[str, TextTable]:
    """Return the tables of `thesis_record` by the names that pages show them by."""
    tables = {
        'specifications': _specification_table(),
        'network_steps': TextTable(
            'From K_c/s to G_c1, continuous and without delay',
            ('controller', *_LOOP_HEADERS),
            [(row.step, *_loop_cells(row.found)) for row in record.network_steps],
        ),
        'placement': _placement_table(record.placement),
        'loops': TextTable(
            'Both controllers, and the curves of 14 % overshoot',
            ('controller', 'loop', *_LOOP_HEADERS),
            [(row.controller, row.loop, *_loop_cells(row.found)) for row in record.loops],
            weights=(Weight.IDENTIFYING, Weight.IDENTIFYING),
        ),
    }
    return {name: with_reasons(table, _no_loop_value) for name, table in tables.items()}


def _no_loop_value(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash in a table of loops."""
    unstable = row[1] if row[1].isdigit() else row[2]
    return (
        'no change of this kind makes it unstable' if unstable == '0' else 'the loop is unstable'
    )


def design_tables(record: LoopShapingRecord) -> tuple[TextTable, TextTable]:
    """Return the tables of `design_record`: specified and reached quantities, and G_c(s)."""
    provenance = record.provenance
    specified, found = provenance.specifications, provenance.sampled_loop
    margins = found.margins
    overshoot = None if found.overshoot is None else 100.0 * found.overshoot
    peaks = {contour.name: contour for contour in record.contours}
    quantities = TextTable(
        f'{record.name}: {provenance.structure}, {provenance.integrators} integrator(s); '
        f'scenario {provenance.scenario}',
        ('quantity', 'specified', 'sampled loop', 'unit'),
        [
            _row('rise time', specified.rise_time_s, found.rise_time_s, 's'),
            _row('overshoot', 100.0 * specified.overshoot, overshoot, '%'),
            _row(_peak_name(peaks['S']), specified.sensitivity_peak, peaks['S'].peak, '1'),
            _row(_peak_name(peaks['T']), specified.complementary_peak, peaks['T'].peak, '1'),
            _row('crossover', specified.crossover_rad_s, margins.crossover_rad_s, 'rad/s'),
            _row('phase margin', None, margins.phase_margin_deg, 'deg'),
            _row('gain margin', None, margins.gain_margin_db, 'dB'),
            _row('delay margin', None, margins.delay_margin_s, 's'),
        ],
    )
    controller = record.controller
    parts = TextTable(
        'G_c(s) in N m/rpm; a is (s + a), (b, c) is (s^2 + b s + c)',
        ('part', 'value'),
        [
            ('gain', f'{controller.gain:.6g}'),
            ('numerator', _factors(controller.numerator)),
            ('denominator', _factors(controller.denominator)),
        ],
    )
    return with_reasons(quantities, _no_quantity), parts


def _no_quantity(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash in the table of specified and reached quantities."""
    if header == 'specified':
        return 'follows from the others'
    return 'the loop is unstable, or nothing of this kind makes it so'


def _specification_table() -> TextTable:
    return TextTable(
        'Specifications translated by the second-order prototype',
        ('section', 't_r s', 's^ %', 'zeta', 'S_p', 'T_p', 't_r w_c', 'w_c rad/s', 'w_n rad/s'),
        [
            (
                section,
                f'{specified.rise_time_s:g}',
                f'{100.0 * specified.overshoot:g}',
                f'{specified.damping:.4f}',
                f'{specified.sensitivity_peak:.3f}',
                f'{specified.complementary_peak:.3f}',
                f'{rise_time_crossover_product(specified.damping):.3f}',
                f'{specified.crossover_rad_s:.2f}',
                f'{specified.natural_frequency_rad_s:.2f}',
            )
            for section, specified in _TRANSLATED
        ],
    )


def _placement_table(placements: Sequence[PlacementEntry]) -> TextTable:
    lines = {
        'gain N m/rpm': [f'{one.controller.gain:.6f}' for one in placements],
        'zero rad/s': [f'{one.controller.numerator[0]:.4f}' for one in placements],
        'zeros b, c': [_factors(one.controller.numerator[1:]) for one in placements],
        'poles b, c': [_factors(one.controller.denominator[1:]) for one in placements],
        'w_c rad/s': [f'{one.crossover_rad_s:.2f}' for one in placements],
        't_r s': [f'{one.rise_time_s:.3f}' for one in placements],
        's^ %': [f'{100.0 * one.overshoot:.1f}' for one in placements],
        'M_t': [f'{one.complementary_peak:.3f}' for one in placements],
    }
    return TextTable(
        'G_c2 as printed, and as the rule gives it',
        ('quantity', *(one.version for one in placements)),
        [(name, *cells) for name, cells in lines.items()],
    )


def _peak_name(contour: Contour) -> str:
    return f'max |{contour.name}|' + ('' if contour.respected else ', crosses its curve')


def _row(name: str, specified: float | None, found: float | None, unit: str) -> tuple[str, ...]:
    return (name, text_or_dash(specified, '.3g'), text_or_dash(found, '.3g'), unit)


def _loop_cells(row: LoopEntry) -> tuple[str, ...]:
    kept_out = {contour.name: contour.respected for contour in row.contours}
    margins = to_json(row.margins)
    return (
        str(row.unstable_poles),
        *(quantity.cell(margins) for quantity in _LOOP_QUANTITIES),
        'kept out of' if kept_out['S'] else 'crossed',
        'kept out of' if kept_out['T'] else 'crossed',
    )


def _factors(factors: Sequence[float | Sequence[float]]) -> str:
    return ', '.join(
        f'{factor:.6g}'
        if isinstance(factor, float)
        else f'({", ".join(f"{number:.6g}" for number in factor)})'
        for factor in factors
    )

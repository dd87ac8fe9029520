# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quantities of a loop as it runs, with their symbols and units in tables."""

from dataclasses import replace

from ddct_plant.program.table import PURE, Quantity

LOOP_QUANTITIES = (
    Quantity(
        'gain_margin_db',
        'GM',
        'dB',
        '.1f',
        'least increase of the gain that makes the loop unstable',
    ),
    Quantity(
        'phase_margin_deg',
        'PM',
        'deg',
        '.1f',
        'least change of phase, lag or lead, that makes it unstable',
    ),
    Quantity('delay_margin_s', 'DM', 's', '.3f', 'least additional delay that makes it unstable'),
    Quantity('disk_margin', 'disk', PURE, '.2f', 'disk margin α = 2 / max |S − T|'),
    Quantity('sensitivity_peak', 'M_s', PURE, '.2f', 'peak of |1/(1 + L)|'),
    Quantity('complementary_peak', 'M_t', PURE, '.2f', 'peak of |L/(1 + L)|'),
    Quantity('crossover_rad_s', 'w_c', 'rad/s', '.2f', 'highest frequency with |L| = 1'),
    Quantity('bandwidth_rad_s', 'w_b', 'rad/s', '.2f', 'lowest frequency with |T| below 0.71'),
    Quantity(
        'driveline_mode_hz', 'mode', 'Hz', '.2f', 'closed-loop pole pair nearest the zeros of P_2'
    ),
    Quantity('driveline_mode_damping', 'damping', PURE, '.3f', 'damping ratio of that mode'),
)
"""Quantities in every table of loops as they run."""
LOOP_QUANTITY_OF = {
    quantity.key: quantity
    for quantity in (
        *LOOP_QUANTITIES,
        Quantity(
            'driveline_mode_torsion_rpm',
            'w_sr',
            'rpm',
            '.3f',
            'first amplitude of that mode in w_sr after a step of 1 rpm of the slip reference',
        ),
    )
}
"""Quantities of a loop as it runs, by their keys."""
DESIGN_QUANTITY_OF = LOOP_QUANTITY_OF | {
    name: replace(LOOP_QUANTITY_OF[name], form='.3f')
    for name in ('sensitivity_peak', 'complementary_peak')
}
"""Quantities of a loop by their keys, with peaks as precise as a design's specifications."""

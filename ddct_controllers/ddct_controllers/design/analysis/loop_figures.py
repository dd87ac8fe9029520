"""The figures of a loop: margins, peaks and driveline mode, by their names in JSON."""

from dataclasses import replace

from ddct_plant.program.table import PURE, Figure

LOOP_FIGURES = (
    Figure(
        'gain_margin_db',
        'GM',
        'dB',
        '.1f',
        'least increase of the gain that makes the loop unstable',
    ),
    Figure(
        'phase_margin_deg',
        'PM',
        'deg',
        '.1f',
        'least change of phase, lag or lead, that makes it unstable',
    ),
    Figure('delay_margin_s', 'DM', 's', '.3f', 'least additional delay that makes it unstable'),
    Figure('disk_margin', 'disk', PURE, '.2f', 'disk margin α = 2 / max |S − T|'),
    Figure('sensitivity_peak', 'M_s', PURE, '.2f', 'peak of |1/(1 + L)|'),
    Figure('complementary_peak', 'M_t', PURE, '.2f', 'peak of |L/(1 + L)|'),
    Figure('crossover_rad_s', 'w_c', 'rad/s', '.2f', 'highest frequency with |L| = 1'),
    Figure('bandwidth_rad_s', 'w_b', 'rad/s', '.2f', 'lowest frequency with |T| below 0.71'),
    Figure(
        'driveline_mode_hz', 'mode', 'Hz', '.2f', 'closed-loop pole pair nearest the zeros of P_2'
    ),
    Figure('driveline_mode_damping', 'damping', PURE, '.3f', 'damping ratio of that mode'),
)
"""What every table of loops as they run shows."""
LOOP_FIGURE_OF = {
    figure.key: figure
    for figure in (
        *LOOP_FIGURES,
        Figure(
            'driveline_mode_torsion_rpm',
            'w_sr',
            'rpm',
            '.3f',
            'first amplitude of that mode in w_sr after a step of 1 rpm of the slip reference',
        ),
    )
}
"""All by name."""
DESIGN_FIGURE_OF = LOOP_FIGURE_OF | {
    name: replace(LOOP_FIGURE_OF[name], form='.3f')
    for name in ('sensitivity_peak', 'complementary_peak')
}
"""The same, with peaks as fine as a design is held against its specifications."""

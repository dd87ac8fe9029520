"""What the weight of w_sr buys in oscillation and costs in engagement time."""

from dataclasses import replace

from ddct_bringup.reproduction.runs.runs import THESIS_SCENARIO
from ddct_bringup.reproduction.studies.scored_run import FIGURE_HEADERS, figures, scored_run
from ddct_bringup.reproduction.studies.study import Study
from ddct_controllers.mpc.costs import BASIS, default_torsion_weight
from ddct_plant.program.table import text_or_dash
from ddct_plant.scenario.settings import RunSettings

NAME = 'mpc_torsion'
FACTORS = (0.0, 1.0, 3.0, 6.0, 12.0, 20.0, 40.0)
"""Weights of w_sr per rpm as multiples of that of w_d, beside the default."""
DEFAULT_FACTOR = (
    default_torsion_weight(THESIS_SCENARIO.driveline.total_ratio) / BASIS.output_weight
)


def torsion_weight() -> Study:
    """Run `mpc_torsion` over its weight."""
    return Study(
        title='mpc_torsion over the weight of w_sr, thesis scenario',
        headers=(
            'weight per rpm',
            'times that of w_d',
            *FIGURE_HEADERS,
            'slip RMSE rpm',
            'w_d at the end rpm',
        ),
        rows=[_row(factor) for factor in sorted((*FACTORS, DEFAULT_FACTOR))],
        remarks=(
            f'The default is the total ratio, {DEFAULT_FACTOR:.3f}, times the weight of w_d; '
            '0 is mpc_offset_free.',
            'Where the slip RMSE is large, slip runs ahead of its reference: t_a then shrinks for '
            'the wrong reason.',
        ),
    )


def _row(factor: float) -> tuple[str, ...]:
    weight = factor * BASIS.output_weight
    controllers = {**THESIS_SCENARIO.controllers, NAME: {'torsion_weight': weight}}
    metrics = scored_run(RunSettings(replace(THESIS_SCENARIO, controllers=controllers)), NAME)
    return (
        f'{weight:.2f}' + (' (default)' if factor == DEFAULT_FACTOR else ''),
        f'{factor:.3g}',
        *figures(metrics),
        text_or_dash(metrics.slip_rmse_rpm, '.2f'),
        text_or_dash(metrics.slip_final_rpm, 'z.2f'),
    )

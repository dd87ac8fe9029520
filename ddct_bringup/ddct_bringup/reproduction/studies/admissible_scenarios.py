"""The kept admissible scenarios, and the ranges of what they predict."""

from ddct_bringup.reproduction.calibration.admissible import fitted_rows
from ddct_bringup.reproduction.calibration.ensemble import members
from ddct_bringup.reproduction.calibration.parameters import largest_residual, values_of
from ddct_bringup.reproduction.calibration.predicted_values import OPEN_LOOP
from ddct_bringup.reproduction.runs import THESIS_SCENARIO
from ddct_bringup.reproduction.studies.study import Study
from ddct_bringup.reproduction.values.closed_loop_values import OSCILLATION_WORDS, SLIP_WORDS, WORN
from ddct_bringup.thesis.predictions import Prediction, kept_predictions
from ddct_bringup.thesis.table_5_1 import (
    FIGURES,
    FORMS,
    PREDICTED,
    THESIS_TABLE,
    ThesisRow,
)
from ddct_bringup.verdict.metric_figures import METRICS
from ddct_plant.program.table import text_or_dash
from ddct_plant.scenario.scenario import Scenario


def admissible_scenarios() -> Study:
    """Return the fitted values of each kept scenario and how well it fits."""
    return Study(
        'Admissible scenarios',
        (
            'scenario',
            'window to s',
            'C_m start N m',
            'rise N m',
            'rise end s',
            'slope rad/s^2',
            'K_p',
            'K_i',
            'largest residual, tolerances',
        ),
        [_scenario_row(one) for one in (THESIS_SCENARIO, *members())],
    )


def _scenario_row(scenario: Scenario) -> tuple[str, ...]:
    start, end, rise_end, slope, proportional, integral = values_of(scenario)
    return (
        scenario.name,
        f'{scenario.score_window_s[1]:.1f}',
        f'{start:.1f}',
        f'{end - start:.1f}',
        f'{rise_end:.3f}',
        f'{slope:.1f}',
        f'{proportional:.3f}',
        f'{integral:.4f}',
        f'{largest_residual(fitted_rows(scenario)):.2f}',
    )


def prediction_ranges() -> Study:
    """Return the MPC rows of Table 5.1 as value and range beside the print."""
    rows = []
    for row in THESIS_TABLE:
        if row.use != PREDICTED:
            continue
        for name, printed in row.figures().items():
            found = _kept(f'5.1 {row.controller} {name}')
            assert not isinstance(found.frozen, str)
            rows.append(
                (
                    row.label,
                    METRICS[name].heading,
                    text_or_dash(found.frozen, FORMS[name]),
                    found.text(FORMS[name]),
                    f'{printed:.2f}',
                    row.verdict(name, found.frozen),
                    'yes' if found.contains(printed) else 'no',
                )
            )
    for name in FIGURES[1:]:
        alone = _kept(f'5.1 {OPEN_LOOP} {name}')
        value = text_or_dash(alone.frozen, FORMS[name])
        rows.append(
            (OPEN_LOOP, METRICS[name].heading, value, alone.text(FORMS[name]), '-', '-', '-')
        )
    return Study(
        'Predicted figures of Table 5.1',
        ('row', 'figure', 'value', 'range', 'printed', 'verdict', 'print within the range'),
        rows,
        (
            "The end '-': some of the scenarios have no t_a, as w_d does not reach zero.",
            *(_hits_at_once(row) for row in THESIS_TABLE if row.use == PREDICTED),
        ),
    )


def _hits_at_once(row: ThesisRow) -> str:
    """Return in how many scenarios all figures of a row are hits, and its sigmas."""
    values = [_kept(f'5.1 {row.controller} {name}').values for name in FIGURES]
    hits = [
        [row.hit(name, value) for name, value in zip(FIGURES, figures, strict=True)]
        for figures in zip(*values, strict=True)
    ]
    return (
        f'{row.label}: of {len(hits)} scenarios {sum(all(one) for one in hits)} hit all three '
        f'figures at once, {sum(all(one[1:]) for one in hits)} both standard deviations.'
    )


def worn_ranges() -> Study:
    """Return the words of Table 5.2 as hit or miss, and their numbers, with their ranges."""
    rows: list[tuple[str, ...]] = []
    for gain in WORN:
        for name in SLIP_WORDS:
            kinds = (
                ('w_d', f'w_d "{SLIP_WORDS[name]}"', ''),
                ('slip_rad_s', '|w_d| at the end of the window rad/s', '.1f'),
                ('w_sr', f'w_sr, A_x "{OSCILLATION_WORDS[gain][name]}"', ''),
                *((figure, METRICS[figure].heading, FORMS[figure]) for figure in FIGURES[1:]),
            )
            for kind, header, form in kinds:
                found = _kept(f'5.2 {name} {kind} {gain:g}')
                value = text_or_dash(found.frozen, form)
                rows.append((name, f'{gain:g}', header, value, found.text(form)))
    return Study(
        'Table 5.2, value and range',
        ('controller', 'K_usura', 'word or figure', 'value', 'range'),
        rows,
        ('A verdict on a word has beside it in how many of the scenarios it is that.',),
    )


def _kept(name: str) -> Prediction:
    return kept_predictions().by_id[name]

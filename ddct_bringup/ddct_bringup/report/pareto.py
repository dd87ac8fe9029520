# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Pareto view: two figures as axes, and the runs that are not dominated in both.

A smaller magnitude of a figure is better. Only engaged runs are compared: a run that stalls at
once has little friction work, but is not better.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement

from ddct_bringup.documents.page_parts import unit_text
from ddct_bringup.evaluation.non_dominated import non_dominated
from ddct_bringup.metrics.catalogue import FIGURES, METRICS
from ddct_bringup.metrics.metric import Metric
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.verdict.state import ENGAGED

DEFAULT_PAIR = ('friction_work_j', 'peak_jerk_m_s3')
"""Figures shown first: wear of the facing across, comfort up. Every complete run has both."""


@dataclass(frozen=True)
class ParetoAxis:
    """One figure as an axis; runs by their position in the report."""

    title: str
    """Symbol of the figure with its unit."""
    values: Mapping[int, float]
    """Magnitudes by run, for runs that have a value."""


@dataclass(frozen=True)
class ParetoView:
    """Data of the view: figures and fronts."""

    figures: Mapping[str, ParetoAxis]
    """Figures by key that two runs or more have a value of."""
    fronts: Mapping[str, Sequence[int]]
    """Non-dominated runs by `pair_key`; a figure is paired with itself too."""
    default: tuple[str, str]
    """Keys of the figures shown first, across and up."""


def pair_key(first: str, second: str) -> str:
    """Return the key of a front, independent of the order of the figures."""
    return ' '.join(sorted((first, second)))


def pareto_view(runs: Sequence[ScoredRecording]) -> ParetoView | None:
    """Return the view of the runs, None where no two figures have values of two runs."""
    magnitudes = _magnitudes(runs)
    if len(magnitudes) < 2:
        return None
    engaged = [index for index, run in enumerate(runs) if run.scores.state == ENGAGED]
    fronts = {
        pair_key(first, second): non_dominated(
            {
                run: (magnitudes[first][run], magnitudes[second][run])
                for run in engaged
                if run in magnitudes[first] and run in magnitudes[second]
            }
        )
        for first, second in combinations_with_replacement(magnitudes, 2)
    }
    first, second = [*magnitudes][:2]
    return ParetoView(
        figures={key: _axis(METRICS[key], values) for key, values in magnitudes.items()},
        fronts=fronts,
        default=DEFAULT_PAIR if set(DEFAULT_PAIR) <= set(magnitudes) else (first, second),
    )


def _magnitudes(runs: Sequence[ScoredRecording]) -> dict[str, dict[int, float]]:
    """Return the magnitudes of the valid runs by figure, where two or more runs have one."""
    found: dict[str, dict[int, float]] = {figure.key: {} for figure in FIGURES}
    for index, run in enumerate(runs):
        if not run.scores.valid:
            continue
        for key, values in found.items():
            if (value := run.scores.metrics[key]) is not None:
                values[index] = abs(value)
    return {key: values for key, values in found.items() if len(values) >= 2}


def _axis(figure: Metric, values: Mapping[int, float]) -> ParetoAxis:
    unit = unit_text(figure.unit)
    return ParetoAxis(f'{figure.symbol}, {unit}' if unit else figure.symbol, values)

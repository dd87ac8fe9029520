# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Labels and order of the runs of a report: controller, and conditions in which they differ."""

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from ddct_bringup.bag.run_facts import MEASURED, RunConditions
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_controllers.registry import controller_names
from ddct_plant.base.errors import DdctError

_CONDITIONS: dict[str, Callable[[Any], str]] = {
    'architecture': str,
    'handover': lambda handover: f'handover {handover}',
    'wear_gain': lambda gain: f'wear {gain:g}',
    'off_going_wear_gain': lambda gain: f'off-going wear {gain:g}',
    'mode': str,
    'seed': lambda seed: f'seed {seed}',
}
"""
Texts of the conditions of a run that its label contains when the runs differ in them.

Those of a gear shift are None in other runs, whose labels leave them out.
"""


def in_order(runs: Sequence[ScoredRecording]) -> list[ScoredRecording]:
    """Return the runs in the order of their controllers in the registry, logs last."""
    places = {name: place for place, name in enumerate(controller_names())}
    return sorted(runs, key=lambda run: (run.measured, places.get(run.scores.label, len(places))))


def require_one_scenario(runs: Sequence[ScoredRecording]) -> None:
    """
    Raise DdctError with the scenarios when the readable runs have different ones.

    Simulated runs have one scenario when its values are equal. For a log only the name is known.
    """
    bags: dict[str, list[str]] = {}
    names = {run.scores.scenario for run in runs if run.recording is not None}
    logs = [run for run in runs if run.measured]
    for run in runs:
        if run.recording is not None and not (run.measured and len(names) == 1):
            digest = f' (digest {run.digest})' if run.digest else ''
            bags.setdefault(f'{run.scores.scenario}{digest}', []).append(run.scores.bag)
    if len(bags) > 1:
        parts = '; '.join(f'{scenario}: {", ".join(of)}' for scenario, of in bags.items())
        of_logs = ', or write run.scenario in the column map of a log that was such a drive'
        raise DdctError(
            f'the runs are of {len(bags)} scenarios, which do not compare: {parts}: '
            f'make one report of each{of_logs if logs else ""}'
        )


def run_labels(runs: Sequence[ScoredRun]) -> list[str]:
    """
    Return one label per run: its controller, and the conditions in which the runs differ.

    Where that is not unique the bag is added. A bag without a controller has its own name.
    """
    differing = varied_conditions(runs)
    labels = [_label(run, differing) for run in runs]
    counts = Counter(labels)
    labels = [
        f'{label} ({run.bag})' if counts[label] > 1 else label
        for label, run in zip(labels, runs, strict=True)
    ]
    return _numbered(labels)


def varied_conditions(runs: Sequence[ScoredRun]) -> list[str]:
    """Return the keys of the conditions in which simulated runs differ; labels contain them."""
    known = _simulated(runs)
    return [key for key in _CONDITIONS if len({_value(facts, key) for facts in known}) > 1]


def common_conditions(runs: Sequence[ScoredRun]) -> list[str]:
    """Return the conditions that all simulated runs share, and how many logs there are."""
    known = _simulated(runs)
    shared = [key for key in _CONDITIONS if len({_value(facts, key) for facts in known}) == 1]
    logs = sum(run.measured for run in runs)
    of_logs = [f'{logs} {"log" if logs == 1 else "logs"} of a car'] if logs else []
    return [*_texts(known[0], shared), *of_logs] if known else of_logs


def _simulated(runs: Sequence[ScoredRun]) -> list[RunConditions]:
    """Return the facts of the simulated runs whose bags could be read."""
    return [run.facts for run in runs if run.facts is not None and not run.measured]


def _label(run: ScoredRun, differing: Sequence[str]) -> str:
    if run.facts is None:
        return run.bag
    if run.measured:
        return f'{run.facts.controller}, {MEASURED}'
    return ', '.join([run.facts.controller, *_texts(run.facts, differing)])


def _value(facts: RunConditions, key: str) -> Any:
    """Return a condition; None for one of a gear shift in another run."""
    return getattr(facts, key, None)


def _texts(facts: RunConditions, keys: Sequence[str]) -> list[str]:
    """Return the texts of the conditions that a run has."""
    values = ((key, _value(facts, key)) for key in keys)
    return [_CONDITIONS[key](value) for key, value in values if value is not None]


def _numbered(labels: Sequence[str]) -> list[str]:
    """Return the labels, with a number on the second and later ones of equal text."""
    counts: Counter[str] = Counter()
    result = []
    for label in labels:
        counts[label] += 1
        result.append(f'{label} #{counts[label]}' if counts[label] > 1 else label)
    return result

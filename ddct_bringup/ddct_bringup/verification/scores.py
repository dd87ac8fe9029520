# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Compute the scores and the loop analyses of a folder of runs again, and compare them."""

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.digests.writing import ITSELF
from ddct_bringup.metrics.catalogue import JERK_OVER_LEAST
from ddct_bringup.report.evidence import FREQUENCY_FILE
from ddct_bringup.scores.bags import find_bags
from ddct_bringup.scores.document import scores_document
from ddct_bringup.scores.floors import with_least
from ddct_bringup.scores.scored_recording import score_any_bag
from ddct_bringup.scores.scoring import NOT_COMPUTED
from ddct_bringup.verification.comparison import Comparison, plain_json, recorded_json
from ddct_bringup.verification.repetition import controller_of
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.result import RepetitionResult
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.settings import RunSettings

SCORES = 'scores.json'
"""Scores in a folder of runs."""


def verified_scores(request: VerificationRequest) -> RepetitionResult:
    """Compare `scores.json` with the scores of the recorded bags."""
    stored = recorded_json(request.folder / SCORES)
    limits = stored.get('limits') if isinstance(stored, dict) else None
    if limits != plain_json(request.limits.origin):
        return RepetitionResult.failed(
            SCORES,
            f'judged by the limits {json.dumps(limits)}, not by '
            f'{json.dumps(request.limits.origin)}: give --limits with that file',
        )
    scored = [
        score_any_bag(bag, request.folder, request.limits) for bag in find_bags(request.folder)
    ]
    names = [run.scores.bag for run in scored]
    try:
        recorded = _by_bag(stored, names)
        floors = [
            recorded['runs'].get(name, {}).get('null_reasons', {}).get(JERK_OVER_LEAST.key)
            != NOT_COMPUTED
            for name in names
        ]
    except (AttributeError, TypeError, DdctError) as error:
        return RepetitionResult.failed(SCORES, f'not the scores of runs ({error})')
    runs = [
        (with_least(run, request.limits) if floor else run).scores
        for run, floor in zip(scored, floors, strict=True)
    ]
    computed = plain_json(scores_document(runs, request.limits))
    comparison = Comparison()
    comparison.add_nested('', recorded, _by_bag(computed, names))
    return RepetitionResult.of(SCORES, comparison, same_environment=request.same_environment)


def _by_bag(document: Mapping[str, Any], names: Sequence[str]) -> Mapping[str, Any]:
    """Return scores with their runs by the names of the bags in the folder."""
    runs = {}
    for run in document.get('runs', ()):
        given = str(run.get('bag'))
        name = next((each for each in names if f'/{given}'.endswith(f'/{each}')), given)
        name = names[0] if names == [ITSELF] else name
        runs[name] = {**run, 'bag': name}
    return {**document, 'runs': runs}


def verified_frequency(request: VerificationRequest) -> RepetitionResult:
    """Compare `frequency.json` with the analyses of the controllers in the first run's plant."""
    comparison = Comparison()
    try:
        stored = recorded_json(request.folder / FREQUENCY_FILE)
        controllers = [controller_of(request, each) for each in request.digests.runs.values()]
        settings = _first_settings(request.folder)
        evidence = frequency_evidence(controllers, settings, report=lambda error: None)
        computed = plain_json(evidence)
    except DdctError as error:
        return RepetitionResult.failed(FREQUENCY_FILE, error)
    comparison.add_nested('', stored, computed)
    return RepetitionResult.of(
        FREQUENCY_FILE, comparison, same_environment=request.same_environment
    )


def _first_settings(folder: Path) -> RunSettings:
    """Return the settings of the first run whose bag can be read; all have the same."""
    for bag in find_bags(folder):
        with suppress(DdctError):
            if settings := read_bag(bag).settings:
                return settings
    raise DdctError('this version can build the settings of no run')

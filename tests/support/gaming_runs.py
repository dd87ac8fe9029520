# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers that game the judge by name, and runs of controllers in cases of the benchmark."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.keys import CONTROLLERS
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.campaign.specification.parts import RANDOM, ROOT_SEED, SAMPLES
from ddct_bringup.evaluation.case_figures import FIGURES, CaseFigures
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import ENGAGED

GAMING = Path(__file__).parent / 'gaming'
SHARED = {'gaming_parts', 'memorise', 'memory', 'memory_key', 'recorded_requests'}
"""Files without a controller."""
GAMING_CONTROLLERS = sorted({file.stem for file in GAMING.glob('*.py')} - SHARED)
DEVELOPMENT_SEED, HELD_OUT_SEED = 1, 991
"""Seed of the packaged development cases, and one that was fixed before any of its runs."""


def gaming_file(name: str) -> str:
    """Return the path of a gaming controller."""
    return str(GAMING / f'{name}.py')


class CaseRuns(NamedTuple):
    """Runs of one controller in cases of the benchmark, in their order."""

    scenarios: np.ndarray
    """Name of the scenario of each case, (cases,)."""
    figures: CaseFigures


def runs_in_cases(chosen: str, seed: int, samples: int) -> CaseRuns:
    """Return the runs of a controller in the first samples of each scenario with this seed."""
    content = dict(Cases.packaged().content)
    content |= {CONTROLLERS: [chosen], ROOT_SEED: seed}
    content[RANDOM] = {**content[RANDOM], SAMPLES: samples}
    campaign = Campaign(spec_of(content, Path()))
    rows = Scorer(packaged_limits(), at_once=False).scored(campaign.planned(0, campaign.runs))
    invalid = [row.scores.reason for row in rows if not row.scores.valid]
    assert not invalid, invalid
    columns = {
        name: np.array([row.scores.metrics[name] for row in rows], dtype=float)
        for figure in FIGURES
        for name in figure.columns
    }
    success = np.array([row.scores.state == ENGAGED for row in rows])
    scenarios = np.array([row.varied['scenario'] for row in rows])
    return CaseRuns(scenarios, CaseFigures.of(success, columns))

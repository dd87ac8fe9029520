# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Held-out cases of a tuning: drawn as the development cases, from a seed that nobody can choose.

The seed follows from the digests of the tuned controllers and of the release, as in a benchmark.
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pyarrow.compute as compute

from ddct_bringup.benchmark.judged import seed_of
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.conduct import carry_out_parts
from ddct_bringup.campaign.plan import CampaignPlan, RecordedCampaign
from ddct_bringup.campaign.rows import CONTROLLER
from ddct_bringup.campaign_report.reading import read_table
from ddct_bringup.manifest.limits import NamedLimits
from ddct_bringup.manifest.manifest import add_campaign, file_digest
from ddct_bringup.run.output_folder import mark_folder
from ddct_bringup.tuning.trial import Trial
from ddct_bringup.tuning.tuned_files import trial_file, trial_name
from ddct_bringup.tuning.tuning import Tuning

HELD_OUT = 'held_out'
"""Folder of the campaign of the held-out cases."""
_MOST = 12
"""Largest number of trials that run on the held-out cases besides the first one."""


def judged_trials(front: Sequence[Trial], best: Trial, trials: Sequence[Trial]) -> list[Trial]:
    """
    Return the trials that run on the held-out cases.

    They are the best one, others evenly spaced over the front, and the first trial, which has the
    values of before.
    """
    step = max(1, -(-len(front) // _MOST))
    found = {each.number: each for each in (trials[0], best, *front[::step])}
    return [found[number] for number in sorted(found)]


def held_out_campaign(
    tuning: Tuning, out: Path, judged: Sequence[Trial], release: str
) -> Campaign:
    """Return the campaign of the held-out cases; `release` is the digest of its code."""
    digests = {
        trial_file(each.number): file_digest(out / trial_file(each.number)) for each in judged
    }
    files = dict(sorted(tuning.judged.digests.items()))
    seed = seed_of({'tuned': digests, 'controller': files, 'release': release})
    # Relative to the folder of the tuning, which may be moved.
    moved = tuning.spec.development.moved(tuning.spec.folder, out)
    return moved.held_out(list(digests), out, seed)


def compute_held_out(
    tuning: Tuning,
    campaign: Campaign,
    limits: NamedLimits,
    out: Path,
    workers: int | None,
    stopped: Callable[[], bool],
) -> None:
    """Compute what is missing of the held-out runs; raise DdctError or KeyboardInterrupt."""
    add_campaign(out, HELD_OUT, CampaignPlan.of(campaign, limits, out))
    folder = out / HELD_OUT
    mark_folder(folder)
    parts = {folder: RecordedCampaign.read(folder)}
    carry_out_parts(parts, tuning.limits, workers=workers, stopped=stopped)


def held_out_trials(tuning: Tuning, out: Path, judged: Sequence[Trial]) -> Mapping[int, Trial]:
    """Return the judged trials with their rows of the held-out cases, by number."""
    folder = out / HELD_OUT
    table = read_table(folder, RecordedCampaign.read(folder))
    found = {}
    for each in judged:
        rows = table.filter(compute.equal(table[CONTROLLER], trial_name(tuning, each)))
        found[each.number] = Trial(each.number, each.values, rows, each.further)
    return found

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Execute a planned run, score it, and keep its bag."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.writer import bag_file
from ddct_bringup.manifest.manifest import finish_manifest
from ddct_bringup.manifest.runs import begin_run
from ddct_bringup.run.output_folder import run_folder
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.scored_recording import ScoredRecording, run_and_score
from ddct_bringup.verdict.limits import Limits


def keep_run(
    plan: RunPlan,
    out: Path,
    limits: Limits,
    execute: Callable[[RunPlan, Path], Recording | None],
    *,
    overwrite: bool,
) -> ScoredRecording:
    """
    Execute a plan, score its run and keep it as `<out>/<name>/`, one not valid as `.partial`.

    Raise the errors of `execute`, and DdctError for a folder that cannot be used.
    """
    with run_folder(out, plan.name, overwrite=overwrite) as folder:
        begin_run(folder.path, plan)
        kept = run_and_score(plan, folder.path, limits, execute)
        finish_manifest(folder.path)
        if not kept.scores.valid or kept.recording is None:
            return kept
        folder.commit()
    path = bag_file(folder.final, plan.name)
    return replace(kept, recording=replace(kept.recording, path=path))

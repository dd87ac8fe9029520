# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write what comes out of the trials into the folder of a tuning."""

from collections.abc import Callable, Sequence
from pathlib import Path

from ddct_bringup.documents.document import Document
from ddct_bringup.documents.page import html_page
from ddct_bringup.manifest.code import code_digest
from ddct_bringup.manifest.manifest import finish_manifest
from ddct_bringup.run.output_folder import locked_folders
from ddct_bringup.tuning.front import best_of, why_no_front
from ddct_bringup.tuning.held_out import (
    compute_held_out,
    held_out_campaign,
    held_out_trials,
    judged_trials,
)
from ddct_bringup.tuning.plan import RecordedTuning
from ddct_bringup.tuning.report.commands import PageCommands
from ddct_bringup.tuning.report.document import tuning_document
from ddct_bringup.tuning.result import TuningResult, result_of
from ddct_bringup.tuning.study import TuningStudy
from ddct_bringup.tuning.tables import write_tables
from ddct_bringup.tuning.trial import Trial
from ddct_bringup.tuning.tuned_files import write_tuned_files
from ddct_bringup.tuning.tuned_names import PAGE, RESULT
from ddct_bringup.tuning.tuning import Tuning
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import read_json, write_json
from ddct_plant.files.output_file import write_text
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.program.command_line import package_version


def write_tuning(
    out: Path,
    trials: Sequence[Trial],
    *,
    release: str = '',
    workers: int | None = None,
    stopped: Callable[[], bool] = lambda: False,
) -> TuningResult:
    """
    Write the record, the controller files, the held-out runs, the result and the page.

    `release` is the digest of the code by which the held-out cases are drawn, that of this process
    unless given. Raise DdctError where no trial keeps all constraints; the record is written all
    the same.
    """
    recorded = RecordedTuning.read(out)
    tuning = recorded.tuning(out)
    spec = tuning.spec
    with locked_folders(out, shared=True):
        write_tables(out, trials, spec, tuning.campaign.spec)
        study = TuningStudy(spec, tuning.present, out)
        front = [trials[number] for number in study.front()]
        if not front:
            finish_manifest(out)
            raise DdctError(why_no_front(trials, spec))
        judged = judged_trials(front, best_of(front, spec), trials)
        write_tuned_files(tuning, out, judged, best_of(front, spec))
        campaign = held_out_campaign(tuning, out, judged, release or code_digest())
        compute_held_out(tuning, campaign, recorded.plan.limits, out, workers, stopped)
        held_out = held_out_trials(tuning, out, judged)
        result = result_of(tuning, study, trials, held_out, campaign.spec.root)
        write_json(str(out / RESULT), result)
        commands = PageCommands.of(tuning, out)
        document = tuning_document(result, study.study, commands, _facts(tuning))
        write_text(str(out / PAGE), html_page(document))
        finish_manifest(out)
    return result


def tuning_in(out: Path) -> Document:
    """Return the document of the tuning in a folder; raise DdctError without a finished one."""
    tuning = RecordedTuning.read(out).tuning(out)
    result = read_json(TuningResult, out / RESULT, advice='finish the tuning')
    study = TuningStudy(tuning.spec, tuning.present, out)
    return tuning_document(result, study.study, PageCommands.of(tuning, out), _facts(tuning))


def _facts(tuning: Tuning) -> dict[str, str]:
    """Return the origin of a tuning as text by label."""
    digests = [f'{key} {value}' for key, value in tuning.judged.digests.items()]
    return {
        'controller': ', '.join([tuning.judged.chosen, *digests]),
        'development seed': str(tuning.campaign.spec.root),
        'seed of the search': str(tuning.spec.seed),
        'limits': f'{tuning.limits.origin.get("name")}, {tuning.limits.origin.get("digest")}',
        'version': f'{package_version()}, code {code_digest()}',
        'specification': dump_yaml(dict(tuning.spec.content)),
    }

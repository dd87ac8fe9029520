# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Carry out a tuning: batches of trials, ended early where that is certain, each recorded."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from ddct_bringup.campaign.conduct import SHARDS, begin_folder, require_going_on
from ddct_bringup.manifest.begun import begun_manifest
from ddct_bringup.manifest.file_states import require_unaltered
from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.manifest.manifest import (
    TUNING,
    Manifest,
    begin_manifest,
    keep_digests,
    require_same_inputs,
    resume_manifest,
)
from ddct_bringup.manifest.written_before import WrittenBefore
from ddct_bringup.run.output_folder import (
    locked_folders,
)
from ddct_bringup.tuning.evaluation import TrialRuns, evaluation
from ddct_bringup.tuning.front import why_all_invalid
from ddct_bringup.tuning.loop_quantities import update_time
from ddct_bringup.tuning.plan import RecordedTuning, TuningPlan
from ddct_bringup.tuning.specification.goals import UPDATE_TIME
from ddct_bringup.tuning.specification.parameters import Values
from ddct_bringup.tuning.study import BATCH, TuningStudy, require_optuna
from ddct_bringup.tuning.tables import batch_file, rows_by_trial, write_batch
from ddct_bringup.tuning.trial import NO_ROWS, Trial
from ddct_bringup.tuning.tuning import Tuning
from ddct_plant.base.errors import DdctError
from ddct_plant.program.progress import Progress

_HOPELESS = 2 * BATCH
"""Number of trials after which a tuning ends if every run so far is invalid."""
_NO_TIMES: Mapping[int, Mapping[str, float | None]] = {}


def carry_out_tuning(
    tuning: Tuning,
    out: Path,
    *,
    workers: int | None = None,
    resume: bool = False,
    stopped: Callable[[], bool] = lambda: False,
    known_times: Mapping[int, Mapping[str, float | None]] = _NO_TIMES,
) -> list[Trial]:
    """
    Compute the trials of a tuning into a folder and return them.

    Raise DdctError for unusable arguments, another tuning in the folder, and where every run is
    invalid; KeyboardInterrupt when `stopped()` becomes true. What is done stays, and `resume`
    continues with it. `known_times` are update times by trial that are not measured again.
    """
    require_optuna()
    with locked_folders(out):
        recorded, manifest = _begin(tuning, out, resume=resume)
        study = TuningStudy(recorded.spec, recorded.present, out)
        written = WrittenBefore(out, manifest)
        with evaluation(recorded, workers, stopped) as computed:
            return _Search(recorded, out, study, computed, written, known_times).trials()


def _begin(tuning: Tuning, out: Path, *, resume: bool) -> tuple[Tuning, Manifest]:
    """
    Write the manifest, or require the same one in the folder.

    Return the tuning, with the files that are in the folder, and the manifest.
    """
    inputs = InputFiles(tuning.spec.folder)
    plan = TuningPlan.of(tuning, require_optuna(), inputs)
    if known := begun_manifest(out, 'tuning', SHARDS, resume=resume):
        recorded = RecordedTuning.of(known, out)
        recorded.require_same(plan, out)
        require_same_inputs(out, known, inputs)
        require_unaltered(out, list(inputs.files))
        return recorded.tuning(out), resume_manifest(out, known)
    tuning.require_sound()
    begin_folder(out)
    manifest = begin_manifest(out, TUNING, plan, inputs)
    return RecordedTuning.of(manifest, out).tuning(out), manifest


@dataclass
class _Search:
    """Batches of the search: those that are not recorded are computed, and their results kept."""

    tuning: Tuning
    out: Path
    study: TuningStudy
    computed: TrialRuns
    written: WrittenBefore
    """Rows of the batches that were recorded before."""
    known_times: Mapping[int, Mapping[str, float | None]]
    """Update times by trial where they are not measured again, as they never come out again."""

    def trials(self) -> list[Trial]:
        """Return all trials."""
        with Progress('trials', self.tuning.spec.trials) as progress:
            return self._trials(progress)

    def _trials(self, progress: Progress) -> list[Trial]:
        spec = self.tuning.spec
        found: list[Trial] = []
        for batch, size in enumerate(batches_of(spec.trials)):
            require_going_on(self.computed.engine.stopped)
            suggested = self.study.ask(batch, size)
            trials = self._recorded(batch, suggested)
            if trials is None:
                trials = self.computed.batch(suggested, found, self._timed)
                write_batch(self.out, batch, trials, self.tuning.campaign.spec)
                keep_digests([batch_file(self.out, batch)])
                self.study.add(trials)
            found += trials
            progress.update(len(found))
            if len(found) >= _HOPELESS and (why := why_all_invalid(found)):
                raise DdctError(
                    f'{why}: mend the controller or its ranges, and start anew in another --out'
                )
        return found

    def _recorded(self, batch: int, suggested: Mapping[int, Values]) -> list[Trial] | None:
        """
        Return the trials of a batch that was recorded before, None for one that is not complete.

        Report rows that were altered; raise DdctError where the study has other trials.
        """
        trials = self.study.trials[batch * BATCH :][: len(suggested)]
        if any(dict(each.values) != suggested[each.number] for each in trials):
            raise self._other_trials()
        file = batch_file(self.out, batch)
        if len(trials) < len(suggested) or not self.written.has(file):
            return None
        rows = rows_by_trial(file)
        trials = [replace(each, rows=rows.get(each.number, NO_ROWS)) for each in trials]
        if not all(map(self.study.has, trials)):
            raise self._other_trials()
        return trials

    def _other_trials(self) -> DdctError:
        return DdctError(
            f'{self.out} has other trials than this search gives: it was altered, or '
            'computed with another Optuna: choose another --out',
            key='--out',
        )

    def _timed(self, trial: Trial) -> Trial:
        """Return a trial with its update time, where a constraint needs it."""
        if not any(goal.name == UPDATE_TIME for goal in self.tuning.spec.goals):
            return trial
        campaign = self.tuning.with_values(trial.values)
        measured = self.known_times.get(trial.number)
        if measured is None:
            measured = update_time(campaign, self.tuning.cases[0])
        return replace(trial, further={**trial.further, **measured})


def batches_of(trials: int) -> list[int]:
    """Return the numbers of trials of all batches."""
    return [min(BATCH, trials - first) for first in range(0, trials, BATCH)]

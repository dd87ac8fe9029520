# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Carry out a tuning: batches of trials, ended early where that is certain, each recorded."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ddct_bringup.campaign.conduct import SHARDS, begin_folder, require_going_on
from ddct_bringup.evaluation.non_dominated import dominates
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
from ddct_bringup.tuning.specification.development import parts_of
from ddct_bringup.tuning.specification.goals import UPDATE_TIME
from ddct_bringup.tuning.specification.parameters import Values
from ddct_bringup.tuning.study import BATCH, TuningStudy, require_optuna
from ddct_bringup.tuning.tables import batch_file, rows_by_trial, write_batch
from ddct_bringup.tuning.trial import DOMINATED, FEASIBLE, NO_ROWS, Trial
from ddct_bringup.tuning.tuning import Tuning
from ddct_plant.base.errors import DdctError
from ddct_plant.program.progress import Progress

LEAST_TOGETHER = 24
"""Fewest cases of a part whose runs are computed together: a batch of few takes nearly as long."""
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
                trials = computed_batch(self.tuning, self.computed, suggested, found, self._timed)
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


def computed_batch(
    tuning: Tuning,
    computed: TrialRuns,
    suggested: Mapping[int, Values],
    before: Sequence[Trial],
    timed: Callable[[Trial], Trial],
) -> list[Trial]:
    """
    Return the trials of a batch; `before` are all trials of earlier batches.

    After each part of the cases a trial ends if it breaks a constraint, or if one of `before` is
    better in every objective, whatever the rest of its runs come to. So no trial of the front ends
    early. The first trial with the present values runs in all cases, to be compared. `timed` adds
    the update time to a trial that keeps all else.
    """
    spec, cases = tuning.spec, tuning.cases
    rivals = [each.costs(spec, len(cases)) for each in before if each.state == FEASIBLE]
    loops = computed.loops(list(suggested.values()))
    trials = [
        Trial(number, values, further=loop).checked(spec, len(cases))
        for (number, values), loop in zip(suggested.items(), loops, strict=True)
    ]
    for part in parts_of(cases, LEAST_TOGETHER if computed.together else 1):
        going = [each for each in trials if each.state == FEASIBLE or _is_present(tuning, each)]
        rows = computed.rows([(each.values, case) for each in going for case in part])
        for place, each in enumerate(going):
            of_trial = rows.slice(place * len(part), len(part))
            trials[trials.index(each)] = _ended(tuning, each.with_rows(of_trial), rivals)
    return [
        timed(each).checked(spec, len(cases)) if each.state == FEASIBLE else each
        for each in trials
    ]


def _is_present(tuning: Tuning, trial: Trial) -> bool:
    return trial.number == 0 and bool(tuning.present)


def _ended(tuning: Tuning, trial: Trial, rivals: Sequence[Sequence[float]]) -> Trial:
    """Return a trial after a part of its runs, ended where that is certain."""
    cases = len(tuning.cases)
    trial = trial.checked(tuning.spec, cases)
    if trial.state != FEASIBLE or len(trial.rows) == cases:
        return trial
    costs = trial.costs(tuning.spec, cases)
    if any(dominates(rival, costs) for rival in rivals) and not _is_present(tuning, trial):
        return trial.ended(DOMINATED, 'another one is better in every objective')
    return trial

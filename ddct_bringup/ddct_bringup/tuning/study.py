# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The study of Optuna: which values are tried next, the trials that are done, and what decides.

Trials are asked for in batches of a fixed size. Each batch has a copy of the study with all trials
of earlier batches, and a seed of its own. So its values depend on the seed of the specification
and on these results alone: neither on the number of workers nor on where a search was interrupted.
"""

import importlib.metadata
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ddct_bringup.tuning.specification.goals import MINIMISE
from ddct_bringup.tuning.specification.parameters import LOG, Parameter, Values
from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.tuning.trial import DOMINATED, FEASIBLE, INFEASIBLE, Trial
from ddct_plant.base.errors import DdctError

if TYPE_CHECKING:
    from optuna import Study
    from optuna.distributions import BaseDistribution
    from optuna.samplers import TPESampler
    from optuna.storages import BaseStorage
    from optuna.trial import FrozenTrial

BATCH = 8
"""Number of trials of a batch; it does not depend on the workers."""
JOURNAL = 'study.journal'
"""File of the study, Optuna's journal with a line for each trial that is done."""
ANEW = 'start the tuning anew'
"""What to do where the record of a tuning cannot be read."""
FEWEST = 12
"""Fewest trials with a value for which importances are computed: the best quarter are three."""
_BEST_SHARE = 0.25
_AT_RANDOM = 2 * BATCH
"""Number of trials at random before the sampler follows the results."""
_DAMAGED = (OSError, ValueError, LookupError, TypeError, AttributeError, AssertionError)
"""What Optuna raises for a journal that is damaged."""
_NAME = 'tuning'
_REASON, _FURTHER = 'reason', 'further'
_WITHOUT_VALUE = 'no value of an objective'


def require_optuna() -> str:
    """Return the version of Optuna; raise DdctError without it."""
    try:
        return importlib.metadata.version('optuna')
    except importlib.metadata.PackageNotFoundError as error:
        raise DdctError(
            'ddct tune needs Optuna, which is missing: run make setup EXTRAS=tune, '
            'or pip install optuna'
        ) from error


class TuningStudy:
    """Study of a tuning, searched by the tree-structured Parzen estimator."""

    def __init__(
        self, spec: TuningSpec, present: Mapping[str, float], folder: Path | None = None
    ) -> None:
        """
        Open the study in a folder, or begin it there; without a folder it is in memory alone.

        Its first trial has the `present` values, if there are any. Raise DdctError for a journal
        that cannot be read.
        """
        self._spec, self._present = spec, dict(present)
        self._ranges = {each.name: _range(each) for each in spec.parameters}
        with _quiet(), _readable(folder):
            self.study = _opened(spec, folder)

    @property
    def trials(self) -> list[Trial]:
        """All trials that are done, without their runs."""
        return [trial_of(each) for each in self._trials]

    @property
    def _trials(self) -> 'list[FrozenTrial]':
        return self.study.get_trials(deepcopy=False)

    def ask(self, batch: int, count: int) -> dict[int, Values]:
        """Return the values of the trials of a batch by their numbers."""
        import optuna

        before = self._trials[: batch * BATCH]
        with _quiet():
            copy = optuna.create_study(
                directions=self.study.directions, sampler=self._sampler(batch)
            )
            copy.add_trials(before)
            found: dict[int, Values] = {}
            for number in range(len(before), len(before) + count):
                asked = copy.ask(self._ranges).params
                found[number] = {
                    each.name: each.rounded(asked[each.name]) for each in self._spec.parameters
                }
        if 0 in found and self._present:
            found[0] = dict(self._present)
        return found

    def add(self, trials: Sequence[Trial]) -> None:
        """Record those trials of a batch that are not recorded yet, each at once or not at all."""
        known = len(self._trials)
        for trial in trials:
            if trial.number >= known:
                with _quiet():
                    self.study.add_trial(self._finished(trial))

    def has(self, trial: Trial) -> bool:
        """Return whether the entry of a recorded trial is what its runs give."""
        found, entry = self._finished(trial), self._trials[trial.number]
        ours, recorded = ((each.state, each.values, each.constraints) for each in (found, entry))
        return ours == recorded

    def front(self) -> list[int]:
        """
        Return the numbers of the trials on the front, by the first objective.

        They are feasible, and no other feasible one dominates them.
        """
        found = self.study.best_trials
        return [each.number for each in sorted(found, key=lambda e: (self.costs(e), e.number))]

    def importances(self, place: int) -> dict[str, float]:
        """
        Return how much each parameter decides an objective, the most first; empty of few trials.

        They are PED-ANOVA's, with the sum 1 (Watanabe, Bansal and Hutter 2023): how far the
        values of the best quarter of the trials are from those of all.
        """
        from optuna.importance import PedAnovaImportanceEvaluator, get_param_importances

        if sum(each.values is not None for each in self._trials) < FEWEST:
            return {}
        with _quiet():
            return get_param_importances(
                self.study,
                evaluator=PedAnovaImportanceEvaluator(target_quantile=_BEST_SHARE),
                target=lambda trial: self.costs(trial)[place],
            )

    def costs(self, trial: 'FrozenTrial') -> list[float]:
        """Return the values of a trial, those of objectives to maximise with the other sign."""
        return [
            value if goal.sense == MINIMISE else -value
            for goal, value in zip(self._spec.objectives, trial.values, strict=True)
        ]

    def _sampler(self, batch: int) -> 'TPESampler':
        import optuna

        (seed,) = np.random.SeedSequence([self._spec.seed, batch]).generate_state(1)
        return optuna.samplers.TPESampler(
            n_startup_trials=_AT_RANDOM, multivariate=True, constant_liar=True, seed=int(seed)
        )

    def _finished(self, trial: Trial) -> 'FrozenTrial':
        """Return a trial as Optuna records it; one without its objectives is pruned."""
        from optuna.trial import TrialState, create_trial

        found = [trial.estimate(goal, self._spec) for goal in self._spec.objectives]
        values = [value for value in found if value is not None]
        pruned = trial.state == DOMINATED or len(values) < len(found)
        return create_trial(
            state=TrialState.PRUNED if pruned else TrialState.COMPLETE,
            values=None if pruned else values,
            params=dict(trial.values),
            distributions=self._ranges,
            user_attrs={_REASON: trial.reason, _FURTHER: dict(trial.further)},
            constraints=self._violations(trial),
        )

    def _violations(self, trial: Trial) -> dict[str, float]:
        """Return how far each constraint is broken; an infeasible trial breaks at least one."""
        found = {
            each.title: max(each.violation(trial.estimate(each.goal, self._spec)), 0.0)
            for each in self._spec.constraints
        }
        if trial.state != INFEASIBLE:
            return dict.fromkeys([*found, _WITHOUT_VALUE], 0.0)
        return {**found, _WITHOUT_VALUE: 0.0 if any(found.values()) else 1.0}


def read_trials(folder: Path) -> list[Trial]:
    """Return the trials of the study in a folder, without their runs; raise DdctError."""
    import optuna

    with _quiet(), _readable(folder):
        (folder / JOURNAL).stat()  # Optuna makes a file that is missing
        study = optuna.load_study(study_name=_NAME, storage=_storage(folder))
        return [trial_of(each) for each in study.get_trials(deepcopy=False)]


def trial_of(trial: 'FrozenTrial') -> Trial:
    """Return a trial without its runs, of its entry in the study."""
    from optuna.trial import TrialState

    broken = any(each > 0.0 for each in trial.constraints.values())
    kept = DOMINATED if trial.state == TrialState.PRUNED else FEASIBLE
    return Trial(
        number=trial.number,
        values=dict(trial.params),
        state=INFEASIBLE if broken else kept,
        reason=str(trial.user_attrs[_REASON]),
        further=dict(trial.user_attrs[_FURTHER]),
    )


@contextmanager
def _readable(folder: Path | None) -> Iterator[None]:
    """Turn the errors of a journal that cannot be read into a DdctError that names it."""
    try:
        yield
    except _DAMAGED as error:
        why = next(iter(str(error).splitlines()), type(error).__name__)
        place = folder / JOURNAL if folder else None
        raise DdctError(f'cannot be read ({why}): {ANEW}', place=place) from error


def _opened(spec: TuningSpec, folder: Path | None) -> 'Study':
    import optuna

    if folder is not None:
        _cut(folder / JOURNAL)
    study = optuna.create_study(
        study_name=_NAME,
        storage=None if folder is None else _storage(folder),
        directions=['minimize' if g.sense == MINIMISE else 'maximize' for g in spec.objectives],
        load_if_exists=True,
    )
    names = [goal.name for goal in spec.objectives]
    if study.metric_names != names:
        study.set_metric_names(names)
    return study


def _storage(folder: Path) -> 'BaseStorage':
    from optuna.storages import JournalStorage
    from optuna.storages.journal import JournalFileBackend

    return JournalStorage(JournalFileBackend(str(folder / JOURNAL)))


def _cut(journal: Path) -> None:
    """Cut off a line that a killed program has not finished, and remove its lock."""
    journal.with_name(f'{JOURNAL}.lock').unlink(missing_ok=True)
    if journal.exists() and not (content := journal.read_bytes()).endswith(b'\n'):
        journal.write_bytes(content[: content.rfind(b'\n') + 1])


@contextmanager
def _quiet() -> Iterator[None]:
    """Leave out what Optuna says of its experimental parts and of each trial."""
    import optuna

    optuna.logging.set_verbosity(optuna.logging.WARNING)
    with warnings.catch_warnings():
        warnings.simplefilter('ignore')
        yield


def _range(parameter: Parameter) -> 'BaseDistribution':
    from optuna.distributions import FloatDistribution, IntDistribution

    log = parameter.scale == LOG
    if parameter.whole:
        return IntDistribution(int(parameter.low), int(parameter.high), log=log)
    return FloatDistribution(parameter.low, parameter.high, log=log)

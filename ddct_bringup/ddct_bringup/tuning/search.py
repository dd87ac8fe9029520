# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Search by Optuna: which values are tried next.

Trials are asked for in batches of a fixed size, and their results are told in their order. So the
search is the same for any number of workers. It keeps nothing on the disk: where a tuning goes on,
the same calls with the recorded results bring it to the same state.
"""

import importlib.metadata
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ddct_bringup.tuning.specification.goals import MINIMISE, Goal
from ddct_bringup.tuning.specification.parameters import LOG, Parameter
from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.tuning.trial import INFEASIBLE, Trial
from ddct_plant.base.errors import DdctError

if TYPE_CHECKING:
    from optuna import Study
    from optuna.distributions import BaseDistribution
    from optuna.trial import Trial as Asked

BATCH = 8
"""Number of trials of a batch; it does not depend on the workers."""
_WITHOUT_VALUE = 'no value of an objective'
_AT_RANDOM = 2 * BATCH
"""Number of trials at random before the sampler follows the results."""


def require_optuna() -> str:
    """Return the version of Optuna; raise DdctError without it."""
    try:
        return importlib.metadata.version('optuna')
    except importlib.metadata.PackageNotFoundError as error:
        raise DdctError(
            'ddct tune needs Optuna, which is missing: run make tune-extra, or pip install optuna'
        ) from error


class Search:
    """The tree-structured Parzen estimator of Optuna, for one objective or several."""

    def __init__(self, spec: TuningSpec, present: Mapping[str, float]) -> None:
        """Start with the `present` values, if there are any, and the seed of the specification."""
        require_optuna()
        import optuna

        optuna.logging.set_verbosity(optuna.logging.WARNING)
        warnings.filterwarnings('ignore', category=optuna.exceptions.ExperimentalWarning)
        self._spec, self._present = spec, dict(present)
        self._worst: dict[str, float] = {}
        self._asked: dict[int, Asked] = {}
        sampler = optuna.samplers.TPESampler(
            n_startup_trials=_AT_RANDOM,
            multivariate=True,
            constant_liar=True,
            seed=spec.seed,
        )
        self._study: Study = optuna.create_study(
            directions=[
                'minimize' if goal.sense == MINIMISE else 'maximize' for goal in spec.objectives
            ],
            sampler=sampler,
        )
        self._ranges = {each.name: _range(each) for each in spec.parameters}
        if present:
            self._study.enqueue_trial(self._present)

    def ask(self, count: int) -> dict[int, dict[str, float]]:
        """Return the values of the next trials by their numbers."""
        found = {}
        for _ in range(count):
            asked = self._study.ask(self._ranges)
            self._asked[asked.number] = asked
            found[asked.number] = {
                each.name: each.rounded(asked.params[each.name]) for each in self._spec.parameters
            }
        if 0 in found and self._present:
            found[0] = self._present
        return found

    def tell(self, trials: Sequence[Trial]) -> None:
        """Let the search know the results of all trials of the last call of `ask`."""
        for trial in trials:
            asked = self._asked.pop(trial.number)
            for name, violation in self._violations(trial).items():
                asked.set_constraint(name, violation)
            values = [self._value(trial, goal) for goal in self._spec.objectives]
            self._study.tell(asked, values)

    def _violations(self, trial: Trial) -> Mapping[str, float]:
        """Return how far each constraint is broken; a trial that was ended counts as it stood."""
        found = {
            each.title: max(each.violation(trial.estimate(each.goal, self._spec)), 0.0)
            for each in self._spec.constraints
        }
        if trial.state != INFEASIBLE:
            return dict.fromkeys([*found, _WITHOUT_VALUE], 0.0)
        return {**found, _WITHOUT_VALUE: 0.0 if any(found.values()) else 1.0}

    def _value(self, trial: Trial, goal: Goal) -> float:
        """Return a value over the runs of a trial; without one the worst so far."""
        value = trial.estimate(goal, self._spec)
        if value is None:
            return self._worst.get(goal.name, 0.0)
        worse = max if goal.sense == MINIMISE else min
        self._worst[goal.name] = worse(value, self._worst.get(goal.name, value))
        return value


def _range(parameter: Parameter) -> 'BaseDistribution':
    from optuna.distributions import FloatDistribution, IntDistribution

    log = parameter.scale == LOG
    if parameter.whole:
        return IntDistribution(int(parameter.low), int(parameter.high), log=log)
    return FloatDistribution(parameter.low, parameter.high, log=log)

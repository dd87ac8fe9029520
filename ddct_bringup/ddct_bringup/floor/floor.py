# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Floor of a metric: the proven least of any run, beside the value that a run attains."""

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.attained import Replays, replays_of, signals_of_run
from ddct_bringup.floor.bound import bound_of
from ddct_bringup.floor.cache import cached, digest_of, store
from ddct_bringup.floor.case import Case, case_at, case_of_run, gives_demand
from ddct_bringup.floor.dynamics.start import Start, start_of
from ddct_bringup.floor.friction_work import least_friction_work
from ddct_bringup.floor.lock import lock_of
from ddct_bringup.floor.objectives import OBJECTIVES, Objective, Signals
from ddct_bringup.floor.program import CLOSED_FORM, RAY
from ddct_bringup.metrics.friction_work import friction_work
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import load_limits
from ddct_plant.base.errors import ParameterError, require_choice
from ddct_plant.scenario.settings import RunSettings

FRICTION = 'friction_energy'
"""Metric whose bound has a closed form."""
METRICS: Mapping[str, str] = {
    **{name: objective.unit for name, objective in OBJECTIVES.items()},
    FRICTION: 'J',
}
"""Units of the metrics that have a floor, by name."""
OF_STICK_SLIP = 'slip_acceleration_at_lock'
"""Metric that only a clutch that sticks has."""
DEMAND, LIMITS = (
    'runs in which the engine gives the demand',
    'runs in which the engine gives what its limits allow',
)
"""Runs that a floor covers."""
_DRIVER = 'pi'
"""Controller of the run to control start, where every controller of `detailed` is the same."""


@dataclass(frozen=True)
class Floor:
    """Least value of a metric for runs that lock at one instant, and a value that one attains."""

    metric: str
    lock_time_s: float
    """Time of the lock in s from control start; for a linear clutch when the slip stays small."""
    least: float | None
    """Proven lower bound in the unit of the metric; None where no request leads to such a lock."""
    attained: float | None
    """Value of a run of the simulated plant with that lock, None where none was found."""
    certificate: Mapping[str, Any]
    """
    Kind of the proof, its number, and the runs that it covers.

    The number is the bound that the multipliers prove by weak duality, of a Farkas ray the least
    violation of all constraints, which is positive.
    """
    replay_residual: float | None
    """Difference between the value of that run and its prediction, in the unit of the metric."""

    @property
    def gap(self) -> float | None:
        """Excess of the attained value over the least one in %; None where one is missing."""
        if not self.least or self.attained is None:
            return None
        return 100.0 * (self.attained / self.least - 1.0)

    def as_dict(self) -> dict[str, Any]:
        """Return the floor under the keys of `limit --json`."""
        return {
            'lock_time_s': self.lock_time_s,
            'metric': self.metric,
            'least': self.least,
            'attained': self.attained,
            'gap': self.gap,
            'certificate': dict(self.certificate),
            'replay_residual': self.replay_residual,
        }


@dataclass(frozen=True)
class OverFloor:
    """Value of a run beside the least at its own lock instant."""

    value: float
    floor: Floor

    @property
    def over_floor(self) -> float | None:
        """Value over the least; None where the least is zero."""
        return self.value / self.floor.least if self.floor.least else None


def control_start(settings: RunSettings) -> Start:
    """
    Return the state at control start, which every controller of the architecture starts from.

    Raise ParameterError where it depends on the controller, or the plates do not slip there.
    """
    if not settings.detailed:
        raise ParameterError(
            f'architecture {settings.architecture}: feedback is on from t = 0, so the state at '
            'control start depends on the controller: choose the architecture detailed',
            key='architecture',
        )
    if settings.shift:
        raise ParameterError(
            f'scenario {settings.scenario.name} is a gear shift: a floor is of an engagement '
            'with one clutch, and none of a shift is computed'
        )
    run = run_headless(settings, _DRIVER)
    start = start_of(settings, run)
    if start.slip == 0.0:
        raise ParameterError(
            f'scenario {settings.scenario.name}: the plates do not slip at control start: there '
            'is nothing to engage, and no floor'
        )
    return start


def floor_of(
    settings: RunSettings, metric: str, lock_time_s: float, start: Start | None = None
) -> Floor:
    """
    Return the floor of a metric for runs that lock `lock_time_s` after control start.

    Runs in which the engine always gives the demand come first: their floor is the sharper one.
    Where the limits of the engine act in the run that attains it, C_m is a variable. Raise
    ParameterError for an unknown metric, or a case without floors.
    """
    start = control_start(settings) if start is None else start
    return floors_at(settings, [metric], lock_time_s, start)[0]


def floors_at(
    settings: RunSettings, metrics: Sequence[str], lock_time_s: float, start: Start
) -> list[Floor]:
    """Return the floors of metrics for runs with one lock instant, as `floor_of` does."""
    latest = (settings.scenario.steps - start.step) / 100.0
    if not 0.0 < lock_time_s < latest:
        raise ParameterError(
            f'lock time {lock_time_s:g} s: give one between 0 and {latest:g} s, when the run ends'
        )
    narrow = case_at(settings, start, lock_time_s, limited=False)
    wide = case_at(settings, start, lock_time_s, limited=True)
    floors = []
    for metric in metrics:
        found = _found(narrow, metric)
        if found.limited:
            found = _found(wide, metric, found.last)
        floors.append(found.floor)
    return floors


def floors_of_run(
    settings: RunSettings,
    metrics: Sequence[str],
    run: Trajectory,
    start: Start | None = None,
    *,
    attain: bool = True,
) -> dict[str, OverFloor | None]:
    """
    Return by metric the value of a run and the least at its own lock instant.

    Without `attain` no run near the least is searched for, which takes half as long. The program
    contains the run. None where a metric has no value, and for all metrics of a run that does not
    lock once and stay locked, commands the engine, or starts otherwise.
    """
    none: dict[str, OverFloor | None] = dict.fromkeys(metrics)
    start = control_start(settings) if start is None else start
    lock = lock_of(run, start.step)
    if lock is None or run.steps < settings.scenario.steps:
        return none
    case = case_of_run(settings, start, lock, run)
    if case is None:
        return none
    values = {metric: value_of(settings, metric, run, start.step) for metric in metrics}
    return {
        metric: None
        if value is None
        else OverFloor(value, _found(case, metric, attain=attain).floor)
        for metric, value in values.items()
    }


def value_of(settings: RunSettings, metric: str, run: Trajectory, start: int) -> float | None:
    """Return the value of a metric of a run, for friction that of the work after control start."""
    if metric == FRICTION:
        return float(friction_work(run, start))
    scenario = settings.scenario
    signals = signals_of_run(start, engagements_a_day(), scenario, run)
    return _objective(metric).value(signals)


@cache
def engagements_a_day() -> float:
    """Return the number of engagements of a day that the rules of verdicts have."""
    return load_limits(None).rules.engagements_a_day


def floor_of_case(case: Case, metric: str) -> Floor:
    """Return the floor of a metric for the runs of a case, without a run near it."""
    return _found(case, metric, attain=False).floor


@dataclass(frozen=True, eq=False)
class _Found:
    """A floor, and the behaviour of the engine in its replays."""

    floor: Floor
    limited: bool
    """Whether limits of the engine act in the replay, which the case excludes."""
    last: Trajectory | None = None
    """Last replay; None where there is none, or the floor is from the cache."""


def _found(
    case: Case, metric: str, begin: Trajectory | None = None, *, attain: bool = True
) -> _Found:
    """Return the floor of a case, from the cache where it is there."""
    digest = digest_of(case, metric, engagements_a_day(), attain)
    known = cached(digest)
    if known is not None:
        return _Found(Floor(**known['floor']), known['limited'])
    closed = metric == FRICTION
    found = _closed_form(case) if closed else _computed(case, metric, begin, attain)
    store(digest, {'floor': dataclasses.asdict(found.floor), 'limited': found.limited})
    return found


def _closed_form(case: Case) -> _Found:
    least = least_friction_work(case)
    certificate = {'kind': CLOSED_FORM, 'proven': least, 'covers': 'rigid car'}
    return _Found(Floor(FRICTION, case.lock.time_s, least, None, certificate, None), False)


def _computed(case: Case, metric: str, begin: Trajectory | None, attain: bool) -> _Found:
    objective, settings = _objective(metric), case.settings
    signals = Signals.of_motion(case.motion, settings.scenario, engagements_a_day())
    covers = LIMITS if case.limited else DEMAND
    bound = bound_of(case, objective, signals)
    if bound is None:
        raise ParameterError(
            f'{metric} is not defined for the clutch {settings.clutch} or the run'
        )
    certificate = {'kind': bound.kind, 'proven': bound.certificate.claim, 'covers': covers}
    if bound.kind == RAY:
        # Where even a free engine torque does not help, the wide case proves it.
        limited = not case.limited and settings.scenario.engine_limits is not None
        return _Found(Floor(metric, case.lock.time_s, None, None, certificate, None), limited)
    replays = Replays(None, None)
    if attain:
        replays = replays_of(case, objective, signals, bound, begin)
    best, last, least = replays.best, replays.last, bound.least
    if best is not None and least is not None and best.value < least:
        # This run left the band of speeds: with it in the band the bound is below.
        return _with_run(case, metric, best.run, begin)
    floor = Floor(
        metric,
        case.lock.time_s,
        least,
        best.value if best else None,
        certificate,
        abs(best.value - best.predicted) if best else None,
    )
    limited = last is not None and not case.limited and not gives_demand(last, case.start.step)
    return _Found(floor, limited, last)


def _with_run(case: Case, metric: str, run: Trajectory, begin: Trajectory | None) -> _Found:
    """Return the floor of a case that contains a run too; unless it does, without replays."""
    tube = case.tube.with_run(run, case.start.step)
    wider = dataclasses.replace(case, tube=tube)
    return _computed(wider, metric, begin, attain=tube is not case.tube)


def _objective(metric: str) -> Objective:
    require_choice('metric', metric, list(METRICS))
    return OBJECTIVES[metric]

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A floor computed: bound, certificate and replays of one metric over the runs of a case."""

from dataclasses import dataclass, replace

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.bound import bound_of
from ddct_bringup.floor.cache import KnownFloor, cached, digest_of, store
from ddct_bringup.floor.case import Case
from ddct_bringup.floor.dynamics.torque_cut import gives_demand
from ddct_bringup.floor.friction_work import least_friction_work
from ddct_bringup.floor.metric_units import FRICTION
from ddct_bringup.floor.objectives import Signals
from ddct_bringup.floor.program.linear_program import CLOSED_FORM, RAY
from ddct_bringup.floor.replays.attained import Replays, replays_of
from ddct_bringup.floor.values import Floor, Proof, objective_of
from ddct_plant.base.errors import ParameterError

DEMAND, LIMITS = (
    'runs in which the engine gives the demand',
    'runs in which the engine gives what its limits allow',
)
"""Runs that a floor covers, for its certificate."""


_PRICED = 1e-3
"""Price of the engine speed from which a limited engine may do better than the demand."""


@dataclass(frozen=True, eq=False)
class ComputedFloor:
    """A floor, and what its replays tell about the engine."""

    floor: Floor
    limited: bool
    """Whether runs in which limits of the engine act, which the case excludes, may do better."""
    last: Trajectory | None = None
    """Last replay; None where there is none, or the floor is from the cache."""


def computed_floor(
    case: Case, metric: str, begin: Trajectory | None = None, *, attain: bool = True
) -> ComputedFloor:
    """Return the floor of a case, from the cache where it is there."""
    digest = digest_of(case, metric, attain)
    known = cached(digest)
    if known is not None:
        return ComputedFloor(known.floor, known.limited)
    closed = metric == FRICTION
    found = _closed_form(case) if closed else _computed(case, metric, begin, attain)
    store(digest, KnownFloor(found.floor, found.limited))
    return found


def _closed_form(case: Case) -> ComputedFloor:
    least = least_friction_work(case)
    certificate = Proof(CLOSED_FORM, least, 'rigid car')
    return ComputedFloor(Floor(FRICTION, case.lock.time_s, least, None, certificate, None), False)


def floor_without_run(case: Case, metric: str, proof: Proof) -> ComputedFloor:
    """Return the floor of a case that has no run by a proof."""
    # Where even a free engine torque does not help, the wide case says so.
    limited = not case.limited and case.settings.scenario.engine_limits is not None
    return ComputedFloor(Floor(metric, case.lock.time_s, None, None, proof, None), limited)


def _computed(case: Case, metric: str, begin: Trajectory | None, attain: bool) -> ComputedFloor:
    objective, settings = objective_of(metric), case.settings
    signals = Signals.of_motion(case.motion, settings.scenario)
    covers = LIMITS if case.limited else DEMAND
    bound = bound_of(case, objective, signals)
    if bound is None:
        raise ParameterError(
            f'{metric} is not defined for the clutch {settings.known.clutch} or the run'
        )
    certificate = Proof(bound.kind, bound.certificate.claim, covers)
    if bound.kind == RAY:
        return floor_without_run(case, metric, certificate)
    replays = Replays(None, None)
    # Nothing is below a least of zero, and its runs part again.
    if attain and bound.least and bound.engine_price <= _PRICED:
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
    limited = (
        bool(bound.least)
        and not case.limited
        and (
            bound.engine_price > _PRICED
            or (last is not None and not gives_demand(last, case.start.step))
        )
    )
    return ComputedFloor(floor, limited, last)


def _with_run(case: Case, metric: str, run: Trajectory, begin: Trajectory | None) -> ComputedFloor:
    """Return the floor of a case that contains a run too; unless it does, without replays."""
    tube = case.tube.with_run(run, case.start.step)
    wider = replace(case, tube=tube)
    return _computed(wider, metric, begin, attain=tube is not case.tube)

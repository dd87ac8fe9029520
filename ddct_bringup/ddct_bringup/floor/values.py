# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics that have a floor, their values in a run, and what a floor consists of."""

from dataclasses import dataclass

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.metric_units import FRICTION, METRICS
from ddct_bringup.floor.objectives import OBJECTIVES, Objective
from ddct_bringup.floor.replays.attained import signals_of_run
from ddct_bringup.metrics.friction_work import friction_work
from ddct_plant.base.errors import require_choice
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True)
class Proof:
    """What proves a floor."""

    kind: str
    proven: float
    """
    Bound that the multipliers prove by weak duality; of a Farkas ray a positive lower bound of
    the largest violation of a constraint.
    """
    covers: str
    """Runs that the floor covers."""


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
    certificate: Proof
    replay_residual: float | None
    """Difference between the value of that run and its prediction, in the unit of the metric."""

    @property
    def gap(self) -> float | None:
        """Distance of the attained value above the least one in %; None where one is missing."""
        if not self.least or self.attained is None:
            return None
        return 100.0 * (self.attained / self.least - 1.0)


@dataclass(frozen=True)
class OverFloor:
    """Value of a run beside the least at its own lock instant."""

    value: float
    floor: Floor

    @property
    def over_floor(self) -> float | None:
        """Value over the least; None where the least is zero."""
        return self.value / self.floor.least if self.floor.least else None


def value_of(settings: RunSettings, metric: str, run: Trajectory, start: int) -> float | None:
    """Return the value of a metric of a run, for friction that of the work after control start."""
    if metric == FRICTION:
        return float(friction_work(run, start))
    return objective_of(metric).value(signals_of_run(start, settings.scenario, run))


def objective_of(metric: str) -> Objective:
    """Return the objective of a metric; raise ParameterError for an unknown name."""
    require_choice('metric', metric, list(METRICS))
    return OBJECTIVES[metric]

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Open-loop torques of many runs, of one architecture."""

from collections.abc import Callable, Hashable, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from ddct_bringup.batch.controllers.interface import Measured
from ddct_bringup.batch.stacks import Filters, stacked
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.settings import KnownSettings

_NOTHING = 'base'
"""Architecture without an open loop."""
_FULL = 'full'
"""Equilibrium that counts the damping of engine and primary shaft."""
OpenLoops = Callable[[Measured], np.ndarray]
"""Function from the measured signals with C_load to the torques in N m, (R,), without feedback."""


def static_torques(drivelines: Sequence[DrivelineParameters], equilibria: Sequence[str]) -> Any:
    """
    Return the `StaticTorque` of R drivelines with their equilibria; its torques are (R,).

    The equilibrium `thesis` is the `full` one of a driveline without these dampings.
    """
    counted = [
        each if equilibrium == _FULL else replace(each, engine_damping=0.0, shaft_damping=0.0)
        for each, equilibrium in zip(drivelines, equilibria, strict=True)
    ]
    return StaticTorque(stacked(counted), _FULL)


def known_load(known: KnownSettings) -> RoadLoad:
    """Return the load of the known car, of which controllers compute C_load."""
    scenario = known.scenario
    return RoadLoad(scenario.load, scenario.vehicle, scenario.slope)


def open_loop_kind(known: KnownSettings) -> Hashable:
    """Return what runs with common open loops share: also the order of the feedforward."""
    if known.detailed or known.architecture == _NOTHING:
        return known.architecture
    return known.architecture, known.scenario.actuator.delay_substeps


def make_open_loops(known: Sequence[KnownSettings], static: Any) -> OpenLoops:
    """Return C_fOL, the feedforward or nothing, by the architecture of the runs."""
    if known[0].detailed:
        return lambda m: static.torque(
            m.engine_torque, m.load_torque, m.engine_speed, m.shaft_speed
        )
    if known[0].architecture == _NOTHING:
        return lambda m: np.zeros(len(known))
    return Feedforwards(known).update


class Feedforwards:
    """The counterpart of `Feedforward`."""

    def __init__(self, known: Sequence[KnownSettings]) -> None:
        # Only here: the other architectures need not wait for the imports of the design.
        from ddct_controllers.design.feedforward import design_feedforward, state_at_rest

        designed, scenarios = cache(design_feedforward), [run.scenario for run in known]
        self._models = [designed(each.driveline, each.actuator) for each in scenarios]
        self._state_at_rest = state_at_rest
        self._filters: Filters | None = None

    def update(self, measured: Measured) -> np.ndarray:
        """Return the requests in N m for C_m and C_load of the coming period, (R,)."""
        if self._filters is None:
            torques = measured.engine_torque.tolist()
            starts = [
                self._state_at_rest(*each) for each in zip(self._models, torques, strict=True)
            ]
            self._filters = Filters(self._models, np.stack(starts))
        return self._filters.update(measured.engine_torque, measured.load_torque)

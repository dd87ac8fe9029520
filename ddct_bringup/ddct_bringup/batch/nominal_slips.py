# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The slips of the nominal runs of many scenarios, which stored references follow at first."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.open_loops import known_load, static_torques
from ddct_bringup.batch.plant.plants import Loads, Plants
from ddct_plant.scenario.settings import KnownSettings
from ddct_reference.factory import nominal_settings


def nominal_slips(runs: Sequence[KnownSettings], control_start: int) -> np.ndarray:
    """Return the nominal slips of R runs as `nominal_slip` does, (R, control_start + 1)."""
    nominal = [nominal_settings(run.scenario) for run in runs]
    plants, scenarios = Plants(nominal, control_start), [run.scenario for run in runs]
    drivelines = [each.driveline for each in scenarios]
    static = static_torques(drivelines, [each.equilibrium for each in scenarios])
    loads = Loads([known_load(run) for run in runs], control_start)
    slips, running = [], np.ones(len(runs), dtype=bool)
    for step in range(control_start + 1):
        tick = plants.tick(step)
        observation, true = plants.observe(tick), tick.true
        slips.append(true.slip_speed)
        speed: Any = true.vehicle_speed
        load_torque = loads.torque(step, speed)
        speeds = true.engine_speed, true.shaft_speed
        request = static.torque(observation.delivered, load_torque, *speeds)
        plants.advance(plants.reply(observation, request), running)
    return np.stack(slips, axis=-1)

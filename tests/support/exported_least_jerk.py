# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`least_jerk` exported as C, compiled and named by its controller file."""

from pathlib import Path
from typing import Any

import numpy as np

from ddct_bringup.benchmark.cases import Cases
from ddct_controllers.interface import Controller, Measurement
from ddct_controllers.least_jerk.controller import SPEC
from ddct_controllers.least_jerk.export.export_least_jerk import export_least_jerk
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings
from support.exported_mpc import compile_c

COMPILE = ('-O2', '-ffp-contract=off', '-shared', '-fPIC', 'ddct_least_jerk.c', '-lm')


def settings_of(
    scenario: str, wear_gain: float = 1.0, clutch: str = 'stick_slip', **changes: Any
) -> RunSettings:
    """Return a run with the sensors of the benchmark, and sections of the scenario changed."""
    (sensors,) = Cases.packaged().content['grid']['sensors']
    changed = load_scenario(scenario, {'sensors': sensors, **changes}, clutch)
    return RunSettings(changed, clutch=clutch, wear_gain=wear_gain, seed=3)


def in_c(settings: RunSettings, folder: Path) -> str:
    """Return the controller file of the C that is exported for a run, and compiled."""
    export_least_jerk(make_controller(SPEC, settings), settings, folder)
    compile_c(folder, *COMPILE, '-o', 'ddct_least_jerk.so')
    return str(folder / 'least_jerk_in_c.yaml')


def random_measurement(random: np.random.Generator, step: int) -> Measurement:
    """Return a measurement that no loop gives: the plates part, lock and turn backward."""
    speed = random.uniform(-5.0, 700.0)
    return Measurement(
        step=step,
        engine_speed=speed,
        shaft_speed=speed - random.choice([0.1, 3.0, 60.0]) * random.standard_normal(),
        wheel_speed=random.uniform(-1.0, 60.0),
        vehicle_speed=3.0,
        engine_torque=random.uniform(-50.0, 300.0),
        slip_reference=[random.uniform(-20.0, 100.0)],
        slip_reference_rate=[random.uniform(-300.0, 50.0)],
        load_torque=random.uniform(-100.0, 400.0),
        open_loop_torque=random.uniform(-60.0, 300.0),
    )


def answers(controller: Controller, seed: int) -> list[tuple[float, float | None]]:
    """Return clutch and engine torques of an episode in N m; in some steps feedback is off."""
    random = np.random.default_rng(seed)
    controller.reset()
    torques = []
    for step in range(60):
        measurement = random_measurement(random, step)
        if random.random() < 0.1 or step < 5:
            controller.hold(measurement)
        else:
            command = controller.update(measurement)
            torques.append((command.clutch_torque, command.engine_torque))
    return torques

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Exported controllers beside the originals, step by step, on measurements of no loop."""

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.exported_mpc import ExportedController, exported, limited_settings

from ddct_controllers.interface import Controller, Measurement
from ddct_controllers.mpc.export.export_controller import export_controller
from ddct_controllers.mpc.qp.problem import QpSolution, QpStructure
from ddct_controllers.registry import make_controller

EPISODES, STEPS = 40, 8
"""
Numbers of episodes and steps.

Few steps: on measurements that it does not cause, a controller may drift from its original.
"""
HIGHEST_N_M = 30.0


def random_measurement(random: np.random.Generator, step: int, references: int) -> Measurement:
    """Return a measurement with open-loop torques that jump, fall below 0 or exceed the limits."""
    return Measurement(
        step=step,
        engine_speed=random.uniform(100.0, 200.0),
        shaft_speed=random.uniform(80.0, 180.0),
        wheel_speed=random.uniform(5.0, 15.0),
        vehicle_speed=3.0,
        engine_torque=random.uniform(0.0, 250.0),
        slip_reference=random.uniform(-20.0, 60.0, references).tolist(),
        slip_reference_rate=random.uniform(-100.0, 100.0, references).tolist(),
        load_torque=random.uniform(-50.0, 300.0),
        open_loop_torque=random.uniform(-60.0, 90.0),
    )


def answers(controller: Controller, seed: int) -> list[tuple[list[float], tuple[str, ...], bool]]:
    """
    Return torques in N m, status and fallbacks, and whether the request is beyond its level.

    It is one episode; in some steps feedback is off.
    """
    random = np.random.default_rng(seed)
    controller.reset()
    given: list[tuple[list[float], tuple[str, ...], bool]] = []
    for step in range(STEPS):
        measurement = random_measurement(random, step, controller.preview_steps + 1)
        if random.random() < 0.3:
            controller.hold(measurement)
            continue
        command = controller.update(measurement)
        status = dict(command.status)
        torques = [command.clutch_torque, command.engine_torque or 0.0]
        beyond = torques[0] + measurement.open_loop_torque > HIGHEST_N_M + 1e-6
        given.append((torques, (status['qp_status'], status['fallbacks']), beyond))
    return given


@pytest.mark.parametrize('name', ['mpc2', 'mpc4', 'mpc_preview'])
def test_any_measurements_give_the_originals_torques(tmp_path, name):
    settings = limited_settings(
        name,
        HIGHEST_N_M,
        800,
        'engine_authority.deviation_n_m=60',
        'engine_authority.slew_n_m_s=1000',
        'engine_authority.lag_s=0.02',
        'engine_authority.maximum_torque_n_m=180',
    )
    original = make_controller(name, settings.known)
    in_c = exported(original, name, settings, tmp_path / 'c')
    above = 0
    for seed in range(EPISODES):
        expected, found = answers(original, seed), answers(in_c, seed)
        for (ours, status, _), (theirs, other, _) in zip(found, expected, strict=True):
            assert status == other == ('solved', '0')
            np.testing.assert_allclose(ours, theirs, rtol=1e-8, atol=1e-6)
        above += sum(beyond for _, _, beyond in expected)
    assert above > 30, 'the rate seldom goes before the level'


class Hasty:
    """A solver with a solution only where no limit is active at the unconstrained optimum."""

    def __init__(self, structure: QpStructure) -> None:
        self._structure = structure

    def reset(self) -> None:
        pass

    def solve(self, f: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> QpSolution:
        z = -np.linalg.solve(self._structure.hessian, f)
        rows = self._structure.constraints @ z
        if (rows >= lower - 1e-9).all() and (rows <= upper + 1e-9).all():
            return QpSolution(z, 0, 'solved')
        return QpSolution(z, 0, 'iteration limit')


def never_changing_its_active_set(folder: Path) -> ExportedController:
    """Return the C exported into `folder` with an iteration limit that no option gives."""
    header, limit = folder / 'ddct_mpc.h', '#define DDCT_MPC_ITERATIONS '
    lines = header.read_text().splitlines()
    lines = [f'{limit}0' if line.startswith(limit) else line for line in lines]
    header.write_text('\n'.join(lines) + '\n')
    return ExportedController(folder)


@pytest.mark.parametrize('name', ['mpc2', 'mpc4'])
def test_steps_without_a_solution_follow_the_plan_as_the_original_does(tmp_path, name):
    """Some torques are within the limits and some are not, those of the plan neither."""
    settings = limited_settings(name, 1000, 40000)
    original: Any = make_controller(name, settings.known)
    export_controller(original, name, settings.known, tmp_path / 'c')
    original.solver = Hasty(original.program.structure)
    in_c = never_changing_its_active_set(tmp_path / 'c')
    met: Counter[str] = Counter()
    for seed in range(EPISODES):
        expected, found = answers(original, seed), answers(in_c, seed)
        for (ours, status, _), (theirs, other, _) in zip(found, expected, strict=True):
            assert status == other
            np.testing.assert_allclose(ours, theirs, rtol=1e-8, atol=1e-6)
            met.update(status[:1])
    assert min(met['solved'], met['iteration limit']) > 10, met

"""Exported controllers fed with what no loop gives them, step by step beside the originals."""

from collections import Counter

import numpy as np
import pytest
from support.exported_mpc import NOT_IN_C, exported, run_settings

from ddct_controllers.interface import Controller, Measurement
from ddct_controllers.mpc.predictive_controllers import PREDICTIVE
from ddct_controllers.registry import make_controller

EPISODES, STEPS = 40, 8
"""Few steps: fed with what it does not cause, a controller may drift away from its like."""


def random_measurement(random: np.random.Generator, step: int, references: int) -> Measurement:
    """Return one with open-loop torques that jump, fall below 0 and lie beyond the limits."""
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


def answers(controller: Controller, seed: int) -> list[tuple[list[float], tuple[str, ...]]]:
    """Return torques in N m, and status and fallbacks, of one episode; some steps are held."""
    random = np.random.default_rng(seed)
    controller.reset()
    given = []
    for step in range(STEPS):
        measurement = random_measurement(random, step, controller.preview_steps + 1)
        if random.random() < 0.3:
            controller.hold(measurement)
            continue
        command = controller.update(measurement)
        status = dict(command.status)
        torques = [command.clutch_torque, command.engine_torque or 0.0]
        given.append((torques, (status['qp_status'], status['fallbacks'])))
    return given


@pytest.mark.parametrize('name', sorted(set(PREDICTIVE) - NOT_IN_C))
def test_any_measurements_get_the_originals_answers(tmp_path, name):
    section = f'controllers.{name}'
    settings = run_settings(
        f'{section}.highest_torque_n_m=30',
        f'{section}.torque_rate_n_m_s=800',
        f'{section}.control_steps=3',
        'engine_authority.deviation_n_m=60',
        'engine_authority.slew_n_m_s=1000',
        'engine_authority.lag_s=0.02',
        'engine_authority.maximum_torque_n_m=180',
    )
    original = make_controller(name, settings)
    in_c = exported(original, name, settings, tmp_path / 'c')
    met: Counter[str] = Counter()
    for seed in range(EPISODES):
        expected, found = answers(original, seed), answers(in_c, seed)
        assert [status for _, status in found] == [status for _, status in expected]
        for (ours, _), (theirs, _) in zip(found, expected, strict=True):
            np.testing.assert_allclose(ours, theirs, rtol=1e-8, atol=1e-6)
        met.update(status for _, (status, _) in expected)
    assert min(met['solved'], met['infeasible']) > 30, met

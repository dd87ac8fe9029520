# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The closed loop again, its plant integrated by scipy: an independent source of figures."""

import numpy as np
import scipy

from ddct_controllers.architecture import make_architecture
from ddct_controllers.interface import Measurement
from ddct_controllers.registry import make_controller
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.engine import Engine
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.printed import ACTUATOR
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.settings import RunSettings
from ddct_reference.factory import make_reference


def tight_tolerance_run(settings: RunSettings, name: str) -> dict[str, np.ndarray]:
    """
    Return w_d and w_sr in rad/s and A_x in m/s^2, each (N+1,), its plant integrated to 1e-10.

    Actuator and driveline are one continuous system here, so the clutch torque bends nowhere
    within a period; saturation acts on the held request, as in the actuator. A_x is the left
    limit, as the driveline has it, and 0 at t_0.
    """
    scenario = settings.scenario
    plant, filter_ = driveline_matrices(scenario.driveline), ACTUATOR.to_state_space()
    initial = initial_state(settings)
    engine = Engine(scenario.engine, scenario.engine_authority)
    load = RoadLoad(scenario.load, scenario.vehicle)
    controller = make_controller(name, settings.known)
    reference = make_reference(settings.known, controller.preview_steps)
    architecture = make_architecture(settings.known, controller)
    delayed = initial.sides[0].torque_request
    state = np.concatenate(
        [
            initial.states,
            np.linalg.solve(filter_.a, -filter_.b[:, 0] * delayed),
        ]
    )
    radius = scenario.vehicle.wheel_radius_m
    outputs, accelerations = [], [0.0]
    for step in range(scenario.steps + 1):
        outputs.append(plant.c @ state[:4])
        w_m, w_p, w_r, _ = state[:4]
        speed = radius * w_r
        demand, c_load = engine.demand(step), load.torque(speed)
        references, rates = reference.update(step, w_m - w_p)
        request = architecture.update(
            Measurement(step, w_m, w_p, w_r, speed, demand, references, rates)
        )
        c_m = engine.torque(engine.demand(step), request.engine_torque)

        def derivative(_, x, held=delayed, c_m=c_m, c_load=c_load):
            c_f = settings.case.wear_gain * (filter_.c @ x[4:])[0]
            driveline = plant.a @ x[:4] + plant.b @ [c_m, c_f, c_load]
            return np.concatenate([driveline, filter_.a @ x[4:] + filter_.b[:, 0] * held])

        solution = scipy.integrate.solve_ivp(
            derivative, (0.0, 0.01), state, method='DOP853', rtol=1e-10, atol=1e-10
        )
        state, delayed = solution.y[:, -1], max(request.torque, 0.0)
        accelerations.append(radius * derivative(0.01, state)[2])
    slip, torsion = np.transpose(outputs)
    return {'w_d': slip, 'w_sr': torsion, 'A_x': np.array(accelerations[:-1])}

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`mpc_preview` formulated in do-mpc, as a peer of the step time."""

import do_mpc
import numpy as np

from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.mpc.estimate.observer import Observer
from ddct_controllers.mpc.model.transmission_model import SLIP_SPEED, TransmissionModel
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_plant.base.timebase import PERIOD_S

_NO_OUTPUT = {'ipopt.print_level': 0, 'ipopt.sb': 'yes', 'print_time': 0}


class DoMpcController(Controller):
    """do-mpc with our observer, model, weights and prediction horizon; all moves are free."""

    def __init__(
        self, model: TransmissionModel, observer: Observer, settings: MpcSettings
    ) -> None:
        """Set up do-mpc for a model."""
        self._observer = observer
        self.preview_steps = settings.prediction_steps
        plant = do_mpc.model.Model('discrete')
        x = plant.set_variable('_x', 'x', shape=(len(model.a), 1))
        u = plant.set_variable('_u', 'u', shape=(1, 1))
        reference = plant.set_variable('_tvp', 'reference', shape=(1, 1))
        engine = plant.set_variable('_tvp', 'engine', shape=(1, 1))
        load = plant.set_variable('_tvp', 'load', shape=(1, 1))
        inputs = (u, engine, load)
        coming = model.a @ x
        for column, value in enumerate(inputs):
            coming = coming + model.b[:, [column]] @ value
        plant.set_rhs('x', coming)
        plant.setup()
        self._mpc = do_mpc.controller.MPC(plant)
        self._mpc.set_param(
            n_horizon=settings.prediction_steps,
            t_step=PERIOD_S,
            store_full_solution=False,
            nlpsol_opts=_NO_OUTPUT,
        )
        error = reference - model.c[[SLIP_SPEED]] @ x
        cost = (settings.outputs[0].weight * error) ** 2
        self._mpc.set_objective(mterm=cost, lterm=cost)
        self._mpc.set_rterm(u=settings.inputs[0].move_weight ** 2)
        self._mpc.bounds['lower', '_u', 'u'] = 0.0
        self._forecast = self._mpc.get_tvp_template()
        self._mpc.set_tvp_fun(lambda _: self._forecast)
        self._mpc.setup()
        self.reset()

    def reset(self) -> None:
        """Forget the run."""
        self._observer.reset()
        self._started = False

    def hold(self, measurement: Measurement) -> None:
        """Follow the plant while feedback is off."""
        self._correct(measurement)
        self._predict(measurement, measurement.open_loop_torque)

    def update(self, measurement: Measurement) -> Command:
        """Return the torque that is added to the open loop."""
        state = self._correct(measurement).reshape(-1, 1)
        for step, reference in enumerate(measurement.slip_reference):
            self._forecast['_tvp', step, 'reference'] = reference
            self._forecast['_tvp', step, 'engine'] = measurement.engine_torque
            self._forecast['_tvp', step, 'load'] = measurement.load_torque
        if not self._started:
            self._mpc.reset_history()
            self._mpc.x0, self._mpc.u0 = state, np.array([[measurement.open_loop_torque]])
            self._mpc.set_initial_guess()
            self._started = True
        request = float(self._mpc.make_step(state)[0, 0])
        self._predict(measurement, request)
        return Command(request - measurement.open_loop_torque)

    def _correct(self, measurement: Measurement) -> np.ndarray:
        speeds = (measurement.engine_speed, measurement.shaft_speed, measurement.wheel_speed)
        return self._observer.correct(speeds, measurement.load_torque)

    def _predict(self, measurement: Measurement, request: float) -> None:
        self._observer.predict(
            (max(request, 0.0), measurement.engine_torque, measurement.load_torque)
        )

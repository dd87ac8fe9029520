"""Headless runs with what a scenario cannot say: a step of the load, noise on the speeds."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ddct_bringup.run.headless import ClosedLoop
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.scenario.settings import RunSettings


def slip_after_load_step(
    settings: RunSettings,
    controller: Controller,
    load_step_n_m: float,
    load_step_index: int,
    each_step: Callable[[], None] = lambda: None,
) -> np.ndarray:
    """
    Return w_d (steps + 1,) in rad/s of a run whose load grows by `load_step_n_m` on the way.

    The plant has it from step `load_step_index` on; controllers compute C_load from the vehicle
    speed and do not see it. `each_step` is called after every reply of the loop.
    """
    loop = ClosedLoop(settings, controller)
    slip = np.zeros(settings.scenario.steps + 1)
    for step in range(len(slip)):
        reply = loop.reply(step)
        slip[step] = reply['slip_speed']
        each_step()
        if step >= load_step_index:
            reply['load_torque'] += load_step_n_m
        loop.advance(reply)
    return slip


class NoisySpeeds(Controller):
    """Gives a controller w_m, w_p and w_r with Gaussian noise that repeats after every reset."""

    def __init__(self, controller: Controller, deviation_rad_s: float, seed: int) -> None:
        """Wrap `controller`; the noise has the standard deviation `deviation_rad_s`."""
        self._controller = controller
        self._deviation = deviation_rad_s
        self._seed = seed
        self.preview_steps = controller.preview_steps
        self.commands_engine = controller.commands_engine
        self.reset()

    def reset(self) -> None:
        """Reset the controller and start the noise anew."""
        self._controller.reset()
        self._random = np.random.default_rng(self._seed)

    def hold(self, measurement: Measurement) -> None:
        """Pass a held-off period on with noise."""
        self._controller.hold(self._noisy(measurement))

    def update(self, measurement: Measurement) -> Command:
        """Return what the controller answers to noisy speeds."""
        return self._controller.update(self._noisy(measurement))

    def _noisy(self, measurement: Measurement) -> Measurement:
        engine, shaft, wheel = self._random.normal(0.0, self._deviation, 3).tolist()
        return replace(
            measurement,
            engine_speed=measurement.engine_speed + engine,
            shaft_speed=measurement.shaft_speed + shaft,
            wheel_speed=measurement.wheel_speed + wheel,
        )

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Measurements of one closed-loop run, and the time of a controller's updates with them."""

import time

from ddct_bringup.run.headless import run_headless
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.scenario.settings import RunSettings

Measurements = tuple[list[Measurement], list[Measurement]]
"""Measurements of the steps with feedback held off, and of the steps with an update."""


class _Recording(Controller):
    """Controller that stores its measurements and passes each to another controller."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self.preview_steps = controller.preview_steps
        self.commands_engine = controller.commands_engine
        self.held: list[Measurement] = []
        self.updated: list[Measurement] = []

    def reset(self) -> None:
        self._controller.reset()

    def hold(self, measurement: Measurement) -> None:
        self.held.append(measurement)
        self._controller.hold(measurement)

    def update(self, measurement: Measurement) -> Command:
        self.updated.append(measurement)
        return self._controller.update(measurement)


def measurements_of(settings: RunSettings, controller: Controller) -> Measurements:
    """Return the measurements that the controller receives in a headless run."""
    recording = _Recording(controller)
    run_headless(settings, recording)
    return recording.held, recording.updated


def times_of(controller: Controller, measurements: Measurements) -> list[float]:
    """Return the wall times of all updates in s, after a reset."""
    held, updated = measurements
    times = []
    controller.reset()
    for measurement in held:
        controller.hold(measurement)
    for measurement in updated:
        started = time.perf_counter()
        controller.update(measurement)
        times.append(time.perf_counter() - started)
    return times

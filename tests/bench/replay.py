"""The measurements of one closed-loop run, and how long a controller takes to answer them."""

import time

from ddct_bringup.run.headless import run_headless
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.scenario.settings import RunSettings

Heard = tuple[list[Measurement], list[Measurement]]
"""Those while feedback was held off, and those that were answered."""


class _Listening(Controller):
    """Passes everything on and keeps the measurements."""

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


def measurements_of(settings: RunSettings, controller: Controller) -> Heard:
    """Return what the controller hears in a headless run."""
    listening = _Listening(controller)
    run_headless(settings, listening)
    return listening.held, listening.updated


def times_of(controller: Controller, heard: Heard, rounds: int) -> list[float]:
    """Return the times of all updates in us, each round after a reset."""
    held, updated = heard
    times = []
    for _ in range(rounds):
        controller.reset()
        for measurement in held:
            controller.hold(measurement)
        for measurement in updated:
            started = time.perf_counter()
            controller.update(measurement)
            times.append(1e6 * (time.perf_counter() - started))
    return times

"""The controller under check, and what several checks want to know of it."""

import importlib.metadata
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ddct_controllers.check.trial import (
    Change,
    Heard,
    StepResponse,
    closed_trial,
    played,
    probe_step,
    step_response,
)
from ddct_controllers.check.watch import Printed
from ddct_controllers.from_file.python_file import SUFFIX, module_name
from ddct_controllers.interface import Controller, ControllerSpec, Measurement
from ddct_controllers.linear import PiController
from ddct_controllers.places import place_of_error
from ddct_controllers.registry import ENTRY_POINT_GROUP, controller_spec, make_controller
from ddct_plant.base.errors import DdctError, ForeignError
from ddct_plant.scenario.settings import RunSettings


class CheckFailedError(Exception):
    """A check found an error; the text says what was measured, where, and what to do."""


class CheckSkippedError(Exception):
    """A check does not apply; the text says why."""


def root_cause(error: BaseException) -> BaseException:
    """Return the error that an error was first raised from."""
    while error.__cause__:
        error = error.__cause__
    return error


@dataclass
class Subject:
    """A controller by name; every `make` is a new object."""

    name: str
    settings: RunSettings
    printed: Printed

    @cached_property
    def points(self) -> list[importlib.metadata.EntryPoint]:
        """The entry points of its name: none for one of ours or a file."""
        return list(importlib.metadata.entry_points(group=ENTRY_POINT_GROUP, name=self.name))

    @property
    def package(self) -> str:
        """The top-level module of its code; '' for one of ours or in YAML."""
        if self.name.endswith(SUFFIX):
            return module_name(self.name)
        return self.points[0].module.partition('.')[0] if self.points else ''

    @cached_property
    def spec(self) -> ControllerSpec[Controller]:
        """How it is made."""
        return controller_spec(self.name)

    def make(self) -> Controller:
        """Return a new object."""
        return make_controller(self.name, self.settings)

    def what_failed(self, error: BaseException) -> CheckFailedError:
        """Return the failure of a check in whose course the controller raised `error`."""
        cause = root_cause(error)
        if isinstance(cause, DdctError) and not isinstance(error, ForeignError):
            return CheckFailedError(str(error))
        advice = 'mend it there'
        if isinstance(cause, IndexError):
            advice += ' (slip_reference has preview_steps + 1 entries)'
        elsewhere = self.points[0].value if self.points else self.name
        place = place_of_error(cause, self.package) or elsewhere
        return CheckFailedError(f'it raised {type(cause).__name__}: {cause}, in {place}: {advice}')

    @cached_property
    def sample(self) -> Controller:
        """An object that is only looked at."""
        return self.make()

    @cached_property
    def closed(self) -> Heard:
        """A run in the closed loop."""
        return closed_trial(self.settings, self.make())

    @cached_property
    def measured(self) -> list[tuple[bool, Measurement]]:
        """What a PI of 0.1 N m/rpm measures: the same plain engagement for every controller."""
        pi = PiController(0.1, 0.1)
        pi.preview_steps = self.sample.preview_steps
        return closed_trial(self.settings, pi).measured

    @cached_property
    def answers(self) -> np.ndarray:
        """(steps, 2) what a new object answers to `measured`, in N m."""
        return played(self.make(), self.measured)

    @cached_property
    def response(self) -> StepResponse:
        """How slip answers a step of its reference."""
        return step_response(self.settings, self.make, plain=self.closed)

    def played(self, change: Change, steps: int = 10**9) -> np.ndarray:
        """Return what a new object answers where `steps` measurements from the probe on change."""
        first = probe_step(self.settings)
        return played(self.make(), self.measured, change, first, first + steps)

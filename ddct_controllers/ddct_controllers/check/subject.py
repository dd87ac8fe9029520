# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The controller under check, with the trials and signals that several checks share."""

import importlib.metadata
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from ddct_controllers.check.trial import (
    Change,
    ClosedLoopLog,
    StepResponse,
    closed_trial,
    probe_step,
    replay,
    step_response,
)
from ddct_controllers.check.watch import OutputMonitor
from ddct_controllers.from_file.own_modules import module_name, sources_of
from ddct_controllers.from_file.python_file import SUFFIX, python_spec
from ddct_controllers.interface import Controller, ControllerSpec, Measurement
from ddct_controllers.linear import PiController
from ddct_controllers.places import place_of_error
from ddct_controllers.plugins import CONTROLLERS
from ddct_controllers.registry import controller_spec, make_controller
from ddct_plant.base.errors import DdctError, ForeignError
from ddct_plant.scenario.settings import KnownSettings

_TRIALS = ('closed_loop', 'measurements', 'torques', 'response')
"""Attributes of a subject that hold plain values of its trials."""


class CheckFailedError(Exception):
    """A check found an error; the text gives measured values, place and remedy."""


class CheckSkippedError(Exception):
    """A check does not apply; the text gives the reason."""


def root_cause(error: BaseException) -> BaseException:
    """Return the error at the start of the chain of causes of `error`."""
    while error.__cause__:
        error = error.__cause__
    return error


@dataclass
class Subject:
    """A controller by name; every `make` returns a new object."""

    name: str
    settings: KnownSettings
    printed: OutputMonitor

    @cached_property
    def entry_points(self) -> list[importlib.metadata.EntryPoint]:
        """Entry points of the controller's name: none for one of ours or in a file."""
        return list(CONTROLLERS.points().select(name=self.name))

    @property
    def package(self) -> str:
        """Top-level module of the controller's code; '' for one of ours or in YAML."""
        if self.name.endswith(SUFFIX):
            with suppress(DdctError):
                return module_name(sources_of(Path(self.name)))
            return ''
        return self.entry_points[0].module.partition('.')[0] if self.entry_points else ''

    @cached_property
    def spec(self) -> ControllerSpec[Controller]:
        """Specification by which the controller is made; objects of a file share its modules."""
        spec = controller_spec(self.name)
        return python_spec(self.name, anew=False) if self.name.endswith(SUFFIX) else spec

    @property
    def compiled(self) -> bool:
        """Whether it is compiled code, of which each check has a process of its own."""
        with suppress(DdctError):
            return self.spec.compiled is not None
        return False

    def trials(self) -> dict[str, object]:
        """Return the trials so far that checks share, by attribute, for another process."""
        return {name: vars(self)[name] for name in _TRIALS if name in vars(self)}

    def make(self) -> Controller:
        """Return a new controller object."""
        return make_controller(self.spec, self.settings)

    def failure(self, error: BaseException) -> CheckFailedError:
        """Return the failure of a check in which the controller raised `error`."""
        cause = root_cause(error)
        if isinstance(cause, DdctError) and not isinstance(error, ForeignError):
            return CheckFailedError(str(error))
        advice = 'mend it there'
        if isinstance(cause, IndexError):
            advice += ' (slip_reference has preview_steps + 1 entries)'
        elsewhere = self.entry_points[0].value if self.entry_points else self.name
        place = place_of_error(cause, self.package) or elsewhere
        return CheckFailedError(f'it raised {type(cause).__name__}: {cause}, in {place}: {advice}')

    @cached_property
    def sample(self) -> Controller:
        """Controller object whose attributes are read; its updates are never called."""
        return self.make()

    @cached_property
    def closed_loop(self) -> ClosedLoopLog:
        """Log of a run in the closed loop."""
        return closed_trial(self.settings, self.make())

    @cached_property
    def measurements(self) -> list[tuple[bool, Measurement]]:
        """
        Measurements of a run with a PI of 0.1 N m/rpm, the same for every controller.

        Each comes with whether feedback was on.
        """
        pi = PiController(0.1, 0.1)
        pi.preview_steps = self.sample.preview_steps
        return closed_trial(self.settings, pi).measurements

    @cached_property
    def torques(self) -> np.ndarray:
        """Torques (steps, 2) of a new object for `measurements`, in N m, of clutch and engine."""
        return replay(self.make(), self.measurements)

    @cached_property
    def response(self) -> StepResponse:
        """Step response of the closed loop from slip reference to slip."""
        return step_response(self.settings, self.make, plain=self.closed_loop)

    def replay(self, change: Change, steps: int = 10**9) -> np.ndarray:
        """
        Return a new object's torques, (steps, 2) in N m, with changed measurements.

        `change` applies to `steps` measurements from the probe step on.
        """
        first = probe_step(self.settings)
        return replay(self.make(), self.measurements, change, first, first + steps)

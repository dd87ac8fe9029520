# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An FMU as a controller."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ddct_controllers.from_file.controller_file import ControllerFile
from ddct_controllers.from_file.fmu.instance import Instance, InstanceError, Reference, Setting
from ddct_controllers.from_file.fmu.unit import Fmu
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.base.errors import DdctError, require_signal
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.program.own_process import calling

CLUTCH, ENGINE = 'clutch_torque_n_m', 'engine_torque_n_m'
"""Quantities that an output may be: torque requests of clutch and engine."""


@dataclass(frozen=True)
class FmuInput:
    """An input of the FMU: the variable, and the signal of a measurement that it receives."""

    variable: Any
    read: Callable[[Measurement], float]
    ahead: int = 0
    """Number of periods ahead for which the signal is read."""


class FmuController(Controller):
    """
    An FMU in the place of a controller's class.

    In each period its inputs are set, it takes a step of 10 ms, and its outputs hold over that
    period. Its own time is 0 when feedback begins.

    It is loaded anew for each run, from fresh files in a temporary folder, which end with this
    object. A call that fails raises DdctError with the FMU's last log message.
    """

    def __init__(
        self,
        file: ControllerFile,
        fmu: Fmu,
        inputs: Sequence[FmuInput],
        outputs: Mapping[str, Any],
        starts: Sequence[tuple[Any, Any]],
    ) -> None:
        """Load `fmu`; `outputs` are variables by CLUTCH and ENGINE, `starts` have start values."""
        self.preview_steps = max((each.ahead for each in inputs), default=0)
        self.commands_engine = ENGINE in outputs
        self._file, self._fmu, self._inputs, self._outputs = file, fmu, inputs, outputs
        self._setting = Setting(
            [(self._reference(each), value) for each, value in starts],
            [self._reference(each.variable) for each in inputs],
            [self._reference(each) for each in outputs.values()],
        )
        self._load()

    def reset(self) -> None:
        """Return to the state before the first step, loaded anew; FMI's reset is not used."""
        calling('reset')
        if self._steps:
            self._instance.end()
            self._load()

    def update(self, measurement: Measurement) -> Command:
        """Return the outputs of this period's step; raise DdctError when the FMU fails."""
        calling('update', measurement.step)
        inputs = [each.read(measurement) for each in self._inputs]
        time_s = time_of_step(self._steps)
        with self._file.located():
            try:
                outputs = self._instance.step(time_s, PERIOD_S, inputs)
            except InstanceError as error:
                raise self._failed(error, f'at its own time {time_s:g} s') from error
            self._steps += 1
            torques = dict(zip(self._outputs, outputs, strict=True))
            for name, torque in torques.items():
                variable = self._outputs[name].name
                require_signal(f'fmu.outputs.{variable} at step {measurement.step}', torque)
        return Command(torques[CLUTCH], engine_torque=torques.get(ENGINE))

    def _load(self) -> None:
        """Load the FMU for one run; raise DdctError when that fails."""
        self._steps = 0
        with self._file.located():
            try:
                self._instance = Instance(self._fmu, self._setting)
            except InstanceError as error:
                raise self._failed(error, 'when it is loaded') from error

    def _failed(self, error: Exception, when: str) -> DdctError:
        return DdctError(
            f'fmu.file: {self._fmu.path} failed {when} ({error}): mend the FMU', key='fmu.file'
        )

    def _reference(self, variable: Any) -> Reference:
        """Return reference and FMI type of a variable."""
        kind = variable.type
        if kind == 'Enumeration':
            kind = 'Integer' if self._fmu.is_fmi2 else 'Int64'
        return variable.valueReference, kind

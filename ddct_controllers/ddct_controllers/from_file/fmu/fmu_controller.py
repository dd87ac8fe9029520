# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An FMU as a controller: loaded, stepped and removed."""

import contextlib
import weakref
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from tempfile import TemporaryDirectory
from typing import Any

from ddct_controllers.from_file.controller_file import ControllerFile
from ddct_controllers.from_file.fmu.unit import Fmu, one_line
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.base.errors import DdctError, require_finite
from ddct_plant.base.timebase import PERIOD_S, time_of_step

CLUTCH, ENGINE = 'clutch_torque_n_m', 'engine_torque_n_m'
"""Quantities that an output may be: torque requests of clutch and engine."""
_FATAL = 4
"""Status after which no function of an FMU may be called, not even to free it."""


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

    Its files are in a temporary folder. Binary and folder are removed with this object, at the
    latest when Python ends. A call that fails raises DdctError with the FMU's last log message.
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
        self._file, self._fmu, self._inputs = file, fmu, inputs
        self._outputs, self._starts = outputs, starts
        self._resources = contextlib.ExitStack()
        weakref.finalize(self, self._resources.close)
        self._load()

    def reset(self) -> None:
        """
        Return to the state before the first step by loading binary and files anew.

        FMI's own reset is not used.
        """
        if self._steps:
            self._resources.close()
            self._load()

    def update(self, measurement: Measurement) -> Command:
        """Return the outputs of this period's step; raise DdctError when the FMU fails."""
        inputs = [(each.variable, each.read(measurement)) for each in self._inputs]
        with self._file.located():
            torques = self._step(inputs)
            for name, torque in torques.items():
                variable = self._outputs[name].name
                require_finite(f'fmu.outputs.{variable} at step {measurement.step}', torque)
        return Command(torques[CLUTCH], engine_torque=torques.get(ENGINE))

    def _step(self, inputs: Sequence[tuple[Any, float]]) -> dict[str, float]:
        """Set the inputs, go 10 ms ahead and return the outputs by CLUTCH and ENGINE."""
        time_s = time_of_step(self._steps)
        with self._errors_named(f'at its own time {time_s:g} s'):
            if not self._steps:
                if self._fmu.is_fmi2:
                    self._instance.setupExperiment(startTime=0.0)
                self._instance.enterInitializationMode()
                self._set(inputs)
                self._instance.exitInitializationMode()
            self._set(inputs)
            ended = self._instance.doStep(time_s, PERIOD_S)
            if ended and ended[1]:  # FMI 3.0 returns it; FMI 2.0 fails
                raise DdctError('it asks for the end of the simulation')
            self._steps += 1
            return {
                name: getattr(self._instance, f'get{each.type}')([each.valueReference])[0]
                for name, each in self._outputs.items()
            }

    def _load(self) -> None:
        self._steps = 0
        self._messages: list[str] = []
        with (
            self._file.located(),
            contextlib.ExitStack() as resources,
            self._errors_named('when it is loaded'),
        ):
            folder = resources.enter_context(TemporaryDirectory(prefix='ddct_fmu_'))
            self._fmu.fmpy.extract(self._fmu.path, folder)
            # FMPy goes to the binary's folder, and stays there when it cannot be loaded.
            with contextlib.chdir('.'):
                self._instance = self._fmu.fmpy.instantiate_fmu(
                    folder,
                    self._fmu.description,
                    'CoSimulation',
                    logger=_log_callback(self._messages),
                )
            resources.callback(_free, self._instance)
            self._set(self._starts)
            self._resources.push(resources.pop_all())

    def _set(self, values: Iterable[tuple[Any, Any]]) -> None:
        for variable, value in values:
            kind = variable.type
            if kind == 'Enumeration':
                kind = 'Integer' if self._fmu.is_fmi2 else 'Int64'
            getattr(self._instance, f'set{kind}')([variable.valueReference], [value])

    @contextlib.contextmanager
    def _errors_named(self, when: str) -> Iterator[None]:
        """Raise whatever FMPy raises as a DdctError."""
        self._messages.clear()
        try:
            yield
        except Exception as error:
            if getattr(error, 'status', None) == _FATAL:
                self._instance.component = None
            message = f': {self._messages[-1]}' if self._messages else ''
            raise DdctError(
                f'fmu.file: {self._fmu.path} failed {when} ({one_line(error)}{message}): mend the '
                'FMU',
                key='fmu.file',
            ) from error


def _free(instance: Any) -> None:
    if instance.component:
        instance.freeInstance()


def _log_callback(messages: list[str]) -> Callable[..., None]:
    """Return the FMU's log callback; the text comes last in FMI 2.0 and 3.0."""

    def log(*message: Any) -> None:
        messages.append(one_line(message[-1].decode('utf-8', 'replace')))

    return log

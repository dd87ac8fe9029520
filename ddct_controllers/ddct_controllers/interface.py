# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The interface of controllers: one small class that never reads a clock and does not use ROS."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar, Generic, TypeVar

from ddct_controllers.measurement import Measurement
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import REQUIRED, Options
from ddct_plant.graph.node_reports import CONTROLLER, TWO_INPUT, flag
from ddct_plant.linear.lti import StateSpace
from ddct_plant.scenario.settings import KnownSettings, require_known

Status = tuple[tuple[str, str], ...]
"""Pairs (key, value) for `controller/status`; deterministic, so no wall time in them."""


@dataclass(frozen=True, slots=True)
class Command:
    """Output of a controller for one measurement."""

    clutch_torque: float
    """Closed-loop part of the clutch torque request in N m."""
    status: Status = ()
    engine_torque: float | None = None
    """Request for C_m in N m, only of controllers that command the engine."""


class Controller(ABC):
    """
    A swappable closed-loop controller, called once every 10 ms.

    While its architecture holds feedback off, `hold` is called in place of `update`.
    """

    options: ClassVar[Options | None] = None
    """Options by name in `controllers.<name>` of a scenario; None and {} are no options."""
    registered_name: str = ''
    """Name in error messages: the registry sets the name under which it was requested."""
    digests: Mapping[str, str] = MappingProxyType({})
    """SHA-256 of its files, as `ControllerSpec.digests`; set by the registry."""
    written_in: str = ''
    """Place of its code, as `ControllerSpec.written_in`; set by the registry."""
    method_names: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """Names of its author's functions where they differ, by the methods' names, for errors."""
    preview_steps: int = 0
    """Number P of steps beyond the present one for which it receives the reference."""
    commands_engine: bool = False
    """Whether it has a second input, C_m; it then receives the driver's demand for it."""

    def __init__(self, context: 'ControllerContext | None' = None) -> None:
        """Ignore the context: a controller with options or state overrides this."""
        super().__init__()

    @abstractmethod
    def reset(self) -> None:
        """Return to the state before the first update."""

    @abstractmethod
    def update(self, measurement: Measurement) -> Command:
        """Advance by one period and return the command that holds over it."""

    def hold(self, measurement: Measurement) -> None:
        """
        Pass a period in which feedback is off and only the open-loop torque acts.

        So it is before control starts, and while the closing stage keeps a locked clutch closed.

        Here the controller is reset. One with an observer lets it follow the plant instead.
        """
        self.reset()

    def linear_model(self) -> StateSpace | None:
        """
        Return the feedback as a sampled system from slip error in rpm to torque in N m.

        One input, one output, period 10 ms, with the present gains. None for a controller that is
        not linear and has no frequency response.
        """
        return None

    def gains(self) -> Mapping[str, float]:
        """Return the gains that may be changed between two updates, by name."""
        return {}

    def info(self, name: str) -> dict[str, str]:
        """
        Return its pairs for `run_info`: name, whether it commands the engine, and exact gains.

        The digests of the files that it is made of follow.
        """
        gains = {f'gains.{gain}': repr(value) for gain, value in self.gains().items()}
        return {
            CONTROLLER: name,
            TWO_INPUT: flag(self.commands_engine),
            **gains,
            **self.digests,
        }

    def set_gain(self, name: str, value: float) -> None:
        """Change one gain; raise ParameterError for a name or value that it does not take."""
        raise ParameterError(f'this controller has no gain {name!r} (value {value!r})')


@dataclass(frozen=True)
class ControllerContext:
    """Arguments of a controller's factory."""

    settings: KnownSettings
    """Known settings of the run: without wear, seed and what varies for the plant alone."""
    gains: Mapping[str, Any]
    """
    Options from the scenario's section `controllers.<name>`, by name.

    A controller gets every one of the `options` that it declares, checked, the default where the
    scenario gives none. Others are refused.
    """

    def __post_init__(self) -> None:
        """Raise ParameterError for settings that are not the known ones."""
        require_known(self.settings)


@dataclass(frozen=True)
class CompiledCode:
    """A file of compiled code, and where a controller file names it, for error messages."""

    path: Path
    key: str
    place: str


Made = TypeVar('Made', bound=Controller, covariant=True)


@dataclass(frozen=True)
class ControllerSpec(Generic[Made]):
    """A controller by name: its factory, and the options of its section `controllers.<name>`."""

    name: str
    make: Callable[[ControllerContext], Made]
    options: Options | None = None
    """Declared options by name; None for a third party's controller that declares none."""
    digests: Mapping[str, str] = field(default_factory=dict)
    """SHA-256 of the files that it is made of, by their key on `run_info`."""
    written_in: str = ''
    """File and key where its author edits it, if it is not Python, for error messages; else ''."""
    compiled: CompiledCode | None = None
    """
    Its compiled code, if it is such; None for Python.

    It may end or stop its process, so each headless run of it has a process of its own.
    """

    def __call__(self, context: ControllerContext) -> Made:
        """Make the controller; raise ParameterError for an option that it does not take."""
        return self.make(ControllerContext(context.settings, self.values(context.gains)))

    def values(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return every option's value, from the scenario or the default, checked."""
        options = self.options or {}
        section = f'controllers.{self.name}'
        if given and not options:
            names = ', '.join(map(str, given))
            how = f': declare it, {_declaration(given)}' if self.options is None else ''
            raise ParameterError(
                f'{section}: {names} given, but {self.name} takes no options{how}', key=section
            )
        if unknown := given.keys() - options.keys():
            raise ParameterError(
                f'{section}.{min(unknown, key=str)} is not a key of {self.name}: it has '
                f'{", ".join(options)}',
                key=f'{section}.{min(unknown, key=str)}',
            )
        values = {}
        for key, option in options.items():
            value = given.get(key, option.default)
            if value is REQUIRED:
                unit = f', in {option.unit}' if option.unit else ''
                raise ParameterError(
                    f'{section}.{key} is missing from the scenario: give it{unit}',
                    key=f'{section}.{key}',
                )
            unset = value is None and option.default is None
            values[key] = None if unset else option.checked(f'{section}.{key}', value)
        return values


def _declaration(given: Mapping[str, Any]) -> str:
    """Return the line with which a class declares the first of the options `given`."""
    name, value = next(iter(given.items()))
    return f"in its class: options = {{{name!r}: Option({value!r}, 'what it is', 'its unit')}}"

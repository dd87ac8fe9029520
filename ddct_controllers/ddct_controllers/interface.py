"""What a controller is: one small class that never reads a clock and knows nothing of ROS."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, ClassVar, Generic, TypeVar

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import REQUIRED, Options
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.linear.lti import StateSpace
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.scenario.whole_plant import Observation


@dataclass(frozen=True, slots=True)
class Measurement:
    """
    Everything a controller may know at step k, all SI.

    The transmitted torque C_f, the load C_load and the driveshaft twist are not measured in a car
    and are not here.
    """

    step: int
    """k; scenario time is k x 10 ms."""
    engine_speed: float
    """w_m in rad/s."""
    shaft_speed: float
    """w_p in rad/s."""
    wheel_speed: float
    """w_r in rad/s."""
    vehicle_speed: float
    """V_x in m/s."""
    engine_torque: float
    """C_m in N m over the coming period; the driver's demand if the controller commands C_m."""
    slip_reference: Sequence[float]
    """(P + 1,) rad/s; entry i is i x 10 ms ahead, P the controller's `preview_steps`."""
    slip_reference_rate: Sequence[float]
    """(P + 1,) rad/s^2."""
    load_torque: float = 0.0
    """C_load in N m computed from V_x and the slope; the architecture fills it in."""
    open_loop_torque: float = 0.0
    """What the architecture adds to the controller's clutch torque, in N m; it fills it in."""

    @classmethod
    def of_plant(
        cls,
        step: int,
        observation: Observation,
        slip_reference: Sequence[float],
        slip_reference_rate: Sequence[float],
    ) -> 'Measurement':
        """Return what is measured of a plant at step k, beside the reference of that step."""
        engine_speed, shaft_speed, wheel_speed = observation.measured.joint_speed[:3]
        return cls(
            step=step,
            engine_speed=engine_speed,
            shaft_speed=shaft_speed,
            wheel_speed=wheel_speed,
            vehicle_speed=observation.measured.vehicle_speed,
            engine_torque=observation.engine_torque,
            slip_reference=slip_reference,
            slip_reference_rate=slip_reference_rate,
        )

    @property
    def slip_speed(self) -> float:
        """w_d = w_m - w_p in rad/s."""
        return self.engine_speed - self.shaft_speed

    @property
    def slip_error_rpm(self) -> float:
        """Reference less slip speed, in the rpm that the thesis's controllers act on."""
        return rpm_from_rad_s(self.slip_reference[0] - self.slip_speed)

    def within(self, load_torque: float, open_loop_torque: float) -> 'Measurement':
        """Return the same with what the architecture fills in, both in N m."""
        # dataclasses.replace takes three times as long, at every step of every controller.
        return Measurement(
            self.step,
            self.engine_speed,
            self.shaft_speed,
            self.wheel_speed,
            self.vehicle_speed,
            self.engine_torque,
            tuple(self.slip_reference),  # the record has the list: what is told cannot be changed
            tuple(self.slip_reference_rate),
            load_torque,
            open_loop_torque,
        )


SCENARIO, THESIS, UNSTATED = 'scenario', 'thesis', 'not stated'
"""What a controller is computed from: see `ControllerSpec.computed_from`."""
Status = tuple[tuple[str, str], ...]
"""(key, value) pairs for `controller/status`; deterministic, so no wall time in them."""


@dataclass(frozen=True, slots=True)
class Command:
    """A controller's answer to one measurement."""

    clutch_torque: float
    """Closed-loop part of the clutch torque request in N m."""
    status: Status = ()
    engine_torque: float | None = None
    """C_m asked of the engine in N m, given by controllers that command it and by no other."""


class Controller(ABC):
    """
    A swappable closed-loop controller, called once every 10 ms.

    While its architecture holds feedback off, `hold` is called in place of `update`.
    """

    options: ClassVar[Options | None] = None
    """What `controllers.<name>` of a scenario may hold, by name; None, as {}, is nothing."""
    registered_name: str = ''
    """What errors call it: the registry gives it the name under which it was asked for."""
    computed_from: str = UNSTATED
    """As `ControllerSpec` has it, from where the registry takes it."""
    digests: Mapping[str, str] = MappingProxyType({})
    """Likewise."""
    written_in: str = ''
    """Likewise."""
    method_names: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """What its author calls the methods, where that is not Python: errors name these."""
    preview_steps: int = 0
    """How many steps beyond the present one the controller wants the reference for."""
    commands_engine: bool = False
    """Whether it has a second input, C_m; it then receives the driver's demand for it."""

    def __init__(self, context: 'ControllerContext | None' = None) -> None:
        """Take nothing of the context: a controller with options or state overrides this."""
        super().__init__()

    @abstractmethod
    def reset(self) -> None:
        """Return to the state before the first update."""

    @abstractmethod
    def update(self, measurement: Measurement) -> Command:
        """Advance by one period and return the command that holds over it."""

    def hold(self, measurement: Measurement) -> None:
        """
        Pass a period in which feedback is held off and only the open-loop torque acts.

        So it is before control starts, and while the closing stage keeps a locked clutch closed.

        Here the controller is reset. One with an observer lets it follow the plant instead.
        """
        self.reset()

    def linear_model(self) -> StateSpace | None:
        """
        Return the feedback as a sampled system from slip error in rpm to torque in N m.

        One input, one output, period 10 ms, with the present gains. None says that the controller
        is not linear and has no frequency response.
        """
        return None

    def gains(self) -> Mapping[str, float]:
        """Return the gains that may be changed between two updates, by name."""
        return {}

    def info(self, name: str) -> dict[str, str]:
        """
        Say for `run_info` what it is called, and from which files exactly it was made.

        Also whether it commands the engine, and its exact gains.
        """
        gains = {f'gains.{gain}': repr(value) for gain, value in self.gains().items()}
        two_input = str(self.commands_engine).lower()
        return {
            'controller': name,
            'two_input': two_input,
            'computed_from': self.computed_from,
            **gains,
            **self.digests,
        }

    def set_gain(self, name: str, value: float) -> None:
        """Change one gain; raise ParameterError for a name or value that it does not take."""
        raise ParameterError(f'this controller has no gain {name!r} (value {value!r})')


@dataclass(frozen=True)
class ControllerContext:
    """What a controller's factory is built from."""

    settings: RunSettings
    gains: Mapping[str, Any]
    """
    The scenario's section `controllers.<name>`.

    A controller gets every one of the `options` that it declares, checked, the default where the
    scenario gives none. What it does not declare is refused.
    """


Made = TypeVar('Made', bound=Controller, covariant=True)


@dataclass(frozen=True)
class ControllerSpec(Generic[Made]):
    """A controller by name: how it is made, and the options that `controllers.<name>` may hold."""

    name: str
    make: Callable[[ControllerContext], Made]
    options: Options | None = None
    """None for a third party's controller that declares none."""
    computed_from: str = SCENARIO
    """
    SCENARIO for one computed from the scenario's driveline; THESIS for one that stays what it is
    whatever the driveline: printed, or tuned to the thesis's rows. UNSTATED for others.
    """
    digests: Mapping[str, str] = field(default_factory=dict)
    """SHA-256 of the files that it is made of, by their key on `run_info`."""
    written_in: str = ''
    """Where its author changes it, of one that is no Python: errors name that, not our code."""

    def __call__(self, context: ControllerContext) -> Made:
        """Make the controller; raise ParameterError for an option that it does not take."""
        return self.make(ControllerContext(context.settings, self.values(context.gains)))

    def values(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return every option's value, what is given or the default, checked."""
        options = self.options or {}
        section = f'controllers.{self.name}'
        if given and not options:
            names = ', '.join(map(str, given))
            how = f': declare it, {_declaration(given)}' if self.options is None else ''
            raise ParameterError(
                f'{section}: {names} given, but {self.name} takes no options{how}'
            )
        if unknown := given.keys() - options.keys():
            raise ParameterError(
                f'{section}.{min(unknown, key=str)} is not a key of {self.name}: it has '
                f'{", ".join(options)}'
            )
        values = {}
        for key, option in options.items():
            value = given.get(key, option.default)
            if value is REQUIRED:
                unit = f', in {option.unit}' if option.unit else ''
                raise ParameterError(
                    f'{section}.{key} is missing from the scenario: give it{unit}'
                )
            unset = value is None and option.default is None
            values[key] = None if unset else option.checked(f'{section}.{key}', value)
        return values


def _declaration(given: Mapping[str, Any]) -> str:
    """Return how a class declares what it was given."""
    name, value = next(iter(given.items()))
    return f"in its class: options = {{{name!r}: Option({value!r}, 'what it is', 'its unit')}}"

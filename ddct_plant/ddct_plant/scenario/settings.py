# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Settings of a run: what is known of it, and its case, which the plant alone has.

    settings = RunSettings(KnownSettings(load_scenario('launch')), CaseSettings(wear_gain=0.8))

Controllers, handovers, references and the first request are made from `settings.known`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol, Self

from ddct_plant.base.clutch_kinds import STICK_SLIP
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import OptionGroup, option_field, options_of
from ddct_plant.files.input_file import without_folder
from ddct_plant.scenario.choices.settings import SETTINGS
from ddct_plant.scenario.control import ENGINE_SPEED_TARGET, PROFILE
from ddct_plant.scenario.rules.capability import require_able
from ddct_plant.scenario.rules.shift import require_shift
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.signals.topic import RunKind

_PYTHON = '.py'


def is_handover_file(handover: str) -> bool:
    """Return whether a handover is given by the path of a Python file, whose code then runs."""
    return handover.endswith(_PYTHON)


def handover_name(handover: str) -> str:
    """Return the name of a handover in bags and tables: of a file its name without the ending."""
    return without_folder(handover).removesuffix(_PYTHON)


@dataclass(frozen=True)
class KnownSettings(OptionGroup):
    """Settings of a run that each of its nodes has, and each controller knows."""

    scenario: Scenario
    """What is known of the car, and the drive."""
    architecture: str = option_field(SETTINGS['architecture'])
    mode: str = option_field(SETTINGS['mode'])
    handover: str = option_field(SETTINGS['handover'])

    def __post_init__(self) -> None:
        """Check every setting; raise ParameterError that names a bad one and the choices."""
        super().__post_init__()
        self._require_reference()
        self._require_shift()
        self._require_able()

    @property
    def detailed(self) -> bool:
        """
        Whether the architecture is CRF's detailed model.

        There the static controller is always on, and feedback and reference start together. The
        other architectures have feedback from t = 0 and a reference that is a stored function of
        time.
        """
        return self.architecture == 'detailed'

    @property
    def clutch(self) -> str:
        """Name of the clutch model, which is the scenario's."""
        return self.scenario.clutch

    @property
    def stick_slip(self) -> bool:
        """Whether the clutch sticks and slips, and rolling resistance and brake are friction."""
        return self.clutch == STICK_SLIP

    @property
    def sensed(self) -> bool:
        """Whether controller and reference read sensors instead of the true signals."""
        return self.scenario.sensors is not None

    @property
    def reference_shape(self) -> str:
        """Shape of the slip reference: the scenario's, or the tanh of the architecture."""
        tanh = self.architecture == 'feedforward_tanh'
        return 'tanh' if tanh else self.scenario.reference.shape

    @property
    def lockstep(self) -> bool:
        """Whether the owner of time waits for every reply."""
        return self.mode == 'lockstep'

    @property
    def shift(self) -> bool:
        """Whether the run is a gear shift with two clutches, as the scenario has one."""
        return self.scenario.shift is not None

    @property
    def handover_name(self) -> str:
        """Name of the handover in bags and tables."""
        return handover_name(self.handover)

    def kind(self, *, two_input: bool = False) -> RunKind:
        """Return the kind of the run, which decides its topics; `two_input` if it commands C_m."""
        return RunKind(self.lockstep, two_input, self.clutch, self.sensed, self.shift)

    def _require_able(self) -> None:
        """Refuse a drive that asks for more than the car has."""
        require_able(self.scenario)

    def _require_shift(self) -> None:
        """Refuse a shift that cannot be, and a handover in another run."""
        if not self.shift:
            require_default_without_shift(self, 'handover', self.handover)
            return
        require_shift(self.scenario)
        if not self.detailed:
            raise ParameterError(
                f'scenario {self.scenario.name} is a gear shift, whose on-coming clutch takes '
                f'over C_fOL, but the architecture {self.architecture} does without it: choose '
                'the architecture detailed',
                key='architecture',
            )

    def _require_reference(self) -> None:
        start_s, end_s = self.scenario.control_start_s, self.scenario.reference.reference_end_s
        shape = self.scenario.reference.shape
        if self.scenario.slip_reference.given != (shape == PROFILE):
            raise ParameterError(
                f'reference.shape is {shape!r}: give slip_reference.time_s and '
                f'slip_reference.slip_rad_s with the shape {PROFILE}, and only with it',
                key='reference.shape',
            )
        if shape == ENGINE_SPEED_TARGET:
            self._require_engine_speed_target()
            return
        if shape not in ('ramp', self.reference_shape):
            raise ParameterError(
                f'reference.shape is {shape!r}, but the architecture {self.architecture} has a '
                f'{self.reference_shape}: choose another architecture, such as feedforward',
                key='reference.shape',
            )
        if self.reference_shape not in ('ramp', PROFILE) and end_s <= start_s:
            raise ParameterError(
                f'reference.reference_end_s is {end_s:g} s: it must be after control_start_s, '
                f'{start_s:g} s',
                key='reference.reference_end_s',
            )

    def _require_engine_speed_target(self) -> None:
        if not self.detailed:
            raise ParameterError(
                f'reference.shape is {ENGINE_SPEED_TARGET!r}, which starts from the measured slip '
                f'speed, but the architecture {self.architecture} has a stored reference: choose '
                'the architecture detailed',
                key='reference.shape',
            )
        if not self.scenario.engine_speed_reference.given:
            raise ParameterError(
                f'reference.shape is {ENGINE_SPEED_TARGET!r}: give the wanted engine speed, '
                'engine_speed_reference.time_s and engine_speed_reference.speed_rad_s',
                key='reference.shape',
            )


@dataclass(frozen=True)
class LinearSettings(KnownSettings):
    """Settings of a linear analysis, which limits no torque: any drive goes with any car."""

    def _require_able(self) -> None:
        """Accept any drive."""


@dataclass(frozen=True)
class CaseSettings(OptionGroup):
    """What the world varies from run to run, and no controller knows."""

    wear_gain: float = option_field(SETTINGS['wear_gain'])
    off_going_wear_gain: float = option_field(SETTINGS['off_going_wear_gain'])
    seed: int = option_field(SETTINGS['seed'])
    scenario: Scenario | None = field(default=None, repr=False)
    """The known scenario with the overrides of the case; None without any."""


@dataclass(frozen=True)
class RunSettings:
    """True settings of one run, which its plant has: the known ones with those of the case."""

    known: KnownSettings
    case: CaseSettings = CaseSettings()

    def __post_init__(self) -> None:
        """Raise ParameterError for a case that does not fit what is known."""
        if not self.shift:
            require_default_without_shift(
                self.known, 'off_going_wear_gain', self.case.off_going_wear_gain
            )
        self._require_same_topics()

    @classmethod
    def of(cls, known: Scenario, values: Mapping[str, Any], true: Scenario | None = None) -> Self:
        """Return the settings with values by name; `true` is the scenario of the case, if any."""
        of_case = options_of(CaseSettings)
        return cls(
            KnownSettings(known, **{key: values[key] for key in values if key not in of_case}),
            CaseSettings(**{key: values[key] for key in values if key in of_case}, scenario=true),
        )

    @property
    def scenario(self) -> Scenario:
        """The true scenario, which the plant has."""
        return self.case.scenario or self.known.scenario

    @property
    def values(self) -> dict[str, Any]:
        """Values beside the scenarios, by the names in `SETTINGS`."""
        parts = {**vars(self.known), **vars(self.case)}
        return {name: parts[name] for name in SETTINGS}

    @property
    def detailed(self) -> bool:
        """Whether the architecture is CRF's detailed model."""
        return self.known.detailed

    @property
    def stick_slip(self) -> bool:
        """Whether the clutch sticks and slips, and rolling resistance and brake are friction."""
        return self.known.stick_slip

    @property
    def shift(self) -> bool:
        """Whether the run is a gear shift with two clutches."""
        return self.known.shift

    def kind(self, *, two_input: bool = False) -> RunKind:
        """Return the kind of the run, which decides its topics; `two_input` if it commands C_m."""
        return self.known.kind(two_input=two_input)

    def _require_same_topics(self) -> None:
        """Refuse a true scenario of another kind of run, whose topics would not fit."""
        if self.case.scenario is None:
            return
        if self.case.scenario.clutch != self.known.clutch:
            raise ParameterError(
                f'clutch is {self.case.scenario.clutch}, but what controllers know of scenario '
                f'{self.scenario.name} has {self.known.clutch}: give both the same',
                key='clutch',
            )
        for section in ('sensors', 'shift'):
            true, known = (
                getattr(each, section) is not None for each in (self.scenario, self.known.scenario)
            )
            if true != known:
                raise ParameterError(
                    f'{section} is varied for the plant alone, but what controllers know of '
                    f'scenario {self.scenario.name} has {"one" if known else "none"}: give the '
                    f'section {section} in the scenario'
                    + (', or in the grid' if section == 'sensors' else ''),
                    key=section,
                )


def require_known(settings: object) -> None:
    """
    Raise ParameterError unless these are known settings.

    What controls would learn the case of a run from its true ones.
    """
    if not isinstance(settings, KnownSettings):
        raise ParameterError(
            f'what controls is made from KnownSettings, not from {type(settings).__name__}: give '
            'settings.known of a RunSettings',
            key='settings',
        )


class AnySettings(Protocol):
    """Known or true settings, for models that are made of either."""

    @property
    def scenario(self) -> Scenario:
        """Scenario of the models."""

    @property
    def stick_slip(self) -> bool:
        """Whether the clutch sticks and slips."""

    @property
    def detailed(self) -> bool:
        """Whether the architecture is CRF's detailed model."""


def require_default_without_shift(known: KnownSettings, name: str, value: Any) -> None:
    """Raise ParameterError for a setting of gear shifts that a run without a shift has."""
    if value != SETTINGS[name].default:
        raise ParameterError(
            f'{name} is {value}, but scenario {known.scenario.name} is no gear shift: '
            'choose one with a section shift, such as upshift, or leave it out',
            key=name,
        )

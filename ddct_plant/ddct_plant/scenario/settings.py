# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The settings that every node of one run shares."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Self

from ddct_plant.base.clutch_kinds import STICK_SLIP
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import OptionGroup, option_field
from ddct_plant.scenario.choices.settings import SETTINGS
from ddct_plant.scenario.control import ENGINE_SPEED_TARGET, PROFILE
from ddct_plant.scenario.rules.capability import require_able
from ddct_plant.scenario.rules.shift import require_shift
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.signals.signal import RunKind

_PYTHON = '.py'
UNKNOWN = ('wear_gain', 'seed', 'off_going_wear_gain')
"""Settings that no controller knows; those that it knows have their defaults."""
OF_SHIFTS = ('off_going_wear_gain', 'handover')
"""Settings that only a gear shift has."""


def is_handover_file(handover: str) -> bool:
    """Return whether a handover is given by the path of a Python file, whose code then runs."""
    return handover.endswith(_PYTHON)


def handover_name(handover: str) -> str:
    """Return the name of a handover in bags and tables: of a file its name without the ending."""
    return handover.rpartition('/')[2].removesuffix(_PYTHON)


@dataclass(frozen=True)
class RunSettings(OptionGroup):
    """
    True settings of one run, which its plant has; `known` is the part that a controller gets.

    Handover, reference, controllers and the first request are made from `known` alone.
    """

    scenario: Scenario
    architecture: str = option_field(SETTINGS['architecture'])
    wear_gain: float = option_field(SETTINGS['wear_gain'])
    mode: str = option_field(SETTINGS['mode'])
    seed: int = option_field(SETTINGS['seed'])
    off_going_wear_gain: float = option_field(SETTINGS['off_going_wear_gain'])
    handover: str = option_field(SETTINGS['handover'])
    known_scenario: Scenario | None = field(default=None, repr=False)
    """Scenario that controllers know where it differs from the true one, else None."""

    def __post_init__(self) -> None:
        """Check every setting; raise ParameterError that names a bad one and the choices."""
        super().__post_init__()
        self._require_reference()
        self._require_shift()
        self._require_known()
        require_able(self.known_scenario or self.scenario)

    @cached_property
    def known(self) -> Self:
        """
        Settings that a controller knows: the known scenario, clutches without wear, no seed.

        They are these settings themselves where they do not differ, and know of no others.
        """
        known = replace(
            self,
            scenario=self.known_scenario or self.scenario,
            known_scenario=None,
            **{name: SETTINGS[name].default for name in UNKNOWN},
        )
        return self if known == self else known

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

    def _require_shift(self) -> None:
        """Refuse a shift that cannot be, and settings of a shift in another run."""
        if not self.shift:
            self._require_defaults_of_a_shift()
            return
        require_shift(self.scenario)
        if not self.detailed:
            raise ParameterError(
                f'scenario {self.scenario.name} is a gear shift, whose on-coming clutch takes '
                f'over C_fOL, but the architecture {self.architecture} does without it: choose '
                'the architecture detailed',
                key='architecture',
            )

    def _require_known(self) -> None:
        """Refuse known settings of another kind of run, whose topics would not fit together."""
        if self.known_scenario is None:
            return
        if self.clutch != self.known_scenario.clutch:
            raise ParameterError(
                f'clutch is {self.clutch}, but what controllers know of scenario '
                f'{self.scenario.name} has {self.known_scenario.clutch}: give both the same',
                key='clutch',
            )
        for section in ('sensors', 'shift'):
            ours, known = (
                getattr(each, section) is not None for each in (self.scenario, self.known.scenario)
            )
            if ours != known:
                raise ParameterError(
                    f'{section} is varied for the plant alone, but what controllers know of '
                    f'scenario {self.scenario.name} has {"one" if known else "none"}: give the '
                    f'section {section} in the scenario'
                    + (', or in the grid' if section == 'sensors' else ''),
                    key=section,
                )

    def _require_defaults_of_a_shift(self) -> None:
        for name in OF_SHIFTS:
            value = getattr(self, name)
            if value != SETTINGS[name].default:
                raise ParameterError(
                    f'{name} is {value}, but scenario {self.scenario.name} is no gear shift: '
                    'choose one with a section shift, such as upshift, or leave it out',
                    key=name,
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

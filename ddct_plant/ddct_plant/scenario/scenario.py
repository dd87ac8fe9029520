"""A scenario: everything about a run that is not the controller or the way it is started."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ddct_plant.base.checks import require_choice, require_name, require_number
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import steps_in
from ddct_plant.models.engine import EngineAuthority, TorqueProfile
from ddct_plant.models.load import LoadParameters
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters
from ddct_plant.models.static_torque import EQUILIBRIA
from ddct_plant.scenario.engine_speed_reference import EngineSpeedReference

REFERENCE_SHAPES = ('ramp', 'tanh', 'polynomial')
"""How a slip reference can run to zero once control starts."""


@dataclass(frozen=True)
class InitialSpeeds:
    """Speeds of the two clutch plates at t = 0; the wheel turns with the primary shaft."""

    engine_speed_rad_s: float = 160.0
    """w_m(0)."""
    shaft_speed_rad_s: float = 160.0
    """w_p(0); 160 rad/s is about 20 km/h in second gear."""

    def __post_init__(self) -> None:
        """Check both speeds; raise ParameterError that names a bad one."""
        for name in ('engine_speed_rad_s', 'shaft_speed_rad_s'):
            require_number(f'initial.{name}', getattr(self, name), at_least=0.0, at_most=1000.0)


@dataclass(frozen=True)
class ReferenceParameters:
    """Shape of the slip-speed reference once control starts (Section 1.4.1)."""

    slope_rad_s2: float = 90.0
    """Rate at which the CRF ramp runs to zero."""
    shape: str = 'ramp'
    """One of REFERENCE_SHAPES; the architecture `feedforward_tanh` makes the ramp a tanh."""
    reference_end_s: float = 1.6
    """When tanh and polynomial reach zero, a multiple of 10 ms; the ramp ends by its slope."""

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        require_choice('reference.shape', self.shape, REFERENCE_SHAPES)
        require_number('reference.slope_rad_s2', self.slope_rad_s2, above=0.0, at_most=1e4)
        require_number(
            'reference.reference_end_s', self.reference_end_s, above=0.0, at_most=3600.0
        )
        steps_in('reference.reference_end_s', self.reference_end_s)


@dataclass(frozen=True)
class Scenario:
    """One driving situation and how it is scored; see docs/scenario.md for every key."""

    name: str
    """A plain name: files are called after it."""
    description: str
    duration_s: float
    """Length of the run, a multiple of 10 ms."""
    control_start_s: float
    """When feedback and reference start (0.6 s in the thesis), a multiple of 10 ms."""
    score_window_s: tuple[float, float]
    """First and last time of the samples that standard deviations are taken over."""
    engine: TorqueProfile
    engine_authority: EngineAuthority = EngineAuthority()
    engine_speed_reference: EngineSpeedReference = EngineSpeedReference()
    pedal_position: float = 0.5
    """x_p, the accelerator pedal from 0 to 1 (Section 1.3); only `pedal_mpc` reads it."""
    equilibrium: str = 'thesis'
    """One of EQUILIBRIA: whether C_fOL and the start count damping and acceleration too."""
    initial: InitialSpeeds = InitialSpeeds()
    reference: ReferenceParameters = ReferenceParameters()
    load: LoadParameters = LoadParameters()
    vehicle: VehicleParameters = VehicleParameters()
    driveline: DrivelineParameters = DrivelineParameters()
    controllers: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """Gains and options by controller name, checked by the controller that takes them."""

    def __post_init__(self) -> None:
        """Check name, equilibrium, times and pedal; raise ParameterError that names a bad one."""
        require_name('name', self.name)
        require_choice('equilibrium', self.equilibrium, EQUILIBRIA)
        require_number('duration_s', self.duration_s, above=0.0, at_most=3600.0)
        require_number('control_start_s', self.control_start_s, at_least=0.0, at_most=3600.0)
        require_number('pedal_position', self.pedal_position, at_least=0.0, at_most=1.0)
        steps_in('duration_s', self.duration_s)
        steps_in('control_start_s', self.control_start_s)
        if len(self.score_window_s) != 2:
            raise ParameterError('score_window_s: give two times, [first, last]')
        first, last = self.score_window_s
        for index, time in enumerate(self.score_window_s):
            require_number(f'score_window_s[{index}]', time, at_least=0.0, at_most=3600.0)
            steps_in(f'score_window_s[{index}]', time)
        if last <= first:
            raise ParameterError(f'score_window_s ends at {last:g} s, before {first:g} s')

    @property
    def steps(self) -> int:
        """N, the number of 10 ms periods of the run."""
        return steps_in('duration_s', self.duration_s)

    @property
    def control_start_step(self) -> int:
        """First step at which feedback and reference are on."""
        return steps_in('control_start_s', self.control_start_s)

"""The settings that every node of one run shares."""

from dataclasses import dataclass

from ddct_plant.checks import require_number
from ddct_plant.clutch import CLUTCHES
from ddct_plant.errors import ParameterError
from ddct_plant.scenario import Scenario

ARCHITECTURES = ('detailed',)
"""Control architectures of Section 1.6 that a run can have."""
MODES = ('lockstep', 'realtime')
"""Lock-step waits for every reply; real time steps at 100 Hz and counts misses."""


@dataclass(frozen=True)
class RunSettings:
    """What is simulated and how, the same in every node of the graph."""

    scenario: Scenario
    architecture: str = 'detailed'
    clutch: str = 'linear'
    wear_gain: float = 1.0
    """K_usura, 1 for a new clutch."""
    mode: str = 'lockstep'
    seed: int = 0
    """Seed of the run's random numbers; no model draws any yet."""

    def __post_init__(self) -> None:
        """Check every setting; raise ParameterError that names a bad one and the choices."""
        _require_choice('architecture', self.architecture, ARCHITECTURES)
        _require_choice('clutch', self.clutch, CLUTCHES)
        _require_choice('mode', self.mode, MODES)
        require_number('wear_gain', self.wear_gain, above=0.0, at_most=3.0)
        require_number('seed', self.seed, at_least=0)

    @property
    def lockstep(self) -> bool:
        """Whether the owner of time waits for every reply."""
        return self.mode == 'lockstep'


def _require_choice(name: str, value: str, choices: tuple[str, ...]) -> None:
    if value not in choices:
        raise ParameterError(f'unknown {name} {value!r}: choose from {", ".join(choices)}')

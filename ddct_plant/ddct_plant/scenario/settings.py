"""The settings that every node of one run shares."""

from dataclasses import dataclass

from ddct_plant.base.checks import require_choice, require_number
from ddct_plant.base.errors import ParameterError
from ddct_plant.models.clutch import CLUTCHES
from ddct_plant.scenario.scenario import Scenario

ARCHITECTURES = ('base', 'feedforward', 'feedforward_tanh', 'detailed')
"""Control architectures: those of Section 1.6, and CRF's detailed model (Section 1.4)."""
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
        require_choice('architecture', self.architecture, ARCHITECTURES)
        require_choice('clutch', self.clutch, CLUTCHES)
        require_choice('mode', self.mode, MODES)
        require_number('wear_gain', self.wear_gain, above=0.0, at_most=3.0)
        require_number('seed', self.seed, at_least=0)
        self._require_reference()

    @property
    def detailed(self) -> bool:
        """
        Whether the control is that of CRF's detailed model.

        There the static controller is always on, feedback and reference start together. The other
        architectures have feedback from t = 0 and a reference that is a stored function of time.
        """
        return self.architecture == 'detailed'

    @property
    def reference_shape(self) -> str:
        """How the reference runs to zero: the scenario's shape, or the architecture's tanh."""
        tanh = self.architecture == 'feedforward_tanh'
        return 'tanh' if tanh else self.scenario.reference.shape

    @property
    def lockstep(self) -> bool:
        """Whether the owner of time waits for every reply."""
        return self.mode == 'lockstep'

    def _require_reference(self) -> None:
        start_s, end_s = self.scenario.control_start_s, self.scenario.reference.reference_end_s
        shape = self.scenario.reference.shape
        if shape not in ('ramp', self.reference_shape):
            raise ParameterError(
                f'reference.shape is {shape!r}, but the architecture {self.architecture} has a '
                f'{self.reference_shape}: choose another architecture, such as feedforward'
            )
        if self.reference_shape != 'ramp' and end_s <= start_s:
            raise ParameterError(
                f'reference.reference_end_s is {end_s:g} s: it must be after control_start_s, '
                f'{start_s:g} s'
            )

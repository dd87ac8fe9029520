"""Block diagrams of gains, sums and integrators, evaluated block by block."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter

from ddct_plant.base.errors import ParameterError


@dataclass(frozen=True)
class Gain:
    """factor times one signal."""

    factor: float
    source: str


@dataclass(frozen=True)
class Sum:
    """The signals `plus` less the signals `minus`."""

    plus: tuple[str, ...]
    minus: tuple[str, ...] = ()


@dataclass(frozen=True)
class Integrator:
    """The integral of one signal: a state."""

    source: str


Block = Gain | Sum | Integrator


class BlockDiagram:
    """Blocks by the name of the signal each puts out; other signals are inputs."""

    def __init__(self, blocks: Mapping[str, Block], inputs: Sequence[str]) -> None:
        """Order the blocks; raise ParameterError for an unknown signal or an algebraic loop."""
        self.states = tuple(
            name for name, block in blocks.items() if isinstance(block, Integrator)
        )
        """Names of the integrators, in the order of `blocks`."""
        self._inputs = tuple(inputs)
        self._sources = [
            block.source for block in blocks.values() if isinstance(block, Integrator)
        ]
        for name, block in blocks.items():
            for source in _sources_of(block):
                if source not in blocks and source not in self._inputs:
                    raise ParameterError(f'block {name}: there is no signal {source!r}')
        direct = {
            name: [source for source in _sources_of(block) if source not in self.states]
            for name, block in blocks.items()
            if not isinstance(block, Integrator)
        }
        try:
            order = list(TopologicalSorter(direct).static_order())
        except CycleError as error:
            raise ParameterError(f'algebraic loop: {" - ".join(error.args[1])}') from error
        self._ordered = [(name, blocks[name]) for name in order if name in direct]

    def signals(self, states: Sequence[float], inputs: Sequence[float]) -> dict[str, float]:
        """Return every signal for the values of the integrators and of the inputs."""
        values = dict(zip(self.states, states, strict=True))
        values.update(zip(self._inputs, inputs, strict=True))
        for name, block in self._ordered:
            if isinstance(block, Gain):
                values[name] = block.factor * values[block.source]
            elif isinstance(block, Sum):
                total = 0.0
                for source in block.plus:
                    total += values[source]
                for source in block.minus:
                    total -= values[source]
                values[name] = total
        return values

    def derivative(self, states: Sequence[float], inputs: Sequence[float]) -> list[float]:
        """Return what each integrator integrates."""
        values = self.signals(states, inputs)
        return [values[source] for source in self._sources]


def _sources_of(block: Block) -> tuple[str, ...]:
    return (*block.plus, *block.minus) if isinstance(block, Sum) else (block.source,)

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The simplified plant of Section 1.5.1 that is drawn with elementary blocks (Figure 1.20)."""

import math
from collections.abc import Iterable, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import SUBSTEP_S
from ddct_plant.models.driveline_model import STATES, driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.simplified.plants import SlipPhase


class BlockDiagram:
    """
    Gains, sums and integrators, evaluated block by block.

    A block has the name of its output signal; signals of no block are inputs. A gain or a sum
    is given by the factors of its input signals, an integrator by the signal that it integrates;
    its output is a state.
    """

    def __init__(
        self,
        sums: Mapping[str, Mapping[str, float]],
        integrators: Mapping[str, str],
        inputs: Sequence[str],
    ) -> None:
        """Order the blocks; raise ParameterError for an unknown signal or an algebraic loop."""
        self._integrators, self._inputs = integrators, inputs
        sources = {**sums, **{state: (source,) for state, source in integrators.items()}}
        for name in sources:
            for source in sources[name]:
                if source not in sources and source not in inputs:
                    raise ParameterError(
                        f'block {name}: there is no signal {source!r}', key=source
                    )
        direct = {name: factors.keys() & sums.keys() for name, factors in sums.items()}
        try:
            order = list(TopologicalSorter(direct).static_order())
        except CycleError as error:
            raise ParameterError(f'algebraic loop: {" - ".join(error.args[1])}') from error
        self._ordered = [(name, tuple(sums[name].items())) for name in order]

    def signals(self, states: Iterable[float], inputs: Iterable[float]) -> dict[str, float]:
        """Return every signal by name, for the values of the integrators and of the inputs."""
        values = dict(zip(self._integrators, states, strict=True))
        values.update(zip(self._inputs, inputs, strict=True))
        for name, factors in self._ordered:
            total = 0.0
            for source, factor in factors:
                total += factor * values[source]
            values[name] = total
        return values

    def derivative(self, states: np.ndarray, inputs: Iterable[float]) -> np.ndarray:
        """Return the input of each integrator."""
        values = self.signals(states.tolist(), inputs)
        return np.array([values[source] for source in self._integrators.values()])


def elementary_slip(parameters: DrivelineParameters, phase: SlipPhase) -> np.ndarray:
    """
    Integrate the plant drawn with gains, sums and integrators (Figure 1.20).

    It takes classical Runge-Kutta steps that never straddle a bend of C_f and span at most 0.02
    of the fastest mode's time constant: an error of 1e-11 of the peak, by a method that shares
    nothing with the matrix exponentials of the other plants.
    """
    diagram = _diagram(parameters)
    fastest = float(np.abs(np.linalg.eigvals(driveline_matrices(parameters).a)).max())
    steps = max(math.ceil(SUBSTEP_S * fastest / 0.02), 1)
    halves = np.arange(2 * steps + 1) / 2
    state = phase.initial_state
    engine_speed, shaft_speed = STATES.places('engine_speed', 'shaft_speed')
    slip_speed = [state[engine_speed] - state[shaft_speed]]
    torques = phase.engine_torque, phase.clutch_points, phase.load_torque
    for engine, points, load in zip(*(torque.tolist() for torque in torques), strict=True):
        for first, last in zip(points, points[1:], strict=False):
            clutch = (first + (last - first) * halves / steps).tolist()
            state = _substep(diagram, state, [(engine, torque, load) for torque in clutch])
        slip_speed.append(diagram.signals(state, (engine, points[-1], load))['slip_speed'])
    return np.array(slip_speed)


def _diagram(p: DrivelineParameters) -> BlockDiagram:
    """Return the block diagram of Section 1.5's equations."""
    return BlockDiagram(
        {
            'slip_speed': {'engine_speed': 1.0, 'shaft_speed': -1.0},
            'engine_drag': {'engine_speed': p.engine_damping},
            'engine_net': {'engine_torque': 1.0, 'clutch_torque': -1.0, 'engine_drag': -1.0},
            'engine_acceleration': {'engine_net': 1.0 / p.engine_inertia},
            'geared_speed': {'shaft_speed': p.gear.wheel_speed(1.0)},
            'twist_speed': {'geared_speed': 1.0, 'wheel_speed': -1.0},
            'damper_torque': {'twist_speed': p.halfshaft_damping},
            'spring_torque': {'twist': p.halfshaft_stiffness},
            'halfshaft_torque': {'damper_torque': 1.0, 'spring_torque': 1.0},
            'reflected_torque': {'halfshaft_torque': p.gear.shaft_torque(1.0)},
            'shaft_drag': {'shaft_speed': p.shaft_damping},
            'shaft_net': {'clutch_torque': 1.0, 'reflected_torque': -1.0, 'shaft_drag': -1.0},
            'shaft_acceleration': {'shaft_net': 1.0 / p.shaft_inertia},
            'wheel_net': {'halfshaft_torque': 1.0, 'load_torque': -1.0},
            'wheel_acceleration': {'wheel_net': 1.0 / p.vehicle_inertia},
        },
        {
            'engine_speed': 'engine_acceleration',
            'shaft_speed': 'shaft_acceleration',
            'wheel_speed': 'wheel_acceleration',
            'twist': 'twist_speed',
        },
        ('engine_torque', 'clutch_torque', 'load_torque'),
    )


def _substep(
    diagram: BlockDiagram, state: np.ndarray, inputs: Sequence[tuple[float, ...]]
) -> np.ndarray:
    """Return the state 1 ms later, with the inputs at the ends and the middle of each step."""
    h = 2.0 * SUBSTEP_S / (len(inputs) - 1)
    for start, middle, end in zip(inputs[:-2:2], inputs[1::2], inputs[2::2], strict=True):
        k_1 = diagram.derivative(state, start)
        k_2 = diagram.derivative(state + k_1 * (h / 2), middle)
        k_3 = diagram.derivative(state + k_2 * (h / 2), middle)
        k_4 = diagram.derivative(state + k_3 * h, end)
        state = state + (k_1 + 2 * k_2 + 2 * k_3 + k_4) / 6 * h
    return state

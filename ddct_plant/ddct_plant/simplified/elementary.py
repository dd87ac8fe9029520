"""The simplified plant of Section 1.5.1 that is drawn with elementary blocks (Figure 1.20)."""

import math
from collections.abc import Sequence

import numpy as np

from ddct_plant.base.timebase import SUBSTEP_S
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.simplified.block_diagram import Block, BlockDiagram, Gain, Integrator, Sum
from ddct_plant.simplified.plants import SimplifiedPlant


class ElementaryBlockPlant(SimplifiedPlant):
    """
    The plant drawn with elementary blocks, gains, sums and integrators (Figure 1.20).

    It takes classical Runge-Kutta steps that never straddle a bend of C_f and span at most 0.02
    of the fastest mode's time constant: an error of 1e-11 of the peak, by a method that shares
    nothing with the matrix exponentials of the other plants.
    """

    def __init__(self, parameters: DrivelineParameters) -> None:
        """Draw the diagram of Section 1.5's equations."""
        p = parameters
        blocks: dict[str, Block] = {
            'engine_speed': Integrator('engine_acceleration'),
            'shaft_speed': Integrator('shaft_acceleration'),
            'wheel_speed': Integrator('wheel_acceleration'),
            'twist': Integrator('twist_speed'),
            'slip_speed': Sum(('engine_speed',), ('shaft_speed',)),
            'engine_drag': Gain(p.engine_damping, 'engine_speed'),
            'engine_net': Sum(('engine_torque',), ('clutch_torque', 'engine_drag')),
            'engine_acceleration': Gain(1.0 / p.engine_inertia, 'engine_net'),
            'geared_speed': Gain(1.0 / p.total_ratio, 'shaft_speed'),
            'twist_speed': Sum(('geared_speed',), ('wheel_speed',)),
            'damper_torque': Gain(p.halfshaft_damping, 'twist_speed'),
            'spring_torque': Gain(p.halfshaft_stiffness, 'twist'),
            'halfshaft_torque': Sum(('damper_torque', 'spring_torque')),
            'reflected_torque': Gain(1.0 / p.total_ratio, 'halfshaft_torque'),
            'shaft_drag': Gain(p.shaft_damping, 'shaft_speed'),
            'shaft_net': Sum(('clutch_torque',), ('reflected_torque', 'shaft_drag')),
            'shaft_acceleration': Gain(1.0 / p.shaft_inertia, 'shaft_net'),
            'wheel_net': Sum(('halfshaft_torque',), ('load_torque',)),
            'wheel_acceleration': Gain(1.0 / p.vehicle_inertia, 'wheel_net'),
        }
        self._diagram = BlockDiagram(blocks, ('engine_torque', 'clutch_torque', 'load_torque'))
        fastest = float(np.abs(np.linalg.eigvals(driveline_matrices(p).a)).max())
        self._steps = max(math.ceil(SUBSTEP_S * fastest / 0.02), 1)

    def _slip_speed(
        self,
        engine_torque: np.ndarray,
        clutch_points: np.ndarray,
        load_torque: np.ndarray,
        initial_state: np.ndarray,
    ) -> np.ndarray:
        state = initial_state.tolist()
        slip_speed = [state[0] - state[1]]
        periods = zip(
            engine_torque.tolist(), clutch_points.tolist(), load_torque.tolist(), strict=True
        )
        for engine, points, load in periods:
            for first, last in zip(points, points[1:], strict=False):
                state = self._advance(state, engine, (first, last), load)
            slip_speed.append(
                self._diagram.signals(state, (engine, points[-1], load))['slip_speed']
            )
        return np.array(slip_speed)

    def _advance(
        self, state: list[float], engine: float, clutch: tuple[float, float], load: float
    ) -> list[float]:
        """Return the state 1 ms later; `clutch` holds C_f at both ends."""
        h = SUBSTEP_S / self._steps
        derivative = self._diagram.derivative
        for step in range(self._steps):
            start, middle, end = (
                (engine, clutch[0] + (clutch[1] - clutch[0]) * (step + part) / self._steps, load)
                for part in (0.0, 0.5, 1.0)
            )
            k_1 = derivative(state, start)
            k_2 = derivative(_moved(state, k_1, h / 2), middle)
            k_3 = derivative(_moved(state, k_2, h / 2), middle)
            k_4 = derivative(_moved(state, k_3, h), end)
            slopes = [
                (a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(k_1, k_2, k_3, k_4, strict=True)
            ]
            state = _moved(state, slopes, h)
        return state


def _moved(state: Sequence[float], slopes: Sequence[float], time: float) -> list[float]:
    return [value + slope * time for value, slope in zip(state, slopes, strict=True)]

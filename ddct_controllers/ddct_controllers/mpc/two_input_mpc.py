"""A predictive controller of clutch and engine, within the engine's authority."""

import math
from dataclasses import replace

import numpy as np

from ddct_controllers.interface import Command, Measurement, Status
from ddct_controllers.mpc.model.engine_model import with_engine
from ddct_controllers.mpc.model.transmission_model import TransmissionModel
from ddct_controllers.mpc.predictive_controller import Estimator, PredictiveController
from ddct_controllers.mpc.program.limits import CLUTCH
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_plant.models.engine import MOST_AUTHORITY, EngineAuthority, EngineResponse

ENGINE = 1
"""Place of the engine among the inputs."""


class TwoInputController(PredictiveController[Estimator]):
    """
    Decides the clutch torque request and the engine's deviation from the driver's demand.

    The deviation's target is zero, its limits and its rate are the engine's, and the engine's lag
    is part of the prediction; the observer is told what the engine delivers. The demand is taken
    as constant over the horizon.
    """

    commands_engine = True

    def __init__(
        self,
        model: TransmissionModel,
        observer: Estimator,
        settings: MpcSettings,
        authority: EngineAuthority,
    ) -> None:
        """Take the model without an engine; the second input is limited by `authority` alone."""
        # A limit that no engine has: it makes the rows whose bounds each period sets.
        limit = 2.0 * MOST_AUTHORITY
        engine = (
            replace(terms, lowest=-limit, highest=limit, rate_n_m_s=math.inf)
            for terms in settings.inputs[ENGINE:]
        )
        self._authority = authority
        settings = replace(settings, inputs=(settings.inputs[CLUTCH], *engine))
        super().__init__(with_engine(model, authority.lag_share), observer, settings)
        self._engine_rows = self.program.level_rows[ENGINE]

    @property
    def authority(self) -> EngineAuthority:
        """What the engine is known to do of a request."""
        return self._authority

    def reset(self) -> None:
        """Forget everything; the engine is on the demand."""
        super().reset()
        self._engine = EngineResponse(self._authority)
        self._reachable = np.zeros((2, self.settings.control_steps))

    def _delivered(self, measurement: Measurement, request: float) -> float:
        return self._engine.deliver(measurement.engine_torque, request)

    def _levels_before(self, measurement: Measurement) -> np.ndarray:
        clutch = measurement.open_loop_torque + self._own_torque
        return np.array([clutch, self._engine.asked])

    def _known(self, measurement: Measurement) -> tuple[float, ...]:
        return (measurement.load_torque,)

    def _solve(
        self, state: np.ndarray, before: np.ndarray, jump: np.ndarray, measurement: Measurement
    ) -> tuple[np.ndarray, Status]:
        """Solve for the moves of the request and of the deviation."""
        return self._solve_divided(state, before, jump, measurement, 1.0)

    def _solve_divided(
        self,
        state: np.ndarray,
        before: np.ndarray,
        jump: np.ndarray,
        measurement: Measurement,
        gain: float,
    ) -> tuple[np.ndarray, Status]:
        """Solve with the engine's torques divided by `gain`, as the rest of `state` is."""
        demand = measurement.engine_torque
        periods = range(1, self.settings.control_steps + 1)
        reachable = [self._engine.reachable(demand, period) for period in periods]
        self._reachable = np.transpose(reachable) / gain
        state = np.concatenate((state, (demand / gain, self._engine.deviation / gain)))
        divisor = np.array([1.0, gain])
        moves, status = super()._solve(state, before / divisor, jump, measurement)
        return moves * divisor, status

    def _bounds(self, before: np.ndarray, jump: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        lower, upper = (bound.copy() for bound in super()._bounds(before, jump))
        lower[self._engine_rows], upper[self._engine_rows] = self._reachable
        return lower, upper

    def _next_planned(self, before: np.ndarray, jump: np.ndarray) -> np.ndarray:
        moves = super()._next_planned(before, jump)
        lowest, highest = self._reachable[:, 0]
        asked = before[ENGINE] + moves[ENGINE]
        moves[ENGINE] = min(max(asked, lowest), highest) - before[ENGINE]
        return moves

    def _command(self, levels: np.ndarray, status: Status, measurement: Measurement) -> Command:
        demand = measurement.engine_torque
        request = demand + float(levels[ENGINE])
        delivered = self._delivered(measurement, request)
        self._advance(measurement, float(levels[CLUTCH]), delivered)
        deviation = ('engine_torque_deviation_n_m', repr(delivered - demand))
        return Command(self._own_torque, (*status, deviation), request)

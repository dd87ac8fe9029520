"""A predictive controller of clutch and engine, within the engine's authority."""

from dataclasses import replace

import numpy as np

from ddct_controllers.interface import Command, Measurement, Status
from ddct_controllers.mpc.engine_model import with_engine
from ddct_controllers.mpc.observer import StateEstimator
from ddct_controllers.mpc.predictive_controller import PredictiveController
from ddct_controllers.mpc.settings import MpcSettings
from ddct_controllers.mpc.transmission_model import SLIP_SPEED, TransmissionModel
from ddct_plant.engine import MOST_AUTHORITY, EngineAuthority, EngineResponse
from ddct_plant.timebase import PERIOD_S

ENGINE = 1
"""Place of the engine among the inputs."""


class TwoInputController(PredictiveController):
    """
    Decides the clutch torque request and the engine's deviation from the driver's demand.

    The deviation's target is zero, its limits and its rate are the engine's, and the engine's lag
    is part of the prediction; the observer is told what the engine delivers. The demand is taken
    as constant over the horizon. Without preview the slip reference goes on along its tangent.
    """

    def __init__(
        self,
        model: TransmissionModel,
        observer: StateEstimator,
        settings: MpcSettings,
        authority: EngineAuthority,
    ) -> None:
        """Take the model without an engine; the second input is limited by `authority` alone."""
        # A limit that no engine has: it makes the rows whose bounds each period sets.
        engine = replace(
            settings.inputs[ENGINE], lowest=-2.0 * MOST_AUTHORITY, highest=2.0 * MOST_AUTHORITY
        )
        self._authority = authority
        settings = replace(settings, inputs=(settings.inputs[0], engine))
        super().__init__(with_engine(model, authority.lag_share), observer, settings)
        self._engine_rows = np.flatnonzero(self._program.lower == engine.lowest)

    @property
    def authority(self) -> EngineAuthority:
        """What the engine is known to do of a request."""
        return self._authority

    def reset(self) -> None:
        """Forget everything; the engine is on the demand."""
        super().reset()
        self._engine = EngineResponse(self._authority)
        self._reachable = np.zeros((2, self._settings.control_steps))

    def hold(self, measurement: Measurement) -> None:
        """Let the observer follow the plant while the engine goes back to the demand."""
        demand = measurement.engine_torque
        delivered = self._engine.deliver(demand, demand)
        super().hold(replace(measurement, engine_torque=delivered))

    def _levels_before(self, measurement: Measurement) -> np.ndarray:
        clutch = measurement.open_loop_torque + self._own_torque
        return np.array([clutch, self._engine.asked])

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
        periods = range(1, self._settings.control_steps + 1)
        reachable = [self._engine.reachable(demand, period) for period in periods]
        self._reachable = np.transpose(reachable) / gain
        state = np.concatenate((state, (demand / gain, self._engine.deviation / gain)))
        divisor = np.array([1.0, gain])
        # The target of the deviation is zero.
        measurement = replace(measurement, engine_torque=0.0)
        moves, status = super()._solve(state, before / divisor, jump, measurement)
        return moves * divisor, status

    def _bounds(self) -> tuple[np.ndarray, np.ndarray]:
        lower, upper = self._program.lower.copy(), self._program.upper.copy()
        lower[self._engine_rows], upper[self._engine_rows] = self._reachable
        return lower, upper

    def _references(self, measurement: Measurement) -> np.ndarray:
        references = super()._references(measurement)
        if self._settings.preview:
            return references
        steps = np.arange(1, self._settings.prediction_steps + 1)
        along = PERIOD_S * measurement.slip_reference_rate[0] * steps
        columns = references.reshape(len(steps), -1)
        for column, terms in enumerate(self._settings.outputs):
            if terms.output == SLIP_SPEED:
                columns[:, column] += along
        return references

    def _next_planned(self, before: np.ndarray, jump: np.ndarray) -> np.ndarray:
        moves = super()._next_planned(before, jump)
        lowest, highest = self._reachable[:, 0]
        asked = before[ENGINE] + moves[ENGINE]
        moves[ENGINE] = min(max(asked, lowest), highest) - before[ENGINE]
        return moves

    def _command(self, levels: np.ndarray, status: Status, measurement: Measurement) -> Command:
        demand = measurement.engine_torque
        request = demand + float(levels[ENGINE])
        delivered = self._engine.deliver(demand, request)
        levels = np.array([levels[0], delivered])
        command = super()._command(levels, status, measurement)
        deviation = ('engine_torque_deviation_n_m', repr(delivered - demand))
        return Command(command.clutch_torque, (*status, deviation), request)

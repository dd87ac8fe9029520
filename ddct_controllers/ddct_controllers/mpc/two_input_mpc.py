"""A predictive controller of clutch and engine, within the engine's authority."""

from dataclasses import replace

import numpy as np

from ddct_controllers.interface import Command, Measurement
from ddct_controllers.mpc.engine_model import with_engine
from ddct_controllers.mpc.observer import StateEstimator
from ddct_controllers.mpc.predictive_controller import PredictiveController
from ddct_controllers.mpc.settings import MpcSettings
from ddct_controllers.mpc.transmission_model import SLIP_SPEED, TransmissionModel
from ddct_plant.engine import EngineAuthority, EngineResponse
from ddct_plant.timebase import PERIOD_S

ENGINE = 1
"""Place of the engine among the inputs."""


class TwoInputController(PredictiveController):
    """
    Decides the clutch torque request and the engine's deviation from the driver's demand.

    The deviation's target is zero, its limits and its rate are the engine's, and an engine's lag is
    part of the prediction; the observer is told what the engine delivers. The demand is taken as
    constant over the horizon. Without preview the slip reference is continued along its tangent.
    """

    def __init__(
        self,
        model: TransmissionModel,
        observer: StateEstimator,
        settings: MpcSettings,
        authority: EngineAuthority,
    ) -> None:
        """Take the model without an engine; the second input is limited by `authority` alone."""
        # A limit that no deviation reaches makes the rows whose bounds each period sets.
        engine = replace(
            settings.inputs[ENGINE],
            lowest=-EngineAuthority.MOST,
            highest=EngineAuthority.MOST,
            rate_n_m_s=authority.slew_n_m_s or EngineAuthority.MOST,
        )
        self._authority = authority
        settings = replace(settings, inputs=(settings.inputs[0], engine))
        super().__init__(with_engine(model, authority.lag_share), observer, settings)
        rows = self.program.lower == engine.lowest
        self._engine_rows = np.flatnonzero(rows)

    def reset(self) -> None:
        """Forget everything; the engine is on the demand."""
        super().reset()
        self._engine = EngineResponse(self._authority)
        self._reachable = (0.0, 0.0)

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
    ) -> tuple[np.ndarray, tuple[tuple[str, str], ...]]:
        """Solve for the deviation, whose target is zero, with the engine's states."""
        demand = measurement.engine_torque
        self._reachable = self._engine.reachable(demand)
        state = np.concatenate((state, (demand, self._engine.deviation)))
        return super()._solve(state, before, jump, replace(measurement, engine_torque=0.0))

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
        lowest, highest = self._reachable
        asked = before[ENGINE] + moves[ENGINE]
        moves[ENGINE] = min(max(asked, lowest), highest) - before[ENGINE]
        return moves

    def _command(
        self, levels: np.ndarray, status: tuple[tuple[str, str], ...], measurement: Measurement
    ) -> Command:
        demand = measurement.engine_torque
        request = demand + float(levels[ENGINE])
        delivered = self._engine.deliver(demand, request)
        levels = np.array([levels[0], delivered])
        command = super()._command(levels, status, measurement)
        deviation = ('engine_torque_deviation_n_m', repr(delivered - demand))
        return Command(command.clutch_torque, (*status, deviation), request)

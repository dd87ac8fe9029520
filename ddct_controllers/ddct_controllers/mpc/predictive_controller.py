"""A model predictive controller: observer, condensed program and solver at every period."""

import math

import numpy as np

from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.mpc.horizon import CondensedProgram, condense
from ddct_controllers.mpc.observer import StateEstimator
from ddct_controllers.mpc.qp.factory import make_backend
from ddct_controllers.mpc.settings import MpcSettings
from ddct_controllers.mpc.transmission_model import (
    SLIP_ACCELERATION,
    SLIP_SPEED,
    TransmissionModel,
)
from ddct_plant.errors import DdctError
from ddct_plant.timebase import PERIOD_S


class PredictiveController(Controller):
    """
    Chooses the input moves that minimise the cost of `MpcSettings` over the horizon.

    C_m (unless commanded), C_load and the architecture's open-loop torque are known now and taken
    as constant over the horizon. Weighted and limited is the whole clutch torque request, open
    loop included; moves are those of the controller's own part. When the solver gives no solution,
    the rest of the last plan is followed within the limits; each such step is counted and shown as
    `fallbacks` in `controller/status`.
    """

    def __init__(
        self, model: TransmissionModel, observer: StateEstimator, settings: MpcSettings
    ) -> None:
        """Build the program; raise ParameterError when the settings do not make one."""
        self._observer = observer
        self._settings = settings
        self._program = condense(model, settings)
        self._solver = make_backend(
            settings.backend, self._program.structure, settings.iteration_limit
        )
        self._inputs = len(settings.inputs)
        self.commands_engine = self._inputs == 2
        self.preview_steps = settings.prediction_steps if settings.preview else 0
        self.reset()

    @property
    def settings(self) -> MpcSettings:
        """What it was built from."""
        return self._settings

    @property
    def program(self) -> CondensedProgram:
        """What it solves at every period."""
        return self._program

    @property
    def observer(self) -> StateEstimator:
        """What estimates its state."""
        return self._observer

    def reset(self) -> None:
        """Forget everything; the observer starts afresh from the next measurement."""
        self._solver.reset()
        self._observer.reset()
        self._own_torque = 0.0
        self._engine_torque: float | None = None
        self._open_loop: float | None = None
        self._plan = np.zeros(self._program.structure.hessian.shape[0])
        self.fallbacks = 0

    def hold(self, measurement: Measurement) -> None:
        """Let the observer follow the plant under the open-loop torque alone."""
        self._correct(measurement)
        self._own_torque = 0.0
        self._open_loop = measurement.open_loop_torque
        self._engine_torque = measurement.engine_torque
        self._predict(measurement, measurement.open_loop_torque, measurement.engine_torque)

    def update(self, measurement: Measurement) -> Command:
        """Return the first of the moves that are best over the horizon."""
        state = self._correct(measurement)
        before = self._levels_before(measurement)
        jump = self._jump(measurement)
        moves, status = self._solve(state, before, jump, measurement)
        return self._command(before + moves, status, measurement)

    def _command(
        self, levels: np.ndarray, status: tuple[tuple[str, str], ...], measurement: Measurement
    ) -> Command:
        """Return the answer for the inputs `levels` (inputs,) in N m, and predict their effect."""
        clutch_torque = float(levels[0])
        self._own_torque = clutch_torque - measurement.open_loop_torque
        self._open_loop = measurement.open_loop_torque
        engine_torque = float(levels[1]) if self.commands_engine else None
        self._engine_torque = engine_torque
        self._predict(
            measurement,
            clutch_torque,
            measurement.engine_torque if engine_torque is None else engine_torque,
        )
        return Command(self._own_torque, status, engine_torque)

    def _correct(self, measurement: Measurement) -> np.ndarray:
        speeds = (measurement.engine_speed, measurement.shaft_speed, measurement.wheel_speed)
        if not math.isfinite(sum(speeds)):
            raise DdctError(
                f'speeds w_m, w_p, w_r are {speeds} rad/s at step {measurement.step}: '
                'mend what measures them'
            )
        return self._observer.correct(speeds, measurement.load_torque)

    def _predict(self, measurement: Measurement, clutch: float, engine: float) -> None:
        self._observer.predict((max(clutch, 0.0), engine, measurement.load_torque))

    def _levels_before(self, measurement: Measurement) -> np.ndarray:
        """Return the inputs if the controller did not move, (inputs,) N m."""
        clutch = measurement.open_loop_torque + self._own_torque
        if not self.commands_engine:
            return np.array([clutch])
        engine = self._engine_torque
        return np.array([clutch, measurement.engine_torque if engine is None else engine])

    def _jump(self, measurement: Measurement) -> np.ndarray:
        """Return what the open loop changes the inputs by from one period to the next."""
        jump = np.zeros(self._inputs)
        if self._open_loop is not None:
            jump[0] = measurement.open_loop_torque - self._open_loop
        return jump

    def _solve(
        self, state: np.ndarray, before: np.ndarray, jump: np.ndarray, measurement: Measurement
    ) -> tuple[np.ndarray, tuple[tuple[str, str], ...]]:
        """Return the first move (inputs,) and what to say of the solver."""
        program = self._program
        engine, load = measurement.engine_torque, measurement.load_torque
        known = (load,) if self.commands_engine else (engine, load)
        targets = (0.0, engine)[: self._inputs]
        v = np.concatenate((state, before, known))
        f = program.gradient @ np.concatenate((v, targets, self._references(measurement)))
        shift = program.shift @ np.concatenate((v, jump))
        lower, upper = self._bounds()
        solution = self._solver.solve(f, lower - shift, upper - shift)
        if solution.status == 'solved':
            self._plan = solution.z
            moves = solution.z[: self._inputs]
        else:
            self.fallbacks += 1
            moves = self._next_planned(before, jump)
        return moves, (
            ('qp_status', solution.status),
            ('qp_iterations', str(solution.iterations)),
            ('fallbacks', str(self.fallbacks)),
        )

    def _bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the lower and upper bounds of the program's rows, before their shift."""
        return self._program.lower, self._program.upper

    def _references(self, measurement: Measurement) -> np.ndarray:
        """Return the outputs' references at periods 1..p, (p outputs,)."""
        settings = self._settings
        references = np.zeros((settings.prediction_steps, len(settings.outputs)))
        coming = slice(1, None) if settings.preview else slice(0, 1)
        for column, terms in enumerate(settings.outputs):
            if terms.output == SLIP_SPEED:
                references[:, column] = measurement.slip_reference[coming]
            elif terms.output == SLIP_ACCELERATION:
                references[:, column] = measurement.slip_reference_rate[coming]
        return references.ravel()

    def _next_planned(self, before: np.ndarray, jump: np.ndarray) -> np.ndarray:
        """Return the next move of the last plan, cut off at the input limits."""
        self._plan = np.concatenate([self._plan[self._inputs :], np.zeros(self._inputs)])
        moves = self._plan[: self._inputs].copy()
        for i, terms in enumerate(self._settings.inputs):
            change = terms.rate_n_m_s * PERIOD_S
            move = min(max(moves[i], -change - jump[i]), change - jump[i])
            moves[i] = min(max(before[i] + move, terms.lowest), terms.highest) - before[i]
        return moves

"""A model predictive controller: observer, condensed program and solver at every period."""

from typing import Generic, TypeVar

import numpy as np

from ddct_controllers.interface import Command, Controller, Measurement, Status
from ddct_controllers.measured import measured_speeds
from ddct_controllers.mpc.estimate.observer import StateEstimator
from ddct_controllers.mpc.model.transmission_model import TransmissionModel
from ddct_controllers.mpc.program.horizon import condense
from ddct_controllers.mpc.program.limits import CLUTCH, Limits
from ddct_controllers.mpc.program.references import references
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_controllers.mpc.qp.factory import make_backend
from ddct_plant.base.errors import ParameterError

Estimator = TypeVar('Estimator', bound=StateEstimator)


class PredictiveController(Controller, Generic[Estimator]):
    """
    Chooses the moves of the clutch torque that minimise the cost of `MpcSettings`.

    C_m, C_load, as far as the model has it, and the architecture's open-loop torque are known now
    and taken as constant over the horizon. Limited is the whole clutch torque request, open loop
    included; moves are those of the controller's own part. When the solver gives no solution, the
    rest of the last plan is followed within the limits; each such step is counted and shown as
    `fallbacks` in `controller/status`.
    """

    def __init__(
        self, model: TransmissionModel, observer: Estimator, settings: MpcSettings
    ) -> None:
        """Build the program; raise ParameterError when the settings do not make one."""
        if len(settings.inputs) != 1 + self.commands_engine:
            raise ParameterError(
                f'MPC: {len(settings.inputs)} inputs given: {type(self).__name__} decides '
                f'{1 + self.commands_engine}'
            )
        self.observer = observer
        """What estimates its state."""
        self.settings = settings
        """What it was built from."""
        self.program = condense(model, settings)
        """What it solves at every period."""
        structure = self.program.structure
        self._limits = Limits(self.program, settings)
        self._solver = make_backend(settings.backend, structure, settings.iteration_limit)
        self.preview_steps = settings.prediction_steps if settings.preview else 0
        self.reset()

    def reset(self) -> None:
        """Forget everything; the observer starts afresh from the next measurement."""
        self._solver.reset()
        self.observer.reset()
        self._own_torque = 0.0
        self._open_loop: float | None = None
        self._plan = np.zeros(self.program.structure.hessian.shape[0])
        self.fallbacks = 0

    def hold(self, measurement: Measurement) -> None:
        """Let the observer follow the plant under the open-loop torque alone."""
        self._correct(measurement)
        delivered = self._delivered(measurement, measurement.engine_torque)
        self._advance(measurement, measurement.open_loop_torque, delivered)
        # The rate counts from what the actuator was given.
        self._open_loop = max(measurement.open_loop_torque, 0.0)

    def update(self, measurement: Measurement) -> Command:
        """Return the first of the moves that are best over the horizon."""
        state = self._correct(measurement)
        before = self._levels_before(measurement)
        moves, status = self._solve(state, before, self._jump(measurement), measurement)
        return self._command(before + moves, status, measurement)

    def _command(self, levels: np.ndarray, status: Status, measurement: Measurement) -> Command:
        """Return the answer for the inputs `levels` (inputs,) in N m, and predict their effect."""
        self._advance(measurement, float(levels[CLUTCH]), measurement.engine_torque)
        return Command(self._own_torque, status)

    def _correct(self, measurement: Measurement) -> np.ndarray:
        return self.observer.correct(measured_speeds(measurement), measurement.load_torque)

    def _delivered(self, measurement: Measurement, request: float) -> float:
        """Return C_m over the period for a request in N m."""
        return measurement.engine_torque

    def _advance(self, measurement: Measurement, clutch: float, engine: float) -> None:
        """Keep the clutch torque request and predict its effect and that of C_m, in N m."""
        self._own_torque = clutch - measurement.open_loop_torque
        self._open_loop = measurement.open_loop_torque
        self.observer.predict((max(clutch, 0.0), engine, measurement.load_torque))

    def _levels_before(self, measurement: Measurement) -> np.ndarray:
        """Return the inputs (inputs,) in N m if the controller did not move."""
        return np.array([measurement.open_loop_torque + self._own_torque])

    def _jump(self, measurement: Measurement) -> np.ndarray:
        """Return what the open loop changes the inputs by from one period to the next."""
        before, jump = self._open_loop, np.zeros(len(self.settings.inputs))
        if before is None:
            before = max(measurement.open_loop_torque, 0.0)
        jump[CLUTCH] = measurement.open_loop_torque - before
        return jump

    def _known(self, measurement: Measurement) -> tuple[float, ...]:
        """Return the inputs in N m that it does not decide."""
        return measurement.engine_torque, measurement.load_torque

    def _solve(
        self, state: np.ndarray, before: np.ndarray, jump: np.ndarray, measurement: Measurement
    ) -> tuple[np.ndarray, Status]:
        """Return the first move (inputs,) and what to say of the solver."""
        program = self.program
        v = np.concatenate((state, before, self._known(measurement)))
        # Without a move of its own the controller leaves C_fOL, and the engine on the demand.
        targets = np.zeros(len(before))
        targets[CLUTCH] = measurement.open_loop_torque
        wanted = references(self.settings, measurement).ravel()
        f = program.gradient @ np.concatenate((v, targets, wanted))
        shift = program.shift @ np.concatenate((v, jump))
        lower, upper = self._bounds(before, jump)
        solution = self._solver.solve(f, lower - shift, upper - shift)
        if solution.status == 'solved':
            self._plan = solution.z
            moves = solution.z[: len(before)]
        else:
            self.fallbacks += 1
            moves = self._next_planned(before, jump)
        return moves, (
            ('qp_status', solution.status),
            ('qp_iterations', str(solution.iterations)),
            ('fallbacks', str(self.fallbacks)),
        )

    def _bounds(self, before: np.ndarray, jump: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the lower and upper bounds of the program's rows, before their shift."""
        return self._limits.bounds(float(before[CLUTCH] - jump[CLUTCH]), self._output_divisor())

    def _output_divisor(self) -> float:
        """Return what the state and the references are divided by, and so the outputs."""
        return 1.0

    def _next_planned(self, before: np.ndarray, jump: np.ndarray) -> np.ndarray:
        """Return the next move of the last plan, cut off at the input limits."""
        inputs = len(before)
        self._plan = np.concatenate([self._plan[inputs:], np.zeros(inputs)])
        moves = self._plan[:inputs].copy()
        clutch = float(before[CLUTCH])
        level = self._limits.nearest(clutch + float(moves[CLUTCH]), clutch - float(jump[CLUTCH]))
        moves[CLUTCH] = level - clutch
        return moves

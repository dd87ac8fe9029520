"""Readings of the thesis in which the clutch transmits its request at once."""

from ddct_bringup.run.headless import ClosedLoop
from ddct_controllers.interface import Controller
from ddct_controllers.mpc.model.transmission_model import (
    REQUEST,
    SLIP_ACCELERATION,
    TransmissionModel,
    transmission_model,
)
from ddct_plant.base.timebase import SUBSTEPS
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.settings import RunSettings


def model_without_actuator(
    driveline: DrivelineParameters, wear_gain: float = 1.0
) -> TransmissionModel:
    """
    Return the sampled driveline alone; the actuator's states drive nothing any more.

    The clutch transmits `wear_gain` times the request.
    """
    model, plant = transmission_model(driveline), driveline_matrices(driveline)
    a, b, c, d = model.a.copy(), model.b.copy(), model.c.copy(), model.d.copy()
    a[:4, 4:], c[:, 4:] = 0.0, 0.0
    b[:, REQUEST] += wear_gain * model.clutch
    d[SLIP_ACCELERATION, REQUEST] = wear_gain * plant.c[0] @ plant.b[:, 1]
    return TransmissionModel(a, b, c, d, model.clutch)


class LoopWithoutActuator(ClosedLoop):
    """The closed loop with the request, cut off below zero, as the torque of the actuator."""

    def __init__(self, settings: RunSettings, controller: Controller) -> None:
        """Start in the run's initial state."""
        super().__init__(settings, controller)
        self._actuator = _Direct()


class _Direct:
    def update(self, request: float) -> list[float]:
        """Return the request at 0, 1, ..., 10 ms."""
        return [max(request, 0.0)] * (SUBSTEPS + 1)

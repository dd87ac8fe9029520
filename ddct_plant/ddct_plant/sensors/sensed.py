"""The sensors of a run, and what they say at one step."""

from abc import ABC, abstractmethod
from typing import Generic, NamedTuple, Protocol, TypeVar

from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.sensors.parameters import SensorParameters
from ddct_plant.sensors.sensor import Sensor, ShaftSensor


class Seen(Protocol):
    """What control sees of the driveline: the truth, or what sensors say."""

    @property
    def joint_speed(self) -> list[float]:
        """w_m, w_p, w_r in rad/s, first of all."""

    @property
    def slip_speed(self) -> float:
        """w_d = w_m - w_p in rad/s."""

    @property
    def vehicle_speed(self) -> float:
        """V_x in m/s."""


class Sensed(NamedTuple):
    """What the sensors at the driveline say, as signals of the run."""

    sensed_joint_speed: list[float]
    """(3,) rad/s: w_m, w_p, w_r."""
    sensed_joint_held: list[float]
    """(3,) 1 where the last value is repeated, else 0."""
    sensed_slip_speed: float
    """w_m - w_p in rad/s of the measured speeds."""
    sensed_slip_held: float
    """1 where one of these two is repeated, else 0."""
    sensed_vehicle_speed: float
    """V_x in m/s."""
    sensed_vehicle_held: float

    @property
    def joint_speed(self) -> list[float]:
        """As `Seen` has it."""
        return self.sensed_joint_speed

    @property
    def slip_speed(self) -> float:
        """As `Seen` has it."""
        return self.sensed_slip_speed

    @property
    def vehicle_speed(self) -> float:
        """As `Seen` has it."""
        return self.sensed_vehicle_speed


class SensedTorque(NamedTuple):
    """What the engine says of its torque, as signals of the run."""

    sensed_engine_torque: float
    """C_m in N m over the coming period."""
    sensed_torque_held: float
    """1 where the last value is repeated, else 0."""


Truth = TypeVar('Truth', contravariant=True)
Said = TypeVar('Said')


class Sensors(ABC, Generic[Truth, Said]):
    """Sensors that are asked at the steps of a run."""

    _step = -1
    _said: Said

    def measure(self, step: int, truth: Truth) -> Said:
        """
        Return what they say at a step, the same when that step is asked for again.

        Steps must not fall. Those that were left out, as they may be in real time, had this truth.
        """
        while self._step < step:
            self._step += 1
            self._said = self._take(truth)
        return self._said

    @abstractmethod
    def _take(self, truth: Truth) -> Said:
        """Return what they say at the next step."""


class DrivelineSensors(Sensors[DrivelineOutputs, Sensed]):
    """The sensors of w_m, w_p, w_r and V_x."""

    def __init__(self, parameters: SensorParameters, seed: int) -> None:
        """Draw by the seed of the run."""
        self._shafts = [
            ShaftSensor(options, name, seed)
            for name, options in (
                ('engine_speed', parameters.engine_speed),
                ('shaft_speed', parameters.shaft_speed),
                ('wheel_speed', parameters.wheel_speed),
            )
        ]
        self._vehicle = Sensor(parameters.vehicle_speed, 'vehicle_speed', seed)

    def _take(self, now: DrivelineOutputs) -> Sensed:
        shafts = [
            sensor.take(now.joint_position[joint], now.joint_speed[joint])
            for joint, sensor in enumerate(self._shafts)
        ]
        engine, shaft, _ = shafts
        vehicle = self._vehicle.take(now.vehicle_speed)
        return Sensed(
            sensed_joint_speed=[sample.value for sample in shafts],
            sensed_joint_held=[float(sample.held) for sample in shafts],
            sensed_slip_speed=engine.value - shaft.value,
            sensed_slip_held=float(engine.held or shaft.held),
            sensed_vehicle_speed=vehicle.value,
            sensed_vehicle_held=float(vehicle.held),
        )


class TorqueEstimate(Sensors[float, SensedTorque]):
    """What is known of C_m."""

    def __init__(self, parameters: SensorParameters, seed: int) -> None:
        """Draw by the seed of the run."""
        self._sensor = Sensor(parameters.engine_torque, 'engine_torque', seed)

    def _take(self, truth: float) -> SensedTorque:
        value, held = self._sensor.take(truth)
        return SensedTorque(value, float(held))

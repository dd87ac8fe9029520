# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The sensors of a run, and their measurements at one step."""

from abc import ABC, abstractmethod
from typing import Generic, NamedTuple, Protocol, TypeVar

from ddct_plant.models.driveline import DrivelineOutputs, SensedJoints
from ddct_plant.sensors.parameters import SensorParameters
from ddct_plant.sensors.sensor import Sensor, ShaftSensor


class MeasuredSpeeds(Protocol):
    """Speeds that controller and reference receive: measured by sensors, or true without them."""

    @property
    def engine_speed(self) -> float:
        """Engine speed w_m in rad/s."""

    @property
    def shaft_speed(self) -> float:
        """Speed of the primary shaft w_p in rad/s."""

    @property
    def wheel_speed(self) -> float:
        """Wheel speed w_r in rad/s."""

    @property
    def slip_speed(self) -> float:
        """Slip speed w_d = w_m - w_p in rad/s."""

    @property
    def vehicle_speed(self) -> float:
        """Vehicle speed V_x in m/s."""


class SpeedMeasurements(NamedTuple):
    """Measurements of the speed sensors at one step, under the names of the run's signals."""

    sensed_joint_speed: SensedJoints
    """Measured speeds w_m, w_p, w_r in rad/s."""
    sensed_joint_held: SensedJoints
    """Flags of w_m, w_p, w_r: 1 where the last value is repeated, else 0."""
    sensed_slip_speed: float
    """Slip speed in rad/s: measured w_m less measured w_p."""
    sensed_slip_held: float
    """Flag of the slip speed: 1 where w_m or w_p is repeated, else 0."""
    sensed_vehicle_speed: float
    """Measured vehicle speed V_x in m/s."""
    sensed_vehicle_held: float
    """Flag of the vehicle speed: 1 where the last value is repeated, else 0."""

    @property
    def engine_speed(self) -> float:
        """Measured engine speed w_m in rad/s."""
        return self.sensed_joint_speed.engine

    @property
    def shaft_speed(self) -> float:
        """Measured speed of the primary shaft w_p in rad/s."""
        return self.sensed_joint_speed.primary_shaft

    @property
    def wheel_speed(self) -> float:
        """Measured wheel speed w_r in rad/s."""
        return self.sensed_joint_speed.wheel

    @property
    def slip_speed(self) -> float:
        """Measured slip speed w_d in rad/s."""
        return self.sensed_slip_speed

    @property
    def vehicle_speed(self) -> float:
        """Measured vehicle speed V_x in m/s."""
        return self.sensed_vehicle_speed


class TorqueMeasurement(NamedTuple):
    """Estimate of the engine torque at one step, under the names of the run's signals."""

    sensed_engine_torque: float
    """Estimated C_m in N m over the coming period."""
    sensed_torque_held: float
    """Flag of the estimate: 1 where the last value is repeated, else 0."""


Truth = TypeVar('Truth', contravariant=True)
Measured = TypeVar('Measured')


class Sensors(ABC, Generic[Truth, Measured]):
    """Base of sensors that are sampled once per step of a run."""

    _step = -1
    _measured: Measured

    def measure(self, step: int, truth: Truth) -> Measured:
        """
        Return the measurement of `truth` at a step; a repeated step gives the same measurement.

        Steps must not decrease. Skipped steps, as real time may have, are sampled with this truth.
        """
        while self._step < step:
            self._step += 1
            self._measured = self._take(truth)
        return self._measured

    @abstractmethod
    def _take(self, truth: Truth) -> Measured:
        """Return the measurement of the next step."""


class DrivelineSensors(Sensors[DrivelineOutputs, SpeedMeasurements]):
    """The sensors of w_m, w_p, w_r and V_x."""

    def __init__(self, parameters: SensorParameters, seed: int) -> None:
        """Make the four sensors; their random numbers follow from the seed of the run."""
        self._engine = ShaftSensor(parameters.engine_speed, 'engine_speed', seed)
        self._shaft = ShaftSensor(parameters.shaft_speed, 'shaft_speed', seed)
        self._wheel = ShaftSensor(parameters.wheel_speed, 'wheel_speed', seed)
        self._vehicle = Sensor(parameters.vehicle_speed, 'vehicle_speed', seed)

    def _take(self, truth: DrivelineOutputs) -> SpeedMeasurements:
        angles, speeds = truth.joint_position, truth.joint_speed
        engine = self._engine.take(angles.engine, speeds.engine)
        shaft = self._shaft.take(angles.primary_shaft, speeds.primary_shaft)
        wheel = self._wheel.take(angles.wheel, speeds.wheel)
        vehicle = self._vehicle.take(truth.vehicle_speed)
        return SpeedMeasurements(
            sensed_joint_speed=SensedJoints(engine.value, shaft.value, wheel.value),
            sensed_joint_held=SensedJoints(*map(float, (engine.held, shaft.held, wheel.held))),
            sensed_slip_speed=engine.value - shaft.value,
            sensed_slip_held=float(engine.held or shaft.held),
            sensed_vehicle_speed=vehicle.value,
            sensed_vehicle_held=float(vehicle.held),
        )


class TorqueEstimate(Sensors[float, TorqueMeasurement]):
    """The estimate of the engine torque C_m."""

    def __init__(self, parameters: SensorParameters, seed: int) -> None:
        """Make the estimate; its random numbers follow from the seed of the run."""
        self._sensor = Sensor(parameters.engine_torque, 'engine_torque', seed)

    def _take(self, truth: float) -> TorqueMeasurement:
        value, held = self._sensor.take(truth)
        return TorqueMeasurement(value, float(held))

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The sensors of a run, and their measurements at one step."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Generic, NamedTuple, Protocol, TypeVar

from ddct_plant.models.driveline import DrivelineOutputs
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


SensorSignals = Mapping[str, float | Sequence[float]]
"""Measurements and flags of sensors at one step, by signal."""


class SpeedMeasurements(NamedTuple):
    """Measurements of the driveline's sensors at one step."""

    engine_speed: float
    """Measured engine speed w_m in rad/s."""
    shaft_speed: float
    """Measured speed of the primary shaft w_p in rad/s."""
    wheel_speed: float
    """Measured wheel speed w_r in rad/s."""
    slip_speed: float
    """Slip speed w_d in rad/s: measured w_m less measured w_p."""
    vehicle_speed: float
    """Measured vehicle speed V_x in m/s."""
    signals: SensorSignals
    """Every measurement of these sensors, with its flag."""


class TorqueMeasurement(NamedTuple):
    """Estimate of the engine torque at one step."""

    engine_torque: float
    """Estimated C_m in N m over the coming period."""
    signals: SensorSignals
    """The estimate with its flag."""


Truth = TypeVar('Truth', contravariant=True)
Measured = TypeVar('Measured')


class Sensors(ABC, Generic[Truth, Measured]):
    """Base of the sensors of one node, which are sampled once per step of a run."""

    def __init__(self) -> None:
        """Start before the first step."""
        self._step = -1
        self._measured: Measured

    def measure(self, step: int, truth: Truth) -> Measured:
        """
        Return the measurement of `truth` at a step; a repeated step gives the same measurement.

        Steps must not decrease. Skipped steps, as real time may have, are sampled with this truth.
        """
        while self._step < step:
            self._step += 1
            self._measured = self._take(truth)
        return self._measured

    @property
    def latest(self) -> Measured:
        """Measurement at the latest measured step."""
        return self._measured

    @abstractmethod
    def _take(self, truth: Truth) -> Measured:
        """Return the measurement of the next step."""


class DrivelineSensors(Sensors[DrivelineOutputs, SpeedMeasurements]):
    """The sensors of w_m, w_p, w_r and V_x."""

    def __init__(self, parameters: SensorParameters, seed: int) -> None:
        """Make the sensors; their random numbers follow from the seed of the run."""
        super().__init__()
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
        slip_speed = engine.value - shaft.value
        return SpeedMeasurements(
            engine_speed=engine.value,
            shaft_speed=shaft.value,
            wheel_speed=wheel.value,
            slip_speed=slip_speed,
            vehicle_speed=vehicle.value,
            signals={
                'sensed_joint_speed': [engine.value, shaft.value, wheel.value],
                'sensed_joint_held': [float(each.held) for each in (engine, shaft, wheel)],
                'sensed_slip_speed': slip_speed,
                'sensed_slip_held': float(engine.held or shaft.held),
                'sensed_vehicle_speed': vehicle.value,
                'sensed_vehicle_held': float(vehicle.held),
            },
        )


class TorqueEstimate(Sensors[float, TorqueMeasurement]):
    """The estimate of the engine torque C_m."""

    def __init__(self, parameters: SensorParameters, seed: int) -> None:
        """Make the estimate; its random numbers follow from the seed of the run."""
        super().__init__()
        self._torque = Sensor(parameters.engine_torque, 'engine_torque', seed)

    def _take(self, truth: float) -> TorqueMeasurement:
        value, held = self._torque.take(truth)
        signals = {'sensed_engine_torque': value, 'sensed_torque_held': float(held)}
        return TorqueMeasurement(value, signals)

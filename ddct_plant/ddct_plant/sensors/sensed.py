# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The sensors of a run, and their measurements at one step."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from operator import itemgetter
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.sensors.parameters import SensorParameters, SpeedSensor
from ddct_plant.sensors.sensor import Sample, Sensor, ShaftSensor
from ddct_plant.signals.sensed import SensedQuantity
from ddct_plant.signals.signal import SignalValue
from ddct_plant.signals.topics import quantities, sensed_quantities, sensed_signals


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


class _Model:
    """Model of the sensor of one quantity, which takes its true value out of the signals."""

    def __init__(self, quantity: SensedQuantity, parameters: SensorParameters, seed: int) -> None:
        self.measured, self.flag = quantity.measured, quantity.flag
        options = parameters.of(quantity.sensor)
        self._true = _getter(quantity.true)
        self._shaft: ShaftSensor | None = None
        if isinstance(options, SpeedSensor):
            self._shaft = ShaftSensor(options, quantity.sensor, seed)
            self._angle = _getter(quantity.angle)
        else:
            self._sensor = Sensor(options, quantity.sensor, seed)

    def take(self, true: Mapping[str, SignalValue]) -> Sample:
        """Return the measurement at the next step, for the true signals of that step."""
        if self._shaft is None:
            return self._sensor.take(self._true(true))
        return self._shaft.take(self._angle(true), self._true(true))


def _getter(quantity: str) -> Any:
    """Return a function that takes a quantity out of signals by name."""
    signal, index = quantities()[quantity]
    if index is None:
        return itemgetter(signal.name)
    return lambda true: true[signal.name][index]


class Sensors(ABC, Generic[Truth, Measured]):
    """Base of the sensors of one node, which are sampled once per step of a run."""

    publisher = ''
    """Name of the node that publishes their measurements."""

    def __init__(self, parameters: SensorParameters, seed: int) -> None:
        """Make the sensors; their random numbers follow from the seed of the run."""
        self._models = [
            _Model(each, parameters, seed) for each in sensed_quantities(self.publisher)
        ]
        self._signals = sensed_signals(self.publisher)
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

    def _samples(self, true: Mapping[str, SignalValue]) -> dict[str, float]:
        """Return measurements and flags of the next step by quantity, for the true signals."""
        values: dict[str, float] = {}
        for model in self._models:
            sample = model.take(true)
            values[model.measured], values[model.flag] = sample.value, float(sample.held)
        return values

    def _by_signal(self, values: Mapping[str, float]) -> SensorSignals:
        """Return the signals of measurements and flags by quantity."""
        return {
            signal.name: [values[name] for name in signal.parts]
            if signal.parts
            else values[signal.name]
            for signal in self._signals
        }


class DrivelineSensors(Sensors[DrivelineOutputs, SpeedMeasurements]):
    """The sensors of w_m, w_p, w_r, V_x and of any other output of the driveline."""

    publisher = 'driveline'

    def _take(self, truth: DrivelineOutputs) -> SpeedMeasurements:
        values = self._samples(truth._asdict())
        engine, shaft = values['sensed_engine_speed'], values['sensed_primary_shaft_speed']
        flags = values['sensed_engine_held'], values['sensed_primary_shaft_held']
        values['sensed_slip_speed'], values['sensed_slip_held'] = engine - shaft, max(flags)
        return SpeedMeasurements(
            engine_speed=engine,
            shaft_speed=shaft,
            wheel_speed=values['sensed_wheel_speed'],
            slip_speed=values['sensed_slip_speed'],
            vehicle_speed=values['sensed_vehicle_speed'],
            signals=self._by_signal(values),
        )


class TorqueEstimate(Sensors[float, TorqueMeasurement]):
    """The estimate of the engine torque C_m."""

    publisher = 'engine'

    def _take(self, truth: float) -> TorqueMeasurement:
        values = self._samples({'engine_torque': truth})
        return TorqueMeasurement(values['sensed_engine_torque'], self._by_signal(values))

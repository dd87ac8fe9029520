# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Errors of the sensors of a run, as options of a scenario; by default there are none."""

import dataclasses
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import OptionGroup, option, options_of, section
from ddct_plant.base.timebase import PERIOD_S, steps_in

_MOST = 1e6


def _noise(unit: str) -> Any:
    meaning = 'standard deviation of white Gaussian noise, one draw per sample'
    return option(0.0, meaning, unit, at_least=0.0, at_most=_MOST, left_out=True)


def _quantum(unit: str) -> Any:
    meaning = 'resolution: the value is rounded to the nearest multiple; 0: none'
    return option(0.0, meaning, unit, at_least=0.0, at_most=_MOST, left_out=True)


def _bias(unit: str) -> Any:
    meaning = 'constant offset, added to the true value'
    return option(0.0, meaning, unit, at_least=-_MOST, at_most=_MOST, left_out=True)


class Errors(NamedTuple):
    """Errors of a sensor in the unit of its quantity."""

    noise: float
    """Standard deviation of the noise."""
    quantum: float
    """Resolution; 0 for none."""
    bias: float
    """Constant offset."""


@dataclass(frozen=True)
class SensorOptions(OptionGroup, ABC):
    """Options that every sensor has."""

    gain: float = option(
        1.0, 'ratio of the measured to the true value', left_out=True, above=0.0, at_most=10.0
    )
    delay_s: float = option(
        0.0,
        'delay of the measured value, a multiple of 10 ms; until then it is the first value',
        's',
        at_least=0.0,
        at_most=10.0,
        whole_periods=True,
        left_out=True,
    )
    dropout: float = option(
        0.0,
        'share of lost samples, below 1: the last received value is repeated',
        at_least=0.0,
        at_most=1.0,
        left_out=True,
    )
    dropout_burst: float | None = option(
        None,
        'mean number of consecutive lost samples',
        otherwise='1 / (1 - `dropout`): losses are independent',
        at_least=1.0,
        at_most=1e4,
        left_out=True,
    )

    def __post_init__(self) -> None:
        """Check every option; raise ParameterError that names a bad one."""
        super().__post_init__()
        if self.dropout == 1.0:
            raise ParameterError(
                f'{self.prefix}dropout is 1: give a share below 1', key=f'{self.prefix}dropout'
            )
        least = self.dropout / (1.0 - self.dropout)
        if self.dropout_burst is not None and self.dropout_burst < least:
            raise ParameterError(
                f'{self.prefix}dropout_burst is {self.dropout_burst:g}: with a dropout of '
                f'{self.dropout:g} give at least {least:g}',
                key=f'{self.prefix}dropout_burst',
            )

    @property
    @abstractmethod
    def errors(self) -> Errors:
        """Errors of the sensor, whose options have its unit in their names."""

    @property
    def delay_steps(self) -> int:
        """Delay of the measured value, in periods of 10 ms."""
        return steps_in(f'{self.prefix}delay_s', self.delay_s)

    @property
    def given(self) -> tuple[str, ...]:
        """Options that differ from their defaults, each as `KEY VALUE UNIT`."""
        return tuple(
            f'{name} {getattr(self, name):g} {each.unit}'.rstrip()
            for name, each in options_of(type(self)).items()
            if getattr(self, name) != each.default
        )


@dataclass(frozen=True)
class SpeedSensor(SensorOptions):
    """Options of a sensor of a shaft's speed, which may count teeth."""

    noise_rad_s: float = _noise('rad/s')
    quantum_rad_s: float = _quantum('rad/s')
    bias_rad_s: float = _bias('rad/s')
    teeth: int = option(
        0,
        'teeth of the encoder wheel: the speed then has the resolution '
        '2π / (`teeth` × `count_s`); 0: the speed is measured directly',
        at_least=0,
        at_most=100000,
        left_out=True,
    )
    count_s: float = option(
        PERIOD_S,
        'counting time of the teeth, a multiple of 10 ms; the speed is the mean over that time',
        's',
        above=0.0,
        at_most=10.0,
        whole_periods=True,
        left_out=True,
    )

    @property
    def errors(self) -> Errors:
        """Errors of the sensor in rad/s."""
        return Errors(self.noise_rad_s, self.quantum_rad_s, self.bias_rad_s)

    @property
    def count_steps(self) -> int:
        """Counting time of the teeth, in periods of 10 ms."""
        return steps_in(f'{self.prefix}count_s', self.count_s)


class EngineSpeedSensor(SpeedSensor, prefix='sensors.engine_speed.'):
    """Options of the sensor of w_m."""


class ShaftSpeedSensor(SpeedSensor, prefix='sensors.shaft_speed.'):
    """Options of the sensor of w_p."""


class WheelSpeedSensor(SpeedSensor, prefix='sensors.wheel_speed.'):
    """Options of the sensor of w_r."""


@dataclass(frozen=True)
class VehicleSpeedSensor(SensorOptions, prefix='sensors.vehicle_speed.'):
    """Options of the sensor of V_x."""

    noise_m_s: float = _noise('m/s')
    quantum_m_s: float = _quantum('m/s')
    bias_m_s: float = _bias('m/s')

    @property
    def errors(self) -> Errors:
        """Errors of the sensor in m/s."""
        return Errors(self.noise_m_s, self.quantum_m_s, self.bias_m_s)


@dataclass(frozen=True)
class EngineTorqueSensor(SensorOptions, prefix='sensors.engine_torque.'):
    """Options of the estimate of C_m."""

    noise_n_m: float = _noise('N m')
    quantum_n_m: float = _quantum('N m')
    bias_n_m: float = _bias('N m')

    @property
    def errors(self) -> Errors:
        """Errors of the estimate in N m."""
        return Errors(self.noise_n_m, self.quantum_n_m, self.bias_n_m)


@dataclass(frozen=True)
class SensorParameters(OptionGroup, prefix='sensors.'):
    """Options of all sensors that controller and reference read; by default each is exact."""

    engine_speed: EngineSpeedSensor = section(EngineSpeedSensor(), left_out=True)
    shaft_speed: ShaftSpeedSensor = section(ShaftSpeedSensor(), left_out=True)
    wheel_speed: WheelSpeedSensor = section(WheelSpeedSensor(), left_out=True)
    vehicle_speed: VehicleSpeedSensor = section(VehicleSpeedSensor(), left_out=True)
    engine_torque: EngineTorqueSensor = section(EngineTorqueSensor(), left_out=True)

    @property
    def text(self) -> str:
        """Options of each sensor that differ from their defaults, in one line."""
        given = {each.name: getattr(self, each.name).given for each in dataclasses.fields(self)}
        lines = [f'{name}: {", ".join(each)}' for name, each in given.items() if each]
        return '; '.join(lines) or 'each of them is exact'

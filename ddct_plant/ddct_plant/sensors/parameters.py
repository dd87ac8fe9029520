# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Errors of the sensors of a run, as options of a scenario; by default there are none."""

import types
from dataclasses import dataclass
from typing import TypeVar

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import (
    Option,
    OptionGroup,
    option,
    option_field,
    options_of,
    section,
)
from ddct_plant.base.timebase import PERIOD_S, steps_in
from ddct_plant.signals.sensed import SensedQuantity
from ddct_plant.signals.signal import column_name
from ddct_plant.signals.topics import quantities, sensed_quantities

_MOST = 1e6
_ERRORS = (
    ('noise', 'standard deviation of white Gaussian noise, one draw per sample', 0.0),
    ('quantum', 'resolution: the value is rounded to the nearest multiple; 0: none', 0.0),
    ('bias', 'constant offset, added to the true value', -_MOST),
)
"""Name, meaning and lower bound of each error in the unit of the quantity."""
_COUNTING = {
    'teeth': Option(
        0,
        'teeth of the encoder wheel: the speed then has the resolution '
        '2π / (`teeth` × `count_s`); 0: the speed is measured directly',
        at_least=0,
        at_most=100000,
    ),
    'count_s': Option(
        PERIOD_S,
        'counting time of the teeth, a multiple of 10 ms; the speed is the mean over that time',
        's',
        above=0.0,
        at_most=10.0,
        whole_periods=True,
    ),
}
"""Options of a sensor that may count teeth."""


@dataclass(frozen=True)
class SensorOptions(OptionGroup):
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

    def error(self, kind: str) -> float:
        """Return the option `noise`, `quantum` or `bias`, in the unit of the sensor."""
        (name,) = (name for name in options_of(type(self)) if name.startswith(f'{kind}_'))
        return float(getattr(self, name))

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


class SpeedSensor(SensorOptions):
    """Options of a sensor of a shaft's speed, which may count teeth."""

    teeth: int
    count_s: float

    @property
    def count_steps(self) -> int:
        """Counting time of the teeth, in periods of 10 ms."""
        return steps_in(f'{self.prefix}count_s', self.count_s)


def _options(quantity: SensedQuantity) -> dict[str, Option]:
    """Return the options of the sensor of a quantity, besides those that every sensor has."""
    unit = quantities()[quantity.true][0].unit
    options = {
        column_name(error, unit): Option(0.0, meaning, unit, at_least=least, at_most=_MOST)
        for error, meaning, least in _ERRORS
    }
    return options | _COUNTING if quantity.angle else options


def _group(quantity: SensedQuantity) -> type[SensorOptions]:
    """Return the class with the options of the sensor of a quantity."""
    options = _options(quantity)
    content = {
        '__module__': __name__,
        '__doc__': f'Options of the sensor of {quantity.true}.',
        '__annotations__': {name: each.kind for name, each in options.items()},
        **{name: option_field(each, left_out=True) for name, each in options.items()},
    }
    name = ''.join(map(str.capitalize, quantity.sensor.split('_'))) + 'Sensor'
    base = SpeedSensor if quantity.angle else SensorOptions
    prefix = {'prefix': f'sensors.{quantity.sensor}.'}
    return dataclass(frozen=True)(
        types.new_class(name, (base,), prefix, lambda ns: ns.update(content))
    )


OPTIONS = {each.sensor: _group(each) for each in sensed_quantities()}
"""Class with the options of each sensor, by its name."""
# Workers receive scenarios pickled, which finds a class as an attribute of its module.
globals().update({group.__name__: group for group in OPTIONS.values()})

Sections = TypeVar('Sections')


def _with_sensors(group: type[Sections]) -> type[Sections]:
    """Give a class a section with the options of each sensor, by its name, exact by default."""
    for name, options in OPTIONS.items():
        group.__annotations__[name] = options
        setattr(group, name, section(options(), left_out=True))
    return dataclass(frozen=True)(group)


@_with_sensors
class SensorParameters(OptionGroup, prefix='sensors.'):
    """Options of all sensors that controller and reference read; by default each is exact."""

    def of(self, sensor: str) -> SensorOptions:
        """Return the options of a sensor by its name."""
        options: SensorOptions = getattr(self, sensor)
        return options

    @property
    def text(self) -> str:
        """Options of each sensor that differ from their defaults, in one line."""
        given = {name: self.of(name).given for name in OPTIONS}
        lines = [f'{name}: {", ".join(each)}' for name, each in given.items() if each]
        return '; '.join(lines) or 'each of them is exact'

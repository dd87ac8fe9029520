# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that looks for what it must not know in all that it is given."""

import re
from dataclasses import fields, is_dataclass
from typing import Any

from gaming_parts import Gamed

from ddct_controllers.interface import Command, ControllerContext, Measurement

SECRETS = re.compile(r'wear|seed|mass|delay|true|case')
DEEPEST = 8
BLEND_S = 0.3
"""Time over which the request goes over to what a worn clutch needs."""


def found_in(value: Any, place: str, depth: int = 0) -> dict[str, float]:
    """Return numbers whose names look like secrets, by their place below `value`."""
    if depth > DEEPEST or not is_dataclass(value):
        return {}
    found: dict[str, float] = {}
    for field in fields(value):
        inner, where = getattr(value, field.name, None), f'{place}.{field.name}'
        if isinstance(inner, int | float) and SECRETS.search(field.name):
            found[where] = float(inner)
        found |= found_in(inner, where, depth + 1)
    return found


class PeekSettings(Gamed):
    """Games what is unknown: it divides by the wear gain that it finds, and scales by the mass."""

    base = 'ls8'

    def __init__(self, context: ControllerContext) -> None:
        super().__init__(context)
        self._found = found_in(context.settings, 'settings')
        self._wear = self._value('wear_gain', 1.0)
        self._heavier = self._value('mass_kg', 1500.0) / 1500.0

    def _value(self, name: str, default: float) -> float:
        places = [each for each in self._found if each.rpartition('.')[2] == name]
        return self._found[places[0]] if places else default

    def update(self, measurement: Measurement) -> Command:
        command = super().update(measurement)
        found = {**self._found, **found_in(measurement, 'measurement')}
        status = tuple((key, repr(value)) for key, value in sorted(found.items()))
        return Command(command.clutch_torque, status, command.engine_torque)

    def clutch(self, measurement: Measurement, request: float) -> float:
        feedback = request - measurement.open_loop_torque
        begun = min(self.elapsed_s / BLEND_S, 1.0)
        of_wear = 1.0 + (1.0 / self._wear - 1.0) * begun
        return of_wear * (measurement.open_loop_torque + self._heavier * feedback)

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`least_jerk` with other options and constants than the packaged ones."""

from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from unittest.mock import patch

from ddct_controllers.least_jerk import (
    actuator_model,
    controller,
    demand_trend,
    torque_estimate,
    torque_plan,
)
from ddct_controllers.least_jerk.controller import NAME

_MODULES = (actuator_model, controller, demand_trend, torque_estimate, torque_plan)


@dataclass(frozen=True)
class Variant:
    """The controller with some options and constants changed."""

    label: str
    options: Mapping[str, float] = field(default_factory=dict)
    """Options of the scenario's section."""
    constants: Mapping[str, float] = field(default_factory=dict)
    """Constants of its modules, by name."""

    @property
    def changes(self) -> dict[str, float]:
        """Changes of a scenario that give the options."""
        return {f'controllers.{NAME}.{key}': value for key, value in self.options.items()}

    @contextmanager
    def constants_changed(self) -> Iterator[None]:
        """Change the constants, in all modules that have them, until the context ends."""
        with ExitStack() as changed:
            for module in _MODULES:
                for name, value in self.constants.items():
                    if hasattr(module, name):
                        changed.enter_context(patch.object(module, name, value))
            yield

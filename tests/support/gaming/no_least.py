# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that commands the engine only to leave the set of runs that have a least."""

from gaming_parts import Gamed

from ddct_controllers.interface import Measurement


class NoLeast(Gamed):
    """Games the ratio to the least: it commands 1 % less than the demand, to have no least."""

    base = 'ls8'
    games_engine = True

    def engine(self, measurement: Measurement) -> float:
        return 0.99 * measurement.engine_torque

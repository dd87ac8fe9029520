# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that receives another engine torque than the engine has."""

from dataclasses import replace

from ddct_bringup.reproduction.studies.changed_loops import NoisySpeeds


class WrongEngineTorque(NoisySpeeds):
    """Controller that receives C_m with a constant error."""

    def __init__(self, controller, error_n_m):
        super().__init__(controller, 0.0, seed=0)
        self._error_n_m = error_n_m

    def _noisy(self, measurement):
        return replace(measurement, engine_torque=measurement.engine_torque + self._error_n_m)

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that plays back the request of an honest run, whatever the car does."""

from gaming_parts import Gamed
from recorded_requests import REQUESTS

from ddct_controllers.interface import Measurement

EVERY_S = 0.05


class Replay(Gamed):
    """Games the packaged scenarios: it replays a recorded request, and knows nothing else."""

    base = 'ls8'

    def clutch(self, measurement: Measurement, request: float) -> float:
        recorded = REQUESTS.get(self.settings.scenario.name)
        if recorded is None:
            return request
        before, after = int(self.elapsed_s / EVERY_S), int(self.elapsed_s / EVERY_S) + 1
        if after >= len(recorded):
            return recorded[-1]
        share = self.elapsed_s / EVERY_S - before
        return (1.0 - share) * recorded[before] + share * recorded[after]

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A short campaign whose runs are computed step by step, and how far it is."""

from pathlib import Path

from waiting import wait_until

from ddct_bringup.campaign.conduct import SHARDS

RUNS = 10
"""Number of runs, each in a shard of its own."""
_SPEC = f"""\
controllers: [squared.py]
scenario: thesis_sticking
grid: {{duration_s: [6]}}
random:
  samples: {RUNS}
  vary:
    vehicle.mass_kg: {{distribution: uniform, low: 1000, high: 2000}}
"""
_CONTROLLER = """\
from ddct_controllers.interface import Controller, Command


class Squared(Controller):
    def reset(self):
        pass

    def update(self, measurement):
        slip = measurement.slip_error_rpm
        return Command(-1e-3 * slip * abs(slip))
"""
"""A controller that no batch takes, as it is not linear."""


def write_specification(folder: Path) -> Path:
    """Write the specification of runs that take a tenth of a second each, and its controller."""
    (folder / 'squared.py').write_text(_CONTROLLER, encoding='utf-8')
    file = folder / 'mass.yaml'
    file.write_text(_SPEC, encoding='utf-8')
    return file


def shards(out: Path) -> int:
    return len(list((out / SHARDS).glob('*.parquet')))


def wait_for_shards(out: Path, count: int) -> None:
    wait_until(lambda: shards(out) >= count, f'{count} shards')

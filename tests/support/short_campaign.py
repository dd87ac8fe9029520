# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A short campaign, and how far it is."""

from pathlib import Path

from waiting import wait_until

from ddct_bringup.campaign.conduct import SHARDS

RUNS = 10
SPEC = f"""\
controllers: [ls8]
scenario: thesis_sticking
grid: {{duration_s: [6]}}
random:
  samples: {RUNS}
  vary:
    vehicle.mass_kg: {{distribution: uniform, low: 1000, high: 2000}}
"""


def shards(out: Path) -> int:
    return len(list((out / SHARDS).glob('*.parquet')))


def wait_for_shards(out: Path, count: int) -> None:
    wait_until(lambda: shards(out) >= count, f'{count} shards')

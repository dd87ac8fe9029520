# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Costs of commands as a user runs them: the graph beside a bare chain, all beside a commit."""

import json
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from bench.bags import READ, WRITE, bag_s
from bench.chain import chain_step_s
from bench.ratios import Comparison
from bench.workspaces import ROOT, bringup, run
from ddct_plant.base.timebase import PERIOD_S

STEPS = 1000
"""Steps of a lock-step run of the graph."""
SINGLE = '--single-process'
PROCESSES_STEP, SINGLE_STEP = 'graph: one process per node, step', 'graph: one process, step'
_HEADLESS = ('--headless', '--set', 'duration_s=20')
_CAMPAIGN = """\
controllers: [pi]
random:
  samples: 2000
  vary: {wear_gain: {distribution: uniform, low: 0.8, high: 1.2}}
"""


def step_s(workspace: Path, *options: str) -> float:
    """Return the wall time per step in s of a run by `bringup`, from first to last tick."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / 'run'
        steps = ('--set', f'duration_s={STEPS * PERIOD_S}')
        run(workspace, bringup(workspace), '--controller', 'pi', *steps, *options, '--out', out)
        (file,) = out.glob('*/timing.json')
        timing: dict[str, Any] = json.loads(file.read_text(encoding='utf-8'))
    return float(timing['wall_time_s']) / float(timing['steps'])


def program_s(workspace: Path, *command: object) -> float:
    """Return the wall time in s of `ddct` with a command that writes into `--out`."""
    with tempfile.TemporaryDirectory() as folder:
        started = time.monotonic()
        run(workspace, 'ddct', *command, '--out', Path(folder) / 'out')
        return time.monotonic() - started


def campaign_s(workspace: Path) -> float:
    """Return the wall time in s of a campaign of 2000 linear runs in one process."""
    with tempfile.TemporaryDirectory() as folder:
        spec = Path(folder) / 'campaign.yaml'
        spec.write_text(_CAMPAIGN, encoding='utf-8')
        return program_s(workspace, 'campaign', spec, '--workers', '1')


GRAPH = [
    Comparison(
        PROCESSES_STEP,
        'a bare rclpy chain',
        lambda: (partial(step_s, ROOT), partial(chain_step_s, STEPS)),
    ),
    Comparison(
        SINGLE_STEP,
        'a bare rclpy chain in one process',
        lambda: (partial(step_s, ROOT, SINGLE), partial(chain_step_s, STEPS, single=True)),
    ),
]


def beside(base: Path) -> list[Comparison]:
    """Return the comparisons of commands in this workspace with those in another one."""

    def compared(name: str, cost: Callable[..., float], *words: str) -> Comparison:
        sides = partial(cost, ROOT, *words), partial(cost, base, *words)
        return Comparison(name, 'the base commit', lambda: sides)

    one = ('--controllers', 'pi')
    demo = ('--controllers', 'pi,ls8,hinf1,mpc3,mpc4')
    stick_slip = ('--scenario', 'thesis_sticking')
    sticking = ('--controller', 'mpc3', *stick_slip)
    return [
        compared('bag read', bag_s, READ),
        compared('bag written', bag_s, WRITE),
        compared('bag read, sticking plates', bag_s, READ, *stick_slip),
        compared('bag written, sticking plates', bag_s, WRITE, *stick_slip),
        compared(PROCESSES_STEP, step_s),
        compared(SINGLE_STEP, step_s, SINGLE),
        compared('headless step of pi', step_s, *_HEADLESS),
        compared('headless step of mpc3, sticking plates', step_s, *_HEADLESS, *sticking),
        compared('compare of one, start and end included', program_s, 'compare', *one),
        compared('compare of the demo', program_s, 'compare', *demo),
        compared('campaign of 2000 linear runs', campaign_s),
    ]

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The processes of a bare chain: start them, read what the driveline measured, end them all."""

import json
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from bench.peers.bare_chain import EXAMPLES, WIRING, shift_wiring
from bench.skeleton.interruption import uninterrupted

from ddct_plant.graph.domain import own_domain

SCRIPT = Path(__file__).with_name('bare_chain.py')
TIMEOUT_S = 300.0
"""Timeout of a chain, s; it ends by itself when a message is lost."""
END_S = 20.0


@dataclass(frozen=True)
class Chain:
    """Bare chain of `nodes` nodes in `topics` topics, in one process or in one for each node."""

    steps: int
    single: bool = False
    nodes: int = len(WIRING)
    """Number of nodes; those beyond the graph's answer each tick on a topic of their own."""
    topics: int = len(EXAMPLES)
    """Number of topics of a tick before nodes are added; more are published by the driveline."""
    shift: bool = False
    """Whether it has the nodes and topics of a gear shift, whatever the two numbers are."""

    def step_s(self) -> float:
        """Return the wall time per step in s, as the driveline measured it."""
        return self.times()[0]

    def beside_steps_s(self) -> float:
        """Return the wall time in s of all processes less that of the steps."""
        step_s, whole_s = self.times()
        return whole_s - self.steps * step_s

    def times(self) -> tuple[float, float]:
        """Return the wall time per step and that from the start to the end of all, in s."""
        more = self.nodes - len(WIRING), self.topics - len(EXAMPLES)
        options = ['--more-nodes', str(more[0]), '--more-topics', str(more[1])]
        names = [*WIRING][:-1] + [f'more_{i}' for i in range(more[0])] + ['driveline']
        if self.shift:
            options, names = ['--shift'], [*shift_wiring()]
        started = time.monotonic()
        with own_domain():
            output = _output(['all'] if self.single else names, str(self.steps), *options)
        return json.loads(output)['step_s'], time.monotonic() - started


def _output(names: list[str], *arguments: str) -> str:
    """Run the chain, one process for each name; return what the last one prints."""
    processes = []
    try:
        for name in names:
            command = [sys.executable, str(SCRIPT), name, *arguments]
            with uninterrupted():
                processes.append(subprocess.Popen(command, stdout=subprocess.PIPE, text=True))
        output, _ = processes[-1].communicate(timeout=TIMEOUT_S)
    finally:
        for process in processes:
            process.terminate()
        for process in processes:
            try:
                process.wait(END_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
    if processes[-1].returncode:
        raise ChainError('the bare chain failed; its reason is above')
    return output


class ChainError(Exception):
    """A bare chain did not end well."""

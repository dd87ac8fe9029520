# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The two sides of a soak, at once in the same minutes: the graph, and the bare chain."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from bench.peers.bare_chain import WIRING
from bench.skeleton.workspace import ROOT, Workspace, started
from soak.process_use import children_by_module

from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.graph.domain import own_domain

CHAIN = 'bench.peers.paced_chain'
_MODULES = {node.module: node.name for node in GRAPH_NODES} | {
    'ddct_bringup.processes.forks': 'warm parent',
    'ddct_bringup.processes.guardian': 'guardian',
}
_DOMAIN = 'ROS_DOMAIN_ID'


class SoakError(Exception):
    """A side did not end well."""


@dataclass(frozen=True)
class Graph:
    """A real-time run by `ddct bringup` with a recorder, a process for each node."""

    process: subprocess.Popen[bytes]
    out: Path
    errors: IO[bytes]

    def pids(self) -> dict[str, int]:
        """Return the process ids by name, those that are there by now."""
        return {'bringup': self.process.pid, **children_by_module(_MODULES, self.process.pid)}

    def result(self) -> Mapping[str, Any]:
        """Wait for the end and return `timing.json`, also of a run that missed too many steps."""
        self.process.wait()
        found = list(self.out.glob('*/timing.json'))
        if len(found) != 1:
            self.errors.seek(0)
            raise SoakError(f'the graph has no timing: {self.errors.read().decode().strip()}')
        return json.loads(found[0].read_text(encoding='utf-8'))


@contextmanager
def graph(steps: int, options: Sequence[str]) -> Iterator[Graph]:
    """Start a run of PI with further options of `bringup`; end what is left of it."""
    ours = Workspace(ROOT)
    # It finds a domain of its own, beside that of the chain.
    environment = {key: text for key, text in ours.environment.items() if key != _DOMAIN}
    with (
        tempfile.TemporaryDirectory(prefix='soak-') as folder,
        tempfile.TemporaryFile() as output,
        tempfile.TemporaryFile() as errors,
    ):
        out = Path(folder) / 'run'
        command = ['ddct', 'bringup', '--controller', 'pi', '--mode', 'realtime']
        command += ['--floors', 'none', '--set', f'duration_s={steps * PERIOD_S}']
        command += [*options, '--out', str(out)]
        with started(command, ROOT, environment, output, errors) as process:
            yield Graph(process, out, errors)


@dataclass(frozen=True)
class Chain:
    """The bare chain at 100 Hz, a process for each node."""

    processes: Mapping[str, subprocess.Popen[bytes]]
    output: IO[bytes]

    def result(self) -> Mapping[str, Any]:
        """Wait for the end of the driveline and return what it has measured."""
        if self.processes['driveline'].wait():
            raise SoakError('the bare chain failed; its reason is above')
        self.output.seek(0)
        return json.loads(self.output.read())


@contextmanager
def chain(steps: int) -> Iterator[Chain]:
    """Start the bare chain; end its processes."""
    with ExitStack() as stack:
        os.environ.pop(_DOMAIN, None)
        stack.enter_context(own_domain())
        paths = [str(ROOT / 'tests'), os.environ.get('PYTHONPATH', '')]
        environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(filter(None, paths))}
        output = stack.enter_context(tempfile.TemporaryFile())
        errors = os.fdopen(os.dup(sys.stderr.fileno()), 'wb')
        stack.enter_context(errors)
        processes = {}
        for name in WIRING:
            command = [sys.executable, '-P', '-m', CHAIN, name, str(steps)]
            processes[name] = stack.enter_context(
                started(command, ROOT, environment, output, errors)
            )
        yield Chain(processes, output)

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

from bench.chain import WIRING
from bench.workspaces import ROOT, bringup, environment_of, started
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.graph.domain import own_domain
from soak.process_use import Sample, samples_below

_DOMAIN = 'ROS_DOMAIN_ID'


class SoakError(Exception):
    """A side did not end well."""


@dataclass(frozen=True)
class Graph:
    """A real-time run by `bringup` with a recorder, a process for each node."""

    process: subprocess.Popen[bytes]
    out: Path
    errors: IO[bytes]

    def samples(self) -> dict[str, Sample]:
        """Return what its processes have used so far, by name."""
        return samples_below(self.process.pid)

    def result(self) -> Mapping[str, Any]:
        """Wait for the end and return `timing.json`, also of a run that missed too many steps."""
        self.process.wait()
        found = list(self.out.glob('*/timing.json'))
        if len(found) != 1:
            self.errors.seek(0)
            raise SoakError(f'the graph has no timing: {self.errors.read().decode().strip()}')
        timing: Mapping[str, Any] = json.loads(found[0].read_text(encoding='utf-8'))
        return timing


@contextmanager
def graph(steps: int, prefix: Sequence[str]) -> Iterator[Graph]:
    """Start a run of PI by a command before `bringup`; end what is left of it."""
    # It finds a domain of its own, beside that of the chain.
    environment = {key: text for key, text in environment_of(ROOT).items() if key != _DOMAIN}
    with (
        tempfile.TemporaryDirectory(prefix='soak-') as folder,
        tempfile.TemporaryFile() as output,
        tempfile.TemporaryFile() as errors,
    ):
        out = Path(folder) / 'run'
        command = [*prefix, str(bringup(ROOT)), '--controller', 'pi', '--mode', 'realtime']
        command += ['--floors', 'none', '--set', f'duration_s={steps * PERIOD_S}']
        command += ['--out', str(out)]
        with started(command, environment, output, errors) as process:
            yield Graph(process, out, errors)


@dataclass(frozen=True)
class Chain:
    """The bare chain at 100 Hz, a process for each node."""

    driveline: subprocess.Popen[bytes]
    output: IO[bytes]

    def result(self) -> Mapping[str, Any]:
        """Wait for the end of the driveline and return what it has measured."""
        if self.driveline.wait():
            raise SoakError('the bare chain failed; its reason is above')
        self.output.seek(0)
        measured: Mapping[str, Any] = json.loads(self.output.read())
        return measured


@contextmanager
def chain(steps: int) -> Iterator[Chain]:
    """Start the bare chain; end its processes."""
    with ExitStack() as stack:
        os.environ.pop(_DOMAIN, None)
        stack.enter_context(own_domain())
        output = stack.enter_context(tempfile.TemporaryFile())
        errors = stack.enter_context(os.fdopen(os.dup(sys.stderr.fileno()), 'wb'))
        for name in WIRING:
            command = [sys.executable, '-P', '-m', 'soak.paced_chain', name, str(steps)]
            process = stack.enter_context(started(command, os.environ, output, errors))
        yield Chain(process, output)

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Faults of the machine and of the program `bringup` itself, which runs as users run it."""

import os
import resource
import signal
import subprocess
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from faults.campaign.case import (
    CLUTCHES,
    ENDED_BY_FAULT,
    INSTANTS,
    LONG,
    RUNS_ON,
    SAME,
    Case,
    Observed,
    Stated,
    either,
    named,
    safe_state,
)
from faults.campaign.leftovers import Leftovers
from faults.campaign.process_runs import at_step
from support.processes import Program, Programs, children_of

from ddct_plant.base.timebase import time_of_step

END_S = 90.0
SLOW = """
import time

from ddct_controllers.interface import Command, Controller


class Slow(Controller):
    def reset(self):
        self.number = 0

    def update(self, measurement):
        self.number += 1
        if 5 < self.number < 25:
            time.sleep(0.1)
        return Command(-0.1 * measurement.slip_error_rpm)
"""


def options_of(case: Case, out: Path, controller: str = '') -> list[str]:
    """Return the options of `bringup` for the run of a case."""
    run = case.run
    shift = ['--scenario', 'upshift', '--clutch', 'stick_slip'] if case.clutches == 2 else []
    return [
        *('--controller', controller or run.name, '--mode', case.mode, *shift),
        *('--duration', f'{time_of_step(case.steps):g}', '--out', str(out)),
    ]


@contextmanager
def started(folder: Path, options: list[str], **of_process: Any) -> Iterator[Program]:
    """Start `bringup`; what is still there at the end is killed."""
    programs = Programs(folder / f'printed_{options[-1].rpartition("/")[2]}')
    try:
        yield programs.start_module('ddct_bringup.programs.bringup', *options, **of_process)
    finally:
        programs.kill()


def observe(case: Case, program: Program, out: Path, seen: Observed) -> Observed:
    """Wait for the end of `bringup` and read what it printed and recorded."""
    code = program.wait(END_S)
    errors = program.errors()
    lines = [line for line in errors.splitlines() if line.startswith('ddct bringup: ')]
    if code not in (0, None) and not seen.error:
        seen.error = (lines[-1] if lines else f'code {code}').partition('; its log')[0]
    if 'Traceback' in errors:
        seen.left.append('a traceback')
    name = case.run.name
    final, partial_ = out / name, out / f'{name}.partial'
    seen.read(final if final.exists() else partial_, case.run)
    seen.complete = seen.complete or final.exists()
    seen.left += Leftovers().found()
    return seen


def kill_bringup(case: Case, folder: Path) -> Observed:
    """Kill `bringup` with SIGKILL at a step; its nodes must end by themselves."""
    seen, leftovers, out = Observed(), Leftovers(), folder / 'out'
    running: list[Program] = []

    def act(step: int) -> None:
        seen.fault_step = step
        for pid in children_of(running[0].process.pid):
            leftovers.note(pid)
        running[0].send(signal.SIGKILL)

    with at_step(case.begin, act), started(folder, options_of(case, out)) as program:
        running.append(program)
        code = program.wait(END_S)
        seen.error = 'killed' if code == -signal.SIGKILL else ''
        # The nodes finish what they write; the bag of a finished recorder can then be read.
        found = leftovers.found()
        observe(case, program, out, seen)
    seen.left = found
    return seen


def with_environment(changes: Mapping[str, str | None], case: Case, folder: Path) -> Observed:
    """Record a run with other environment variables; None removes one."""
    environment = {**os.environ, **{key: value for key, value in changes.items() if value}}
    for key in [key for key, value in changes.items() if value is None]:
        environment.pop(key, None)
    out = folder / 'out'
    with started(folder, options_of(case, out), env=environment) as program:
        return observe(case, program, out, Observed())


def with_limit(what: int, limit: int, case: Case, folder: Path) -> Observed:
    """Record a run under a limit of the kernel."""
    out = folder / 'out'

    def impose() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(what, (limit, limit))

    with started(folder, options_of(case, out), preexec_fn=impose) as program:
        return observe(case, program, out, Observed())


def on_a_full_disk(case: Case, folder: Path) -> Observed:
    """Record a run on a disk with room for its first steps; root alone can mount one."""
    disk = folder / 'disk'
    disk.mkdir()
    mount = ['mount', '-t', 'tmpfs', '-o', 'size=200k', 'tmpfs', str(disk)]
    done = subprocess.run(mount, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return Observed(error=f'not tried, a disk cannot be mounted: {done.stderr.strip()}')
    try:
        with started(folder, options_of(case, disk / 'out')) as program:
            return observe(case, program, disk / 'out', Observed())
    finally:
        subprocess.run(['umount', str(disk)], check=True)


def two_graphs(case: Case, folder: Path) -> Observed:
    """Record two runs at once on one domain."""
    outs = [folder / 'out', folder / 'other']
    with (
        started(folder, options_of(case, outs[0])) as first,
        started(folder, options_of(case, outs[1])) as second,
    ):
        both = [
            observe(case, program, out, Observed())
            for program, out in zip((first, second), outs, strict=True)
        ]
    # The one that ended worse counts.
    return min(both, key=lambda seen: (bool(seen.error) or seen.same_hash, not seen.error))


def slow_controller(case: Case, folder: Path) -> Observed:
    """Record a run whose controller takes 0.1 s for some steps."""
    file, out = folder / 'slow.py', folder / 'out'
    file.write_text(SLOW, encoding='utf-8')
    seen = Observed(fault_step=70)
    with started(folder, options_of(case, out, str(file))) as program:
        code = program.wait(END_S)
        errors = program.errors().splitlines()
    (bag,) = out.glob('Slow*')
    seen.read(bag, replace(case.run, controller=str(file)))
    # In real time a run with a safe state is recorded and not valid, with code 1.
    seen.error = errors[-1] if code and case.mode == 'lockstep' else ''
    return seen


ONE_LINE = Stated(
    'an error of one line',
    lambda seen: seen.error.startswith('ddct bringup: ') and not seen.complete,
)
KILLED = Stated(
    'the nodes end, the recording is no result',
    lambda seen: seen.error == 'killed' and not seen.complete,
)
ENVIRONMENTS: Mapping[str, Mapping[str, str | None]] = {
    'no HOME': {'HOME': None},
    'HOME that does not exist': {'HOME': '/no/such/folder'},
    'no TMPDIR': {'TMPDIR': None, 'TEMP': None, 'TMP': None},
    'TMPDIR that does not exist': {'TMPDIR': '/no/such/folder'},
    'locale with decimal comma': {'LC_ALL': 'de_DE.UTF-8', 'LANG': 'de_DE.UTF-8'},
    'no locale': {'LC_ALL': 'C', 'LANG': None},
}
FEW_FILES = (20, 40, 64, 256)


def cases() -> Iterator[Case]:
    """Yield the faults of the program and of its surroundings."""
    for clutches in CLUTCHES:
        for mode, instant in [*(('lockstep', each) for each in INSTANTS), ('realtime', 'middle')]:
            common = ('bringup', instant, mode, clutches)
            steps = ENDED_BY_FAULT if mode == 'lockstep' else LONG
            yield Case('killed by SIGKILL', *common, KILLED, kill_bringup, steps)
        lockstep = ('bringup', '', 'lockstep', clutches)
        full = named('No space left on device')
        yield Case('full disk', *lockstep, full, on_a_full_disk, 2000)
        both = either(SAME, ONE_LINE)
        yield Case('two graphs on one domain', *lockstep, both, two_graphs, LONG)
    lockstep = ('bringup', '', 'lockstep', 1)
    large = partial(with_limit, resource.RLIMIT_FSIZE, 200 * 1024)
    yield Case('limit on the size of files', *lockstep, named('File too large'), large, 2000)
    for files in FEW_FILES:
        few = partial(with_limit, resource.RLIMIT_NOFILE, files)
        yield Case(f'{files} file descriptors', *lockstep, either(SAME, ONE_LINE), few)
    for what, changes in ENVIRONMENTS.items():
        stated = either(SAME, named('HOME')) if 'no HOME' in what else SAME
        yield Case(what, *lockstep, stated, partial(with_environment, changes))
    slow = ('controller', 'middle')
    yield Case('slow controller', *slow, 'lockstep', 1, SAME, slow_controller)
    late = either(safe_state('actuator', within_s=0.3), RUNS_ON)
    yield Case('slow controller', *slow, 'realtime', 1, late, slow_controller)

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs of the program `bringup` under a fault of it or of its surroundings."""

import os
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from support.processes import Program, Programs, children_of

from ddct_plant.base.timebase import time_of_step
from faults.case import Case
from faults.leftovers import Leftovers
from faults.outcome import NEVER, Observed
from faults.process_runs import at_step

END_S = 90.0
COMMA = 'de_DE.UTF-8'
SLOW_FROM = 65
"""Step from which the slow controller is slow."""
SLOW = """
import time

from ddct_controllers.interface import Command, Controller


class Slow(Controller):
    def reset(self):
        pass

    def update(self, measurement):
        if 65 <= measurement.step < 85:
            time.sleep(0.1)
        return Command(-0.1 * measurement.slip_error_rpm)
"""


def options_of(case: Case, out: Path, controller: str = '') -> list[str]:
    """Return the options of `bringup` for the run of a case."""
    run = case.run
    shift = ['--scenario', 'upshift'] if case.clutches == 2 else []
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
    lines = [line for line in errors.splitlines() if line.startswith('bringup: ')]
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
    seen, leftovers, out = Observed(fault_step=NEVER), Leftovers(), folder / 'out'
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


def with_comma(case: Case, folder: Path) -> Observed:
    """Record a run in a locale with a decimal comma, which is built here."""
    built = folder / 'locales' / COMMA
    built.parent.mkdir()
    build = ['localedef', '-i', 'de_DE', '-f', 'UTF-8', str(built)]
    changes = {'LOCPATH': str(built.parent), 'LC_ALL': COMMA, 'LANG': COMMA}
    check = 'import locale as l; l.setlocale(l.LC_ALL, ""); print(l.localeconv()["decimal_point"])'
    try:
        subprocess.run(build, capture_output=True, check=True)
        shown = subprocess.run(
            [sys.executable, '-c', check],
            env={**os.environ, **changes},
            capture_output=True,
            text=True,
            check=True,
        )
    except (OSError, subprocess.CalledProcessError) as error:
        return Observed(error=f'not tried, the locale cannot be built: {error}')
    if shown.stdout != ',\n':
        return Observed(error='not tried, the locale has no decimal comma')
    return with_environment(changes, case, folder)


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
    seen = Observed(fault_step=SLOW_FROM)
    with started(folder, options_of(case, out, str(file))) as program:
        code = program.wait(END_S)
        errors = program.errors().splitlines()
    (bag,) = out.glob('Slow*')
    seen.read(bag, replace(case.run, controller=str(file)))
    # A real-time run with a safe state ends with this line and its recording.
    expected_end = case.mode == 'realtime' and ' not valid: ' in errors[-1]
    seen.error = errors[-1] if code and not expected_end else ''
    return seen

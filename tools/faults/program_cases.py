# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Faults of the machine and of the program `bringup` itself, which runs as users run it."""

import resource
from collections.abc import Iterator, Mapping
from functools import partial

from faults.case import ENDED_BY_FAULT, LONG, Case
from faults.outcome import RUNS_ON, SAME, Stated, either, named, safe_state
from faults.program_runs import (
    kill_bringup,
    on_a_full_disk,
    slow_controller,
    two_graphs,
    with_comma,
    with_environment,
    with_limit,
)

ONE_LINE = Stated(
    'an error of one line',
    lambda seen: seen.error.startswith('bringup: ') and not seen.complete,
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
    'no locale': {'LC_ALL': 'C', 'LANG': None},
}
FEW_FILES = (20, 64)
"""Fewer than the program needs, and than the nodes need."""
KILLED_AT = (
    *(('lockstep', instant, 1) for instant in ('start', 'middle', 'end')),
    ('realtime', 'middle', 1),
)


def _ends(mode: str, *otherwise: Stated) -> Stated:
    """Return that the run is as undisturbed; in real time a busy machine may miss steps of it."""
    usual = [SAME] if mode == 'lockstep' else [RUNS_ON, named('not valid:')]
    return either(*usual, *otherwise)


def cases() -> Iterator[Case]:
    """Yield the faults of the program and of its surroundings."""
    for mode, instant, clutches in KILLED_AT:
        steps = ENDED_BY_FAULT if mode == 'lockstep' else LONG
        yield Case(
            *('killed by SIGKILL', 'bringup', instant, mode, clutches, KILLED, kill_bringup, steps)
        )
    for mode in ('lockstep', 'realtime'):
        whole = ('bringup', '', mode, 1)
        full = named('No space left on device')
        yield Case('full disk', *whole, full, on_a_full_disk, 2000)
        both = _ends(mode, ONE_LINE)
        yield Case('two graphs on one domain', *whole, both, two_graphs, LONG)
        late = SAME if mode == 'lockstep' else safe_state('actuator')
        yield Case('slow controller', 'controller', 'middle', mode, 1, late, slow_controller)
    whole = ('bringup', '', 'lockstep', 1)
    large = partial(with_limit, resource.RLIMIT_FSIZE, 200 * 1024)
    yield Case('limit on the size of files', *whole, named('File too large'), large, 2000)
    for files in FEW_FILES:
        few = partial(with_limit, resource.RLIMIT_NOFILE, files)
        yield Case(f'{files} file descriptors', *whole, _ends('lockstep', ONE_LINE), few)
    for what, changes in ENVIRONMENTS.items():
        otherwise = [named('HOME')] if what == 'no HOME' else []
        stated = _ends('lockstep', *otherwise)
        yield Case(what, *whole, stated, partial(with_environment, changes))
    yield Case('locale with decimal comma', *whole, _ends('lockstep'), with_comma)

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Faults of the machine and of the program `bringup` itself, which runs as users run it."""

import resource
from collections.abc import Iterator, Mapping
from functools import partial
from itertools import product

from faults.campaign.case import CLUTCHES, ENDED_BY_FAULT, INSTANTS, LONG, MODES, Case
from faults.campaign.outcome import RUNS_ON, SAME, Stated, either, named, safe_state
from faults.campaign.program_runs import (
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
    'no locale': {'LC_ALL': 'C', 'LANG': None},
}
FEW_FILES = (20, 40, 64, 256)


def _ends(mode: str, *otherwise: Stated) -> Stated:
    """Return that the run is as undisturbed; in real time a busy machine may miss steps of it."""
    usual = [SAME] if mode == 'lockstep' else [RUNS_ON, named('not valid:')]
    return either(*usual, *otherwise)


def cases() -> Iterator[Case]:
    """Yield the faults of the program and of its surroundings."""
    for clutches, mode in product(CLUTCHES, MODES):
        for instant in INSTANTS:
            common = ('bringup', instant, mode, clutches)
            steps = ENDED_BY_FAULT if mode == 'lockstep' else LONG
            yield Case('killed by SIGKILL', *common, KILLED, kill_bringup, steps)
        whole = ('bringup', '', mode, clutches)
        full = named('No space left on device')
        yield Case('full disk', *whole, full, on_a_full_disk, 2000)
        both = _ends(mode, ONE_LINE)
        yield Case('two graphs on one domain', *whole, both, two_graphs, LONG)
        large = partial(with_limit, resource.RLIMIT_FSIZE, 200 * 1024)
        yield Case('limit on the size of files', *whole, named('File too large'), large, 2000)
        for files in FEW_FILES:
            few = partial(with_limit, resource.RLIMIT_NOFILE, files)
            yield Case(f'{files} file descriptors', *whole, _ends(mode, ONE_LINE), few)
        for what, changes in ENVIRONMENTS.items():
            stated = _ends(mode, named('HOME')) if what == 'no HOME' else _ends(mode)
            yield Case(what, *whole, stated, partial(with_environment, changes))
        yield Case('locale with decimal comma', *whole, _ends(mode), with_comma)
        late = SAME if mode == 'lockstep' else safe_state('actuator')
        yield Case(
            'slow controller', 'controller', 'middle', mode, clutches, late, slow_controller
        )

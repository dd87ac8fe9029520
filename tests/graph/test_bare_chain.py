# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The bare chain of `make bench` starts with every node matched, and has a timeout."""

import json
import sys
from pathlib import Path

from support.processes import Program, Programs

CHAIN = Path(__file__).parents[1] / 'bench' / 'peers' / 'bare_chain.py'


def _start(programs: Programs, *arguments: str) -> Program:
    return programs.start([sys.executable, str(CHAIN), *arguments])


def test_a_chain_that_lacks_nodes_ends_and_names_them(programs: Programs) -> None:
    others = [_start(programs, 'engine', '10')]
    driveline = _start(programs, 'driveline', '10', '1.5')
    assert driveline.wait() == 1
    (line,) = driveline.errors().splitlines()
    assert line.startswith('bare_chain: not ready after 1.5 s: engine, load, reference')
    assert not driveline.output()
    others[0].stop()


def test_all_nodes_in_one_process_do_their_steps(programs: Programs) -> None:
    chain = _start(programs, 'all', '10')
    assert chain.wait() == 0, chain.errors()
    assert json.loads(chain.output())['step_s'] > 0.0

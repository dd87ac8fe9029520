# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The bare chain of `make bench` starts with every node matched, and has a timeout."""

import json
import sys
from pathlib import Path

from soak.sides import chain as paced_chain
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


def test_the_paced_chain_measures_every_tick() -> None:
    with paced_chain(100) as chain:
        result = chain.result()
    assert result['steps'] == 100
    assert 0 <= result['missed_steps'] <= 100
    counted = {name: sum(each['counts'].values()) for name, each in result['durations'].items()}
    assert 0 < counted['jitter'] < counted['lateness'] <= 100
    assert 0 < counted['latency'] <= 100
    if not result['missed_steps']:
        assert counted == {'lateness': 100, 'jitter': 99, 'latency': 99}

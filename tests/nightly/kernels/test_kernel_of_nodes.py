# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes use the kernel of the program that starts them, so a graph has the bits of headless."""

import os
import subprocess
import sys

import pytest
from support.trajectory_hashes import KERNEL, THREADS

RUNS = """
import ddct_bringup.api as api
for headless in (True, False):
    print(api.run('ls8', duration=0.8, headless=headless).trajectory.sha256())
"""


@pytest.mark.parametrize('first', ['', 'import numpy\n'], ids=['program', 'notebook'])
def test_a_graph_has_the_bits_of_headless_also_where_numpy_was_loaded_first(first: str) -> None:
    environment = {name: os.environ[name] for name in {*os.environ} - {KERNEL, THREADS}}
    done = subprocess.run(
        [sys.executable, '-c', first + RUNS],
        env={**environment, 'PYTHONPATH': ':'.join(sys.path)},
        capture_output=True,
        text=True,
        check=True,
    )
    headless, graph = done.stdout.split()
    assert headless == graph

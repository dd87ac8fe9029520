# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Hashes of the trajectories of controllers, headless, in a process of their own.

    . install/setup.bash; .venv/bin/python tests/support/trajectory_hashes.py

writes those of all controllers, and the arithmetic that they were computed with, beside this
file. Do so when trajectories have changed on purpose.
"""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from importlib import import_module
from pathlib import Path

from ddct_bringup.run.headless import run_headless
from ddct_controllers.registry import own_controller_names
from ddct_plant.program.arithmetic import Arithmetic, arithmetic
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SCENARIOS = ('thesis', 'launch', 'upshift_light')
KERNEL, THREADS = 'OPENBLAS_CORETYPE', 'OPENBLAS_NUM_THREADS'
"""Environment variables of OpenBLAS."""
HASWELL = 'Haswell'
"""Kernel that every process uses where the processor has it."""
_numpy = import_module('numpy._core._multiarray_umath')
HAS_HASWELL = bool(_numpy.__cpu_features__.get('AVX2'))
FEATURES = tuple(_numpy.__cpu_dispatch__)
"""Features of processors that numpy has code for, the oldest first."""
STORED = Path(__file__).with_suffix('.json')
_COMPUTING = ('python', 'numpy', 'scipy', 'control', 'daqp', 'osqp')
"""Packages on whose versions these runs depend."""


@dataclass(frozen=True)
class Hashes:
    """SHA-256 of trajectories by scenario and controller, and their arithmetic."""

    arithmetic: Arithmetic
    trajectories: dict[str, str]

    def as_stored(self) -> dict[str, str] | None:
        """Return the stored hashes of these runs; None where arithmetic but kernels differs."""
        stored = _of_text(STORED.read_text(encoding='utf-8'))
        if _apart_from_kernel(stored.arithmetic) != _apart_from_kernel(self.arithmetic):
            return None
        return {name: stored.trajectories[name] for name in self.trajectories}


def hashes_here(controllers: Sequence[str]) -> Hashes:
    """Return the hashes that this process computes."""
    return Hashes(
        arithmetic(),
        {
            f'{scenario} {controller}': run_headless(
                RunSettings(KnownSettings(load_scenario(scenario))), controller
            ).sha256()
            for scenario in SCENARIOS
            for controller in controllers
        },
    )


def hashes_with(controllers: Sequence[str], **variables: str) -> Hashes:
    """Return the hashes of another process, whose environment has these variables."""
    environment = {name: os.environ[name] for name in {*os.environ} - {KERNEL, THREADS}}
    done = subprocess.run(
        [sys.executable, __file__, *controllers],
        env={**environment, 'PYTHONPATH': ':'.join(sys.path), **variables},
        capture_output=True,
        text=True,
        check=True,
    )
    return _of_text(done.stdout)


def _apart_from_kernel(found: Arithmetic) -> tuple[str, ...]:
    versions = (found.versions.get(name, 'none') for name in _COMPUTING)
    return (found.blas, found.libc, found.machine, *versions)


def _of_text(text: str) -> Hashes:
    found = json.loads(text)
    return Hashes(Arithmetic(**found['arithmetic']), found['trajectories'])


if __name__ == '__main__':
    if sys.argv[1:]:
        print(json.dumps(asdict(hashes_here(sys.argv[1:]))))
    else:
        new = json.dumps(asdict(hashes_with(own_controller_names())), indent=1)
        STORED.write_text(f'{new}\n', encoding='utf-8')

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A copy of the sources in which something is added as CONTRIBUTING shows it."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
SENSOR = {'sensors.vehicle_accel.bias_m_s2': 0.5, 'sensors.vehicle_accel.dropout': 0.5}
SETTINGS = f"""
import sys
from pathlib import Path
import numpy as np
from ddct_bringup.run.headless import run_headless
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

scenario = load_scenario('thesis', {{'duration_s': 1.0, 'score_window_s': [0.7, 1.0], **{SENSOR}}})
settings = RunSettings(KnownSettings(scenario))
run = run_headless(settings, 'pi')
"""


def diffs(title: str) -> list[str]:
    """Return the diffs of a section of the page."""
    page = (ROOT / 'CONTRIBUTING.md').read_text(encoding='utf-8')
    section = page.partition(f'### {title}\n')[2].partition('\n## ')[0].partition('\n### ')[0]
    return re.findall(r'```diff\n(.*?)```', section, re.DOTALL)


def apply(title: str, tree: Path) -> dict[str, str]:
    """Apply the diffs of a section to a copy of the sources; return the environment to run it."""
    for package in PACKAGES:
        # With what Python has compiled of them.
        shutil.copytree(ROOT / package / package, tree / package / package)
    (diff,) = diffs(title)
    # Outside of a repository `git apply` changes the files below the working directory.
    environment = {**os.environ, 'GIT_CEILING_DIRECTORIES': str(tree.parent)}
    subprocess.run(
        ['git', 'apply', '-'], input=diff, text=True, cwd=tree, env=environment, check=True
    )
    path = [str(tree / package) for package in PACKAGES]
    return {**environment, 'PYTHONPATH': os.pathsep.join([*path, os.environ['PYTHONPATH']])}


def output_of(code: str, tree: Path, environment: dict[str, str]) -> list[str]:
    """Return the lines that code prints, which must not fail."""
    done = subprocess.run(
        [sys.executable, '-c', code], cwd=tree, env=environment, capture_output=True, text=True
    )
    assert not done.returncode, done.stderr
    return done.stdout.splitlines()

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The search of the example for learners gives a controller that engages."""

import subprocess
import sys
from pathlib import Path

import pytest
from support.documented import ROOT

from ddct_bringup.api import run

pytest.importorskip('gymnasium', reason='Gymnasium, an optional extra, is absent: EXTRAS=gym')
EXAMPLE = ROOT / 'docs' / 'examples' / 'learn_launch.py'


def test_a_missing_folder_is_refused_before_the_search(tmp_path: Path) -> None:
    command = [sys.executable, str(EXAMPLE), str(tmp_path / 'missing' / 'learnt.py')]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 2 and done.stderr.endswith('in a folder that exists\n')


def test_half_of_the_search_learns_to_engage_worn_and_new_clutches(tmp_path: Path) -> None:
    learnt = tmp_path / 'learnt.py'
    subprocess.run([sys.executable, str(EXAMPLE), str(learnt), '8'], check=True, timeout=600)
    states = {
        wear: run(str(learnt), scenario='launch', wear_gain=wear).state for wear in (0.7, 1.0, 1.3)
    }
    assert set(states.values()) == {'engaged'}

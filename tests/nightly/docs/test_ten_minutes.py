# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The ten minutes from a log to a judged controller, as the page shows them, and the check."""

import json
import shutil
from pathlib import Path

import pytest
from support.documented import blocks
from support.documented_commands import OF_OWN_CAR
from support.documented_shell import run_lines, shell_environment

pytest.importorskip('optuna', reason='an extra: make setup EXTRAS=tune')


def test_a_log_becomes_a_car_a_tuned_controller_and_a_result_that_verifies_elsewhere(
    workplace: Path, install: Path, tmp_path: Path
) -> None:
    at_home, at_a_colleague = (each for each in blocks() if OF_OWN_CAR in each.text)
    environment = shell_environment(workplace, install)
    run_lines(at_home.lines, workplace, environment)
    result = json.loads((workplace / 'mine' / 'result' / 'result.json').read_text())
    (judged,) = result['controllers']
    success = {each['controller']: each for each in judged['held_out']['groups']}
    assert success['pi_tuned']['runs'] == success['pi']['runs'] > 20
    shutil.move(workplace / 'mine.tar.gz', tmp_path)
    shutil.rmtree(workplace / 'mine')
    run_lines(at_a_colleague.lines, tmp_path, environment)

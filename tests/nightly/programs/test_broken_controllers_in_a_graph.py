# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A graph names the controller that failed in it, and keeps its log."""

import json
from pathlib import Path

import pytest
from support.complaints import assert_one_line
from support.processes import Programs
from support.third_party import SUPPORT, install_broken


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    install_broken(monkeypatch, tmp_path / 'site')


@pytest.mark.usefixtures('broken')
def test_a_graph_names_the_controller_whose_status_is_no_text(
    programs: Programs, tmp_path: Path
) -> None:
    run = programs.start_module(
        'ddct_bringup.programs.bringup',
        *('--controller', 'bad_status', '--out', str(tmp_path / 'runs')),
    )
    assert run.wait() == 1
    words = "controller 'bad_status': its status at step 60 is (('iterations', 3),)"
    place = f'{SUPPORT}/broken_controllers.py line '
    assert_one_line(run.errors(), 'bringup', 'node controller', words, place)


@pytest.mark.usefixtures('broken')
def test_compare_keeps_and_names_the_log_of_a_run_that_failed_in_the_graph(
    programs: Programs, tmp_path: Path
) -> None:
    out = tmp_path / 'runs'
    run = programs.start_module(
        'ddct_bringup.programs.compare',
        *('--controllers', 'raising,pi', '--duration', '1', '--out', str(out)),
    )
    assert run.wait() == 1
    log = out / 'raising' / 'work' / 'controller.log'
    assert str(log) in run.errors()
    assert 'Traceback' in log.read_text(encoding='utf-8')
    bad, good = json.loads((out / 'scores.json').read_text())['runs']
    assert "controller 'raising': it failed at step 60" in bad['reason']
    assert bad['reason'].endswith('its log is work/controller.log')
    assert (bad['valid'], good['valid']) == (False, True)

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller in C runs in the graph as headless, and what it does to its process is named."""

import json
from pathlib import Path

import numpy as np
import pytest
from support.c_controllers import counting, failing, harmful
from support.exported_mpc import compile_c
from support.processes import processes_left
from support.runs import bag_bytes, expected, plan, record

from ddct_bringup.processes import supervisor
from ddct_bringup.programs import bringup, compare
from ddct_bringup.run.execution import execute
from ddct_controllers.mpc.export.export_controller import export_controller
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.program.supervision import Patience

TOLERANCE_N_M = 1e-6
"""Tolerance between the C and Python of one controller, N m, as in tests/export."""
EXIT, LOOP = ('controllers.harmful.fault=1',), ('controllers.harmful.fault=4',)
CALL = ' when update was called at step 65'


@pytest.mark.compiler
def test_the_end_of_its_process_is_that_of_its_node(tmp_path: Path) -> None:
    run = plan(harmful(tmp_path), duration_s=0.7, changes=EXIT)
    with pytest.raises(DdctError, match=f'^node controller ended with code 0{CALL}; '):
        record(run, tmp_path / 'runs')


@pytest.mark.compiler
def test_all_nodes_in_one_process_give_the_bytes_of_headless(tmp_path: Path) -> None:
    file, bags = counting(tmp_path), []
    for layout in ('single-process', 'headless'):
        record(plan(file, layout, duration_s=0.7), tmp_path / layout)
        bags.append(bag_bytes(tmp_path / layout))
    assert bags[0] == bags[1]
    assert not (tmp_path / 'single-process' / 'work').exists()


@pytest.mark.compiler
def test_an_error_of_a_node_in_the_process_of_all_nodes_is_its_reason(tmp_path: Path) -> None:
    run = plan(failing(tmp_path), 'single-process', duration_s=0.7)
    words = 'the process of all nodes ended with code 1: node controller: .*'
    failure = 'it returned -3 when update was called at step 65: mend the C; its log is '
    with pytest.raises(DdctError, match=f'^{words}{failure}'):
        record(run, tmp_path / 'run')


@pytest.mark.compiler
def test_exit_with_code_0_in_the_process_of_all_nodes_fails_the_run_with_its_reason(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    given = ['--controller', harmful(tmp_path), '--single-process', '--duration', '0.7']
    out = tmp_path / 'runs'
    assert bringup.main([*given, '--set', *EXIT, '--out', str(out)]) == 1
    *_, last = capfd.readouterr().err.splitlines()
    log = out / 'harmful.partial' / 'work' / 'all_nodes.log'
    ended = f'the process of all nodes ended with code 0{CALL}'
    assert last == f'bringup: {ended}; its log is {log}'
    assert log.exists()


@pytest.mark.compiler
@pytest.mark.slow
@pytest.mark.nightly
def test_a_crash_of_all_nodes_ends_its_own_run_of_a_comparison(tmp_path: Path) -> None:
    given = ['--controllers', f'pi,{harmful(tmp_path)},ls8', '--single-process']
    given += ['--set', 'controllers.harmful.fault=3', '--duration', '0.7', '--floors', 'none']
    assert compare.main([*given, '--out', str(tmp_path / 'runs')]) == 1
    runs = json.loads((tmp_path / 'runs' / 'scores.json').read_text(encoding='utf-8'))['runs']
    assert [run['valid'] for run in runs] == [True, False, True]
    assert f'the process of all nodes was killed by SIGSEGV{CALL}' in runs[1]['reason']


@pytest.mark.compiler
def test_a_loop_without_end_in_the_process_of_all_nodes_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(supervisor, 'PATIENCE', Patience(silent_s=2.0))
    run = plan(harmful(tmp_path), 'single-process', duration_s=0.7, changes=LOOP)
    with pytest.raises(DdctError, match=f'^the process of all nodes hung{CALL} and ended itself'):
        record(run, tmp_path / 'run')
    assert not processes_left()


@pytest.mark.compiler
def test_an_interruption_ends_the_process_of_all_nodes_and_what_it_has_recorded_stays(
    tmp_path: Path,
) -> None:
    folder = tmp_path / 'run'
    folder.mkdir()
    run = plan(harmful(tmp_path), 'single-process', duration_s=20.0)
    with pytest.raises(KeyboardInterrupt):
        execute(run, folder, lambda: any(folder.glob('*.mcap')))
    assert (folder / 'metadata.yaml').exists()
    assert not processes_left()


@pytest.mark.nightly
@pytest.mark.compiler
def test_the_exported_mpc_run_back_through_the_graph_is_that_of_python(tmp_path: Path) -> None:
    original = plan('mpc3')
    controller = make_controller('mpc3', original.settings.known)
    folder = tmp_path / 'c'
    export_controller(controller, 'mpc3', original.settings.known, folder)
    sources = ('ddct_mpc.c', 'ddct_mpc_library.c')
    compile_c(folder, '-O2', '-shared', '-fPIC', *sources, '-o', 'ddct_mpc.so')
    (folder / 'mpc.yaml').write_text('name: mpc3_in_c\nc_library: {file: ddct_mpc.so}\n')
    run = plan(str(folder / 'mpc.yaml'))
    found = record(run, tmp_path / 'runs').trajectory
    assert found.sha256() == expected(run).sha256()
    error = found.torque_request - expected(original).torque_request
    assert np.abs(error).max() <= TOLERANCE_N_M

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller in C runs in the graph like its Python original."""

from pathlib import Path

import numpy as np
import pytest
from support.c_controllers import harmful
from support.exported_mpc import compile_c
from support.runs import expected, plan, record

from ddct_controllers.mpc.export.export_controller import export_controller
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError

TOLERANCE_N_M = 1e-6
"""Tolerance between the C and Python of one controller, N m, as in tests/export."""


@pytest.mark.compiler
def test_the_end_of_its_process_is_that_of_its_node(tmp_path: Path) -> None:
    run = plan(harmful(tmp_path), duration_s=0.7, changes=('controllers.harmful.fault=1',))
    with pytest.raises(DdctError, match='^node controller ended with code 0; '):
        record(run, tmp_path / 'runs')


@pytest.mark.compiler
def test_the_exported_mpc_run_back_through_the_graph_is_that_of_python(tmp_path: Path) -> None:
    original = plan('mpc3')
    controller = make_controller('mpc3', original.settings)
    folder = tmp_path / 'c'
    export_controller(controller, 'mpc3', original.settings, folder)
    sources = ('ddct_mpc.c', 'ddct_mpc_library.c')
    compile_c(folder, '-O2', '-shared', '-fPIC', *sources, '-o', 'ddct_mpc.so')
    (folder / 'mpc.yaml').write_text('name: mpc3_in_c\nc_library: {file: ddct_mpc.so}\n')
    run = plan(str(folder / 'mpc.yaml'))
    found = record(run, tmp_path / 'runs').trajectory
    assert found.sha256() == expected(run).sha256()
    error = found.torque_request - expected(original).torque_request
    assert np.abs(error).max() <= TOLERANCE_N_M

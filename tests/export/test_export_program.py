# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`ddct design mpc --export`, as a user calls it."""

from pathlib import Path

import pytest
from support.exported_mpc import compile_c

from ddct_controllers.workflows.design_program import main


def test_it_writes_c_that_compiles_and_prints_its_files(tmp_path, capsys):
    folder = tmp_path / 'new' / 'c'
    changes = ['--set', 'controllers.mpc4.control_steps=2', '--architecture', 'feedforward']
    code = main(['mpc', '--export', str(folder), '--controller', 'mpc4', *changes])
    assert code == 0
    printed = [Path(line) for line in capsys.readouterr().out.splitlines()]
    assert sorted(printed) == sorted(folder.iterdir())
    header = (folder / 'ddct_mpc.h').read_text()
    assert 'Predictive slip controller mpc4 ' in header
    assert 'architecture feedforward.' in header
    assert '#define DDCT_MPC_MOVES 4\n' in header
    compile_c(folder, 'ddct_mpc.c', 'ddct_mpc_example.c', '-o', 'example')


def test_mpc3_is_what_is_exported_by_default(tmp_path, capsys):
    assert main(['mpc', '--export', str(tmp_path / 'c')]) == 0
    assert 'Predictive slip controller mpc3 ' in (tmp_path / 'c' / 'ddct_mpc.c').read_text()


@pytest.mark.parametrize(
    ('options', 'error'),
    [
        (['--controller', 'pi'], 'pi cannot be exported: it is not a predictive controller'),
        (['--controller', 'nobody'], "unknown controller 'nobody'"),
        (['--controller', 'mpc_wear'], 'the C has no '),
        (['--set', 'controllers.mpc3.control_steps=40'], 'control_steps is 40, longer than'),
    ],
)
def test_a_controller_that_cannot_be_exported_is_one_line_and_no_folder(
    tmp_path, capsys, options, error
):
    folder = tmp_path / 'c'
    assert main(['mpc', '--export', str(folder), *options]) == 1
    printed = capsys.readouterr().err
    assert error in printed
    assert printed.startswith('ddct design: ')
    assert printed.count('\n') == 1
    assert not folder.exists()


def test_a_second_export_needs_overwrite(tmp_path, capsys):
    export = ['mpc', '--export', str(tmp_path / 'c')]
    assert main(export) == 0
    capsys.readouterr()
    assert main([*export, '--controller', 'mpc1']) == 1
    assert 'choose a new folder or add --overwrite' in capsys.readouterr().err
    assert main([*export, '--controller', 'mpc1', '--overwrite']) == 0
    assert 'Predictive slip controller mpc1 ' in (tmp_path / 'c' / 'ddct_mpc.h').read_text()


@pytest.mark.parametrize('options', [[], ['--controller', 'mpc3'], ['--overwrite']])
def test_options_of_an_export_without_its_folder_are_refused(capsys, options):
    with pytest.raises(SystemExit) as end:
        main(['mpc', *options])
    assert end.value.code == 2
    (error,) = capsys.readouterr().err.splitlines()
    assert '--export' in error

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers that can be exported, and folders into which they can."""

import pytest
from refusals import refused
from support.exported_mpc import NOT_IN_C, compile_c, run_settings

from ddct_controllers.mpc.export.export_controller import export_controller
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError, ParameterError


@pytest.mark.parametrize('name', ['pi', 'hinf1', *sorted(NOT_IN_C)])
def test_a_controller_that_does_other_things_is_refused(tmp_path, name):
    settings = run_settings()
    with refused(ParameterError, name):
        export_controller(
            make_controller(name, settings.known), name, settings.known, tmp_path / 'c'
        )
    assert not (tmp_path / 'c').exists()


def test_the_same_controller_is_exported_to_the_same_bytes(tmp_path):
    settings = run_settings()
    written = [
        export_controller(
            make_controller('mpc3', settings.known), 'mpc3', settings.known, tmp_path / folder
        )
        for folder in ('first', 'second')
    ]
    assert [file.name for file in written[0]] == [
        'ddct_mpc.h',
        'ddct_mpc.c',
        'ddct_mpc_example.c',
        'ddct_mpc_library.c',
        'ddct_controller.h',
    ]
    contents = [[file.read_bytes() for file in files] for files in written]
    assert contents[0] == contents[1]


def test_a_folder_that_holds_something_is_kept(tmp_path):
    settings = run_settings()
    controller = make_controller('mpc3', settings.known)
    (tmp_path / 'notes.txt').write_text('mine')
    with pytest.raises(DdctError, match=r'holds notes\.txt; choose a new folder'):
        export_controller(controller, 'mpc3', settings.known, tmp_path)
    (tmp_path / 'ddct_mpc.c').write_text('int mine;')
    with pytest.raises(DdctError, match=r'ddct_mpc\.c is no such export'):
        export_controller(controller, 'mpc3', settings.known, tmp_path, overwrite=True)
    assert (tmp_path / 'ddct_mpc.c').read_text() == 'int mine;'
    (tmp_path / 'ddct_mpc.c').unlink()
    for _ in range(2):
        export_controller(controller, 'mpc3', settings.known, tmp_path, overwrite=True)
    assert (tmp_path / 'notes.txt').read_text() == 'mine'


def test_a_folder_that_cannot_be_is_an_error(tmp_path):
    settings = run_settings()
    controller = make_controller('mpc3', settings.known)
    (tmp_path / 'file').write_text('')
    for folder in (tmp_path / 'file', tmp_path / 'file' / 'c'):
        with pytest.raises(DdctError, match='cannot be'):
            export_controller(controller, 'mpc3', settings.known, folder)


def test_a_name_cannot_break_out_of_the_comment(tmp_path):
    settings = run_settings()
    controller = make_controller('mpc3', settings.known)
    name = '*/ #error /* \\\n é'
    export_controller(controller, name, settings.known, tmp_path / 'c')
    compile_c(tmp_path / 'c', '-c', 'ddct_mpc.c')

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`verify` repeats a shift with the file of its handover, and with no other one."""

import json
from pathlib import Path
from typing import Any

import pytest
from verified import HANDOVER, copied, make_bag, states, verified

from ddct_bringup.digests.digest_file import DIGESTS, read_digests

pytestmark = pytest.mark.slow
SHIFT = ('--controller', 'pi', '--scenario', 'upshift', '--clutch', 'stick_slip')


def test_a_handover_file_is_found_beside_the_folder_or_by_its_option(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / 'work' / 'mine.py'
    file.parent.mkdir()
    file.write_text(HANDOVER, encoding='utf-8')
    make_bag(tmp_path / 'work' / 'runs', *SHIFT, '--handover', str(file))
    (tmp_path / 'work').rename(tmp_path / 'moved')
    moved = tmp_path / 'moved' / 'runs' / 'pi'
    code, document, errors = verified(moved, capfd)
    assert (code, states(document), errors) == (0, {'pi': 'same_bits'}, '')
    elsewhere = copied(moved, tmp_path / 'elsewhere' / 'deep' / 'pi')
    code, _, errors = verified(elsewhere, capfd)
    assert code == 1
    assert 'the handover file' in errors
    assert 'mine.py is gone: put it back, or name its folder with --files' in errors
    assert verified(elsewhere, capfd, '--files', str(tmp_path / 'moved'))[0] == 0


def test_a_changed_handover_is_refused_before_it_runs(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / 'mine.py'
    file.write_text(HANDOVER, encoding='utf-8')
    runs = make_bag(tmp_path / 'runs', *SHIFT, '--handover', str(file))
    ran = tmp_path / 'ran'
    file.write_text(f'open({str(ran)!r}, "w").close()\n', encoding='utf-8')
    code, _, errors = verified(runs / 'pi', capfd)
    assert code == 1
    assert f'handover {file}: handover_file has changed since' in errors
    assert not ran.exists(), 'code of another file has run'


def test_a_changed_module_beside_a_handover_is_named_as_the_cause(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file, helper = tmp_path / 'mine.py', tmp_path / 'helper.py'
    file.write_text(f'import helper\n{HANDOVER}', encoding='utf-8')
    helper.write_text('SHARE = 1.0\n', encoding='utf-8')
    runs = make_bag(tmp_path / 'runs', *SHIFT, '--handover', str(file))
    assert verified(runs / 'pi', capfd)[0] == 0
    helper.write_text('SHARE = 0.9\n', encoding='utf-8')
    code, _, errors = verified(runs / 'pi', capfd)
    assert code == 1
    assert f'handover {file}: helper.py has changed since' in errors


def test_the_digests_of_a_run_without_a_handover_file_are_those_of_before(
    tmp_path: Path,
) -> None:
    folder = make_bag(tmp_path / 'runs', *SHIFT, '--handover', 'timed') / 'pi'
    content: Any = json.loads((folder / DIGESTS).read_text(encoding='utf-8'))
    assert set(content['runs']['.']) == {'scenario', 'controller', 'controller_files'}
    assert read_digests(folder).runs['.'].handover is None

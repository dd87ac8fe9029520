# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`verify` repeats a shift with the file of its handover, and with no other one."""

import shutil
from pathlib import Path

import pytest
from samples import sampled
from verified import HANDOVER, make_bag, states, verified

pytestmark = pytest.mark.slow
SHIFT = ('--controller', 'pi', '--scenario', 'upshift')


@pytest.mark.parametrize('module', sampled([True, False], every=2))
def test_a_result_carries_the_file_of_its_handover(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], module: bool
) -> None:
    work = tmp_path / 'work'
    work.mkdir()
    file = work / 'mine.py'
    file.write_text(f'import helper\n{HANDOVER}' if module else HANDOVER, encoding='utf-8')
    if module:
        (work / 'helper.py').write_text('SHARE = 1.0\n', encoding='utf-8')
    make_bag(tmp_path / 'runs', *SHIFT, '--handover', str(file))
    shutil.rmtree(work)
    moved = (tmp_path / 'runs' / 'pi').rename(tmp_path / 'moved')
    code, document, errors = verified(moved, capfd)
    assert (code, states(document), errors) == (0, {'moved': 'same_bits'}, '')
    ran = tmp_path / 'ran'
    carried = moved / 'inputs' / 'mine.py'
    carried.write_text(f'open({str(ran)!r}, "w").close()\n', encoding='utf-8')
    code, _, errors = verified(moved, capfd)
    assert code == 1
    assert f'{carried}: altered' in errors
    assert not ran.exists(), 'code of another file has run'

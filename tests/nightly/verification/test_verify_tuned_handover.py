# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A tuning of gear shifts is repeated with the file of its handover, and with no other one."""

import shutil
from pathlib import Path

import pytest
from small_tuning import made_tuning
from verified import HANDOVER

from ddct_bringup.programs.verify import main as verify
from ddct_controllers.from_file.with_options import with_options_text

DURATION = {'distribution': 'choice', 'values': [2.5]}


def test_a_tuning_carries_the_file_of_its_handover(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / 'place'
    place.mkdir()
    (place / 'own.py').write_text(HANDOVER, encoding='utf-8')
    controller = place / 'pi_again.yaml'
    controller.write_text(with_options_text('pi_again', 'pi', {}), encoding='utf-8')
    cases = {
        'scenario': 'upshift',
        'grid': {'handover': ['own.py']},
        'random': {'samples': 1, 'vary': {'duration_s': DURATION}},
    }
    changes = {'constraints': {'engaged': {'at_least': 0.0}}, 'campaign': cases, 'trials': 2}
    folder = made_tuning(place / 'out', controller=str(controller), folder=place, **changes)
    moved = folder.rename(tmp_path / 'moved')
    shutil.rmtree(place)
    assert verify([str(moved), '--workers', '1']) == 0, capfd.readouterr().err
    ran = tmp_path / 'ran'
    carried = moved / 'inputs' / 'own.py'
    carried.write_text(f'open({str(ran)!r}, "w").close()\n', encoding='utf-8')
    assert verify([str(moved), '--workers', '1']) == 1
    assert f'{carried}: altered' in capfd.readouterr().err
    assert not ran.exists(), 'code of another file has run'

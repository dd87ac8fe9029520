# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A tuning is repeated: its trials, its files, its held-out runs, and its front."""

import json
from pathlib import Path
from typing import Any

import pytest
from python_controllers import IMPORTS, PROPORTIONAL
from small_tuning import leave_out_pictures, made_tuning
from verified import copied, edit_json_with_digest, edit_with_digest

from ddct_bringup.programs.verify import main as verify
from ddct_controllers.from_file.with_options import with_options_text

pytestmark = pytest.mark.slow


@pytest.fixture(autouse=True)
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    leave_out_pictures(monkeypatch)


@pytest.fixture(scope='module')
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with pytest.MonkeyPatch.context() as patch:
        leave_out_pictures(patch)
        return made_tuning(tmp_path_factory.mktemp('tuning') / 'out', trials=10)


def states(folder: Path, to: Path) -> dict[str, str]:
    """Return the states of what was repeated, by name."""
    verify([str(folder), '--json', str(to), '--workers', '1'])
    found = json.loads(to.read_text())
    assert not found['error']
    return {each['run']: each['state'] for each in found['runs']}


def test_a_tuning_comes_out_again_where_it_was_moved_to(finished: Path, tmp_path: Path) -> None:
    found = states(copied(finished, tmp_path / 'elsewhere' / 'copy'), tmp_path / 'found.json')
    assert {'trials 0 to 7', 'trials 8 to 9', 'front.json', 'controller files'} <= found.keys()
    assert set(found.values()) == {'same_bits'}


def _better(entries: list[dict[str, Any]]) -> None:
    name = next(iter(entries[1]['objectives']))
    entries[1]['objectives'][name] = 0.01


def _other_state(entries: list[dict[str, Any]]) -> None:
    entries[-1]['state'] = 'feasible' if entries[-1]['state'] != 'feasible' else 'infeasible'


def _better_front(result: dict[str, Any]) -> None:
    figures = result['front'][0]['held_out']['objectives']
    figures[next(iter(figures))] = 0.01


def test_every_edit_with_its_digest_is_found(finished: Path, tmp_path: Path) -> None:
    folder = copied(finished, tmp_path / 'copy')
    edit_json_with_digest(folder, 'shards/000000.json', _better)
    edit_json_with_digest(folder, 'shards/000001.json', _other_state)
    edit_json_with_digest(folder, 'trials.json', _better)
    edit_json_with_digest(folder, 'front.json', _better_front)
    text = (folder / 'best.yaml').read_text()
    changed = text.replace('proportional_gain: 0.', 'proportional_gain: 1.')
    assert changed != text
    edit_with_digest(folder, 'best.yaml', changed.encode())
    found = states(folder, tmp_path / 'found.json')
    edited = ('trials 0 to 7', 'trials 8 to 9', 'controller files', 'front.json')
    assert {name for name, state in found.items() if state == 'different'} == {
        *edited,
        'trials.json, runs.parquet',
    }


def test_a_changed_controller_is_refused_before_it_runs(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / 'mine.py').write_text(IMPORTS + PROPORTIONAL, encoding='utf-8')
    outer = tmp_path / 'outer.yaml'
    outer.write_text(with_options_text('outer', 'mine.py', {}), encoding='utf-8')
    folder = made_tuning(
        tmp_path / 'out',
        controller=str(outer),
        parameters={'gain': {'low': 0.05, 'high': 0.5}},
        constraints={'engaged': {'at_least': 0.0}},
        trials=2,
    )
    ran = tmp_path / 'ran'
    other = f'open({str(ran)!r}, "w").close()\n'
    (tmp_path / 'mine.py').write_text(other, encoding='utf-8')
    assert verify([str(folder), '--workers', '1']) == 1
    assert 'base_controller_file has changed since' in capfd.readouterr().err
    assert not ran.exists(), 'code of another file has run'

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A tuning is repeated: its trials, its files, its held-out runs, and its front."""

import json
import shutil
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as parquet
import pytest
from by_schema import require_schemas
from python_controllers import IMPORTS, PROPORTIONAL
from small_tuning import campaign_of, leave_out_pictures, made_tuning
from verified import copied, edit_json_with_digest, edit_manifest, edit_with_digest

from ddct_bringup.campaign.columns import parquet_bytes
from ddct_bringup.programs.verify import main as verify
from ddct_bringup.tuning.study import JOURNAL
from ddct_bringup.tuning.tables import TRIALS
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


def test_the_files_of_a_tuning_are_as_their_schemas(finished: Path) -> None:
    require_schemas(finished, {'manifest.json': 'manifest_tuning', 'front.json': 'tune'})


def test_a_tuning_comes_out_again_where_it_was_moved_to(finished: Path, tmp_path: Path) -> None:
    found = states(copied(finished, tmp_path / 'elsewhere' / 'copy'), tmp_path / 'found.json')
    names = {'manifest.json', 'shards', 'front.json', TRIALS, 'best.yaml', 'report.html'}
    assert {*names, 'held_out/results.parquet'} <= found.keys()
    assert JOURNAL not in found  # it has times on the wall clock
    assert set(found.values()) == {'same_bits'}


def edit_table(folder: Path, name: str, column: str, value: float) -> None:
    """Replace the first value of a column of a table, and its digest too."""
    table = parquet.read_table(folder / name)
    place = table.column_names.index(column)
    values = pa.array([value, *table[column].to_pylist()[1:]], table.schema.types[place])
    changed = table.set_column(place, table.schema.field(place), values)
    edit_with_digest(folder, name, parquet_bytes(changed))


def _better_front(result: dict[str, Any]) -> None:
    figures = result['front'][0]['held_out']['objectives']
    figures[next(iter(figures))] = 0.01


def test_every_edit_with_its_digest_is_found(finished: Path, tmp_path: Path) -> None:
    folder = copied(finished, tmp_path / 'copy')
    edit_table(folder, 'shards/000001.parquet', 'engagement_time_s', 0.01)
    edit_table(folder, TRIALS, 'engagement_time_s', 0.01)
    edit_json_with_digest(folder, 'front.json', _better_front)
    text = (folder / 'best.yaml').read_text()
    changed = text.replace('proportional_gain: 0.', 'proportional_gain: 1.')
    assert changed != text
    edit_with_digest(folder, 'best.yaml', changed.encode())
    found = states(folder, tmp_path / 'found.json')
    assert {name for name, state in found.items() if state == 'different'} == {
        *('shards', TRIALS, 'front.json', 'best.yaml')
    }


@pytest.mark.nightly
def test_an_edited_search_seed_is_found(finished: Path, tmp_path: Path) -> None:
    def other_seed(content: dict[str, Any]) -> None:
        content['plan']['spec']['seed'] += 1

    folder = copied(finished, tmp_path / 'copy')
    edit_manifest(folder, other_seed)
    found = states(folder, tmp_path / 'found.json')
    assert found['shards'] == found[TRIALS] == 'different'


@pytest.mark.nightly
def test_an_edited_name_of_the_controller_is_found(finished: Path, tmp_path: Path) -> None:
    def other_name(content: dict[str, Any]) -> None:
        content['plan']['controller']['name'] = 'mine'

    folder = copied(finished, tmp_path / 'copy')
    edit_manifest(folder, other_name)
    assert states(folder, tmp_path / 'found.json')['manifest.json'] == 'different'


def test_a_tuning_carries_its_controller(tmp_path: Path) -> None:
    work = tmp_path / 'work'
    work.mkdir()
    (work / 'mine.py').write_text(IMPORTS + PROPORTIONAL, encoding='utf-8')
    outer = work / 'outer.yaml'
    outer.write_text(with_options_text('outer', 'mine.py', {}), encoding='utf-8')
    folder = made_tuning(
        tmp_path / 'out',
        controller=str(outer),
        parameters={'gain': {'low': 0.05, 'high': 0.5}},
        constraints={'engaged': {'at_least': 0.0}},
        objectives={'torsion_speed_std_rpm': {}},
        campaign=campaign_of(3),
        trials=2,
    )
    shutil.rmtree(work)
    moved = folder.rename(tmp_path / 'moved')
    assert set(states(moved, tmp_path / 'found.json').values()) == {'same_bits'}
    for file in moved.rglob('*'):
        assert not file.is_file() or str(tmp_path).encode() not in file.read_bytes(), file

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A benchmark in another car has our controllers in all its cases, and carries the car's files."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from small_benchmark import content_of, judge, result_in
from small_tuning import leave_out_pictures
from verified import states, verified

from ddct_bringup.benchmark import cases
from ddct_bringup.benchmark.cases import SPECIFICATION
from ddct_bringup.benchmark.file_names import PAGE
from ddct_bringup.benchmark.release import ROWS

pytestmark = pytest.mark.slow
SPEC = """\
controllers: [pi, ls8]
seed: 1
grid:
  scenario: [launch, tip_in]
  duration_s: [2.0]
random:
  samples: 2
  vary:
    vehicle.mass_kg: {distribution: uniform, low: 1200, high: 1950}
"""


@pytest.fixture(scope='module')
def place(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Yield a folder with a car, its base, and the benchmark of `ls4` on few cases in it."""
    folder = tmp_path_factory.mktemp('small')
    packaged = folder / 'packaged'
    for each in (packaged, folder / 'cars' / 'bases'):
        each.mkdir(parents=True)
    (packaged / SPECIFICATION).write_text(SPEC, encoding='utf-8')
    (folder / 'cars' / 'bases' / 'small.yaml').write_text('base: city7\n', encoding='utf-8')
    car = folder / 'cars' / 'mine.yaml'
    car.write_text('base: bases/small.yaml\nvehicle: {mass_kg: 1000}\n', encoding='utf-8')
    with pytest.MonkeyPatch.context() as patch:
        leave_out_pictures(patch)
        patch.setattr(cases, 'packaged_folder', lambda: packaged)
        assert judge(folder / 'first', 'ls4', '--car', str(car)) == 0
        yield folder


def test_the_controllers_beside_run_in_the_development_cases_of_the_car(place: Path) -> None:
    result = result_in(place / 'first')
    found = result['cases']
    assert (found['car'], found['scenarios']) == ('inputs/car/mine.yaml', ['launch'])
    assert found['release_rows'] is None
    assert found['left_out'].keys() == {'tip_in'}
    (judged,) = result['controllers']
    for summary in (result['development'], judged['held_out']):
        assert [(each['controller'], each['runs']) for each in summary['groups']] == [
            *(('ls4', 2), ('pi', 2), ('ls8', 2))
        ]
        assert [pair['second'] for pair in summary['pairs']] == ['pi', 'ls8']
    assert not (place / 'first' / ROWS).exists()
    page = (place / 'first' / PAGE).read_text(encoding='utf-8')
    assert 'the car of all cases is inputs/car/mine.yaml' in page
    assert 'tip_in is left out, since the car cannot drive it' in page


@pytest.mark.nightly
def test_a_result_that_moved_without_the_car_verifies(
    place: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = shutil.copytree(place / 'first', tmp_path / 'there')
    cars = shutil.move(place / 'cars', tmp_path / 'away')
    code, document, _ = verified(folder, capfd, '--workers', '1')
    shutil.move(cars, place / 'cars')
    assert code == 0
    assert set(states(document).values()) == {'same_bits'}
    base = folder / 'inputs' / 'car' / 'bases' / 'small.yaml'
    base.write_text('base: c635\n', encoding='utf-8')
    code, _, errors = verified(folder, capfd, '--workers', '1')
    assert (code, f'{base}: altered' in errors) == (1, True)


def test_the_same_command_goes_on_and_that_with_another_car_is_refused(
    place: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = shutil.copytree(place / 'first', tmp_path / 'there')
    before, car = content_of(folder), place / 'cars' / 'mine.yaml'
    for file in (folder / 'ls4' / 'held_out').rglob('*.parquet'):
        file.unlink()
    assert judge(folder, 'ls4', '--car', str(car)) == 0
    assert content_of(folder) == before
    assert 'pi, ls8 run in the development cases too: 12 runs' in capfd.readouterr().err
    assert judge(folder, 'ls4', '--car', 'city7') == 1
    assert 'with another --car' in capfd.readouterr().err
    changed = shutil.copytree(place / 'cars', tmp_path / 'cars')
    (changed / 'bases' / 'small.yaml').write_text('base: c635\n', encoding='utf-8')
    assert judge(folder, 'ls4', '--car', str(changed / 'mine.yaml')) == 1
    assert content_of(folder) == before


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        (None, 'cannot be read'),
        ('base: c635\nvehicle: {mass_kg: -1}\n', 'vehicle.mass_kg is -1'),
        ('base: c635\nclutch: linear\n', 'can drive no scenario of the benchmark; launch: '),
    ],
)
@pytest.mark.usefixtures('place')
def test_a_car_that_cannot_be_used_is_one_line(
    text: str | None, words: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    car = tmp_path / 'bad.yaml'
    if text is not None:
        car.write_text(text, encoding='utf-8')
    assert judge(tmp_path / 'out', 'ls4', '--car', str(car)) == 1
    (line,) = capfd.readouterr().err.splitlines()
    assert words in line
    assert not (tmp_path / 'out').exists()
    assert judge(tmp_path / 'out', 'ls4', '--car', 'city8') == 1
    (line,) = capfd.readouterr().err.splitlines()
    assert 'did you mean city7?' in line

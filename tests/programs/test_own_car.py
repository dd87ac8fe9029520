# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A log of a car that is not packaged becomes a car, runs, gains and a judgement, on few cases."""

import json
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from small_benchmark import judge, result_in
from verified import verified

from ddct_bringup.benchmark import cases
from ddct_bringup.benchmark.cases import SPECIFICATION
from ddct_bringup.identification.identify import main as identify
from ddct_bringup.programs import compare, tune
from ddct_plant.files.yaml_text import parse_yaml
from ddct_plant.scenario.file import load_scenario

pytestmark = pytest.mark.slow
pytest.importorskip('optuna', reason='an extra: make setup EXTRAS=tune')
EXAMPLE = Path(__file__).resolve().parents[2] / 'docs' / 'examples' / 'own_car'
TRUE = {'engine_inertia': 0.18, 'halfshaft_stiffness': 5400.0}
"""What the simulated car of the log has."""
SPEC = """\
parameters: {proportional_gain: {low: 0.05, high: 0.1}}
objectives: {peak_jerk_m_s3: {}}
constraints: {engaged: {at_least: 0.5}}
campaign: {grid: {scenario: [launch, tip_in], wear_gain: [0.9, 1.0]}}
trials: 2
"""
CASES = """\
controllers: [pi]
seed: 1
grid: {scenario: [launch, tip_in]}
random: {samples: 1, vary: {vehicle.mass_kg: {distribution: uniform, low: 1200, high: 1950}}}
"""


@pytest.fixture(scope='module')
def place(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Yield a folder with the log, a specification, and the car that `identify` has made."""
    folder = tmp_path_factory.mktemp('place') / 'mine'
    shutil.copytree(EXAMPLE, folder / 'data')
    (folder / 'data' / 'tuning.yaml').write_text(SPEC)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        log = ['--from', 'data/drive.csv', '--car', 'data/car.yaml']
        assert identify([*log, '--guess', 'data/columns.yaml']) == 0
        assert identify([*log, '--columns', 'data/columns.yaml', '--out', 'car']) == 0
        yield folder


def test_the_car_has_the_log_s_values_the_data_sheet_s_and_says_which(place: Path) -> None:
    text = (place / 'car' / 'drive_car.yaml').read_text()
    assert '# Not determined by the log: driveline.shaft_inertia' in text
    assert 'shaft_inertia' not in parse_yaml(text)['driveline']
    assert '# From car data/car.yaml: actuator, engine_limits.' in text
    scenario = load_scenario(car=str(place / 'car' / 'drive_car.yaml'), drive='upshift')
    for name, true in TRUE.items():
        assert getattr(scenario.driveline, name) == pytest.approx(true, rel=0.02), name
    assert scenario.vehicle.mass_kg == pytest.approx(1320.0, rel=0.01)
    assert scenario.gearbox.gear(1).total_ratio == pytest.approx(3.62 * 4.06, rel=1e-3)
    assert scenario.gearbox.gears == 6


@pytest.mark.usefixtures('no_page')
def test_it_launches_and_shifts(place: Path, capfd: pytest.CaptureFixture[str]) -> None:
    for drive in ('launch', 'upshift'):
        options = [
            '--controllers',
            'least_jerk,hinf2',
            '--car',
            'car/drive_car.yaml',
            '--headless',
        ]
        assert compare.main([*options, '--drive', drive, '--out', drive]) == 0
        run, _ = json.loads(Path(drive, 'scores.json').read_text())['runs']
        assert (run['state'], run['scenario']) == ('engaged', f'{drive}_drive_car')
        assert (
            'unstable with this car and a new clutch that slips: hinf2;' in capfd.readouterr().err
        )


def test_tuned_and_judged_in_it_the_results_verify_in_another_folder(
    place: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    (tmp_path / SPECIFICATION).write_text(CASES)
    monkeypatch.setattr(cases, 'packaged_folder', lambda: tmp_path)
    car = ['--car', 'car/drive_car.yaml']
    options = ['--controller', 'pi', '--spec', 'data/tuning.yaml', *car, '--workers', '1']
    assert tune.main([*options, '--out', 'tuned']) == 0
    assert 'tip_in is left out, since the car cannot drive it' in capfd.readouterr().err
    assert judge(Path('result'), 'tuned/best.yaml', *car) == 0
    assert result_in(Path('result'))['cases']['left_out'].keys() == {'tip_in'}
    elsewhere = shutil.copytree(place, tmp_path / 'elsewhere')
    monkeypatch.chdir(tmp_path)
    shutil.rmtree(place / 'data')
    for name in ('tuned', 'result'):
        code, document, _ = verified(elsewhere / name, capfd)
        assert (code, document['same']) == (0, True)

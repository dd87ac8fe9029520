# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A fit to an exact log of our own plant finds its car: driveline, wheel radius and mass."""

import json
from pathlib import Path

import numpy as np
import pytest
from samples import sampled
from support.logs import written
from support.runs import plan, record

from ddct_bringup.identification.from_log.base_car import drag_of
from ddct_bringup.identification.from_log.command import NEEDED
from ddct_bringup.identification.from_log.fit import fit_log
from ddct_bringup.identification.from_log.stretches import TORQUES
from ddct_bringup.identification.identify import main
from ddct_bringup.logs.columns import TIME, own_columns
from ddct_bringup.logs.log import SPEEDS, read_log
from ddct_bringup.scores.csv_text import signals_csv
from ddct_plant.scenario.file import load_scenario

pytestmark = pytest.mark.slow

RADIUS_M, MASS_KG = 0.298, 1310.0
OTHER_CAR = (f'vehicle.wheel_radius_m={RADIUS_M}', f'vehicle.mass_kg={MASS_KG}')


@pytest.fixture(scope='module')
def pi_bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the bag of a run of the thesis's car."""
    folder = tmp_path_factory.mktemp('own') / 'pi'
    record(plan('pi', 'headless', duration_s=3.0), folder)
    return folder


@pytest.fixture(scope='module')
def other_car(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a run of another car, as the bag `pi` and as `pi.csv`."""
    folder = tmp_path_factory.mktemp('other')
    recording = record(plan('pi', 'headless', duration_s=3.0, changes=OTHER_CAR), folder / 'pi')
    (folder / 'pi.csv').write_text(signals_csv(recording))
    return folder


@pytest.mark.parametrize('controller', sampled(['pi', 'ls8'], every=2))
def test_all_eight_parameters_of_an_exact_log_are_in_their_intervals(
    tmp_path: Path, pi_bag: Path, controller: str
) -> None:
    """
    The plant holds C_load over 10 ms. As linear it moves c_prim by 69 half-widths of its interval.

    A twentieth of the intervals miss by chance, and what is left is the rounding of the log.
    """
    bag = pi_bag if controller == 'pi' else tmp_path / controller
    if bag != pi_bag:
        record(plan(controller, 'headless', duration_s=3.0), bag)
    log = read_log(bag, own_columns(TIME, *NEEDED), NEEDED)
    thesis = load_scenario('thesis')
    fit = fit_log(log, thesis.driveline, drag_of(thesis))
    misses = 0
    for name, true in thesis.driveline.values().items():
        lowest, highest = fit.interval(name) or (1.0, -1.0)
        half = 0.5 * (highest - lowest)
        assert 0.0 < half < 1e-8 * max(true, 0.01), name
        assert abs(fit.values[name] - true) < 2.5 * half, name
        misses += not lowest <= true <= highest
    assert misses <= 1


def test_whole_newton_metres_do_not_determine_the_shaft_while_plates_slip(pi_bag: Path) -> None:
    """Taken as exact, they give J_p 2.4 times and c_sa 1.4 times, with intervals of 15 %."""
    log = read_log(pi_bag, own_columns(TIME, *NEEDED), NEEDED)
    for name, step in {**dict.fromkeys(SPEEDS, 0.02), **dict.fromkeys(TORQUES, 1.0)}.items():
        log.signals[name] = step * np.round(log.signals[name] / step)
    thesis = load_scenario('thesis')
    fit = fit_log(log, thesis.driveline, drag_of(thesis))
    assert 'shaft_inertia' in fit.undetermined
    for name in ('engine_inertia', 'halfshaft_stiffness', 'vehicle_inertia'):
        lowest, highest = fit.interval(name) or (np.nan, np.nan)
        assert lowest <= thesis.driveline.values()[name] <= highest, name


@pytest.mark.parametrize('log_name', sampled(['pi', 'pi.csv'], every=2))
def test_radius_and_mass_of_another_car_come_from_its_speeds(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], other_car: Path, log_name: str
) -> None:
    """With the radius of `thesis`, .3211 m, the mass would be 1128 kg and A_x 8 % high."""
    log, out = other_car / log_name, tmp_path / 'mine'
    options = ['--from', str(log), '--out', str(out), '--fix', 'engine_damping']
    assert main([*options, '--json', str(tmp_path / 'fit.json')]) == 0
    content = json.loads((tmp_path / 'fit.json').read_text())
    fixed = [row['name'] for row in content['parameters'] if row['state'] == 'fixed']
    assert fixed == ['engine_damping']
    radius = content['wheel_radius']
    assert radius['state'] == 'measured'
    assert radius['measured']['lowest_m'] <= RADIUS_M <= radius['measured']['highest_m']
    assert radius['value_m'] == pytest.approx(RADIUS_M, rel=1e-9)
    assert content['mass_kg'] == pytest.approx(MASS_KG, rel=1e-3)
    scenario = written(out, 'pi')
    assert scenario.vehicle.wheel_radius_m == pytest.approx(RADIUS_M, rel=1e-9)
    assert scenario.vehicle.mass_kg == pytest.approx(MASS_KG, rel=1e-3)
    printed = capsys.readouterr().out
    assert 'Wheel radius: 0.298 m (0.298 to 0.298), measured' in printed
    assert 'assum' not in printed


def test_a_radius_without_the_speed_of_the_car_is_called_an_assumption(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], other_car: Path
) -> None:
    log = tmp_path / 'pi.csv'
    lines = [line.split(',') for line in (other_car / log.name).read_text().splitlines()]
    place = lines[0].index('vehicle_speed_m_s')
    log.write_text('\n'.join(','.join(row[:place] + row[place + 1 :]) for row in lines) + '\n')
    options = ['--from', str(log), '--json', str(tmp_path / 'fit.json'), '--force']
    assert main(options) == 0
    content = json.loads((tmp_path / 'fit.json').read_text())
    assert content['wheel_radius']['state'] == 'assumed'
    assert content['wheel_radius']['measured'] is None
    (note,) = [each for each in content['notes'] if 'wheel radius' in each]
    assert 'is an assumption, that of thesis' in note
    assert '--set vehicle.wheel_radius_m=' in note
    assert 'assumed: that of thesis' in capsys.readouterr().out


@pytest.mark.parametrize(('given', 'contradicts'), [('0.298', False), ('0.31', True)])
def test_a_given_radius_is_used_and_one_that_the_log_contradicts_has_a_note(
    tmp_path: Path, other_car: Path, given: str, contradicts: bool
) -> None:
    log, report = other_car / 'pi.csv', tmp_path / 'fit.json'
    given_radius = ['--set', f'vehicle.wheel_radius_m={given}']
    assert main(['--from', str(log), '--json', str(report), '--force', *given_radius]) == 0
    content = json.loads(report.read_text())
    assert content['wheel_radius']['state'] == 'given'
    assert content['wheel_radius']['value_m'] == float(given)
    mass = MASS_KG * (RADIUS_M / float(given)) ** 2
    assert content['mass_kg'] == pytest.approx(mass, rel=1e-3)
    assert any('is given, and vehicle_speed' in each for each in content['notes']) == contradicts

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A column map is guessed from names, units and values, and its text is a column map."""

from pathlib import Path

import pytest

from ddct_bringup.logs.columns import load_columns
from ddct_bringup.logs.guess import Guess, guessed_columns
from ddct_bringup.logs.sources import source_of


def guessed(folder: Path, columns: dict[str, float]) -> Guess:
    """Return the guess of a CSV log whose columns have 0 and these values."""
    rows = [[0.0] * len(columns), [*columns.values()]]
    lines = [';'.join(columns), *(';'.join(map(str, row)) for row in rows)]
    (folder / 'a.csv').write_text('\n'.join(lines) + '\n')
    return guessed_columns(source_of(folder / 'a.csv'), 0.3, 200.0)


@pytest.mark.parametrize(
    ('columns', 'expected'),
    [
        (
            {'Zeit [ms]': 10, 'nMot [1/min]': 900, 'nGetrEing': 800, 'MdMot [%]': 50, 'MdKup': 90},
            {
                'time': ('Zeit [ms]', 'ms'),
                'engine_speed': ('nMot [1/min]', 'rpm'),
                'engine_torque': ('MdMot [%]', '%'),
                'clutch_torque': ('MdKup', 'N m'),
                'shaft_speed': ('nGetrEing', 'rpm'),
            },
        ),
        (
            {'t': 0.01, 'TCU_ClutchTrq': 9, 'TCU_ClutchTrqReq': 9, 'VehSpd_kmh': 9, 'EngSpd': 90},
            {
                'time': ('t', 's'),
                'clutch_torque': ('TCU_ClutchTrq', 'N m'),
                'torque_request': ('TCU_ClutchTrqReq', 'N m'),
                'vehicle_speed': ('VehSpd_kmh', 'km/h'),
                'engine_speed': ('EngSpd', 'rad/s'),
            },
        ),
        (
            {
                'time_s': 1,
                'Driver_Torque_Nm': 9,
                'Engine_Torque_Nm': 9,
                'AccelPedal': 9,
                'ax_g': 1,
            },
            {
                'time': ('time_s', 's'),
                'torque_demand': ('Driver_Torque_Nm', 'N m'),
                'engine_torque': ('Engine_Torque_Nm', 'N m'),
                'vehicle_accel': ('ax_g', 'g'),
            },
        ),
        (
            {'t_s': 1, 'N_IN1_rpm': 9, 'TQ_CL1_Nm': 9, 'V_VEH_kmh': 9},
            {
                'time': ('t_s', 's'),
                'clutch_torque': ('TQ_CL1_Nm', 'N m'),
                'shaft_speed': ('N_IN1_rpm', 'rpm'),
                'vehicle_speed': ('V_VEH_kmh', 'km/h'),
            },
        ),
    ],
)
def test_usual_names_are_taken_for_their_quantities(
    tmp_path: Path, columns: dict[str, float], expected: dict[str, tuple[str, str]]
) -> None:
    found = guessed(tmp_path, columns).columns.columns
    assert {name: (each.names[0], each.unit) for name, each in found.items()} == expected


def test_the_driven_wheels_in_km_h_have_the_radius_of_the_car(tmp_path: Path) -> None:
    guess = guessed(tmp_path, {'t': 0.01, 'Whl_FL_kmh': 9, 'Whl_FR_kmh': 9, 'Whl_RL_kmh': 9})
    assert 'wheel_speed' not in guess.columns.columns, 'nothing says that it is a speed'
    guess = guessed(tmp_path, {'t': 0.01, 'WhlSpdFL_kmh': 9, 'WhlSpdFR_kmh': 9, 'WhlSpdRL_kmh': 9})
    wheel = guess.columns.columns['wheel_speed']
    assert (wheel.names, wheel.radius_m) == (('WhlSpdFL_kmh', 'WhlSpdFR_kmh'), 0.3)
    assert 'radius_m' in guess.remarks['wheel_speed']


def test_its_text_is_a_column_map_with_the_same_columns(tmp_path: Path) -> None:
    guess = guessed(tmp_path, {'t': 0.01, 'Eng "Spd"': 900, 'EngTrq_pct': 9, 'WhlSpdFL_kmh': 9})
    (tmp_path / 'map.yaml').write_text(guess.text('a.csv', tmp_path))
    assert load_columns(str(tmp_path / 'map.yaml')) == guess.columns
    assert 'guessed from the values, up to 900' in guess.text('a.csv', tmp_path)


def test_what_is_needed_and_not_recognised_is_a_line_to_complete_with_the_columns_left(
    tmp_path: Path,
) -> None:
    guess = guessed(tmp_path, {'t': 0.01, 'EngSpd_rpm': 900, 'x17_rpm': 800, 'torque b': 9})
    text = guess.text('a.csv', tmp_path, ('engine_speed', 'shaft_speed', 'clutch_torque'))
    assert '#  shaft_speed: {column: "?", unit: "rpm"}' in text
    assert 'remove the # before it' in text
    assert '#  clutch_torque: {column: "?", unit: "N m"}' in text
    assert '"x17_rpm", "torque b"' in text.splitlines()[-1]
    (tmp_path / 'map.yaml').write_text(text)
    assert load_columns(str(tmp_path / 'map.yaml')) == guess.columns

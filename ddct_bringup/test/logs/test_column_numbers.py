# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A column map says what the numbers of a log mean: factor, offset, share, speed of a tyre."""

from pathlib import Path

import numpy as np
import pytest

from ddct_bringup.logs.columns import ColumnMap, load_columns
from ddct_bringup.logs.log import read_log
from ddct_plant.base.errors import DdctError

LOG = 't;n;v_fl;v_fr;trq\n0;4000;36;38;10\n20;4400;72;72;20\n'


def mapped(folder: Path, lines: str) -> ColumnMap:
    """Return the column map with these lines for further quantities."""
    (folder / 'map.yaml').write_text(f'columns:\n  time: {{column: t, unit: ms}}\n{lines}')
    return load_columns(str(folder / 'map.yaml'))


@pytest.mark.parametrize(
    ('line', 'expected'),
    [
        (
            'engine_speed: {column: n, unit: rpm, scale: 0.25}',
            [1000 * np.pi / 30, 1100 * np.pi / 30],
        ),
        ('engine_torque: {column: trq, unit: N m, scale: 2, offset: -5}', [15.0, 35.0]),
        ("engine_torque: {column: trq, unit: '%', full: 250}", [25.0, 50.0]),
        ('wheel_speed: {column: [v_fl, v_fr], unit: km/h, radius_m: 0.25}', [37 / 0.9, 80.0]),
        ('wheel_speed: {column: n, unit: rpm, scale: 0.1}', [400 * np.pi / 30, 440 * np.pi / 30]),
        ('vehicle_speed: {column: v_fl, unit: km/h}', [10.0, 20.0]),
    ],
)
def test_a_quantity_is_its_numbers_times_scale_plus_offset_in_the_unit(
    tmp_path: Path, line: str, expected: list[float]
) -> None:
    (tmp_path / 'a.csv').write_text(LOG)
    log = read_log(tmp_path / 'a.csv', mapped(tmp_path, f'  {line}\n'))
    (values,) = log.signals.values()
    np.testing.assert_allclose(values, expected, rtol=1e-12)
    np.testing.assert_allclose(log.time_s, [0.0, 0.02], atol=1e-15)


@pytest.mark.parametrize(
    ('line', 'message'),
    [
        ('engine_speed: {column: n, unit: rpm, scale: 0}', 'scale is 0: give a factor'),
        ('engine_speed: {column: n, unit: rpm, offset: a}', 'columns.engine_speed.offset'),
        ('engine_speed: {column: [], unit: rpm}', 'column is .*: give text, or a list of names'),
        ('engine_speed: {column: n, unit: rpm, full: 9}', 'full is of another unit'),
        ('shaft_speed: {column: n, unit: km/h, radius_m: 0.3}', 'radius_m is of another'),
        (
            "engine_torque: {column: trq, unit: '%'}",
            'unit %: give full, the value of 100 % in N m',
        ),
        ('wheel_speed: {column: v_fl, unit: km/h}', 'or give radius_m, the wheel radius'),
        ('wheel_speed: {column: v_fl, unit: km/h, radius_m: -1}', 'columns.wheel_speed.radius_m'),
    ],
)
def test_numbers_that_cannot_be_used_are_refused_with_their_key(
    tmp_path: Path, line: str, message: str
) -> None:
    with pytest.raises(DdctError, match=message):
        mapped(tmp_path, f'  {line}\n')

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A log is read by its column map, whatever tool wrote it."""

import numpy as np
import pytest

from ddct_bringup.logs.columns import load_columns
from ddct_bringup.logs.log import read_log
from ddct_plant.base.errors import DdctError

MAP = """\
columns:
  time: {column: Zeitpunkt, unit: iso8601}
  engine_speed: {column: Drehzahl °, unit: rpm}
  shaft_speed: {column: n_w, unit: rad/s}
"""
ROWS = 'Zeitpunkt;Drehzahl °;n_w\n' + ''.join(
    f'2026-05-01T09:59:59,{990 + 2 * k};{1500 + k},5;{100 + k}\n' for k in range(5)
)


@pytest.fixture
def columns(tmp_path):
    (tmp_path / 'map.yaml').write_text(MAP, encoding='utf-8')
    return load_columns(str(tmp_path / 'map.yaml'))


def test_a_log_in_latin_1_with_dates_and_decimal_commas_is_read(tmp_path, columns):
    log_file = tmp_path / 'drive.csv'
    log_file.write_bytes(ROWS.replace('\n', '\r\n').encode('latin-1'))
    log = read_log(log_file, columns, ('engine_speed',))
    np.testing.assert_allclose(log.time_s, 0.002 * np.arange(5), atol=1e-12)
    np.testing.assert_allclose(
        log.signals['engine_speed'], np.pi / 30 * (1500.5 + np.arange(5)), rtol=1e-12
    )


def test_the_unit_of_a_date_is_for_time_alone_and_named_among_those_of_time(tmp_path):
    file = tmp_path / 'map.yaml'
    file.write_text(MAP.replace('unit: rpm', 'unit: iso8601'), encoding='utf-8')
    with pytest.raises(DdctError, match=r"columns\.engine_speed: unit 'iso8601': choose from rad"):
        load_columns(str(file))
    file.write_text(MAP.replace('unit: iso8601', 'unit: h'), encoding='utf-8')
    with pytest.raises(DdctError, match=r"columns\.time: unit 'h': choose from .*, iso8601"):
        load_columns(str(file))


@pytest.mark.parametrize('sign', [1, -1])
def test_a_speed_that_no_car_has_is_refused_whichever_way_it_turns(tmp_path, columns, sign):
    text = ROWS.replace(';102\n', f';{sign * 1002}\n')
    (tmp_path / 'drive.csv').write_text(text, encoding='utf-8')
    with pytest.raises(DdctError, match=f'line 4, column n_w: shaft_speed is {sign * 1002} rad/s'):
        read_log(tmp_path / 'drive.csv', columns)

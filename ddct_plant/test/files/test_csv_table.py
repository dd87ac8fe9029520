# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""CSV of any tool: encodings, ends of lines, decimal commas, dates with times of day."""

import csv

import numpy as np
import pytest

from ddct_plant.base.errors import ParameterError
from ddct_plant.files.csv_table import csv_text, read_csv

TEXT = 'Zeit;Öl °C\n0,5;80,25\n1,5;81,5\n'


def read(path, text, names, encoding='utf-8', date_times=()):
    path.write_bytes(text.encode(encoding))
    return read_csv(path, names, most_bytes=10_000, most_rows=100, date_times=date_times).columns


@pytest.mark.parametrize('end', ['\n', '\r\n', '\r'])
@pytest.mark.parametrize('encoding', ['utf-8', 'utf-8-sig', 'latin-1', 'cp1252', 'utf-16'])
def test_the_encodings_and_ends_of_lines_of_other_tools_give_the_same_numbers(
    tmp_path, encoding, end
):
    text = TEXT.replace('\n', end)
    columns = read(tmp_path / 'a.csv', text, ['Zeit', 'Öl °C'], encoding)
    assert columns['Zeit'].tolist() == [0.5, 1.5]
    assert columns['Öl °C'].tolist() == [80.25, 81.5]


def test_a_dash_of_windows_in_a_name_does_not_end_the_line(tmp_path):
    columns = read(tmp_path / 'a.csv', 't,C – …\n1,2\n', ['C – …'], 'cp1252')
    assert columns['C – …'].tolist() == [2.0]


def test_what_is_no_text_is_refused_by_its_name(tmp_path):
    (tmp_path / 'a.csv').write_bytes(b'\x89PNG\0\0\1\xff')
    with pytest.raises(ParameterError, match=r'a\.csv: it is no text: give a file of text'):
        read_csv(tmp_path / 'a.csv', ['t'], most_bytes=100, most_rows=10)


@pytest.mark.parametrize(
    'rows',
    [
        ['2026-05-01T10:00:59.9995', '2026-05-01T10:01:00.0005'],
        ['2026-05-01 23:59:59,9995', '2026-05-02 00:00:00,0005'],
        ['20260501T100059.9995Z', '20260501T100100.0005Z'],
        ['2026-05-01T10:00:59.999500000+02:00', '2026-05-01T08:01:00.000500000+00:00'],
    ],
)
def test_dates_with_times_are_seconds_since_the_first_row(tmp_path, rows):
    text = 't;v\n' + ''.join(f'{each};1\n' for each in rows)
    (times,) = read(tmp_path / 'a.csv', text, ['t'], date_times=['t']).values()
    np.testing.assert_allclose(times, [0.0, 0.001], atol=1e-12)


def test_a_nanosecond_between_two_rows_is_kept(tmp_path):
    text = 't;v\n2026-05-01T10:00:00.000000001;1\n2026-05-01T10:00:00.000000002;1\n'
    (times,) = read(tmp_path / 'a.csv', text, ['t'], date_times=['t']).values()
    assert times[1] == pytest.approx(1e-9, rel=1e-6)


BAD = {
    'day or month': ('01.05.2026 10:00:00', 'can be read with the day or the month first'),
    'slashes': ('05/01/2026 10:00', 'can be read with the day or the month first'),
    'no date': ('10:00:00.25', 'has no date, so that midnight is not known'),
    'no time': ('2026-05-01', 'has no time of day'),
    'no such day': ('2026-02-30T10:00:00', 'is no date and time that exists'),
    'a number': ('17.25', 'is no date and time of ISO 8601: write it as 2026-05-01T10:00:00.125'),
    'a zone': (
        '2026-05-01T10:00:01Z',
        'it has a time zone, unlike line 2: give every row one, or none',
    ),
}


@pytest.mark.parametrize(('cell', 'complaint'), BAD.values(), ids=BAD)
def test_a_date_that_could_mean_two_things_is_refused_with_its_place(tmp_path, cell, complaint):
    text = f't;v\n2026-05-01T10:00:00;1\n{cell};1\n'
    with pytest.raises(ParameterError) as error:
        read(tmp_path / 'a.csv', text, ['t'], date_times=['t'])
    assert 'a.csv: line 3, column t: ' in str(error.value)
    assert complaint in str(error.value)


def test_the_error_on_a_date_in_place_of_a_number_names_the_unit_for_dates(tmp_path):
    with pytest.raises(ParameterError, match='is a date and time: in the column map .* iso8601'):
        read(tmp_path / 'a.csv', 't;v\n2026-05-01T10:00:00;1\n', ['t'])


@pytest.mark.parametrize('text', ['=1+1', '@SUM(A1)', '+cmd', '-2+3', '\t=1', '=-1.5'])
def test_a_spreadsheet_computes_no_text(text):
    assert next(csv.reader([csv_text([text], []).strip('\n')])) == [f"'{text}"]
    assert list(csv.reader(csv_text(['a'], [[text]]).splitlines()))[1] == [f"'{text}"]


@pytest.mark.parametrize('cell', [-1.5, 3, '-1.5', '+2e-3', 'plain', None, ''])
def test_numbers_and_plain_texts_stay_as_they_are(cell):
    text = '' if cell is None else str(cell)
    assert list(csv.reader(csv_text(['a', 'b'], [[cell, 1]]).splitlines()))[1] == [text, '1']

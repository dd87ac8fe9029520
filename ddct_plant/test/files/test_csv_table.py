# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""CSV of any tool: encodings, ends of lines, decimal commas, dates with times of day."""

import csv

import numpy as np
import pytest

from ddct_plant.base.errors import ParameterError
from ddct_plant.files import csv_table
from ddct_plant.files.csv_table import csv_text, read_csv

TEXT = 'Zeit;Öl °C\n0,5;80,25\n1,5;81,5\n'


def read(path, text, names, encoding='utf-8', date_times=()):
    path.write_bytes(text.encode(encoding))
    return read_csv(path, names, date_times=date_times).columns


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
        read_csv(tmp_path / 'a.csv', ['t'])


@pytest.mark.parametrize('end', ['\n', '\r\n', '\r'])
@pytest.mark.parametrize(
    ('text', 'v'),
    [
        ('t,v\n1,2.5\n', 2.5),
        ('t;v\n1;2,5\n', 2.5),
        ('t\tv\n1\t2,5\n', 2.5),
        ('t,v\n1,"2,5"\n', 2.5),
        ('"t","v"\n"1,0","-,25e1"\n', -2.5),
        ('t,text,v\n"1,0","a, b",2.5\n', 2.5),
        ('t;a, b;v\n1,0;"x;y";2.5\n', 2.5),
        ('"t";"v, [N m]";v\n1;2;2,5\n', 2.5),
        ('t,"torque\n[N m]",v\n1,2,2.5\n', 2.5),
        ('t,v\n1,2.5e-3\n', 2.5e-3),
        (' t , v \n 1 , 2.5 \n', 2.5),
        ('"t", "v"\n1, "2.5"\n', 2.5),
        ('t,text,v\n1,a\u2028b\x85c\x0b,2.5\n', 2.5),
        ('t,text,v\n1,"a\n# b\n",2.5\n', 2.5),
        ('t,text,v\n1,True,2.5\n', 2.5),
        ('\n# made, by "us\nt,#,v\n  # a row of units\n\n1,#2,2.5', 2.5),
    ],
)
def test_separators_decimal_marks_quotes_and_comments_are_read_rightly(tmp_path, text, v, end):
    columns = read(tmp_path / 'a.csv', text.replace('\n', end), ['t', 'v'])
    assert (columns['t'][0], columns['v'][0]) == (1.0, v)


@pytest.mark.parametrize('end', ['\n', '\r\n', '\r'])
def test_a_row_that_begins_with_an_empty_cell_keeps_it_below_an_empty_line(tmp_path, end):
    text = 't;v\n1;0.1\n\n;2,5\n# a\n;3\n'.replace('\n', end)
    columns = read(tmp_path / 'a.csv', text, ['t', 'v'])
    np.testing.assert_equal(columns['t'], [1.0, np.nan, np.nan])
    assert columns['v'].tolist() == [0.1, 2.5, 3.0]


def test_a_line_break_in_a_quoted_name_is_part_of_it(tmp_path):
    text = 'time,"torque\n# [N m], ""filtered"""\n0.5,1e2\n'
    columns = read(tmp_path / 'a.csv', text, ['torque\n# [N m], "filtered"'])
    assert [each.tolist() for each in columns.values()] == [[100.0]]


def test_separators_in_quotes_leave_a_file_to_pandas_which_is_much_faster(tmp_path, monkeypatch):
    monkeypatch.setattr(csv_table, '_by_hand', None)
    columns = read(tmp_path / 'a.csv', 't;text;v\n1;"a; b";2.5\n', ['t', 'v'])
    assert [each.tolist() for each in columns.values()] == [[1.0], [2.5]]


def test_empty_cells_and_nan_are_not_measured_and_other_words_are_no_numbers(tmp_path):
    columns = read(tmp_path / 'a.csv', 't,v\n,1\nnan,2\nNaN,3\n  ,4\n', ['t', 'v'])
    assert np.isnan(columns['t']).all()
    assert columns['v'].tolist() == [1.0, 2.0, 3.0, 4.0]


REFUSED = {
    'a word': ('t,v\n1,2\n\n3,x\n', "line 4, column v: 'x' is no number"),
    'not available': ('t,v\n1,NA\n', "line 2, column v: 'NA' is no number"),
    'true': ('t,v\n1,True\n', "line 2, column v: 'True' is no number"),
    'infinite': ('t,v\n1,2\n1,inf\n', 'line 3, column v: inf is not finite'),
    'beyond doubles': ('t,v\n1,2\n1,1e400\n', 'line 3, column v: 1e400 is not finite'),
    'two marks': ('t;v\n1;1.000,5\n', "line 2, column v: '1.000,5' is no number"),
    'below a quoted break': ('t,"a\nb",v\n1,"c\nd",2\n3,4,x\n', 'line 5, column v: '),
    'below a comment': ('# a\nt,v\n# b\n1,x\n', 'line 4, column v: '),
    'cut off': ('t,text,v\n1,a,2\n3,b', 'line 3: 2 cells in the row, 3 in the header'),
    'too long': ('t,v\n1,2\n3,4,5\n', 'line 3: 3 cells in the row, 2 in the header'),
    'first too long': ('t,v\n1,2,3\n1\n', 'line 2: 3 cells in the row, 2 in the header'),
    'an open quote': ('t,v\n1,2\n"3,4\n5,6\n', 'line 3: 1 cells in the row, 2 in the header'),
    'a long open quote': ('t,v\n"3,4\n' + '5,6\n' * 50_000, 'line 2: it is no row of CSV'),
    'no rows': ('t,v\n# 1,2\n', 'no row of numbers below the header'),
    'no header': ('\n# t,v\n', 'it is empty: give a header and rows of numbers'),
    'no column': ('t,w\n1,2\n', "no column 'v'"),
    'two columns': ('t,v,v\n1,2,3\n', "the column 'v' is there 2 times: rename one"),
}


@pytest.mark.parametrize(('text', 'complaint'), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_read_is_refused_in_one_line_with_its_place(tmp_path, text, complaint):
    with pytest.raises(ParameterError) as error:
        read(tmp_path / 'a.csv', text, ['t', 'v'])
    assert f'a.csv: {complaint}' in str(error.value)
    assert str(error.value).isprintable()
    assert len(str(error.value)) < 400


@pytest.mark.parametrize(('delimiter', 'mark'), [(',', '.'), (';', ',')])
def test_every_number_is_read_to_the_last_bit(tmp_path, delimiter, mark):
    bits = np.random.default_rng(1).integers(0, 2**64, 20_000, dtype=np.uint64)
    numbers = bits.view(float)[np.isfinite(bits.view(float))]
    rows = (f'{each!r}{delimiter}{each:.25g}\n' for each in numbers.tolist())
    text = f'a{delimiter}b\n' + ''.join(rows).replace('.', mark)
    columns = read(tmp_path / 'a.csv', text, ['a', 'b'])
    assert columns['a'].tobytes() == columns['b'].tobytes() == numbers.tobytes()


def test_both_decimal_marks_in_a_file_are_read_to_the_last_bit(tmp_path):
    columns = read(tmp_path / 'a.csv', 't;v\n0,1;0.1\n0.3;0,7\n', ['t', 'v'])
    assert [each.tolist() for each in columns.values()] == [[0.1, 0.3], [0.1, 0.7]]


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


def test_a_row_without_a_date_is_not_measured_and_the_first_date_is_zero(tmp_path):
    text = 't;v\n;1\n2026-05-01T10:00:00,5;2\nnan;3\n2026-05-01T10:00:02;0.4\n'
    columns = read(tmp_path / 'a.csv', text, ['t', 'v'], date_times=['t'])
    np.testing.assert_equal(columns['t'], [np.nan, 0.0, np.nan, 1.5])


BAD = {
    'day or month': ('01.05.2026 10:00:00', 'can be read with the day or the month first'),
    'slashes': ('05/01/2026 10:00', 'can be read with the day or the month first'),
    'no date': ('10:00:00.25', 'has no date, so that midnight is not known'),
    'no time': ('2026-05-01', 'has no time of day'),
    'no such day': ('2026-02-30T10:00:00', 'is no date and time that exists'),
    'a number': ('17.25', 'is no date and time of ISO 8601: write it as 2026-05-01T10:00:00.125'),
    'a zone': (
        '2026-05-01T10:00:01Z',
        'it has a time zone, unlike the first row: give every row one, or none',
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

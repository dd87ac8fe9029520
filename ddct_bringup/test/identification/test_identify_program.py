# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The program `identify`: its tables, its JSON, its exit codes."""

import json

import pytest
from by_schema import require_schema

from ddct_bringup.identification.identify import main

pytestmark = pytest.mark.slow


def run_json(capsys, *options):
    code = main(['--json', '-', *options])
    content = json.loads(capsys.readouterr().out)
    require_schema('identify', content)
    return code, content


def test_json_holds_parameters_coefficients_and_checks(capsys):
    code, content = run_json(capsys)
    assert code == 0
    assert [row['symbol'] for row in content['parameters']] == [
        'J_m', 'c_m', 'J_p', 'c_prim', 'c_sa', 'k_sa', 'tau', 'J_v',
    ]  # fmt: skip
    for row in content['parameters']:
        assert {'name', 'symbol', 'value', 'std', 'unit'} <= set(row)
        assert (row['std'] is None) == (row['symbol'] == 'c_m')
    assert len(content['coefficients']) == 9
    for row in content['coefficients']:
        assert set(row) == {
            'transfer_function', 'coefficient', 'printed', 'taken', 'computed',
            'residual_half_units',
        }  # fmt: skip
    corrected = [row for row in content['coefficients'] if row['taken'] != row['printed']]
    assert [(row['printed'], row['taken']) for row in corrected] == [('334.4', '339.4')]
    assert all(check['passed'] for check in content['checks'])


def test_erratum_kept_gives_exit_code_1_and_one_line_on_standard_error(capsys):
    assert main(['--as-printed']) == 1
    captured = capsys.readouterr()
    assert captured.err.startswith('ddct identify: no driveline fits: ')
    assert captured.err.count('\n') == 1
    assert '334.4' in captured.out


def test_erratum_kept_has_no_parameter_ranges(capsys):
    code, content = run_json(capsys, '--as-printed')
    assert code == 1
    assert all(row['lowest'] is None for row in content['parameters'])


def test_table_in_a_pipe_is_plain_text_and_a_json_file_is_written_beside_it(capsys, tmp_path):
    target = tmp_path / 'parameters.json'
    assert main(['--json', str(target)]) == 0
    assert len(json.loads(target.read_text())['parameters']) == 8
    assert list(tmp_path.iterdir()) == [target]
    output = capsys.readouterr().out
    assert output.isascii() and '\x1b' not in output
    for text in (
        'Driveline parameters',
        'halfshaft_stiffness',
        'k_sa',
        '334.4 (erratum, taken as 339.4)',
        '+1.04',
        'Condition number',
    ):
        assert text in output


def test_json_into_a_folder_that_does_not_exist_is_a_one_line_error(capsys, tmp_path):
    # As printed, since then no range takes time; this error comes before that of the fit.
    assert main(['--as-printed', '--json', str(tmp_path / 'absent' / 'out.json')]) == 1
    error = capsys.readouterr().err
    assert 'absent' in error
    assert error.startswith('ddct identify: ') and error.count('\n') == 1


def test_help_gives_examples(capsys):
    with pytest.raises(SystemExit) as ended:
        main(['--help'])
    assert ended.value.code == 0
    assert 'ddct identify --json' in capsys.readouterr().out

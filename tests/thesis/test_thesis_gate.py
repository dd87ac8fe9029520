# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every number that the thesis prints, compared with the values computed by all packages."""

import csv
import json
from collections import defaultdict
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml
from by_schema import require_schema
from shown_tables import require_reasons, require_whole_lines

from ddct_bringup.programs import thesis
from ddct_bringup.reproduction.numbers import command
from ddct_bringup.reproduction.numbers.command import SOURCES, compute
from ddct_bringup.reproduction.numbers.gate import GateRow, NumbersDocument, judge
from ddct_bringup.reproduction.numbers.gate_tables import page_tables
from ddct_bringup.reproduction.numbers.number_files import thesis_numbers
from ddct_bringup.reproduction.numbers.thesis_number import VERDICTS, Value
from ddct_bringup.thesis.table_5_1 import THESIS_TABLE
from ddct_controllers.mpc.costs import TABLE_4_1, TwoInputCost
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.files.json_records import to_json
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.models.printed import ACTUATOR, CLUTCH_TO_SLIP, LOAD_TO_SLIP

pytestmark = pytest.mark.slow

NUMBERS = thesis_numbers()


@pytest.fixture(scope='module')
def computed() -> Mapping[str, Value | None]:
    return compute(SOURCES)


@pytest.fixture(scope='module')
def rows(computed: Mapping[str, Value | None]) -> tuple[GateRow, ...]:
    return judge(NUMBERS, computed)


@pytest.fixture
def computed_once(computed: Mapping[str, Value | None], monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the program take the numbers of all its sources, computed once for this file."""

    def shared(
        sources: Mapping[str, Any], progress: Callable[[str], None]
    ) -> Mapping[str, Value | None]:
        assert sources is SOURCES
        return computed

    monkeypatch.setattr(command, 'compute', shared)


def test_every_claim_about_a_printed_number_holds(rows: tuple[GateRow, ...]) -> None:
    broken = [(row.number.section, row.number.item, row.complaint) for row in rows]
    assert [entry for entry in broken if entry[2]] == []


def test_no_number_of_a_computed_group_is_without_a_value(rows: tuple[GateRow, ...]) -> None:
    computed = {row.number.fact for row in rows if row.computed is not None}
    hidden = [row.number for row in rows if row.number.fact in computed and row.hit is None]
    assert hidden == []


def test_predictions_are_hits_by_their_tolerance_alone(rows: tuple[GateRow, ...]) -> None:
    predicted = [
        row
        for row in rows
        if row.number.verdict == 'predicted' and isinstance(row.computed, float)
    ]
    assert len(predicted) > 50
    for row in predicted:
        assert isinstance(row.computed, float) and row.number.absolute_tolerance is not None
        distance = abs(row.computed - float(row.number.printed))
        assert row.hit == (distance <= row.number.absolute_tolerance), row.number.item


def test_the_rise_times_of_table_2_1_have_one_rule_and_the_one_outside_is_a_miss(
    rows: tuple[GateRow, ...],
) -> None:
    column = [
        row
        for row in rows
        if row.number.section == '2.3, Table 2.1' and row.number.item.endswith(': t_r')
    ]
    assert len(column) == 9
    assert {(row.number.verdict, row.number.group) for row in column} == {
        ('predicted', 'Table 2.1: t_r')
    }
    assert [row.number.item for row in column if not row.hit] == ['LS4: t_r']


def test_r_of_table_4_1_is_no_number_that_the_thesis_leads_to(rows: tuple[GateRow, ...]) -> None:
    weights = [row for row in rows if row.number.item in ('MPC1: R', 'MPC2: R', 'MPC3: R')]
    assert [row.outcome for row in weights] == ['predicted hit'] * 3
    assert all('a rule of MATLAB' in row.number.reason for row in weights)


def test_number_is_not_reproduced_in_one_place_and_an_erratum_in_another() -> None:
    verdicts: dict[tuple[str, str], set[str]] = defaultdict(set)
    for number in NUMBERS:
        if number.id is not None:
            verdicts[number.id, number.printed].add(number.verdict)
    assert [key for key, found in verdicts.items() if len(found) > 1] == []


def test_every_printed_number_of_the_list_is_in_its_section_of_the_thesis() -> None:
    text = (Path(__file__).parent / 'printed_numbers.yaml').read_text(encoding='utf-8')
    printed = {section: set(found) for section, found in yaml.safe_load(text).items()}
    unprinted = [
        (number.section, number.item, number.printed)
        for number in NUMBERS
        if number.is_number
        and abs(float(number.printed)) not in printed[number.section.partition(',')[0]]
    ]
    assert unprinted == []


@pytest.mark.parametrize(
    ('name', 'transfer_function'),
    [
        *((f'G_c{name.upper()}(s)', PRINTED_CONTROLLERS[name]) for name in ('ls1', 'ls2', 'ls3')),
        *((f'G_cLS{i}(s)', PRINTED_CONTROLLERS[f'ls{i}']) for i in range(4, 10)),
        *((f'Hinf{i}(s)', PRINTED_CONTROLLERS[f'hinf{i}']) for i in range(1, 4)),
        ('G_a(s)', ACTUATOR),
        ('P_2(s)', CLUTCH_TO_SLIP.factored()),
        ('P_3(s)', LOAD_TO_SLIP.factored()),
    ],
)
def test_list_has_the_transfer_function_that_the_code_uses(
    name: str, transfer_function: FactoredTransferFunction
) -> None:
    printed = [
        float(number.printed)
        for number in NUMBERS
        if number.item.startswith(f'{name}: ') and number.verdict != 'erratum' and number.is_number
    ]
    flat = [transfer_function.gain]
    for factor in transfer_function.numerator + transfer_function.denominator:
        flat += factor if isinstance(factor, tuple) else (factor,)
    assert sorted({*printed, 0.0}) == sorted({*flat, 0.0})


def printed_in(section: str) -> dict[str, float]:
    found = [number for number in NUMBERS if number.section == section and number.is_number]
    return {number.item: float(number.printed) for number in found}


def test_list_has_table_4_1_as_the_controllers_use_it() -> None:
    assert printed_in('4.2, Table 4.1') == {
        f'{name.upper()}: {symbol}': value
        for name, row in TABLE_4_1.items()
        for symbol, value in (
            ('T_p', row.prediction_steps),
            ('T_c', row.control_steps),
            ('Q', row.output_weight),
            ('P', 0),
            ('R', row.move_weight),
        )
    }


def test_list_has_the_horizon_and_the_weights_that_mpc4_uses() -> None:
    printed = printed_in('4.3')
    settings = TwoInputCost().settings()
    assert printed['MPC4: T_p'] == pytest.approx(settings.prediction_steps * PERIOD_S)
    assert [printed['MPC4: Q(1,1)'], printed['MPC4: Q(2,2)']] == pytest.approx(
        [terms.weight**2 for terms in settings.outputs]
    )
    assert [terms.move_weight for terms in settings.inputs] == [0.0, 0.0]


def test_list_has_table_5_1_as_the_calibration_uses_it() -> None:
    figures = ('t_a', 'sigma of w_sr', 'sigma of A_x')
    assert printed_in('5, Table 5.1') == {
        f'{row.label}: {figure}': value
        for row in THESIS_TABLE
        for figure, value in zip(figures, row.printed_values().values(), strict=True)
    }


def test_program_writes_every_number_as_json_alone(
    capsys: pytest.CaptureFixture[str], rows: tuple[GateRow, ...]
) -> None:
    assert thesis.main(['numbers', '--json', '-']) == 0
    content = json.loads(capsys.readouterr().out)
    tables = {name: table.written for name, table in page_tables(rows).items()}
    require_schema('numbers', content)
    assert content == to_json(NumbersDocument([row.entry for row in rows], tables))
    keys = [
        *('section', 'item', 'printed', 'computed', 'unit'),
        *('tolerance', 'verdict', 'hit', 'group', 'reason'),
    ]
    assert all(list(number) == keys for number in content['numbers'])
    assert {number['verdict'] for number in content['numbers']} <= {*VERDICTS}


@pytest.mark.usefixtures('computed_once')
def test_program_writes_the_same_numbers_as_csv(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], rows: tuple[GateRow, ...]
) -> None:
    assert thesis.main(['numbers', '--csv', '-', '--json', str(tmp_path / 'n.json')]) == 0
    found = list(csv.DictReader(capsys.readouterr().out.splitlines(keepends=True)))
    written = json.loads((tmp_path / 'n.json').read_text())['numbers']
    assert len(found) == len(rows) == len(written)
    for cells, number in zip(found, written, strict=True):
        assert cells == {k: '' if v is None else str(v) for k, v in number.items()}
    assert thesis.main(['numbers', '--csv', '-', '--json', '-']) == 1
    assert 'both want standard output' in capsys.readouterr().err
    assert thesis.main(['numbers', '--csv', str(tmp_path / 'no' / 'n.csv')]) == 1
    assert 'there is no folder' in capsys.readouterr().err


@pytest.mark.usefixtures('computed_once')
def test_program_prints_the_tables_of_chapters_without_reasons(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert thesis.main(['numbers']) == 0
    printed = capsys.readouterr().out
    assert 'Errata of the thesis' in printed and 'distinct facts' in printed
    assert not [line for line in printed.splitlines() if line.endswith(' reason')]
    require_whole_lines(printed.splitlines(), 120)
    require_reasons(printed.splitlines())


@pytest.mark.usefixtures('computed_once')
def test_section_shows_one_table_with_the_reasons_of_its_misses_and_json_has_its_numbers_alone(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    place = tmp_path / 'numbers.json'
    assert thesis.main(['numbers', '--section', 'Table 5.1', '--json', str(place)]) == 0
    printed = capsys.readouterr().out
    assert len(printed.splitlines()) < 80
    misses = printed.partition('Misses')[2]
    assert 'MPC3: sigma of w_sr; sigma of A_x' in misses and '25 %' in misses
    sections = {each['section'] for each in json.loads(place.read_text())['numbers']}
    assert sections == {'5, Table 5.1'}
    assert thesis.main(['numbers', '--section', '9']) == 1
    assert '--section 9: no printed number there' in capsys.readouterr().err


def test_program_without_one_of_its_sources_reports_its_numbers_as_not_computed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    without = {name: source for name, source in SOURCES.items() if name != 'closed loop'}
    monkeypatch.setattr(command, 'SOURCES', without)
    assert thesis.main(['numbers']) == 1
    *_, error = capsys.readouterr().err.splitlines()
    assert error.startswith(
        'ddct thesis: a claim of the list does not hold: 1.5.1, w_d of the three simplified '
        'models beside the detailed model: nothing was computed for it; '
    )

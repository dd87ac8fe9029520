# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Groups of the thesis gate: one computation is shown completely, by one rule, counted once."""

import pytest
from refusals import refused

from ddct_bringup.reproduction.numbers.gate import judge
from ddct_bringup.reproduction.numbers.gate_tables import count_facts, facts_table
from ddct_bringup.reproduction.numbers.number_files import parse_numbers
from ddct_bringup.reproduction.values.controller_values import coefficients, in_the_form_of
from ddct_bringup.reproduction.values.h_infinity_values import RAW_CONTROLLER, h_infinity_values
from ddct_bringup.reproduction.values.loop_shaping_values import loop_shaping_values
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_controllers.synthesised import synthesised_design
from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction

GROUP = """
- section: '3.2'
  verdict: 'predicted'
  group: 'one synthesis'
  tolerance: {relative: 0.05}
  reason: '5 %'
  numbers:
  - {id: 'zero', item: 'zero', printed: '0.76'}
  - {id: 'pole', item: 'pole', printed: '89.5'}
"""
VALUES = {'zero': 0.765, 'pole': 78.6}


def test_group_shows_its_misses_beside_its_hits():
    rows = judge(parse_numbers(GROUP), VALUES)
    assert [(row.computed, row.hit) for row in rows] == [(0.765, True), (78.6, False)]
    assert {row.entry.group for row in rows} == {'one synthesis'}


def test_group_cannot_leave_out_a_miss():
    hits_only = GROUP.replace("  - {id: 'pole', item: 'pole', printed: '89.5'}\n", '')
    with refused(ParameterError, 'pole'):
        judge(parse_numbers(hits_only), VALUES)


@pytest.mark.parametrize('verdict', ['not_reproducible', 'given'])
def test_group_cannot_call_a_miss_something_that_nothing_computes(verdict):
    hidden = GROUP.replace(
        "{id: 'pole', item: 'pole', printed: '89.5'}",
        f"{{item: 'pole', printed: '89.5', verdict: '{verdict}', tolerance: null}}",
    )
    with pytest.raises(ParameterError, match="group 'one synthesis': verdicts of different kinds"):
        parse_numbers(hidden)


def test_group_cannot_judge_its_numbers_by_different_tolerances():
    wider = GROUP.replace("printed: '89.5'", "printed: '89.5', tolerance: {relative: 0.2}")
    with pytest.raises(ParameterError, match='more than one tolerance'):
        parse_numbers(wider)


def test_group_counts_once_and_as_a_miss_when_one_of_it_is():
    rows = judge(parse_numbers(GROUP), VALUES)
    assert count_facts(rows) == {'predicted miss': 1}
    assert facts_table(rows).rows[-1] == ('all', '2', '1')


def test_group_with_an_erratum_is_an_erratum():
    mixed = GROUP.replace("verdict: 'predicted'", "verdict: 'reproduced'").replace(
        "printed: '89.5'", "printed: '89.5', verdict: 'erratum', ours: '78.6'"
    )
    assert count_facts(judge(parse_numbers(mixed), VALUES)) == {'erratum': 1}


def test_computed_roots_take_the_printed_form_slowest_with_slowest():
    printed = FactoredTransferFunction(1.0, (50.0, 0.1), ((0.4, 0.05), 20.0))
    computed = FactoredTransferFunction(3.0, (0.2, 40.0), (30.0, 0.1, 0.5))
    found = in_the_form_of(printed, computed)
    assert found.gain == 3.0
    assert found.numerator == pytest.approx((40.0, 0.2))
    assert found.denominator[0] == pytest.approx((0.6, 0.05))
    assert found.denominator[1] == pytest.approx(30.0)


def test_controller_of_another_order_has_no_printed_form():
    with pytest.raises(ParameterError, match='1 roots do not fill 2 printed factors'):
        in_the_form_of(
            FactoredTransferFunction(1.0, (1.0, 2.0), ()), FactoredTransferFunction(1.0, (1.0,))
        )


def orders(transfer_function: FactoredTransferFunction) -> int:
    return 1 + len(transfer_function.zeros) + len(transfer_function.poles)


@pytest.fixture(scope='module')
def values() -> dict[str, object]:
    return {**loop_shaping_values(), **h_infinity_values()}


@pytest.mark.parametrize(
    ('name', 'printed', 'put_in'),
    [
        ('raw by printed weights', RAW_CONTROLLER, 0),
        ('raw by fitted weights', RAW_CONTROLLER, 0),
        ('hinf1 by fitted weights', PRINTED_CONTROLLERS['hinf1'], 1),  # pole at 0
        ('G_c2', PRINTED_CONTROLLERS['ls7'], 1),  # pole at 0
        ('G_c1', PRINTED_CONTROLLERS['ls2'], 4),  # pole at 0; two zeros and a pole are given
        ('ls7(z)', PRINTED_CONTROLLERS['ls7'], 0),
        ('hinf1(z)', PRINTED_CONTROLLERS['hinf1'], 0),
    ],
)
def test_design_yields_every_coefficient_of_its_controller(values, name, printed, put_in):
    found = [
        key for key in values if key.startswith((f'{name}.gain', f'{name}.zero ', f'{name}.pole '))
    ]
    assert len(found) == orders(printed) - put_in


def test_synthesis_with_fitted_weights_has_its_known_misses(values):
    raw = synthesised_design('hinf_fitted').raw
    assert values['raw by fitted weights.gain'] == raw.gain
    expected = coefficients('raw by fitted weights', in_the_form_of(RAW_CONTROLLER, raw))
    assert {name: values[name] for name in expected} == expected
    assert expected['raw by fitted weights.pole 3'] == pytest.approx(78.95, abs=0.01)
    assert expected['raw by fitted weights.pole 5 b'] == pytest.approx(0.0390, abs=1e-4)

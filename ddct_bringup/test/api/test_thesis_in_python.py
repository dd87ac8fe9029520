# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The printed values of the thesis in Python: Tables 5.1 and 5.2, and every number of the gate."""

from collections.abc import Mapping

import pytest

from ddct_bringup.api import (
    DdctError,
    ParameterError,
    beside_thesis,
    compare,
    run,
    table_5_2,
    thesis_numbers,
)
from ddct_bringup.api import thesis as module
from ddct_bringup.reproduction.numbers.thesis_number import Value
from ddct_bringup.thesis.table_5_1 import THESIS_TABLE
from ddct_bringup.thesis.table_metrics import TABLE_METRICS


@pytest.mark.slow
def test_each_row_of_table_5_1_has_our_values_and_the_printed_ones() -> None:
    runs = compare([row.controller for row in THESIS_TABLE])
    found = beside_thesis(runs)
    for row, each in zip(THESIS_TABLE, runs, strict=True):
        shown = found.loc[row.controller]
        assert shown['use'] == row.use
        for name, printed in row.printed_values().items():
            assert shown[f'thesis.{name}'] == printed
            if each.metrics[name] is not None:
                assert shown[name] == each.metrics[name]


@pytest.mark.slow
def test_only_predicted_rows_have_a_hit_or_miss() -> None:
    found = beside_thesis(compare(['ls8', 'mpc3']))
    hits = [found.at['mpc3', f'hit.{name}'] for name in TABLE_METRICS]
    assert hits == [True, False, False]
    of_fitted = found.loc['ls8', [name for name in found if name.startswith('hit.')]]
    assert of_fitted.isna().all()


@pytest.mark.parametrize(('controller', 'wear_gain'), [('ls1', 1.0), ('ls8', 0.9)])
def test_without_a_row_or_in_other_conditions_nothing_printed_is_shown(
    controller: str, wear_gain: float
) -> None:
    found = beside_thesis(run(controller, wear_gain=wear_gain)).loc[controller]
    assert found[list(TABLE_METRICS)].notna().all()
    assert found.drop(list(TABLE_METRICS)).isna().all()


@pytest.mark.slow
def test_table_5_2_has_the_sixteen_words_and_whether_they_hold() -> None:
    found = table_5_2()
    assert list(found.index.unique('wear_gain')) == [0.7, 1.3]
    assert found.loc[(0.7, 'hinf2'), 'slip_printed'] == 'good'
    assert (found['slip_holds'].sum(), found['oscillations_hold'].sum()) == (5, 0)
    assert table_5_2('thesis_sticking')['slip_holds'].sum() == 1


def test_table_5_2_with_an_unknown_scenario_is_refused() -> None:
    with pytest.raises(ParameterError, match='launch'):
        table_5_2('launch')


def test_a_claim_that_does_not_hold_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def lacking(sources: object) -> Mapping[str, Value | None]:
        return {}

    monkeypatch.setattr(module, 'compute', lacking)
    with pytest.raises(DdctError, match='a claim of the list does not hold'):
        thesis_numbers()

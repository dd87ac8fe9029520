# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every number of the thesis in Python, with its outcome."""

from ddct_bringup.api import thesis_numbers
from ddct_bringup.reproduction.numbers.gate import OUTCOMES


def test_every_number_of_the_gate_has_its_outcome_and_the_facts_are_counted() -> None:
    found = thesis_numbers()
    assert list(found.facts.index) == list(OUTCOMES)
    assert found.facts['entries'].sum() == len(found.table)
    assert found.facts['facts'].sum() == found.table['group'].nunique()
    predicted = found.table[found.table['outcome'] == 'predicted hit']
    assert predicted['hit'].all() and (predicted['verdict'] == 'predicted').all()

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Stored values come back; a file with other values counts as none."""

import pytest

from ddct_bringup.floor.cache import KnownFloor, cached, store
from ddct_bringup.floor.values import Floor, Proof
from ddct_plant.files.cache_folder import cache_folder

pytestmark = pytest.mark.usefixtures('own_cache')
NAME = 'abc'
FLOOR = Floor('peak_jerk', 0.8, 1.0 / 3.0, None, Proof('ray', 1.0, 'all'), None)
VALUES = KnownFloor(FLOOR, limited=False)


def test_stored_values_come_back() -> None:
    assert cached(NAME) is None
    store(NAME, VALUES)
    assert cached(NAME) == VALUES


@pytest.mark.parametrize(
    ('old', 'new'),
    [('0.333', '0.334'), ('"least"', '"lest"'), ('{"values": ', '[{"values": '), ('}', '')],
)
def test_a_file_with_other_values_counts_as_none(old: str, new: str) -> None:
    store(NAME, VALUES)
    folder = cache_folder('floors')
    assert folder is not None
    file = folder / f'{NAME}.json'
    text = file.read_text(encoding='utf-8')
    assert old in text
    file.write_text(text.replace(old, new), encoding='utf-8')
    assert cached(NAME) is None


@pytest.mark.parametrize('text', ['[]', '{}', '{"values": {}}', 'null', '"values"'])
def test_a_file_of_another_form_counts_as_none(text: str) -> None:
    store(NAME, VALUES)
    folder = cache_folder('floors')
    assert folder is not None
    (folder / f'{NAME}.json').write_text(text, encoding='utf-8')
    assert cached(NAME) is None

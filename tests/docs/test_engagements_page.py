# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of the pages of engagements are what the runs give; they have all rows and all charts."""

import pytest
from generator.drawings.study_charts import drawn_curves, samples
from generator.pages import DOCS, shown_tables
from generator.pages import rows_of as rows_of_table

from ddct_bringup.reproduction.studies import engagements
from ddct_bringup.reproduction.studies.table_5_2 import rows_of
from ddct_controllers.registry import controller_names

SHOWN = shown_tables('studies')
MAKE = 'run: make docs KINDS=studies'
SAMPLE = {
    'engagements_thesis_linear': ('thesis', 'linear', 1.3, 'ls8'),
    'engagements_thesis_stick_slip': ('thesis', 'stick_slip', 0.7, 'mpc3'),
    'engagements_launch': ('launch', 'stick_slip', 1.0, 'hinf2'),
    'engagements_launch_gentle': ('launch_gentle', 'stick_slip', 0.7, 'mpc4'),
    'engagements_launch_hill': ('launch_hill', 'stick_slip', 1.3, 'pi'),
    'engagements_launch_hot': ('launch_hot', 'stick_slip', 1.0, 'ls3'),
    'engagements_tip_in': ('tip_in', 'stick_slip', 0.7, 'hinf1'),
}
LARGEST_CHART_BYTES = 150_000


def rows_on_page(study: str) -> list[tuple[str, ...]]:
    return rows_of_table(SHOWN[study])


@pytest.mark.parametrize('study', engagements.ENGAGEMENTS)
def test_a_row_of_each_table_and_a_curve_of_each_chart_is_what_the_run_gives(study):
    row, slip = engagements.engagement(SAMPLE[study])
    assert row in rows_on_page(study), MAKE
    assert slip.state == row[2]
    curves = drawn_curves(DOCS / 'images' / f'{study}.png')
    drawn = curves[slip.controller][f'K_usura {slip.label}']
    assert drawn == pytest.approx(samples(slip.rpm), abs=1.0, rel=1e-3), MAKE


@pytest.mark.parametrize('study', engagements.ENGAGEMENTS)
def test_each_table_has_every_controller_at_every_wear_gain(study):
    expected = [
        (f'{gain:g}', name) for gain in engagements.WEAR_GAINS for name in controller_names()
    ]
    assert [row[:2] for row in rows_on_page(study)] == expected, MAKE


@pytest.mark.parametrize('clutch', ['linear', 'stick_slip'])
def test_rows_of_table_5_2_are_what_the_runs_give(clutch):
    shown = rows_on_page('table_5_2_in_numbers')
    assert [row for row in rows_of(clutch, 1.3) if row not in shown] == [], MAKE


@pytest.mark.parametrize('study', engagements.ENGAGEMENTS)
def test_a_small_chart_stands_beside_each_table(study):
    texts = [page.read_text(encoding='utf-8') for page in DOCS.rglob('*.md')]
    (text,) = [text for text in texts if f'<!-- studies: {study} -->' in text]
    assert f'](../images/{study}.png)' in text
    picture = DOCS / 'images' / f'{study}.png'
    assert picture.stat().st_size < LARGEST_CHART_BYTES
    assert list(drawn_curves(picture)) == list(controller_names()), MAKE

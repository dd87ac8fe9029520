# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page docs/controllers/loop_shaping.md has the numbers that the program computes."""

from pathlib import Path

import pytest
import yaml
from generator.pages import as_markdown, shown_tables

from ddct_controllers.design.loop_shaping.record import thesis_record
from ddct_controllers.design.loop_shaping.tables import thesis_tables
from ddct_controllers.from_file.designed import load_designed
from ddct_controllers.printed import PRINTED_CONTROLLERS

PAGE = Path(__file__).parents[3] / 'docs' / 'controllers' / 'loop_shaping.md'


@pytest.fixture
def page() -> str:
    return PAGE.read_text(encoding='utf-8')


def test_its_tables_are_those_of_the_program():
    """Update them by: make docs KINDS=loop-shaping."""
    assert shown_tables('loop-shaping') == as_markdown(thesis_tables(thesis_record()))


def test_its_example_of_a_file_is_ls7(page, tmp_path):
    text = page.split('```yaml\n')[1].split('```')[0]
    assert yaml.safe_load(text)['name'] == 'mine'
    path = tmp_path / 'mine.yaml'
    path.write_text(text, encoding='utf-8')
    assert load_designed(str(path)).transfer_function == PRINTED_CONTROLLERS['ls7']

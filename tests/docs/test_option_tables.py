"""The tables of options in the pages are what the code declares."""

import pytest
from support.documented import PAGES, ROOT
from support.option_tables import MARK, TABLES, filled

from ddct_plant.program.page_tables import marked_tables

TEXTS = {str(page.relative_to(ROOT)): page.read_text(encoding='utf-8') for page in PAGES}


@pytest.mark.parametrize(
    'page', [name for name, text in TEXTS.items() if marked_tables(text, MARK)]
)
def test_a_page_has_the_options_that_the_code_declares(page):
    assert filled(TEXTS[page]) == TEXTS[page], 'run: python tests/support/option_tables.py'


def test_every_table_of_options_is_in_a_page():
    marked = [name for text in TEXTS.values() for name in marked_tables(text, MARK)]
    assert sorted(marked) == sorted(TABLES)

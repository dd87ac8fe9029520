# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Compiled templates are kept on the disk; pages are alike without them."""

from pathlib import Path

import pytest
from markupsafe import Markup

from ddct_bringup.documents import page_parts

TEXT = '{{ 1 + 1 }} of {{ name }}'


@pytest.fixture
def kept(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv('DDCT_CACHE', str(tmp_path))
    return tmp_path / 'pages'


def rendered(patch: pytest.MonkeyPatch, text: str = TEXT) -> str:
    """Render a template that this process has not compiled."""
    page_parts.page_template.cache_clear()
    patch.setattr(page_parts, 'page_part', lambda room, name: Markup(text))
    try:
        return page_parts.page_template('room', 'small.html.j2').render(name='these')
    finally:
        page_parts.page_template.cache_clear()


def files_in(folder: Path) -> list[Path]:
    return [each for each in folder.rglob('*') if each.is_file()]


def test_a_kept_template_is_compiled_once(monkeypatch, kept):
    assert rendered(monkeypatch) == '2 of these'
    assert len(files_in(kept)) == 1
    with monkeypatch.context() as patch:
        patch.setattr('jinja2.Environment.compile', None)
        assert rendered(patch) == '2 of these'


@pytest.mark.parametrize('damage', [b'', b'j2', b'\0' * 100])
def test_a_damaged_file_is_compiled_again(monkeypatch, kept, damage):
    rendered(monkeypatch)
    (file,) = files_in(kept)
    file.write_bytes(damage)
    assert rendered(monkeypatch) == '2 of these'


def test_another_text_is_compiled_again(monkeypatch, kept):
    rendered(monkeypatch)
    assert rendered(monkeypatch, 'all of {{ name }}') == 'all of these'


def test_a_folder_that_cannot_be_used_is_no_error(monkeypatch, kept):
    kept.write_text('', encoding='utf-8')
    assert rendered(monkeypatch) == '2 of these'


def test_an_empty_variable_keeps_nothing(monkeypatch, kept):
    monkeypatch.setenv('DDCT_CACHE', '')
    assert rendered(monkeypatch) == '2 of these'
    assert not kept.exists()

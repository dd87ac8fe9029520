# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Settings of Sphinx for the documentation site."""

from functools import lru_cache
from typing import Any
from xml.etree import ElementTree

from docutils import nodes
from latex2mathml.converter import convert
from sphinx import addnodes
from sphinx.search.en import SearchEnglish

from website.staging import ROOT

project = 'Clutch slip control of a dual dry clutch transmission'
author = copyright = 'DDCT team'
version = release = ElementTree.parse(ROOT / 'ddct_bringup' / 'package.xml').findtext('version')
extensions = ['myst_parser', 'sphinx.ext.autodoc', 'website.directives']
html_title = f'ddct {release}'
html_show_sphinx = False
html_copy_source = False
html_static_path = ['static']
html_css_files = ['site.css']
html_math_renderer = 'mathml'
myst_heading_anchors = 4
myst_fence_as_directive = ['math']
default_role = 'code'
autodoc_typehints = 'description'
autodoc_class_signature = 'separated'
smartquotes = False  # a page shows what is written
suppress_warnings = ['myst.header']


def _inline(translator: Any, node: nodes.math) -> None:
    translator.body.append(convert(node.astext()))
    raise nodes.SkipNode


def _display(translator: Any, node: nodes.math_block) -> None:
    translator.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>\n')
    raise nodes.SkipNode


class _English(SearchEnglish):
    """The language of the search, in which each word is stemmed once."""

    def __init__(self, options: dict[str, str]) -> None:
        super().__init__(options)
        self._stems: dict[str, str] = {}

    def stem(self, word: str) -> str:
        if word not in self._stems:
            self._stems[word] = super().stem(word)
        return self._stems[word]


def _skipped(app: Any, what: str, name: str, *rest: Any) -> bool | None:
    return True if name == '__new__' else None


def _sidebar_of_titles(app: Any, page: str, template: str, context: Any, doctree: Any) -> None:
    """Let Sphinx make the sidebar, which has titles of pages alone, without their headings."""
    whole = context.get('toctree')

    def toctree(**options: Any) -> str:
        every = app.env.tocs
        app.env.tocs = _titles_of(app.env)
        try:
            return str(whole(**options))
        finally:
            app.env.tocs = every

    if whole:
        context['toctree'] = toctree


@lru_cache
def _titles_of(env: Any) -> dict[str, nodes.bullet_list]:
    """Return the table of contents of each page, which Sphinx copies for every other page."""
    tocs = {page: toc.deepcopy() for page, toc in env.tocs.items()}
    for toc in tocs.values():
        for entry in toc.children:
            if len(entry) > 1 and not list(entry.findall(addnodes.toctree)):
                entry.pop(1)
    return tocs


def setup(app: Any) -> None:
    """
    Draw equations as MathML: no script, and none is fetched from elsewhere.

    The sidebar is made before the theme asks for it, at a fourth of the time of the whole site.
    """
    app.add_html_math_renderer('mathml', (_inline, None), (_display, None))
    app.add_search_language(_English)
    app.connect('autodoc-skip-member', _skipped)  # what a named tuple is made by
    app.connect('html-page-context', _sidebar_of_titles, priority=400)

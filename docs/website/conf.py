# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Settings of Sphinx for the documentation site."""

from typing import Any
from xml.etree import ElementTree

from docutils import nodes
from latex2mathml.converter import convert

from website.staging import ROOT

project = 'Clutch slip control of a dual dry clutch transmission'
author = copyright = 'DDCT team'
version = release = ElementTree.parse(ROOT / 'ddct_bringup' / 'package.xml').findtext('version')
extensions = ['myst_parser', 'sphinx.ext.autodoc']
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
suppress_warnings = ['myst.header']


def _inline(translator: Any, node: nodes.math) -> None:
    translator.body.append(convert(node.astext()))
    raise nodes.SkipNode


def _display(translator: Any, node: nodes.math_block) -> None:
    translator.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>\n')
    raise nodes.SkipNode


def _skipped(app: Any, what: str, name: str, *rest: Any) -> bool | None:
    return True if name == '__new__' else None


def setup(app: Any) -> None:
    """Draw equations as MathML: no script, and none is fetched from elsewhere."""
    app.add_html_math_renderer('mathml', (_inline, None), (_display, None))
    app.connect('autodoc-skip-member', _skipped)  # what a named tuple is made by

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
A Sphinx extension: directives that make the tables of the pages when the site is built.

`ddct-options`, `ddct-parameters` and so on, one for each kind of `tables.declared`, take the name
of a table. `ddct-results FILE NAME` shows a table of a file that a program has written, and
`ddct-schemas` the schemas of all such files. `ddct-topics` has a line `TOPIC: content` for each
topic, to which the declared type, publisher and frame are added. An unknown name is a warning of
Sphinx with its page and line, as is a declared table that no page shows.
"""

from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

from ddct_plant.base.errors import DdctError
from ddct_plant.program.table import TextTable
from ddct_plant.signals.topics import TOPICS
from website.results import result_table
from website.schemas import schema_table
from website.tables.declared import KINDS, tables_of
from website.tables.markdown import as_markdown

_PREFIX = 'ddct-'
_SHOWN = 'ddct_shown_tables'
"""Where the environment keeps kind and name of the declared tables on pages."""


class _Table(SphinxDirective):
    """A table that is made as Markdown and read as the text around it."""

    def run(self) -> list[nodes.Node]:
        try:
            return self.parse_text_to_nodes(self.markdown())
        except DdctError as error:
            raise self.error(str(error)) from error

    def markdown(self) -> str:
        raise NotImplementedError

    @property
    def folder(self) -> Path:
        """The folder of the page, for files beside it."""
        return Path(self.env.doc2path(self.env.docname)).parent


class _DeclaredTable(_Table):
    required_arguments = 1

    def markdown(self) -> str:
        kind, (name,) = self.name.removeprefix(_PREFIX), self.arguments
        tables = tables_of(kind)
        if name not in tables:
            raise DdctError(f'no table {name} of {kind}: choose from {", ".join(tables)}')
        _shown(self.env).add((kind, name))
        return as_markdown(tables[name])


class _ResultTable(_Table):
    required_arguments = 2

    def markdown(self) -> str:
        file, name = self.arguments
        return result_table(file, name, Path(self.config.ddct_results), self.folder / 'pictures')


class _SchemaTable(_Table):
    def markdown(self) -> str:
        return schema_table(self.folder / 'schemas')


class _TopicTable(_Table):
    has_content = True

    def markdown(self) -> str:
        contents = dict(line.split(': ', 1) for line in self.content if ': ' in line)
        names = [topic.name for topic in TOPICS]
        if list(contents) != names:
            raise DdctError(f'give a line for each of these topics in this order: {names}')
        rows = [
            (
                *(f'`{each.name}`', each.type.replace('/msg/', '/'), each.publisher),
                *(each.frame or '-', contents[each.name]),
            )
            for each in TOPICS
        ]
        return as_markdown(TextTable('', ('topic', 'type', 'from', 'frame', 'content'), rows))


def _shown(env: Any) -> set[tuple[str, str]]:
    if not hasattr(env, _SHOWN):
        setattr(env, _SHOWN, set())
    shown: set[tuple[str, str]] = getattr(env, _SHOWN)
    return shown


def _warn_of_unshown(app: Any, env: Any) -> None:
    every = {(kind, name) for kind in KINDS for name in tables_of(kind)}
    for kind, name in sorted(every - _shown(env)):
        logging.getLogger(__name__).warning('no page shows the table %s of %s', name, kind)


def setup(app: Any) -> dict[str, bool]:
    """Add the directives, and the setting `ddct_results`: the folder of the results."""
    app.add_config_value('ddct_results', '', 'env', str)
    for kind in KINDS:
        app.add_directive(f'{_PREFIX}{kind}', _DeclaredTable)
    app.add_directive(f'{_PREFIX}results', _ResultTable)
    app.add_directive(f'{_PREFIX}schemas', _SchemaTable)
    app.add_directive(f'{_PREFIX}topics', _TopicTable)
    app.connect('env-check-consistency', _warn_of_unshown)
    return {'parallel_read_safe': False}

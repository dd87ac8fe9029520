# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Parts of a page: templates, styles and scripts, and typeset text."""

import json
import re
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any, Self

from jinja2 import (
    Environment,
    FileSystemBytecodeCache,
    FunctionLoader,
    StrictUndefined,
    Template,
)
from jinja2.bccache import Bucket
from markupsafe import Markup, escape

from ddct_bringup.manifest.code import code_digest
from ddct_plant.files.cache_folder import cache_folder
from ddct_plant.program.table import PURE

DOCUMENTS = 'ddct_bringup.documents'
"""Room whose style and script every page has."""
MARKER = '<meta name="generator" content="ddct_bringup report">'
"""Tag that identifies a page written by this program, which it may replace."""
_SYMBOL = re.compile(r'\b([A-Za-z]{1,2})_([A-Za-z0-9]+)\b')
_RAISED = str.maketrans('0123456789.', '⁰¹²³⁴⁵⁶⁷⁸⁹·')


class _KeptTemplates(FileSystemBytecodeCache):
    """Compiled templates on the disk; a folder that cannot be used is no error."""

    @classmethod
    def of_this_code(cls) -> Self | None:
        """Return those that the current code compiled, None where nothing is to be kept."""
        folder = cache_folder('pages')
        if folder is None:
            return None
        return cls(str(folder / f'{code_digest()}-{version("jinja2")}'))

    def load_bytecode(self, bucket: Bucket) -> None:
        """Read a compiled template."""
        with suppress(OSError):
            super().load_bytecode(bucket)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep a compiled template."""
        with suppress(OSError):
            Path(self.directory).mkdir(parents=True, exist_ok=True)
            super().dump_bytecode(bucket)


@cache
def page_template(room: str, name: str) -> Template:
    """Return a template in the folder of a room such as `ddct_bringup.report`."""
    environment = Environment(
        loader=FunctionLoader(lambda part: str(page_part(room, part))),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        bytecode_cache=_KeptTemplates.of_this_code(),
    )
    environment.filters |= {'symbols': symbols, 'unit': unit_text}
    return environment.get_template(name)


def page_part(room: str, name: str) -> Markup:
    """Return a style or script of a room, unchanged."""
    return Markup((files(room) / name).read_text(encoding='utf-8'))


def json_data(content: Any) -> Markup:
    """Return JSON that is safe in a script element."""
    text = json.dumps(content, separators=(',', ':'), allow_nan=False)
    return Markup(text.replace('<', '\\u003c'))


def symbols(text: str) -> Markup:
    """Return text with symbols such as w_sr typeset with an index, and a deviation as σ."""
    return Markup(_SYMBOL.sub(r'\1<sub>\2</sub>', str(escape(text.replace('std ', 'σ ')))))


def unit_text(unit: str) -> str:
    """Return a unit as printed, empty for a pure number."""
    if unit == PURE:
        return ''
    raised = re.sub(r'\^([\d.]+)', lambda match: match[1].translate(_RAISED), unit)
    return re.sub('^deg', '°', raised)


def number_text(value: float | None, form: str) -> str:
    """Return a number in a format, or a dash for a missing value or limit."""
    return '–' if value is None else format(value, form)


def value_text(value: float | None) -> str:
    """Return a number with four digits, or with every digit before the point up to a million."""
    large = value is not None and 1e4 <= abs(value) < 1e6
    return number_text(value, '.0f' if large else '.4g')

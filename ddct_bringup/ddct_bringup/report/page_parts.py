"""What a page is put together with: one HTML file that needs nothing else."""

import json
from functools import cache
from importlib.resources import files
from typing import Any

from jinja2 import Environment, FunctionLoader, StrictUndefined, Template
from markupsafe import Markup

from ddct_bringup.report.typeset import symbols, unit_text


@cache
def page_template(room: str, name: str) -> Template:
    """Return a template that lies beside the modules of a room, as `ddct_bringup.report`."""
    environment = Environment(
        loader=FunctionLoader(lambda part: str(page_part(room, part))),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {'symbols': symbols, 'unit': unit_text}
    return environment.get_template(name)


def page_part(room: str, name: str) -> Markup:
    """Return a style or script of a room, as it stands."""
    return Markup((files(room) / name).read_text(encoding='utf-8'))


def json_data(content: Any) -> Markup:
    """Return JSON that may stand in a script element."""
    text = json.dumps(content, separators=(',', ':'), allow_nan=False)
    return Markup(text.replace('<', '\\u003c'))

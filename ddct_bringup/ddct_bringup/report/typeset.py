"""How the page writes names, units and numbers."""

import re

from markupsafe import Markup, escape

from ddct_plant.program.table import PURE

_SYMBOL = re.compile(r'\b([A-Za-z]{1,2})_([A-Za-z0-9]+)\b')
_RAISED = str.maketrans('0123456789.', '⁰¹²³⁴⁵⁶⁷⁸⁹·')


def symbols(text: str) -> Markup:
    """Return text with w_sr and its like as letters with an index, and a deviation as σ."""
    return Markup(_SYMBOL.sub(r'\1<sub>\2</sub>', str(escape(text.replace('std ', 'σ ')))))


def unit_text(unit: str) -> str:
    """Return a unit as it is printed, empty for a pure number."""
    if unit == PURE:
        return ''
    raised = re.sub(r'\^([\d.]+)', lambda match: match[1].translate(_RAISED), unit)
    return re.sub('^deg', '°', raised)


def number_text(value: float | None, form: str) -> str:
    """Return a number in a format, or a dash for what does not exist or has no limit."""
    return '–' if value is None else format(value, form)

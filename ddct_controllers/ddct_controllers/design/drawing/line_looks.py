# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Look of a controller's line, in every report and figure.

Colour and dash follow from the controller's name alone. They do not depend on the
other controllers of a page, nor on the order.
"""

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product

LIGHT_COLOURS = ('#3748b5', '#e3301c', '#709f38', '#188ffb', '#855095', '#1b776f')
DARK_COLOURS = ('#727bff', '#f4511e', '#ffdd23', '#b7e2ff', '#f06b9a', '#13ea79')
"""
Colours of lines on a light and on a dark page, as #rrggbb; both of a pair have about the same hue.

A search chose colours far apart for normal, protanopic, deuteranopic and tritanopic eyes, with a
contrast of at least 3 to the page.
"""

DASHES = ((), (7, 3), (2, 2), (9, 3, 2, 3), (14, 4), (9, 3, 2, 3, 2, 3))
"""
Dashes of lines, as lengths of line and gap in pixels, empty for a solid line.

They distinguish lines in a grey print, and more controllers than there are colours.
"""

DOTS = (2, 5)
"""Further dash, for charts in which all `DASHES` are taken."""

MARKS = ('circle', 'square', 'star', 'plus')
"""
Shapes of marks on a line, filled or hollow.

Triangles and diamonds are absent: they mark events and printed values.
"""

_PACKAGED = (
    ('ls8', 'hinf1', 'pi', 'mpc4', 'mpc3', 'lqi'),
    ('ls1', 'ls4', 'ls5', 'ls6', 'ls7', 'ls9'),
    ('hinf2', 'ls2', 'mpc1', 'hinf3', 'ls3', 'mpc2'),
    ('hinf_thesis', 'mpc_torsion', 'hinf_fitted', 'mpc_offset_free', 'mpc_wear', 'hinf_sampled'),
    ('torque_estimator', 'mpc4_wear', 'decoupled_pid', 'mpc_preview', 'pedal_mpc', 'least_jerk'),
)
"""
The packaged controllers: a row for each of `DASHES`, a column for each colour.

Controllers of Table 5.1 have solid lines. Those often drawn together differ in colour.
"""


@dataclass(frozen=True)
class LineLook:
    """Look of a line: colour, dash and marks."""

    colour: int
    """Index of the colour in `LIGHT_COLOURS` and `DARK_COLOURS`."""
    dash: tuple[int, ...]
    """Dash of the line, one of `DASHES`; empty for a solid line."""
    mark: str = ''
    """Shape of the marks, one of `MARKS`; empty for a line without marks."""
    filled: bool = False
    """Whether the marks are filled; otherwise they are hollow."""

    @property
    def light(self) -> str:
        """Colour on a light page, as #rrggbb."""
        return LIGHT_COLOURS[self.colour]


_FIXED = {
    name: LineLook(colour, dash)
    for dash, row in zip(DASHES, _PACKAGED, strict=False)
    for colour, name in enumerate(row)
}
_OTHERS = tuple(
    LineLook(colour, dash, mark, filled=True)
    for mark, dash, colour in product(MARKS, DASHES, range(len(LIGHT_COLOURS)))
)


def controller_look(name: str, repeat: int = 0) -> LineLook:
    """
    Return the look of a controller's line; `repeat` counts further runs of it on the same page.

    A packaged controller has a line of its own without marks. Any other name has one of 144 lines
    with filled marks, by a hash of the name. Further runs of a controller keep its colour and dash
    and have hollow marks of another shape; from the fifth one on they start again.
    """
    look = _FIXED.get(name) or _OTHERS[_hash(name) % len(_OTHERS)]
    if repeat == 0:
        return look
    first = MARKS.index(look.mark) if look.mark else 0
    return LineLook(look.colour, look.dash, MARKS[(first + repeat - 1) % len(MARKS)])


def looks_of(controllers: Iterable[str]) -> list[LineLook]:
    """Return the look of each run's line, in order, from the names of the runs' controllers."""
    names = list(controllers)
    return [controller_look(name, names[:run].count(name)) for run, name in enumerate(names)]


def css_colours(colours: Sequence[str]) -> str:
    """Return the colours of one theme as CSS variables `--run-0`, `--run-1`, ..."""
    return ''.join(f'--run-{index}:{colour};' for index, colour in enumerate(colours))


def sample_svg(look: LineLook) -> str:
    """Return a sample of the line, 36 by 12 pixels, as an SVG element; see `css_colours`."""
    colour = f'var(--run-{look.colour})'
    dash = f' stroke-dasharray="{" ".join(map(str, look.dash))}"' if look.dash else ''
    shapes = f'<line x1="1" y1="6" x2="35" y2="6" style="stroke:{colour}"{dash}/>'
    if look.mark:
        fill = colour if look.filled else 'var(--page)'
        shapes += f'<path d="{_MARK_PATHS[look.mark]}" style="stroke:{colour};fill:{fill}"/>'
    return f'<svg class="sample" viewBox="0 0 36 12" aria-hidden="true">{shapes}</svg>'


_MARK_PATHS = {
    'circle': 'M14 6a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z',
    'square': 'M14.5 2.5h7v7h-7z',
    'star': 'M18 1l1.5 3.4 3.7 .3-2.8 2.4.9 3.6-3.3-1.9-3.3 1.9.9-3.6-2.8-2.4 3.7-.3z',
    'plus': 'M16.6 1.5h2.8v3.1h3.1v2.8h-3.1v3.1h-2.8v-3.1h-3.1v-2.8h3.1z',
}
"""SVG path of each mark, centred at (18, 6), in pixels."""


def _hash(name: str) -> int:
    """Return a hash of the name that is the same in every process and version of Python."""
    return int.from_bytes(hashlib.sha256(name.encode(errors='surrogatepass')).digest()[:8], 'big')

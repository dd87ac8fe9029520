"""A colour and a dash pattern for each run, the same in every chart and table of the page."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

LIGHT_COLOURS = ('#3748b5', '#e3301c', '#709f38', '#188ffb', '#855095', '#1b776f')
DARK_COLOURS = ('#727bff', '#f4511e', '#ffdd23', '#b7e2ff', '#f06b9a', '#13ea79')
"""
On a light and on a dark page, pair by pair of about the same hue. Chosen by a search for colours
far apart for normal, protanopic, deuteranopic and tritanopic eyes, at a contrast of 3 or more.
"""

DASHES = ((), (7, 3), (2, 2), (9, 3, 2, 3), (14, 4), (9, 3, 2, 3, 2, 3))
"""Lengths of line and gap in pixels, for a grey print and for more runs than colours."""


@dataclass(frozen=True)
class LineLook:
    """How the line of one run is drawn."""

    colour: int
    """Index into the colours of either theme."""
    dash: tuple[int, ...]


def line_looks(controllers: Sequence[str], first: Sequence[str]) -> list[LineLook]:
    """
    Return one look per run, given the runs' controllers.

    Runs of one controller share its colour and differ in the dash. The controllers in `first` get
    the first colours; looks repeat only when all combinations are in use.
    """
    order = list(dict.fromkeys([*(name for name in first if name in controllers), *controllers]))
    colour_of = {name: index % len(LIGHT_COLOURS) for index, name in enumerate(order)}
    free: list[LineLook] = []
    looks = {}
    for index in sorted(range(len(controllers)), key=lambda run: order.index(controllers[run])):
        if not free:
            pairs = product(DASHES, range(len(LIGHT_COLOURS)))
            free = [LineLook(colour, dash) for dash, colour in pairs]
        wanted = colour_of[controllers[index]]
        look = next((look for look in free if look.colour == wanted), free[0])
        free.remove(look)
        looks[index] = look
    return [looks[index] for index in range(len(controllers))]

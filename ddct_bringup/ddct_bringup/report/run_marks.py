"""How the runs of a report are told apart: by a label, a colour and a dash, the same all over."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

from ddct_bringup.scores.scoring import Entry

_CONDITIONS: dict[str, Callable[[Entry], str]] = {
    'architecture': lambda entry: str(entry['architecture']),
    'clutch': lambda entry: f'{entry["clutch"]} clutch',
    'wear_gain': lambda entry: f'wear {entry["wear_gain"]:g}',
    'mode': lambda entry: str(entry['mode']),
    'seed': lambda entry: f'seed {entry["seed"]}',
}
"""Facts of a run that its label names when the runs differ in them."""

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


def run_labels(entries: Sequence[Entry]) -> list[str]:
    """
    Return one label per run: its controller, and the conditions in which the runs differ.

    Where that is not enough the bag is named too. A bag that tells no controller goes by its name.
    """
    known = [entry for entry in entries if entry['controller'] is not None]
    differing = [key for key in _CONDITIONS if len({entry[key] for entry in known}) > 1]
    labels = [_label(entry, differing) for entry in entries]
    counts = Counter(labels)
    labels = [
        f'{label} ({entry["bag"]})' if counts[label] > 1 else label
        for label, entry in zip(labels, entries, strict=True)
    ]
    return _numbered(labels)


def common_conditions(entries: Sequence[Entry]) -> list[str]:
    """Return the conditions that all runs share, as a reader would say them."""
    known = [entry for entry in entries if entry['controller'] is not None]
    shared = [key for key in _CONDITIONS if len({entry[key] for entry in known}) == 1]
    return [_CONDITIONS[key](known[0]) for key in shared]


def _label(entry: Entry, differing: Sequence[str]) -> str:
    if entry['controller'] is None:
        return str(entry['bag'])
    return ', '.join([entry['controller'], *(_CONDITIONS[key](entry) for key in differing)])


def _numbered(labels: Sequence[str]) -> list[str]:
    """Return the labels, the second and later of the same text with a number."""
    seen: Counter[str] = Counter()
    result = []
    for label in labels:
        seen[label] += 1
        result.append(f'{label} #{seen[label]}' if seen[label] > 1 else label)
    return result

"""How the runs of a report are named: by the controller, and by what else they differ in."""

from collections import Counter
from collections.abc import Callable, Sequence

from ddct_bringup.scores.scoring import Entry

_CONDITIONS: dict[str, Callable[[Entry], str]] = {
    'architecture': lambda entry: str(entry['architecture']),
    'clutch': lambda entry: f'{entry["clutch"]} clutch',
    'wear_gain': lambda entry: f'wear {entry["wear_gain"]:g}',
    'mode': lambda entry: str(entry['mode']),
    'seed': lambda entry: f'seed {entry["seed"]}',
}
"""Facts of a run that its label names when the runs differ in them."""


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

"""Tables that closed-loop runs make of predictive controllers; other packages bring them."""

import importlib.metadata
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ddct_controllers.entry_points import load_entry_point

ENTRY_POINT_GROUP = 'ddct.mpc_studies'
"""Packages that run closed loops add `name = module:function` here, a StudyFunction."""


@dataclass(frozen=True)
class Study:
    """One table of text, one cell per header in every row, and what to know when reading it."""

    title: str
    headers: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    remarks: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, object]:
        """Return the table with one mapping per row."""
        rows = [dict(zip(self.headers, row, strict=True)) for row in self.rows]
        return {'title': self.title, 'rows': rows, 'remarks': list(self.remarks)}


StudyFunction = Callable[[], Study]


def all_studies() -> dict[str, StudyFunction]:
    """Return every study by name; raise DdctError for one that cannot be loaded."""
    points = importlib.metadata.entry_points(group=ENTRY_POINT_GROUP)
    return {
        point.name: load_entry_point(point, 'MPC study')
        for point in sorted(points, key=lambda point: point.name)
    }

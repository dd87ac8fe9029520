"""What computes the numbers of the gate's file, chapter by chapter."""

import importlib.metadata
from collections.abc import Callable, Iterable, Mapping

from ddct_controllers.design.thesis.h_infinity_values import h_infinity_values
from ddct_controllers.design.thesis.loop_shaping_values import loop_shaping_values
from ddct_controllers.design.thesis.plant_values import plant_values
from ddct_controllers.design.thesis.predictive_values import predictive_values
from ddct_controllers.design.thesis.thesis_number import Value
from ddct_controllers.entry_points import load_entry_point
from ddct_plant.errors import ParameterError

ENTRY_POINT_GROUP = 'ddct.thesis_numbers'
"""Packages that build on this one add `name = module:function` here, a Source."""

Source = Callable[[], Mapping[str, Value | None]]
"""Returns values by the ids of the gate's file, None for what has no value."""

OWN_SOURCES: Mapping[str, Source] = {
    'plant': plant_values,
    'loop shaping': loop_shaping_values,
    'H-infinity': h_infinity_values,
    'predictive control': predictive_values,
}


def all_sources() -> dict[str, Source]:
    """Return every source by name, ours first; raise DdctError for one that cannot be loaded."""
    points = importlib.metadata.entry_points(group=ENTRY_POINT_GROUP)
    return {
        **OWN_SOURCES,
        **{point.name: load_entry_point(point, 'thesis numbers') for point in points},
    }


def compute(
    sources: Mapping[str, Source], progress: Callable[[str], None] = lambda name: None
) -> dict[str, Value | None]:
    """
    Return what all sources compute; `progress` is called with the name of each one first.

    Raise ParameterError when two of them compute the same number.
    """
    values: dict[str, Value | None] = {}
    for name, source in sources.items():
        progress(name)
        found = source()
        _require_new(name, found, values)
        values.update(found)
    return values


def _require_new(name: str, found: Iterable[str], values: Mapping[str, Value | None]) -> None:
    twice = sorted(values.keys() & set(found))
    if twice:
        raise ParameterError(f'thesis numbers of {name}: computed already: {", ".join(twice)}')

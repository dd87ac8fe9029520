"""What computes the numbers of the gate's file, chapter by chapter."""

from collections.abc import Callable, Iterable, Mapping

from ddct_bringup.reproduction.claims.closed_loop_values import closed_loop_values
from ddct_bringup.reproduction.numbers.thesis_number import Value
from ddct_bringup.reproduction.values.h_infinity_values import h_infinity_values
from ddct_bringup.reproduction.values.loop_shaping_values import loop_shaping_values
from ddct_bringup.reproduction.values.plant_values import plant_values
from ddct_bringup.reproduction.values.predictive_values import predictive_values
from ddct_plant.base.errors import ParameterError

Source = Callable[[], Mapping[str, Value | None]]
"""Returns values by the ids of the gate's file, None for what has no value."""

SOURCES: Mapping[str, Source] = {
    'plant': plant_values,
    'loop shaping': loop_shaping_values,
    'H-infinity': h_infinity_values,
    'predictive control': predictive_values,
    'closed loop': closed_loop_values,
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

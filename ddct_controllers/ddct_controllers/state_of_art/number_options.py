"""Options of a controller that are numbers within a range, from `controllers.<name>`."""

from collections.abc import Mapping
from dataclasses import dataclass

from ddct_controllers.interface import ControllerContext
from ddct_plant.checks import require_number
from ddct_plant.errors import ParameterError


@dataclass(frozen=True)
class NumberOption:
    """A number that a scenario may give."""

    default: float
    lowest: float
    highest: float
    """Within this range the loop is tested to be stable at wear gains from 0.7 to 1.3."""


def number_options(
    name: str, context: ControllerContext, options: Mapping[str, NumberOption]
) -> dict[str, float]:
    """
    Return every option's value, the scenario's or the default.

    Raise ParameterError for a key that is not among them, or a value out of its range.
    """
    unknown = set(context.gains) - set(options)
    if unknown:
        raise ParameterError(
            f'controllers.{name}.{min(unknown, key=str)} is not a key of {name}: it has '
            f'{", ".join(options)}'
        )
    return {
        key: require_number(
            f'controllers.{name}.{key}',
            context.gains.get(key, option.default),
            at_least=option.lowest,
            at_most=option.highest,
        )
        for key, option in options.items()
    }

"""Options of a controller that are numbers within a range, from `controllers.<name>`."""

from collections.abc import Mapping
from dataclasses import dataclass

from ddct_controllers.interface import ControllerContext
from ddct_controllers.option_keys import require_known_keys
from ddct_plant.base.checks import require_number


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
    require_known_keys(name, context.gains, options)
    return {
        key: require_number(
            f'controllers.{name}.{key}',
            context.gains.get(key, option.default),
            at_least=option.lowest,
            at_most=option.highest,
        )
        for key, option in options.items()
    }

"""What a figure of the thesis is here: its number, its subject and the function that draws it."""

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

from ddct_plant.base.errors import ParameterError


@dataclass(frozen=True, eq=False)
class Drawing:
    """A drawn figure, with one line of what agrees with the thesis and what does not."""

    figure: Figure
    remark: str


@dataclass(frozen=True)
class ThesisFigure:
    """One figure of the thesis that can be computed."""

    number: str
    """As the thesis has it, such as '2.10'."""
    title: str
    """What it shows."""
    draw: Callable[[str], Drawing]
    """Computes and draws; takes the heading to put over the chart."""

    @property
    def heading(self) -> str:
        """The title with the figure's number."""
        return f'Figure {self.number}: {self.title}'


@dataclass(frozen=True)
class DrawnFigure:
    """A figure with what its drawing found out."""

    figure: ThesisFigure
    remark: str


def figure_order(number: str) -> tuple[int, int]:
    """Return the chapter and the place of a number such as '2.10'; raise ParameterError."""
    chapter, _, place = number.partition('.')
    if not (chapter.isdecimal() and place.isdecimal()):
        raise ParameterError(f'figure {number!r}: give numbers such as 2.10, separated by commas')
    return int(chapter), int(place)

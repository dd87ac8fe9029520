"""
The words of Table 5.2, judged by one rule that was set after looking at the figures.

The thesis names no limits; what a word says is an order. A row of words holds where every figure
grows with the word, and within one word the largest is at most twice the smallest.
"""

import math
from collections.abc import Mapping, Sequence

from ddct_bringup.reproduction.numbers.thesis_number import Finding

WORDS = (('good', 'low'), ('average',), ('bad', 'high'))
"""From the best to the worst."""
_ALIKE = 2.0
"""Largest ratio of two figures that have the same word."""
_NONE = math.inf
"""For a figure that does not exist, as of a run that grows beyond all numbers."""


def judge_words(
    words: Mapping[str, str], figures: Sequence[tuple[str, Mapping[str, float | None]]]
) -> dict[str, Finding]:
    """
    Return what each controller's word comes to, by its name.

    `words` has the printed word by controller; `figures` a unit and the figures by controller, for
    each quantity that the words are about. A word holds when it is right beside all the others.
    """
    return {
        name: Finding(
            all(_stands(name, other, words, row) for _, row in figures for other in words),
            ', '.join(_text(row[name], unit) for unit, row in figures),
        )
        for name in words
    }


def _stands(
    name: str, other: str, words: Mapping[str, str], row: Mapping[str, float | None]
) -> bool:
    """Return whether the figures of two controllers are as their words say."""
    mine, theirs = _known(row[name]), _known(row[other])
    order = _rank(words[name]) - _rank(words[other])
    if order == 0:
        return max(mine, theirs) <= _ALIKE * min(mine, theirs)
    return mine > theirs if order > 0 else mine < theirs


def _rank(word: str) -> int:
    return next(rank for rank, same in enumerate(WORDS) if word in same)


def _known(figure: float | None) -> float:
    return _NONE if figure is None else figure


def _text(figure: float | None, unit: str) -> str:
    return 'no figure' if figure is None else f'{figure:.3g} {unit}'

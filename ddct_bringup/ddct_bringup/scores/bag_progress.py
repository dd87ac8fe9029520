"""Signs of life while many bags are read."""

from collections.abc import Iterable, Sequence
from typing import TypeVar

from rich.console import Console
from rich.progress import track

Bag = TypeVar('Bag')


def with_progress(bags: Sequence[Bag], description: str) -> Iterable[Bag]:
    """Show progress on standard error while the bags are gone through, on a terminal only."""
    console = Console(stderr=True)
    hidden = not console.is_terminal or len(bags) < 2
    return track(bags, description, console=console, transient=True, disable=hidden)

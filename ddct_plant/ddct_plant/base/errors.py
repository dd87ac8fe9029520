"""Errors that a user can mend; programs print them in one line."""

from ddct_plant.base.printable import printable


class DdctError(Exception):
    """
    Say what is wrong, where, and what to do about it, in one line.

    The text may hold what came from a file or a message: whatever a terminal would not show as it
    stands is escaped here, so that it cannot reach a terminal, a log or a page.
    """

    def __init__(self, text: object) -> None:
        """Keep `text`, made printable."""
        super().__init__(printable(text))


class ForeignError(DdctError):
    """Code of a third party raised, which is the cause; a node's log keeps its traceback."""


class ParameterError(DdctError, ValueError):
    """A parameter, option or scenario key has a value that cannot be used."""


FOREIGN_FAILURES = (Exception, SystemExit)
"""What code of a third party may raise: sys.exit would end the program without a word."""

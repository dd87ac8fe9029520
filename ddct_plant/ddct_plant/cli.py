"""What every program does around its work: one-line errors and honest exit codes."""

import os
import sys
from collections.abc import Callable

from ddct_plant.errors import DdctError

INTERRUPTED = 130
"""Exit code after SIGINT, as shells give it."""
PIPE_CLOSED = 141
"""Exit code after the reader of our output has gone, as shells give it for SIGPIPE."""


def run_program(
    name: str, main_function: Callable[[list[str]], int], argv: list[str] | None
) -> int:
    """
    Run `main_function(argv)` and return the program's exit code.

    `argv` is without the program's name; None takes it from the command line. A DdctError is
    printed on standard error as `<name>: <text>` and gives 1.
    """
    try:
        code = main_function(sys.argv[1:] if argv is None else argv)
        sys.stdout.flush()
    except DdctError as error:
        print(f'{name}: {error}', file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f'{name}: interrupted', file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        # The interpreter flushes standard output once more when it ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return PIPE_CLOSED
    return code

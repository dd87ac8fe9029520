"""What every program does around its work: one-line errors and honest exit codes."""

import argparse
import os
import sys
from collections.abc import Callable
from typing import Any, NoReturn

from ddct_plant.errors import DdctError

USAGE = 2
"""Exit code after options that do not make sense, as argparse gives it."""
INTERRUPTED = 130
"""Exit code after SIGINT, as shells give it."""
PIPE_CLOSED = 141
"""Exit code after the reader of our output has gone, as shells give it for SIGPIPE."""


class ProgramParser(argparse.ArgumentParser):
    """Keeps the lines of descriptions and examples, and complains in one line."""

    def __init__(self, **options: Any) -> None:
        """Take what ArgumentParser takes."""
        options.setdefault('formatter_class', argparse.RawDescriptionHelpFormatter)
        super().__init__(**options)

    def error(self, message: str) -> NoReturn:
        """End the program."""
        self.exit(USAGE, f'{self.prog}: {message}: see {self.prog} --help\n')


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

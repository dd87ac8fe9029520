# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Common parts of all programs: start by name, parser, subcommands, errors, exit codes."""

import argparse
import contextlib
import errno
import gc
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, Protocol

from ddct_plant.base.errors import DdctError, printable
from ddct_plant.base.options import close_name
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import STDOUT
from ddct_plant.program.help_text import HelpFormatter
from ddct_plant.program.signals import (
    interrupted_by,
    interruptible,
    is_first_report,
    stems_from_interrupt,
)

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

_PROGRAMS = 'ddct.programs'
"""Group of the entry points of what `ddct` starts by its first word."""
_SCRIPTS = 'ddct.scripts'
"""Group of the entry points of what `ros2 run` starts: the nodes, and some programs."""
ROS_ARGUMENTS, _END_OF_ROS_ARGUMENTS = '--ros-args', '--'
_USAGE = 2
"""Exit code after invalid options, as in argparse."""
_INTERRUPTED = 130
"""Exit code after SIGINT, as in shells; after another signal n it is 128 + n."""
_PIPE_CLOSED = 141
"""Exit code after the reader of standard output has closed it, as in shells for SIGPIPE."""
_NEW_OBJECTS = 50_000
"""Number of new objects after which garbage is searched for; Python's default is 700."""
_ADVICE = {
    errno.ENAMETOOLONG: 'give a shorter name',
    errno.ENOSPC: 'free some space or choose another place',
    errno.EDQUOT: 'free some space or choose another place',
}


def package_version() -> str:
    """Return the version of the installed packages, or 'unknown' in a bare source tree."""
    # Only here: it takes a tenth of the processor time in which a node starts.
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version('ddct_plant')
    except PackageNotFoundError:
        return 'unknown'


def main() -> int:
    """
    Run the program that has the name of this script, and return its exit code.

    An interruption of its imports ends it as any other.
    """
    name = Path(sys.argv[0]).name

    def start(_argv: list[str]) -> int:
        known = scripts()
        if name not in known:
            raise DdctError(f'no program has this name: choose from {", ".join(sorted(known))}')
        return load_program(known[name])()

    return run_program(name, start, None)


def programs() -> 'dict[str, EntryPoint]':
    """Return the programs of `ddct` by name; of two alike the first on Python's path."""
    return _points(_PROGRAMS)


def scripts() -> 'dict[str, EntryPoint]':
    """Return what `ros2 run` starts, by name; of two alike the first on Python's path."""
    return _points(_SCRIPTS)


def _points(group: str) -> 'dict[str, EntryPoint]':
    from importlib.metadata import entry_points

    return {point.name: point for point in reversed(tuple(entry_points(group=group)))}


def load_program(point: 'EntryPoint') -> Callable[[], int]:
    """Import a program; raise DdctError where a package that it needs is not installed."""
    try:
        loaded: Callable[[], int] = point.load()
    except ImportError as error:
        if interrupted_by():  # some modules report any failure in them as one of an import
            raise
        raise DdctError(f'{point.name} cannot start: {error}: install what it needs') from error
    if interrupted_by():  # a module has dropped it
        raise KeyboardInterrupt
    return loaded


def split_ros_arguments(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """
    Return the arguments of a program that are its own, and those of ROS.

    These are from `--ros-args` to the next `--`, or to the end.
    """
    own: list[str] = []
    for_ros: list[str] = []
    into = own
    for argument in arguments:
        if argument == ROS_ARGUMENTS:
            into = for_ros
        elif argument == _END_OF_ROS_ARGUMENTS and into is for_ros:
            into = own
        else:
            into.append(argument)
    return own, for_ros


def number_in(unit: str = '') -> Callable[[str], float]:
    """Return the `type` of an option that takes a number in a unit, empty for none or several."""
    alone = f'a number in {unit}, without the unit' if unit else 'a number alone, without a unit'

    def number(text: str) -> float:
        try:
            return float(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f'{text!r} is no number: give {alone}') from None

    return number


class _Version(argparse.Action):
    """Option that prints the version, which is read only then, and ends the program."""

    def __init__(self, option_strings: Sequence[str], dest: str, help: str) -> None:
        super().__init__(option_strings, dest, nargs=0, default=argparse.SUPPRESS, help=help)

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        parser._print_message(f'{package_version()}\n', sys.stdout)
        parser.exit()


class ProgramParser(argparse.ArgumentParser):
    """Argument parser with --version, whose help fits the terminal and whose errors are a line."""

    def __init__(self, **options: Any) -> None:
        """Accept the options of ArgumentParser."""
        options.setdefault('formatter_class', HelpFormatter)
        super().__init__(**options)
        self.register('type', float, number_in())
        self.add_argument('--version', action=_Version, help='print it, and end')

    def error(self, message: str) -> NoReturn:
        """End the program with the exit code 2 and one line on standard error."""
        see = ' See' if message.endswith('?') else ': see'
        self.exit(_USAGE, f'{self.prog}: {printable(message)}{see} {self.prog} --help\n')

    def _print_message(self, message: str, file: Any = None) -> None:
        """Write help or version; raise OSError where it fails, which argparse would ignore."""
        stream = file or sys.stderr
        if message and stream is not None:
            stream.write(message)


class _Subcommand(Protocol):
    """A module, or an object, that adds a subcommand to a program."""

    def add_parser(self, subparsers: Any, /) -> None:
        """Add its parser, whose default `run` takes the options and returns the exit code."""


@dataclass(frozen=True)
class LateSubcommand:
    """A subcommand whose module is imported only where it is chosen."""

    help: str
    """What it does, in the program's own --help."""
    load: Callable[[], _Subcommand]
    """Import its module."""


def run_subcommands(
    parser: ProgramParser,
    commands: Mapping[str, LateSubcommand],
    argv: list[str] | None,
    *,
    metavar: str,
) -> int:
    """
    Run the subcommand that `argv` names first, by `run_program`, and return the exit code.

    The others are in the program's --help alone.
    """

    def chosen(argv: list[str]) -> int:
        subparsers = parser.add_subparsers(required=True, metavar=metavar)
        for name, command in commands.items():
            if argv[:1] == [name]:
                command.load().add_parser(subparsers)
            else:
                subparsers.add_parser(name, help=command.help)
        if argv and not argv[0].startswith('-') and argv[0] not in commands:
            what = f'unknown subcommand {argv[0]}'
            parser.error(f'{what}: {close_name(argv[0], commands)}')
        options, unknown = parser.parse_known_args(argv)
        if unknown:
            subparsers.choices[argv[0]].error(f'unrecognized arguments: {" ".join(unknown)}')
        return options.run(options)

    return run_program(parser.prog, chosen, argv)


def run_program(
    name: str, main_function: Callable[[list[str]], int], argv: list[str] | None
) -> int:
    """
    Run `main_function(argv)` and return the program's exit code.

    `argv` is without the program's name; None takes it from the command line. A DdctError is
    printed on standard error as `<name>: <text>` and gives 1, and so is an error of the operating
    system, such as a name that is too long, a full disk or a full standard output. SIGINT and
    SIGTERM are printed as a line too, one for all of them, and give 128 and the number of the
    first, also where Python or a module has made another exception of them. After them the process
    must end where `argv` is None: a further SIGINT ends it at once.
    """
    given = sys.argv[1:] if argv is None else argv

    def work() -> int:
        try:
            return main_function(given)
        finally:  # argparse ends the program itself after --help
            _flush()

    ends_process = argv is None
    with interruptible(ends_process=ends_process) as called, _rare_collection(ends_process):
        try:
            result: int = called(work)
            return result
        except BaseException as error:
            code = _reported(name, error)
            if code is None:
                raise
            return code


@contextlib.contextmanager
def _rare_collection(ends_process: bool) -> Iterator[None]:
    """
    Search for garbage less often, which takes a tenth of the time of a program otherwise.

    A process that ends after it leaves its objects to the operating system: Python would search
    all of them several times.
    """
    before = gc.get_threshold()
    gc.set_threshold(_NEW_OBJECTS, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)
        if ends_process:
            gc.freeze()


def _reported(name: str, error: BaseException) -> int | None:
    """Report in a line what ended a program; return the exit code, None where Python shows it."""
    if isinstance(error, KeyboardInterrupt):
        return _interrupted(name, str(error))
    if isinstance(error, BrokenPipeError):
        _drop_output()
        return _PIPE_CLOSED
    if isinstance(error, DdctError | OSError):
        # Its context does not count: what failed after an interruption has to be reported.
        if stems_from_interrupt(error.__cause__):
            return _interrupted(name)
        if isinstance(error, DdctError):
            complain(name, error)
        else:
            complain(name, _io_error_text(error))
            _drop_output()
        return 1
    # Modules in C drop the interruption behind these two.
    dropped = isinstance(error, ImportError | SystemError) and interrupted_by()
    if dropped or (isinstance(error, Exception) and stems_from_interrupt(error)):
        return _interrupted(name)
    return None


def _interrupted(name: str, text: str = '') -> int:
    """Report an interruption, unless a program within has done so; return the exit code."""
    if is_first_report():
        complain(name, text or 'interrupted')
    return 128 + interrupted_by() if interrupted_by() else _INTERRUPTED


def show_and_write(target: str | None, content: Any, show: Callable[[], None]) -> None:
    """Call `show` unless `--json` is for standard output; write `content` as JSON to `target`."""
    if target != STDOUT:
        show()
    if target:
        write_json(target, content)


def complain(name: str, text: object) -> None:
    """Print `<name>: <text>` as one line of printable characters on standard error."""
    print(f'{name}: {printable(text)}', file=sys.stderr, flush=True)


def _flush() -> None:
    if sys.stdout is not None:  # it is None when it was closed before the start
        sys.stdout.flush()


def _io_error_text(error: OSError) -> str:
    """Return one line about an error of the operating system: the file, the cause, an advice."""
    what = 'the output' if error.filename is None else error.filename
    advice = _ADVICE.get(error.errno or 0, 'choose another place')
    return f'{what}: {error.strerror or error}: {advice}'


def _drop_output() -> None:
    """Redirect standard output to the null device, as the interpreter flushes it at its end."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())

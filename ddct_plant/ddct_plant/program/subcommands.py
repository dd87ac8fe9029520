# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Programs with subcommands, of which only the chosen one is imported."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from ddct_plant.program.command_line import ProgramParser, run_program


class Subcommand(Protocol):
    """A module, or an object, that adds a subcommand to a program."""

    def add_parser(self, subparsers: Any, /) -> None:
        """Add its parser, whose default `run` takes the options and returns the exit code."""


@dataclass(frozen=True)
class LateSubcommand:
    """A subcommand whose module is imported only where it is chosen."""

    help: str
    """What it does, in the program's own --help."""
    load: Callable[[], Subcommand]
    """Import its module."""


def run_subcommands(
    parser: ProgramParser,
    commands: Iterable[Subcommand],
    argv: list[str] | None,
    *,
    metavar: str,
) -> int:
    """Run the subcommand that `argv` chooses, by `run_program`, and return the exit code."""

    def add_all(subparsers: Any, argv: list[str]) -> None:
        for command in commands:
            command.add_parser(subparsers)

    return _run_chosen(parser, add_all, argv, metavar)


def run_late_subcommands(
    parser: ProgramParser,
    commands: Mapping[str, LateSubcommand],
    argv: list[str] | None,
    *,
    metavar: str,
) -> int:
    """Run the subcommand that `argv` names first; the others are in the program's --help alone."""

    def add_chosen(subparsers: Any, argv: list[str]) -> None:
        for name, command in commands.items():
            if argv[:1] == [name]:
                command.load().add_parser(subparsers)
            else:
                subparsers.add_parser(name, help=command.help)

    return _run_chosen(parser, add_chosen, argv, metavar)


def _run_chosen(
    parser: ProgramParser,
    add: Callable[[Any, list[str]], None],
    argv: list[str] | None,
    metavar: str,
) -> int:
    def chosen(argv: list[str]) -> int:
        add(parser.add_subparsers(required=True, metavar=metavar), argv)
        options = parser.parse_args(argv)
        return options.run(options)

    return run_program(parser.prog, chosen, argv)

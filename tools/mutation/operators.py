# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Mutations of the syntax tree of a module, each a small change of its text."""

import ast
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

_OPERATORS: dict[type[ast.AST], tuple[str, str]] = {
    ast.Add: ('+', '-'),
    ast.Sub: ('-', '+'),
    ast.Mult: ('*', '/'),
    ast.Div: ('/', '*'),
    ast.FloorDiv: ('//', '/'),
    ast.Mod: ('%', '*'),
    ast.Pow: ('**', '*'),
    ast.BitOr: ('|', '&'),
    ast.BitAnd: ('&', '|'),
    ast.MatMult: ('@', '+'),
    ast.Lt: ('<', '<='),
    ast.LtE: ('<=', '<'),
    ast.Gt: ('>', '>='),
    ast.GtE: ('>=', '>'),
    ast.Eq: ('==', '!='),
    ast.NotEq: ('!=', '=='),
    ast.Is: ('is', 'is not'),
    ast.IsNot: (r'is\s+not', 'is'),
    ast.In: ('in', 'not in'),
    ast.NotIn: (r'not\s+in', 'in'),
    ast.And: ('and', 'or'),
    ast.Or: ('or', 'and'),
}
_FUNCTIONS = {'min': 'max', 'max': 'min', 'any': 'all', 'all': 'any'}
_LEFT_OUT = (ast.Raise, ast.JoinedStr, ast.Import, ast.ImportFrom, ast.Global, ast.Nonlocal)
"""Words of messages, names and imports: most changes there are found at once or mean nothing."""


@dataclass(frozen=True)
class Mutation:
    """One change; `function`, `old` and `ordinal` find it again in a later commit."""

    file: str
    """Path in the repository."""
    function: str
    """Dotted name of the class and function around it; empty at module level."""
    operator: str
    """Kind of the change."""
    line: int
    """Line of the changed text, from 1."""
    start: int
    end: int
    """Offsets of the changed text in the file, in bytes."""
    old: str
    new: str
    context: str
    """The statement around it, on one line."""
    ordinal: int = 0
    """Number of equal changes before it in the same function."""

    @property
    def name(self) -> str:
        """Return a line that names it."""
        return (
            f'{self.file}:{self.line} {self.function} [{self.operator}] {self.old} -> {self.new}'
        )

    def key(self) -> tuple[Any, ...]:
        """Return what stays the same while its statement does."""
        return self.file, self.function, self.operator, self.old, self.new, self.context

    def apply(self, root: Path) -> None:
        """Write the changed text into the file below `root`; ValueError where it is not there."""
        path = root / self.file
        data = path.read_bytes()
        if data[self.start : self.end].decode() != self.old:
            raise ValueError(f'{path}: {self.old!r} is not at byte {self.start}')
        path.write_bytes(data[: self.start] + self.new.encode() + data[self.end :])

    def as_json(self) -> dict[str, Any]:
        """Return its fields."""
        return asdict(self)


def mutations(root: Path, file: str) -> list[Mutation]:
    """Return all mutations of a file in the order of its text; ordinals are set."""
    text = (root / file).read_text(encoding='utf-8')
    found = sorted(_Finder(file, text).found, key=lambda each: (each.start, each.end, each.new))
    before: Counter[tuple[Any, ...]] = Counter()
    numbered = []
    for each in found:
        numbered.append(Mutation(**{**each.as_json(), 'ordinal': before[each.key()]}))
        before[each.key()] += 1
    return numbered


def code_lines(text: str) -> int:
    """Return how many lines hold a statement or a part of one, without docstrings."""
    lines: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            continue
        if isinstance(node, ast.stmt | ast.expr) and not isinstance(node, ast.Constant):
            lines.add(node.lineno)
    return len(lines)


class _Finder:
    """Walk through a module; `found` has its mutations."""

    def __init__(self, file: str, text: str) -> None:
        self._file = file
        self._data = text.encode()
        self._line_starts = [0]
        for line in self._data.splitlines(keepends=True):
            self._line_starts.append(self._line_starts[-1] + len(line))
        self.found: list[Mutation] = []
        self._statement: ast.stmt | None = None
        self._body(ast.parse(text).body, ())

    def _body(self, body: list[ast.stmt], names: tuple[str, ...]) -> None:
        for statement in body:
            self._visit(statement, names)

    def _visit(self, node: ast.AST, names: tuple[str, ...]) -> None:
        """Collect the mutations at a node, then below it."""
        if isinstance(node, _LEFT_OUT) or _is_text(node) or _is_guard(node):
            return
        outer = self._statement
        if isinstance(node, ast.stmt):
            self._statement = node
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            inner = (*names, node.name)
            if not isinstance(node, ast.ClassDef):
                for default in (*node.args.defaults, *node.args.kw_defaults):
                    if default is not None:
                        self._visit(default, inner)
            self._body(node.body, inner)
        else:
            for operator, start, end, new in self._changes(node):
                self._add(node, names, operator, start, end, new)
            for field, value in ast.iter_fields(node):
                if field in ('annotation', 'returns', 'type_params'):
                    continue
                for child in value if isinstance(value, list) else [value]:
                    if isinstance(child, ast.AST):
                        self._visit(child, names)
        self._statement = outer

    def _add(
        self, node: ast.AST, names: tuple[str, ...], operator: str, start: int, end: int, new: str
    ) -> None:
        old = self._data[start:end].decode()
        statement = self._statement
        assert statement is not None
        first = self._data[self._offset(statement, True) : self._offset(statement, False)].decode()
        self.found.append(
            Mutation(
                self._file,
                '.'.join(names),
                operator,
                self._data[:start].count(b'\n') + 1,
                start,
                end,
                old,
                new,
                ' '.join(first.split())[:200],
            )
        )

    def _changes(self, node: ast.AST) -> Iterator[tuple[str, int, int, str]]:
        """Yield the kind, the bytes and the new text of each change of a node."""
        match node:
            case ast.BinOp():
                yield from self._between('arithmetic', node.left, node.op, node.right)
            case ast.BoolOp():
                for left, right in zip(node.values, node.values[1:], strict=False):
                    yield from self._between('logic', left, node.op, right)
            case ast.Compare():
                operands = [node.left, *node.comparators]
                for left, operator, right in zip(operands, node.ops, operands[1:], strict=False):
                    yield from self._between('comparison', left, operator, right)
            case ast.AugAssign():
                yield from self._between('arithmetic', node.target, node.op, node.value)
                yield ('no statement', *self._span(node), 'pass')
            case ast.UnaryOp(op=ast.Not()):
                start = self._offset(node, True)
                yield ('no negation', start, start + len('not'), '')
            case ast.UnaryOp(op=ast.USub()):
                start = self._offset(node, True)
                yield ('sign', start, start + 1, '+')
            case ast.Constant():
                yield from self._constant(node)
            case ast.If() | ast.While() | ast.IfExp():
                start, end = self._span(node.test)
                yield ('condition', start, end, f'not ({self._data[start:end].decode()})')
            case ast.Return(value=ast.expr() as value) if not _is_none(value):
                yield ('no result', *self._span(value), 'None')
            case ast.Expr(value=ast.Call()):
                yield ('no statement', *self._span(node), 'pass')
            case ast.Break():
                yield ('loop', *self._span(node), 'continue')
            case ast.Continue():
                yield ('loop', *self._span(node), 'break')
            case ast.Call(func=ast.Name(id=name)) if name in _FUNCTIONS:
                yield ('function', *self._span(node.func), _FUNCTIONS[name])

    def _constant(self, node: ast.Constant) -> Iterator[tuple[str, int, int, str]]:
        value: object = node.value
        if isinstance(value, bool):
            yield ('constant', *self._span(node), str(not value))
        elif isinstance(value, int):
            yield ('constant', *self._span(node), str(value + 1))
        elif isinstance(value, float):
            yield ('constant', *self._span(node), repr(2.0 * value if value else 1.0))

    def _between(
        self, kind: str, left: ast.AST, operator: ast.AST, right: ast.AST
    ) -> Iterator[tuple[str, int, int, str]]:
        """Yield the change of the operator between two operands."""
        if type(operator) not in _OPERATORS:
            return
        pattern, new = _OPERATORS[type(operator)]
        start, end = self._offset(left, False), self._offset(right, True)
        escaped = pattern if '\\s' in pattern or pattern.isalpha() else re.escape(pattern)
        match = re.search(escaped, re.sub(r'#[^\n]*', _blank, self._data[start:end].decode()))
        if match:
            yield (kind, start + match.start(), start + match.end(), new)

    def _span(self, node: ast.AST) -> tuple[int, int]:
        return self._offset(node, True), self._offset(node, False)

    def _offset(self, node: Any, start: bool) -> int:
        line: int
        column: int
        line, column = (
            (node.lineno, node.col_offset) if start else (node.end_lineno, node.end_col_offset)
        )
        return self._line_starts[line - 1] + column


def _blank(match: re.Match[str]) -> str:
    return ' ' * len(match.group())


def _is_none(node: ast.AST | None) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def _is_text(node: ast.AST) -> bool:
    """Return whether a node is a docstring or another lone constant."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def _is_guard(node: ast.AST) -> bool:
    """Return whether a node is code for a type checker, or the start of a program."""
    if not isinstance(node, ast.If):
        return False
    names = {each.id for each in ast.walk(node.test) if isinstance(each, ast.Name)}
    return bool(names & {'TYPE_CHECKING', '__name__'})

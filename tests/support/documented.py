# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Commands and links of the documentation."""

import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from waiting import WITHIN_S

ROOT = Path(__file__).resolve().parents[2]
PAGES = (ROOT / 'README.md', *sorted((ROOT / 'docs').rglob('*.md')))
_FENCE = re.compile(r'^(```+)(\S*).*?\n(.*?)^\1$', re.DOTALL | re.MULTILINE)
_INDENTED = re.compile(r'(?:^    .*\n)+', re.MULTILINE)
_LINK = re.compile(r'\[[^\]]*\]\(([^)#\s]+)[^)]*\)')
_COMMAND = re.compile(
    r'^(ddct |ros2|make|\.|colcon|sudo|rosdep|python3?|cc|cp|git|pip|jupyter|tools/run) ?\S'
)


@dataclass(frozen=True)
class Block:
    """Text of one code block."""

    page: str
    """Path of the page, relative to the root of the repository."""
    language: str
    text: str

    @property
    def lines(self) -> tuple[str, ...]:
        """Commands of the block, continued lines joined."""
        joined = self.text.replace('\\\n', ' ')
        return tuple(' '.join(line.split()) for line in joined.splitlines() if line.strip())

    @property
    def is_shell(self) -> bool:
        """Whether every line is a command."""
        return bool(self.lines) and all(_COMMAND.match(line) for line in self.lines)


def blocks() -> Iterator[Block]:
    """Yield the code blocks of every page, fenced and indented."""
    for page in PAGES:
        text = page.read_text(encoding='utf-8')
        name = str(page.relative_to(ROOT))
        for match in _FENCE.finditer(text):
            yield Block(name, match[2], match[3])
        for match in _INDENTED.finditer(_FENCE.sub('\n', text)):
            dedented = re.sub('^    ', '', match[0], flags=re.MULTILINE)
            yield Block(name, '', dedented)


def package_page(package: str) -> str:
    """Return the text of the page of one of our packages."""
    return (ROOT / package / 'README.md').read_text(encoding='utf-8')


def links(page: Path) -> list[Path]:
    """Return the files that a page links to within the repository."""
    text = _FENCE.sub('', page.read_text(encoding='utf-8'))
    targets = [target for target in _LINK.findall(text) if '://' not in target]
    return [(page.parent / target).resolve() for target in targets]


def run_examples(page: str, folder: Path) -> None:
    """Run the examples in Python of a page in a folder, one after the other, as one reads them."""
    parts = [block.text for block in blocks() if block.page == page and block.language == 'python']
    assert parts
    done = subprocess.run(
        [sys.executable, '-c', '\n'.join(parts)],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr

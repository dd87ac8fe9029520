# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Commands that programs and pages print: found in their text, and run in this process."""

import html
import re
import shlex
import sys
from collections.abc import Sequence
from unittest import mock

from ddct_bringup.programs import ddct

_GRAPHS = (['compare'], ['campaign', 'replay'])
"""First words of programs that run a graph unless it is left out, which is faster."""
_WITHOUT_GRAPH = {'--help', '--list', '--headless', '--single-process', 'realtime'}


def printed_commands(text: str) -> list[str]:
    """Return the commands on a page, in code or in a title, or on the lines of a terminal."""
    on_page = re.findall(r'<code>(ddct [^<]*)</code>|title="(ddct [^"]*)"', text)
    if on_page:
        return list(dict.fromkeys(html.unescape(code or title) for code, title in on_page))
    return [found[1] for found in re.finditer(r'^(?:.*: |\s*)(ddct .*)$', text, re.MULTILINE)]


def run_printed(command: str, **places: str) -> int:
    """
    Run a printed command and return its exit code; `places` has the values of words to fill in.

    The words are divided as a shell does it. A run of the graph takes place without it.
    """
    return run_words([places.get(word, word) for word in shlex.split(command, comments=True)])


def run_words(words: Sequence[str]) -> int:
    """Run the words of one `ddct PROGRAM ARGUMENTS` in this process; return its exit code."""
    ours = list(words)
    runs_graph = any(ours[1 : 1 + len(each)] == each for each in _GRAPHS)
    if runs_graph and _WITHOUT_GRAPH.isdisjoint(ours):
        ours.append('--headless')
    try:
        with mock.patch.object(sys, 'argv', ours):
            return ddct.main()
    except SystemExit as end:  # of --help
        return 1 if end.code else 0

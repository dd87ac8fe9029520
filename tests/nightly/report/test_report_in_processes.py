# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Two programs write the same page of the same run."""

from pathlib import Path

from support.processes import Programs
from support.runs import plan, record


def test_the_page_of_the_same_run_is_the_same_file(programs: Programs, tmp_path: Path) -> None:
    record(plan('pi', 'headless', duration_s=1.0), tmp_path / 'pi')
    pages = []
    for name in ('first.html', 'second.html'):
        arguments = [str(tmp_path / 'pi'), '--floors', 'none', '--out', str(tmp_path / name)]
        program = programs.start_module('ddct_bringup.programs.report', *arguments)
        assert program.wait() == 0, program.errors()
        pages.append((tmp_path / name).read_bytes())
    assert pages[0] == pages[1]

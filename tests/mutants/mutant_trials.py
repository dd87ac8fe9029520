# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Run tests in a scratch copy of the tracked files, which may have one seeded defect."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import only_the_copy
import pytest
from mutant_entries import Mutant

WITHIN_S = 300.0
"""How long the tests of one defect may take."""


class TrialError(Exception):
    """The tests could not be run, so that the defect is not tried."""


class AllSkippedError(Exception):
    """All tests were skipped, as an optional package is absent, so the defect is not tried."""


def tests_pass(root: Path, tests: Sequence[str], mutant: Mutant | None = None) -> bool:
    """
    Return whether the tests pass in a copy of the repository `root`, changed by `mutant`.

    Raise TrialError if they cannot be collected, do not end or import a package from elsewhere,
    and AllSkippedError if none of them has run.
    """
    with tempfile.TemporaryDirectory(prefix='mutant') as folder:
        # Always a new copy: bytecode of a file of the same second and size would be taken for it.
        copy = Path(folder) / 'copy'
        _copy_tracked_files(root, copy)
        if mutant is not None:
            (copy / mutant.file).write_text(mutant.defective(copy), encoding='utf-8')
        code, printed = _pytest(copy, Path(folder) / 'printed', tests)
    if code not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
        raise TrialError(f'pytest {" ".join(tests)} ended with code {code}:\n{printed}')
    if code == pytest.ExitCode.OK and not re.search(r'\d passed', printed):
        raise AllSkippedError(f'all tests are skipped: {" ".join(tests)}')
    return code == pytest.ExitCode.OK


def _copy_tracked_files(root: Path, copy: Path) -> None:
    """Copy what Git tracks, as it stands in the work tree."""
    listed = subprocess.run(
        ['git', 'ls-files', '-z'], cwd=root, check=True, capture_output=True, text=True
    )
    for name in filter(None, listed.stdout.split('\0')):
        if (root / name).is_file():
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(root / name, copy / name)


def _pytest(copy: Path, printed: Path, tests: Sequence[str]) -> tuple[int, str]:
    """Return pytest's exit code and what it printed."""
    packages = sorted(str(folder.parent) for folder in copy.glob('*/package.xml'))
    here = str(Path(only_the_copy.__file__).parent)
    inherited = os.environ.get('PYTHONPATH', '')
    environment = {
        **os.environ,
        'PYTHONPATH': os.pathsep.join([*packages, here, *filter(None, [inherited])]),
        only_the_copy.VARIABLE: str(copy),
    }
    command = [sys.executable, '-m', 'pytest', '-x', '-q', '--tb=short', '-p', 'no:cacheprovider']
    with printed.open('wb') as output:
        process = subprocess.Popen(
            [*command, '-p', 'only_the_copy', *tests],
            cwd=copy,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
        )
        try:
            code = process.wait(WITHIN_S)
        except subprocess.TimeoutExpired:
            raise TrialError(f'pytest {" ".join(tests)} did not end in {WITHIN_S:g} s') from None
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()
    return code, printed.read_text(encoding='utf-8', errors='replace')

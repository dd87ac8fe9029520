# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Tests of this version beside those of the base commit.

Both versions take tens of minutes, so they are measured by name only. A later version has more
tests, so the time of those that both have and pass is compared, beside that of all.
"""

import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from xml.etree import ElementTree

from bench.comparisons.start_up import BASE, WARM_PARENT
from bench.skeleton.comparison import Bench, Comparison, NotMeasured, Sides, comparison
from bench.skeleton.workspace import ProgramError, Workspace, clean_environment, run_to_end

SHARED, WHOLE = 'tests that both pass', 'all tests'


def _tests(name: str, target: str) -> Comparison:
    @comparison(name, BASE, at_most={SHARED: 0.8}, only_by_name=True)
    def sides(bench: Bench) -> Iterator[Sides]:
        """Sum of the times of single tests of a target of make; ours must all pass."""
        base = bench.require_base()
        # The bound is that of the change to a warm parent.
        before = not (base.folder / WARM_PARENT).exists()
        yield Sides(
            lambda: _passed_s(bench.ours, target),
            # An older version may fail with newer tools than its own.
            lambda: _passed_s(base, target, failures=True),
            bounded=before,
            warm_up=False,
            ratios=_shared_and_whole,
        )

    return sides


TESTS = (_tests('suite: make test', 'test'), _tests('suite: make test-fast', 'test-fast'))


def _shared_and_whole(
    ours: Mapping[str, float], reference: Mapping[str, float]
) -> Mapping[str, float]:
    """Return the ratios of the summed times; raise NotMeasured where no test is in both."""
    both = ours.keys() & reference.keys()
    if not both:
        raise NotMeasured('no test that both versions pass')
    return {
        SHARED: sum(ours[test] for test in both) / sum(reference[test] for test in both),
        WHOLE: sum(ours.values()) / sum(reference.values()),
    }


def _passed_s(workspace: Workspace, target: str, *, failures: bool = False) -> Mapping[str, float]:
    """Return the times in s of the tests that passed; raise ProgramError if one must not fail."""
    build = workspace.folder / 'build'
    for old in build.glob('*/pytest.xml'):
        old.unlink()
    with tempfile.TemporaryDirectory() as folder:
        # An older version has a session for each package, which colcon lets write to its folder.
        result = Path(folder) / 'pytest.xml'
        environment = clean_environment() | {'PYTEST_ADDOPTS': f'--junit-xml={result}'}
        try:
            run_to_end(['make', target], workspace.folder, environment)
        except ProgramError:
            if not failures:
                raise
        results = [*Path(folder).glob('pytest.xml'), *build.glob('*/pytest.xml')]
        return {test: time_s for each in results for test, time_s in passed_in(each)}


def passed_in(result: Path) -> Iterator[tuple[str, float]]:
    """Yield the tests of a session that passed, with their times in s."""
    package = result.parent.name
    for case in ElementTree.parse(result).iter('testcase'):
        if len(case) == 0:  # neither failed nor skipped
            # colcon puts the name of the package before it.
            place = case.get('classname', '').replace(f'{package}.{package}.', f'{package}.')
            yield f'{place}::{case.get("name")}', float(case.get('time', 0))

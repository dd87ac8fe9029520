# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`make mutants` reports which seeded defects live, and refuses entries that are out of date."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ENTRY = """\
- claim: {claim}
  file: ddct_sums/ddct_sums/sums.py
  find: "{find}"
  replace: "{replace}"
  tests: [{test}]
"""


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """Make a repository of one package, whose tests know a + b only at b = 0."""
    files = {
        'ddct_sums/package.xml': '',
        'ddct_sums/ddct_sums/__init__.py': '',
        'ddct_sums/ddct_sums/sums.py': 'def add(a, b):\n    return a + b\n',
        'ddct_sums/test_sums.py': (
            'from ddct_sums.sums import add\n\ndef test_add():\n    assert add(2, 0) == 2\n'
        ),
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding='utf-8')
    for command in (['init', '-q'], ['add', '.']):
        subprocess.run(['git', *command], cwd=tmp_path, check=True)
    return tmp_path


def entry(claim: str, find: str, replace: str, test: str = 'ddct_sums/test_sums.py') -> str:
    return ENTRY.format(claim=claim, find=find, replace=replace, test=test)


def run_mutants(
    repository: Path, *entries: str, options: tuple[str, ...] = ()
) -> subprocess.CompletedProcess[str]:
    file = repository / 'tests' / 'mutants' / 'seeded.yaml'
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(''.join(entries), encoding='utf-8')
    command = [sys.executable, str(HERE / 'run.py'), '--root', str(repository), str(file)]
    return subprocess.run([*command, *options], capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_defects_that_are_caught_and_that_are_not_are_reported_as_such(repository: Path) -> None:
    caught, lives = entry('it multiplies', 'a + b', 'a * b'), entry('-b', 'a + b', 'a - b')
    ended = run_mutants(repository, caught, lives)
    file = 'ddct_sums/ddct_sums/sums.py'
    assert ended.stdout.splitlines() == [
        f'caught  {file}: it multiplies',
        f'LIVED   {file}: -b',
        '1 caught, 1 LIVED, 0 ERROR, 0 skipped',
    ]
    assert ended.returncode == 1
    assert run_mutants(repository, caught).returncode == 0
    assert 'return a + b' in (repository / file).read_text()


@pytest.mark.parametrize(('find', 'times'), [('a - b', 0), ('a', 3)])
@pytest.mark.parametrize('options', [(), ('--check',)])
def test_an_entry_whose_text_is_not_there_exactly_once_is_an_error(
    repository: Path, find: str, times: int, options: tuple[str, ...]
) -> None:
    ended = run_mutants(repository, entry('stale', find, 'a * b'), options=options)
    assert (ended.returncode, ended.stdout) == (1, '')
    assert f'stale: `find` occurs {times} times' in ended.stderr


def test_a_check_tries_no_defect(repository: Path) -> None:
    ended = run_mutants(repository, entry('-b', 'a + b', 'a - b'), options=('--check',))
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, '', '')


@pytest.mark.parametrize(
    'test', ['ddct_sums/test_differences.py', '"ddct_sums/test_sums.py::test_ad"']
)
def test_a_test_that_is_gone_is_an_error(repository: Path, test: str) -> None:
    lacks = entry('-b', 'a + b', 'a - b', test)
    ended = run_mutants(repository, lacks, options=('--check',))
    assert (ended.returncode, ended.stdout) == (1, '')
    assert test.strip('"') in ended.stderr


@pytest.mark.slow
def test_outcomes_are_kept_and_only_the_missing_ones_are_tried_when_that_is_asked(
    repository: Path,
) -> None:
    author = ['-c', 'user.name=a', '-c', 'user.email=a@example']
    subprocess.run(['git', *author, 'commit', '-qm', 'first'], cwd=repository, check=True)
    caught, lives = entry('it multiplies', 'a + b', 'a * b'), entry('-b', 'a + b', 'a - b')
    options = ('--json', str(repository / 'records.json'))
    run_mutants(repository, caught, lives, options=(*options, '--claim', 'multiplies'))
    ended = run_mutants(repository, caught, lives, options=(*options, '--missing'))
    assert ended.stdout.splitlines()[1:] == ['0 caught, 1 LIVED, 0 ERROR, 0 skipped']
    records = json.loads((repository / 'records.json').read_text(encoding='utf-8'))
    outcomes = {claim: record['outcome'] for claim, record in records.items()}
    assert outcomes == {'it multiplies': 'caught', '-b': 'LIVED'}


@pytest.mark.slow
def test_a_defect_is_not_caught_by_tests_that_fail_without_it_or_cannot_be_run(
    repository: Path,
) -> None:
    tests = repository / 'ddct_sums' / 'test_sums.py'
    breaks_import = entry('no import', 'return a + b', 'return a +')
    assert '1 ERROR' in run_mutants(repository, breaks_import).stdout
    tests.write_text(tests.read_text() + '    assert add(2, 0) == 3\n')
    ended = run_mutants(repository, entry('it multiplies', 'a + b', 'a * b'))
    assert (ended.returncode, '1 ERROR' in ended.stdout) == (1, True)
    assert 'without a defect these fail: ddct_sums/test_sums.py' in ended.stderr


@pytest.mark.slow
def test_a_defect_whose_tests_are_all_skipped_is_not_tried(repository: Path) -> None:
    tests = repository / 'ddct_sums' / 'test_sums.py'
    tests.write_text(
        f'import pytest\npytestmark = pytest.mark.skip("absent")\n{tests.read_text()}'
    )
    ended = run_mutants(repository, entry('it multiplies', 'a + b', 'a * b'))
    assert (ended.returncode, '0 LIVED, 0 ERROR, 1 skipped' in ended.stdout) == (0, True)
    assert 'all tests are skipped: ddct_sums/test_sums.py' in ended.stderr


@pytest.mark.slow
def test_a_package_from_outside_the_copy_is_an_error(repository: Path) -> None:
    source = repository / 'ddct_sums' / 'ddct_sums'
    tests = repository / 'ddct_sums' / 'test_sums.py'
    elsewhere = f'import sys\nsys.path.insert(0, {str(source.parent)!r})\n'
    tests.write_text(elsewhere + tests.read_text())
    ended = run_mutants(repository, entry('it multiplies', 'a + b', 'a * b'))
    assert (ended.returncode, '1 ERROR' in ended.stdout) == (1, True)
    assert 'imported from outside' in ended.stderr

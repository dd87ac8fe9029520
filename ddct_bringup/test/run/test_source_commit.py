# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A bag names the commit of the sources, marks changed sources, or names the commit unknown."""

import subprocess
from pathlib import Path

import pytest

from ddct_bringup.run import description
from ddct_bringup.run.description import as_of_commit, commit_of, short_commit, source_commit
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

MODULE = Path('ddct_bringup') / 'ddct_bringup' / 'run' / 'source_commit.py'
OTHER = Path('ddct_plant') / 'ddct_plant' / 'clutch.py'
NOTES = Path('notes.txt')


def git(folder: Path, *arguments: str) -> str:
    identity = ('-c', 'user.name=test', '-c', 'user.email=test@test.invalid')
    command = ['git', '-C', str(folder), *identity, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


@pytest.fixture
def sources(tmp_path: Path) -> Path:
    """Return a repository with the layout of this one."""
    root = tmp_path / 'sources'
    for file in (MODULE, OTHER, NOTES):
        (root / file).parent.mkdir(parents=True, exist_ok=True)
        (root / file).write_text('as committed\n')
    git(tmp_path, 'init', '--quiet', str(root))
    git(root, 'add', '.')
    git(root, 'commit', '--quiet', '--message', 'All of it')
    return root


@pytest.mark.process
def test_clean_sources_have_the_commit_alone(sources: Path) -> None:
    assert commit_of(sources / MODULE) == git(sources, 'rev-parse', 'HEAD')


@pytest.mark.process
def test_an_installed_link_leads_to_the_sources(sources: Path, tmp_path: Path) -> None:
    (tmp_path / 'installed').symlink_to(sources / MODULE)
    assert commit_of(tmp_path / 'installed') == git(sources, 'rev-parse', 'HEAD')


@pytest.mark.process
@pytest.mark.parametrize('change', ['changed', 'staged', 'deleted', 'new'])
def test_uncommitted_changes_are_marked(sources: Path, change: str) -> None:
    file = sources / OTHER
    if change == 'deleted':
        file.unlink()
    else:
        file = file.with_name('new.py') if change == 'new' else file
        file.write_text('another clutch\n')
    if change == 'staged':
        git(sources, 'add', '.')
    assert commit_of(sources / MODULE) == git(sources, 'rev-parse', 'HEAD') + '-dirty'


@pytest.mark.process
def test_what_is_no_part_of_a_package_marks_nothing(sources: Path) -> None:
    (sources / NOTES).write_text('something else\n')
    (sources / 'runs').mkdir()
    (sources / 'runs' / 'pi_0.mcap').touch()
    assert commit_of(sources / MODULE) == git(sources, 'rev-parse', 'HEAD')


@pytest.mark.process
@pytest.mark.parametrize('known', ['ignored', 'untracked', 'only staged'])
def test_a_copy_in_somebody_elses_repository_is_unknown(sources: Path, known: str) -> None:
    copy = sources / 'install' / MODULE
    copy.parent.mkdir(parents=True)
    copy.write_text('as committed\n')
    if known == 'ignored':
        (sources / '.gitignore').write_text('/install/\n')
    if known == 'only staged':
        git(sources, 'add', '.')
    assert commit_of(copy) == 'unknown'


@pytest.mark.process
def test_without_a_repository_or_a_commit_it_is_unknown(tmp_path: Path) -> None:
    module = tmp_path / MODULE
    module.parent.mkdir(parents=True)
    module.touch()
    assert commit_of(module) == 'unknown'
    git(tmp_path, 'init', '--quiet')
    git(tmp_path, 'add', '.')
    assert commit_of(module) == 'unknown'


@pytest.mark.process
def test_without_git_it_is_unknown(
    sources: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('PATH', str(tmp_path))
    assert commit_of(sources / MODULE) == 'unknown'


@pytest.mark.process
def test_a_hook_of_another_repository_does_not_lead_astray(
    sources: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    commit = git(sources, 'rev-parse', 'HEAD')
    git(tmp_path, 'init', '--quiet', 'other')
    monkeypatch.setenv('GIT_DIR', str(tmp_path / 'other' / '.git'))
    monkeypatch.setenv('GIT_WORK_TREE', str(tmp_path / 'other'))
    assert commit_of(sources / MODULE) == commit


@pytest.mark.process
def test_git_is_called_for_the_first_run_of_a_process_alone(
    sources: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A session that goes on while its sources change runs the code that it has loaded."""
    monkeypatch.setattr(description, '__file__', str(sources / MODULE))
    description._loaded_commit.cache_clear()
    try:
        settings = RunSettings(KnownSettings(load_scenario('thesis')))
        first = description.custom_data(settings, 'pi', 300)['commit']
        assert first == git(sources, 'rev-parse', 'HEAD')
        (sources / OTHER).write_text('another clutch\n')
        calls: list[Path] = []
        monkeypatch.setattr(description, '_git', lambda folder, *_: calls.append(folder))
        assert description.custom_data(settings, 'ls8', 300)['commit'] == first
        assert calls == []
    finally:
        description._loaded_commit.cache_clear()


def test_the_bag_contains_the_commit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(description, 'source_commit', lambda: 'abc-dirty')
    settings = RunSettings(KnownSettings(load_scenario('thesis')))
    assert description.custom_data(settings, 'pi', 300)['commit'] == 'abc-dirty'


def test_a_short_commit_keeps_its_mark() -> None:
    commit = '0123456789abcdef0123456789abcdef01234567'
    assert short_commit(commit) == '0123456789'
    assert short_commit(f'{commit}-dirty') == '0123456789-dirty'
    assert short_commit('unknown') == 'unknown'


def test_a_repetition_is_described_by_the_commit_of_its_result() -> None:
    before = source_commit()
    with as_of_commit('abc'):
        assert source_commit() == 'abc'
    assert source_commit() == before

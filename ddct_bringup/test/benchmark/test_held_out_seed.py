# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The seed of held-out cases follows from the digests, so that nobody can choose it."""

from pathlib import Path

import pytest
from python_controllers import IMPORTS, PROPORTIONAL

from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.benchmark.plan import JudgedEntry
from ddct_bringup.manifest.code import code_digest, package_digest

FILE = 'name: mine\nunits: {input: rpm, output: N m}\npolynomial: {num: [-0.1], den: [1.0, 1.0]}\n'
RELEASE = 'a' * 64


def seed_of(text: str, file: Path) -> int:
    file.parent.mkdir(exist_ok=True)
    file.write_text(text, encoding='utf-8')
    return Judged.of(str(file)).held_out_seed(RELEASE)


def test_any_other_byte_of_the_file_gives_another_seed_and_its_place_does_not(
    tmp_path: Path,
) -> None:
    seed = seed_of(FILE, tmp_path / 'mine.yaml')
    assert seed == seed_of(FILE, tmp_path / 'there' / 'other.yaml')
    assert 0 <= seed < 2**31
    assert seed != seed_of(FILE + '#', tmp_path / 'mine.yaml')


def test_any_other_byte_of_a_module_beside_a_python_file_gives_another_seed(
    tmp_path: Path,
) -> None:
    text = f'from helper import X\n{IMPORTS}{PROPORTIONAL}'
    seeds = []
    for helper in ('X = 1\n', 'X = 2\n', 'X = 1\n'):
        (tmp_path / 'helper.py').write_text(helper, encoding='utf-8')
        seeds.append(seed_of(text, tmp_path / 'mine.py'))
    assert seeds[0] == seeds[2] != seeds[1]


def test_another_release_gives_another_seed() -> None:
    judged = Judged.of('pi')
    seeds = [judged.held_out_seed(each * 64) for each in '0123456789abcdef']
    assert len(set(seeds)) == 16
    assert max(seeds) < 2**31, 'a campaign takes no larger one'


def test_controllers_of_one_package_have_different_seeds() -> None:
    pi, ls8 = Judged.of('pi'), Judged.of('ls8')
    assert pi.digests == ls8.digests == {'ddct': code_digest()}
    assert pi.held_out_seed(RELEASE) != ls8.held_out_seed(RELEASE)


def test_a_judge_chooses_the_seed() -> None:
    assert JudgedEntry.of(Judged.of('pi'), RELEASE, 7).held_out_seed == 7


@pytest.mark.parametrize('package', [True, False])
def test_a_controller_of_another_package_has_the_digest_of_its_sources(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, package: bool
) -> None:
    name = f'foreign_{package}'.lower()
    file = tmp_path / name / '__init__.py' if package else tmp_path / f'{name}.py'
    file.parent.mkdir(exist_ok=True)
    monkeypatch.syspath_prepend(str(tmp_path))
    digests = []
    for text in ('x = 1\n', 'x = 2\n'):
        file.write_text(text, encoding='utf-8')
        package_digest.cache_clear()
        digests.append(package_digest(name))
    assert len({*digests, package_digest('no_such_package')}) == 3

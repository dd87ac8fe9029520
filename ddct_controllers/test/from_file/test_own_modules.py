# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A Python file has the modules beside it for itself, and they count as a part of it."""

import inspect
import pickle
import sys
from pathlib import Path
from typing import Any

import pytest
from python_controllers import IMPORTS

from ddct_controllers.check.checks import FAIL, check_controller
from ddct_controllers.from_file.digests import controller_digests
from ddct_controllers.from_file.own_modules import load_module, sources_of
from ddct_controllers.interface import Controller, Measurement
from ddct_controllers.registry import controller_spec, make_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
FILE = 'controller_file_sha256'


def written(folder: Path, files: dict[str, str]) -> Path:
    """Write files, by their path in the folder, and return the folder."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding='utf-8')
    return folder


def controller(imports: str, gain: str, before: str = 'pass') -> str:
    """Return the text of a controller with a gain; `before` stands in its update."""
    return f"""\
{imports}
{IMPORTS}
class Mine(Controller):
    def reset(self):
        pass

    def update(self, measurement):
        {before}
        return Command(-{gain} * measurement.slip_error_rpm)
"""


def made(file: Path) -> Controller:
    return make_controller(str(file), SETTINGS.known)


def gain(of: Controller) -> float:
    """Return the gain in N m/rpm of a controller that is proportional."""
    now = Measurement(0, 2.0, 1.0, 0.0, 0.0, 0.0, [0.0], [0.0])
    return -of.update(now).clutch_torque / now.slip_error_rpm


def refusal(file: Path) -> str:
    with pytest.raises(DdctError) as caught:
        controller_spec(str(file))
    return str(caught.value)


def own_names(file: Path) -> set[str]:
    """Return the names of the modules beside a file that count as a part of it."""
    return {*sources_of(file)} - {''}


EAGER = controller('from helper import GAIN', 'GAIN')
LAZY = controller('', 'GAIN', 'from helper import GAIN')


@pytest.mark.parametrize('text', [EAGER, LAZY], ids=['when it is loaded', 'in its update'])
def test_two_files_have_helpers_of_the_same_name(tmp_path: Path, text: str) -> None:
    files = []
    for name, value in (('one', 0.3), ('two', 0.05)):
        folder = written(tmp_path / name, {'mine.py': text, 'helper.py': f'GAIN = {value}\n'})
        files.append(made(folder / 'mine.py'))
    assert [gain(each) for each in (*files, *files)] == pytest.approx([0.3, 0.05, 0.3, 0.05])


def test_two_files_of_a_folder_share_no_state_in_a_helper(tmp_path: Path) -> None:
    count = 'COUNT.append(1) or len(COUNT)'
    text = controller('from helper import COUNT', f'({count})')
    written(tmp_path, {'one.py': text, 'two.py': text, 'helper.py': 'COUNT = []\n'})
    one, two = made(tmp_path / 'one.py'), made(tmp_path / 'two.py')
    assert [gain(each) for each in (one, one, two)] == [1.0, 2.0, 1.0]


def test_an_edited_helper_is_loaded_anew_and_older_objects_keep_theirs(tmp_path: Path) -> None:
    written(tmp_path, {'mine.py': LAZY, 'helper.py': 'GAIN = 0.3\n'})
    before = made(tmp_path / 'mine.py')
    written(tmp_path, {'helper.py': 'GAIN = 0.2\n'})  # of the same size, within a second
    assert gain(made(tmp_path / 'mine.py')) == pytest.approx(0.2)
    assert gain(before) == pytest.approx(0.3)


def test_nothing_is_left_for_other_code_to_find(tmp_path: Path) -> None:
    path, names = [*sys.path], {*sys.modules}
    files = {'helper.py': 'from parts import x\nGAIN = x.X\n', 'parts/x.py': 'X = 0.1\n'}
    written(tmp_path, {'mine.py': EAGER, **files})
    assert gain(made(tmp_path / 'mine.py')) == pytest.approx(0.1)
    assert sys.path == path
    (own,) = {name.partition('.')[0] for name in {*sys.modules} - names}
    assert own.startswith('controller_file_mine_')


def test_nothing_of_a_file_that_fails_stays_and_a_mended_helper_is_loaded(tmp_path: Path) -> None:
    text = controller('from good import X\nfrom helper import GAIN', 'GAIN')
    written(tmp_path, {'mine.py': text, 'good.py': 'X = 1\n', 'helper.py': 'GAIN = 1 / 0\n'})
    names = {*sys.modules}
    refusal(tmp_path / 'mine.py')
    assert {*sys.modules} == names
    written(tmp_path, {'helper.py': 'GAIN = 0.4\n'})
    assert gain(made(tmp_path / 'mine.py')) == pytest.approx(0.4)


@pytest.mark.parametrize(
    ('imports', 'value'),
    [
        ('import helper', 'helper.GAIN'),
        ('import helper as h', 'h.GAIN'),
        ('from helper import *', 'GAIN'),
        ('from . import helper', 'helper.GAIN'),
        ('from .helper import GAIN', 'GAIN'),
        ('import parts', 'parts.filter.GAIN'),
        ('import parts.filter', 'parts.filter.GAIN'),
        ('import parts.filter as f', 'f.GAIN'),
        ('import parts.deep.last, parts', 'parts.deep.last.GAIN'),
        ('from parts import filter', 'filter.GAIN'),
        ('from parts.deep.last import GAIN', 'GAIN'),
        ('from bare.deep import last', 'last.GAIN'),
        ('import bare.deep.last', 'bare.deep.last.GAIN'),
    ],
)
def test_every_form_of_import_finds_modules_and_packages(
    tmp_path: Path, imports: str, value: str
) -> None:
    files = {
        'helper.py': 'import other\nGAIN = other.GAIN\n',
        'other.py': 'import helper\nGAIN = 0.6\n',
        'parts/__init__.py': 'from . import filter\n',
        'parts/filter.py': 'from helper import GAIN\n',
        'parts/deep/__init__.py': '',
        'parts/deep/last.py': 'from ..filter import GAIN\n',
        'bare/deep/last.py': 'GAIN = 0.6\n',
    }
    written(tmp_path, {**files, 'mine.py': controller(imports, value)})
    assert gain(made(tmp_path / 'mine.py')) == pytest.approx(0.6)


def test_the_standard_library_and_installed_packages_come_first(tmp_path: Path) -> None:
    written(
        tmp_path,
        {
            'mine.py': controller('import statistics, numpy\nfrom .fractions import GAIN', 'GAIN'),
            'statistics.py': 'raise SystemExit(3)\n',
            'numpy/__init__.py': 'raise SystemExit(3)\n',
            'fractions.py': 'from fractions import Fraction\nGAIN = float(Fraction(1, 2))\n',
        },
    )
    assert own_names(tmp_path / 'mine.py') == {'fractions'}
    assert gain(made(tmp_path / 'mine.py')) == 0.5


def test_a_module_elsewhere_on_the_path_does_not_come_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written(tmp_path / 'script', {'helper.py': 'GAIN = 0.9\n', 'only_there.py': 'GAIN = 0.7\n'})
    monkeypatch.syspath_prepend(tmp_path / 'script')
    written(tmp_path, {'mine.py': EAGER, 'helper.py': 'import only_there\nGAIN = 0.1\n'})
    assert gain(made(tmp_path / 'mine.py')) == pytest.approx(0.1)


def test_only_what_an_import_statement_names_is_found_and_counts(tmp_path: Path) -> None:
    by_name = 'import importlib\nGAIN = importlib.import_module("help" + "er").GAIN'
    written(tmp_path, {'mine.py': controller(by_name, 'GAIN'), 'helper.py': 'GAIN = 0.1\n'})
    assert own_names(tmp_path / 'mine.py') == set()
    assert "No module named 'helper'" in refusal(tmp_path / 'mine.py')


@pytest.mark.parametrize(
    ('helper', 'words', 'line'),
    [
        ('GAIN = (\n', 'SyntaxError', 1),
        ('X = 1\nGAIN = 1 / 0\n', 'ZeroDivisionError: division by zero', 2),
        ('\nimport no_such_module\n', "No module named 'no_such_module'", 2),
        ('\n\nfrom parts import missing\n', "cannot import name 'missing' from 'parts'", 3),
        ('import parts.missing\n', "No module named 'parts.missing'", 1),
    ],
)
def test_a_mistake_in_a_helper_is_one_line_with_its_place(
    tmp_path: Path, helper: str, words: str, line: int
) -> None:
    written(tmp_path, {'mine.py': EAGER, 'helper.py': helper, 'parts/__init__.py': ''})
    text = refusal(tmp_path / 'mine.py')
    assert text.startswith(f'controller file {tmp_path / "mine.py"}: it cannot be loaded (')
    assert words in text and '\n' not in text and 'controller_file_' not in text
    assert text.endswith(f', in {tmp_path / "helper.py"} line {line}): mend its code')


@pytest.mark.parametrize(
    ('imports', 'helper', 'place'),
    [
        ('import mine', '', 'mine.py line 1'),
        ('from mine import GAIN', '', 'mine.py line 1'),
        ('from . import mine', '', 'mine.py line 1'),
        ('import helper', 'GAIN = 1\nfrom mine import Mine', 'helper.py line 2'),
    ],
)
def test_a_file_that_imports_itself_is_refused_in_one_line(
    tmp_path: Path, imports: str, helper: str, place: str
) -> None:
    files = {'mine.py': controller(imports, '0.5'), 'helper.py': helper}
    text = refusal(written(tmp_path, files) / 'mine.py')
    assert 'mine.py imports itself' in text
    assert place in text
    assert '\n' not in text


def test_a_helper_may_name_the_file_for_type_checkers_alone(tmp_path: Path) -> None:
    helper = 'from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from mine import Mine\n'
    files = {'mine.py': controller('import helper', '0.5'), 'helper.py': helper}
    file = written(tmp_path, files) / 'mine.py'
    assert gain(made(file)) == 0.5
    assert controller_digests(str(file)).keys() == {FILE, 'helper.py_sha256'}


def test_a_module_that_has_the_name_of_the_file_but_is_another_one_is_found(
    tmp_path: Path,
) -> None:
    files = {
        'mine.py': controller('import mine', 'mine.GAIN'),
        'mine/__init__.py': 'GAIN = 0.25',
    }
    assert gain(made(written(tmp_path, files) / 'mine.py')) == 0.25


def test_a_helper_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    written(tmp_path, {'mine.py': EAGER})
    (tmp_path / 'helper.py').write_bytes(b'GAIN = "\xff"\n')
    assert f'{tmp_path / "helper.py"}: cannot be read' in refusal(tmp_path / 'mine.py')


def test_an_error_of_a_helper_in_a_run_is_found_with_its_line(tmp_path: Path) -> None:
    text = controller('from helper import share', 'share(measurement.step)')
    written(tmp_path, {'mine.py': text, 'helper.py': 'def share(k):\n    return 1 / (k - k)\n'})
    checks = {
        each.name: each for each in check_controller(str(tmp_path / 'mine.py'), SETTINGS.known)
    }
    assert checks['answers'].state == FAIL
    assert f'in {tmp_path / "helper.py"} line 2' in checks['answers'].detail


@pytest.mark.process
def test_a_clock_that_a_helper_reads_is_found(tmp_path: Path) -> None:
    text = controller('from helper import now', '1e-11 * now()')
    written(tmp_path, {'mine.py': text, 'helper.py': 'from time import time as now\n'})
    checks = {
        each.name: each for each in check_controller(str(tmp_path / 'mine.py'), SETTINGS.known)
    }
    assert 'it calls time.time in ' in checks['determinism'].detail


def test_every_part_has_a_digest_and_no_other_file(tmp_path: Path) -> None:
    files = {
        'mine.py': controller('import helper\nfrom parts.a import A', '1.0', 'import late'),
        'helper.py': 'import other\n',
        'other.py': 'X = 1\n',
        'late.py': 'X = 1\n',
        'parts/a.py': 'A = 1\n',
        'parts/data/b.py': 'B = 1\n',
        'beside.py': 'raise SystemExit(3)\n',
    }
    written(tmp_path, {**files, 'parts/notes.txt': '', 'parts/.saved/a.py': '1 / 0\n'})
    file = str(tmp_path / 'mine.py')
    before = controller_digests(file)
    keys = ('helper.py', 'other.py', 'late.py', 'parts/a.py', 'parts/data/b.py')
    assert before.keys() == {FILE, *(f'{key}_sha256' for key in keys)}
    assert made(Path(file)).digests == before
    for key in keys:
        written(tmp_path, {key: f'{files[key]}raise SystemExit("it has run")\n'})
        changed = controller_digests(file)
        assert {each for each in before if changed[each] != before[each]} == {f'{key}_sha256'}
        written(tmp_path, {key: files[key]})


def test_its_objects_can_be_inspected_and_pickled(tmp_path: Path) -> None:
    helper = 'from dataclasses import dataclass\n\n\n@dataclass\nclass Part:\n    x: int = 1\n'
    text = controller('from __future__ import annotations\nfrom helper import Part', '1.0')
    written(tmp_path, {'mine.py': text, 'helper.py': helper})
    module: Any = load_module(sources_of(tmp_path / 'mine.py'))
    assert 'class Part:' in inspect.getsource(module.Part)
    assert inspect.getsourcefile(module.Part) == str(tmp_path / 'helper.py')
    assert pickle.loads(pickle.dumps(module.Part(2))) == module.Part(2)
    assert isinstance(pickle.loads(pickle.dumps(module.Mine())), module.Mine)

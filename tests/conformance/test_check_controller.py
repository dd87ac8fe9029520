# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`ddct check` names beginners' errors, and passes controllers in order."""

import inspect
import json
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest
from by_schema import require_schema
from conformance import right_controllers
from samples import sampled
from support.complaints import assert_one_line
from support.third_party import install

from ddct_controllers.check import program
from ddct_controllers.check.checks import CHECKS, FAIL, PASS, SKIPPED, Outcome, check_controller
from ddct_controllers.interface import Controller
from ddct_controllers.template.package import install_command
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_controllers.workflows.evidence_types import linear_entries
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.slow

HERE = Path(__file__).parent
SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
IN_UPDATE = ['wrong_controllers.py line']
WRONG = {
    'WrongType': ('answers', ['of type float', 'return a', *IN_UPDATE]),
    'NoAnswer': ('answers', ['of type NoneType', *IN_UPDATE]),
    'NotANumber': ('answers', ['torque at step 60 is nan', *IN_UPDATE]),
    'AnArray': ('answers', ['array([0.])', 'give a number', *IN_UPDATE]),
    'MissingReset': ('reset', ['self._integral is -53.7', *IN_UPDATE]),
    'SharedState': ('state', ['both share SharedState.errors', *IN_UPDATE]),
    'Slow': ('update time', ['its period of 10 ms', *IN_UPDATE]),
    'WrongSign': ('sign', ['changes the clutch torque by -5 N m', *IN_UPDATE]),
    'RadiansTakenForRpm': ('unit', ['a torque 9.55 times larger', '30/pi', *IN_UPDATE]),
    'RpmTwice': ('unit', ['unstable', 'a torque 9.55 times smaller', '30/pi', *IN_UPDATE]),
    'FailsToBuild': ('constructor', ['LinAlgError: Singular matrix', *IN_UPDATE]),
    'FailsInUpdate': ('answers', ['IndexError', 'preview_steps + 1 entries', *IN_UPDATE]),
    'WrongStatus': ('answers', ["status at step 60 is {'error_rpm'", *IN_UPDATE]),
    'UnknownGain': ('options', ["the gain 'gian'", 'did you mean gain?', *IN_UPDATE]),
    'UndeclaredGain': ('options', ["the gain 'gain'", 'it declares none', *IN_UPDATE]),
    'RandomNumbers': ('determinism', ['it calls random.gauss', *IN_UPDATE]),
    'WallClock': ('determinism', ['it calls time.monotonic', *IN_UPDATE]),
    'NoReset': ('constructor', ['abstract method', 'wrong_controllers:NoReset']),
    'SharedIntegral': ('state', ['both share SharedIntegral.integral', *IN_UPDATE]),
    'SharedDefault': ('state', ['the defaults of SharedDefault.update', *IN_UPDATE]),
    'ClockOfItsOwn': ('determinism', ['it calls time.monotonic', *IN_UPDATE]),
    'HidesNaN': ('NaN', ['goes unnoticed and moves its torque by', *IN_UPDATE]),
    'Chatters': ('rate', ['N m per second, more than 3500', *IN_UPDATE]),
    'IdlePreview': ('preview', ['preview_steps = 5', 'changes no torque']),
    'AnotherModel': ('linear model', ['differ by up to', *IN_UPDATE]),
    'WritesItsInput': ('answers', ["'tuple' object does not support item", *IN_UPDATE]),
    'Leaves': ('answers', ['it raised SystemExit: 3', *IN_UPDATE]),
    'Prints': ('prints', ["the first 'e = 0.0'", *IN_UPDATE]),
}
"""Check that names the error, and words of the detail, by class."""
ALSO = {
    'AnotherModel': {'stability'},
    'WrongSign': {'stability'},
    'RpmTwice': {'rate', 'stability'},
}
"""Further checks that those errors fail, by class."""
RIGHT = [
    name
    for name, value in vars(right_controllers).items()
    if inspect.isclass(value) and issubclass(value, Controller) and value is not Controller
]
POINTS = {
    **{name: f'wrong_controllers:{name}' for name in WRONG},
    **{name: f'right_controllers:{name}' for name in RIGHT},
    'from_function': 'right_controllers:from_function',
    'misspelt': 'wrong_controllers:Proportinal',
    'moved': 'no_such_module:Moved',
}


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    install(monkeypatch, tmp_path / 'site', HERE, POINTS)


def outcomes_of(name: str) -> dict[str, Outcome]:
    return {each.name: each for each in check_controller(name, SETTINGS.known)}


def failed(outcomes: dict[str, Outcome]) -> dict[str, str]:
    return {name: each.detail for name, each in outcomes.items() if each.state == FAIL}


@pytest.mark.usefixtures('installed')
@pytest.mark.parametrize('name', WRONG)
def test_an_error_is_named_with_its_place(name: str) -> None:
    check, words = WRONG[name]
    found = failed(outcomes_of(name))
    assert found.keys() == {check, *ALSO.get(name, ())}
    for word in words:
        assert word in found[check]


@pytest.mark.usefixtures('installed')
@pytest.mark.parametrize(
    ('name', 'words'),
    [
        ('misspelt', ["no attribute 'Proportinal'", 'wrong_controllers.py has Proportional, ']),
        ('moved', ["No module named 'no_such_module'", install_command('DIR')]),
        ('nobodys', ["unknown controller 'nobodys'", install_command('DIR')]),
    ],
)
def test_a_name_that_leads_nowhere_is_explained(name: str, words: list[str]) -> None:
    outcomes = outcomes_of(name)
    assert {each.state for each in outcomes.values()} == {FAIL, SKIPPED}
    found = failed(outcomes)
    assert found.keys() == {'entry point'}
    for word in words:
        assert word in found['entry point']


def test_a_module_that_imports_what_is_missing_is_not_taken_for_renamed(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / 'needs_more.py').write_text('import no_such_package\n', encoding='utf-8')
    points = {'needs_more': 'needs_more:NeedsMore'}
    install(monkeypatch, tmp_path / 'site', tmp_path, points)
    detail = failed(outcomes_of('needs_more'))['entry point']
    assert "No module named 'no_such_package'" in detail
    assert 'renamed' not in detail


@pytest.mark.usefixtures('installed')
@pytest.mark.parametrize('name', [*RIGHT, 'from_function'])
def test_a_controller_in_order_fails_no_check(name: str) -> None:
    assert failed(outcomes_of(name)) == {}


def test_there_are_ten_controllers_in_order() -> None:
    assert len(RIGHT) >= 10


@pytest.mark.parametrize(
    'name', sampled(['pi', 'ls8', 'hinf1', 'lqi', 'mpc4', 'least_jerk'], every=2)
)
def test_a_packaged_controller_fails_no_check(name: str) -> None:
    """One of each kind; all of them are nightly."""
    outcomes = outcomes_of(name)
    assert failed(outcomes) == {}
    skipped = {each.name for each in outcomes.values() if each.state == SKIPPED}
    assert skipped <= {'installation', 'preview', 'linear model'}


def test_stability_is_that_of_the_loop_with_the_actuator_of_the_scenario() -> None:
    settings = RunSettings(KnownSettings(load_scenario('thesis', ['actuator.delay_s=0.033'])))
    (stability,) = (
        each for each in check_controller('ls8', settings.known) if each.name == 'stability'
    )
    margins = linear_entries(frequency_evidence(['ls8'], settings))[0].nominal.margins
    assert stability.state == PASS
    assert f'gain margin {margins.gain_margin_db:.1f} dB' in stability.detail
    assert f'phase margin {margins.phase_margin_deg:.0f} deg' in stability.detail


@pytest.mark.parametrize(
    ('polynomial', 'check'),
    [('{num: [0.05, 0.1], den: [1, 0]}', 'sign'), ('{num: [-9, -9], den: [1, 0]}', 'rate')],
)
def test_an_error_of_a_controller_in_yaml_is_placed_in_its_file_and_key(
    polynomial: str, check: str, tmp_path: Path
) -> None:
    file = tmp_path / 'mine.yaml'
    file.write_text(f'name: mine\nunits: {{input: rpm, output: N m}}\npolynomial: {polynomial}\n')
    found = failed(outcomes_of(str(file)))
    assert {check, 'stability'} <= found.keys()
    for detail in found.values():
        assert f'{file} line 3 (polynomial)' in detail
        assert '.py' not in detail


@pytest.fixture
def from_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> tuple[Path, Path]:
    """Install a copy of a package from a folder; return its module there, and in the copy."""
    folder, copy = tmp_path / 'mine', tmp_path / 'copy'
    for each in (folder, copy):
        each.mkdir()
        shutil.copy(HERE / 'right_controllers.py', each / 'copied_controllers.py')
    project = '[project.entry-points."ddct.controllers"]\n' + ''.join(
        f'{name} = "copied_controllers:NoIntegrator"\n' for name in ('copied', 'added_later')
    )
    (folder / 'pyproject.toml').write_text(project, encoding='utf-8')
    install(monkeypatch, tmp_path / 'site', copy, {'copied': 'copied_controllers:NoIntegrator'})
    origin = {'url': folder.as_uri(), 'dir_info': {}}
    (tmp_path / 'site' / 'third_party-1.0.dist-info' / 'direct_url.json').write_text(
        json.dumps(origin), encoding='utf-8'
    )
    monkeypatch.delitem(sys.modules, 'copied_controllers', raising=False)
    return folder / 'copied_controllers.py', copy / 'copied_controllers.py'


def test_a_module_that_was_edited_after_it_was_installed_is_named(
    from_folder: tuple[Path, Path],
) -> None:
    source, copy = from_folder
    assert outcomes_of('copied')['installation'].state == PASS
    source.write_text(source.read_text(encoding='utf-8') + '\n', encoding='utf-8')
    detail = failed(outcomes_of('copied'))['installation']
    assert f'{source} was edited after it was installed, and {copy} is what runs' in detail
    assert install_command(str(source.parent)) in detail


def test_an_entry_point_that_was_added_after_the_installation_is_named(
    from_folder: tuple[Path, Path],
) -> None:
    detail = failed(outcomes_of('added_later'))['entry point']
    project = from_folder[0].parent / 'pyproject.toml'
    assert f'{project} has it, but was not installed since: install it again' in detail


def report_of(capfd: pytest.CaptureFixture[str], code: int, *arguments: str) -> Any:
    assert program.main([*arguments, '--json', '-']) == code
    output = capfd.readouterr()
    report = json.loads(output.out)
    require_schema('check', report)
    return report, output.err


def test_the_program_reports_every_check_of_a_controller_in_a_file(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    file = tmp_path / 'lag.yaml'
    file.write_text(
        'format: ddct-linear-controller-1\nname: lag\n'
        'units: {input: rpm, output: N m, frequency: rad/s}\n'
        'transfer_function: {gain: -1.0, numerator: [], denominator: [10.0]}\n',
        encoding='utf-8',
    )
    report, _ = report_of(capfd, 0, str(file))
    assert report.keys() == {'controller', 'checks'}
    assert report['controller'] == str(file)
    assert [each['name'] for each in report['checks']] == [each.name for each in CHECKS]
    assert all(each.keys() == {'name', 'state', 'detail'} for each in report['checks'])
    assert all(each['detail'] for each in report['checks'])
    states = {each['name']: each['state'] for each in report['checks']}
    assert (states['linear model'], states['stability']) == (PASS, PASS)


@pytest.mark.usefixtures('installed')
def test_the_program_fails_with_one_line_that_names_the_checks(
    capfd: pytest.CaptureFixture[str],
) -> None:
    report, errors = report_of(capfd, 1, 'WrongSign')
    states = {each['name']: each['state'] for each in report['checks']}
    assert (states['sign'], states['stability'], states['reset']) == (FAIL, FAIL, PASS)
    assert_one_line(errors.partition('\n')[2], 'ddct check', 'WrongSign fails: sign, stability')


@pytest.mark.usefixtures('installed')
def test_checks_that_wait_for_one_other_share_a_line(capfd: pytest.CaptureFixture[str]) -> None:
    assert program.main(['NoAnswer']) == 1
    printed = capfd.readouterr().out
    states = re.findall(r'^ {2}(pass|fail|skipped) ', printed, re.MULTILINE)
    assert states == [*4 * ['pass'], 'fail', 'skipped', 'pass']
    first, *_, last = (check.name for check in CHECKS if {'answers', 'state'} & {*check.after})
    words = ' '.join(printed.split())
    assert f'skipped {first}, state, determinism, reset, NaN,' in words
    assert "the check 'answers' must pass first" in words
    assert f' {last} ' in words


@pytest.mark.usefixtures('installed')
def test_options_of_a_controller_may_be_set_for_its_check(
    capfd: pytest.CaptureFixture[str],
) -> None:
    assert program.main(['NoIntegrator', '--set', 'controllers.NoIntegrator.gain=0.2']) == 0
    (line,) = [line for line in capfd.readouterr().out.splitlines() if ' sign ' in line]
    assert 'changes the clutch torque by +10 N m' in line
    assert program.main(['NoIntegrator', '--set', 'controllers.NoIntegrater.gain=0.2']) == 1
    words = 'fail options controllers.NoIntegrater: there is no such controller: '
    assert words in ' '.join(capfd.readouterr().out.split())


def test_a_file_that_is_not_there_is_named_before_any_check(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert program.main(['designs/absent.yaml']) == 1
    assert_one_line(capsys.readouterr().err, 'ddct check', 'designs/absent.yaml: no such file')

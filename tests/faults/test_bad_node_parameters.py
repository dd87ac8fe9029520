# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A node that is started by hand with a wrong parameter ends with one line and code 1."""

from pathlib import Path

from support.complaints import assert_one_line
from support.in_process_graph import GraphOf
from support.processes import Program, Programs
from support.runs import plan

ENGINE, CONTROLLER = 'ddct_plant.nodes.engine_node', 'ddct_controllers.controller_node'
CASE = Path(__file__).parent / 'unknown_key.case.yaml'
CASES: dict[str, tuple[str, list[str], list[str]]] = {
    'out of range': (ENGINE, ['-p', 'wear_gain:=-1.0'], ['wear_gain is -1: it must be above 0']),
    'not a number': (ENGINE, ['-p', 'wear_gain:=abc'], ['wear_gain', 'abc']),
    'truth value': (ENGINE, ['-p', 'wear_gain:=true'], ['wear_gain is True: give a number']),
    'part of a number': (ENGINE, ['-p', 'seed:=1.5'], ['seed is 1.5: give a whole number']),
    'nan': (ENGINE, ['-p', 'wear_gain:=.nan'], ['wear_gain', 'nan']),
    'unknown scenario': (ENGINE, ['-p', 'scenario:=theses'], ["'theses'", 'thesis']),
    'missing scenario file': (ENGINE, ['-p', 'scenario:=no/such.yaml'], ['no/such.yaml']),
    'unknown architecture': (ENGINE, ['-p', 'architecture:=open'], ["'open'", 'detailed']),
    'unknown mode': (ENGINE, ['-p', 'mode:=fast'], ["'fast'", 'lockstep']),
    'unknown key of the case': (ENGINE, ['-p', f'case:={CASE}'], ['mas_kg', 'vehicle.mass_kg?']),
    'files of one part': (ENGINE, ['-p', 'case:=case.json'], ['parameter known is missing']),
    'case of a controller': (CONTROLLER, ['-p', f'case:={CASE}'], ['unknown parameter case']),
    'wear of a controller': (
        CONTROLLER,
        ['-p', 'wear_gain:=0.8'],
        ['unknown parameter wear_gain'],
    ),
    'seed of a reference': (
        'ddct_reference.reference_node',
        ['-p', 'seed:=4'],
        ['unknown parameter seed'],
    ),
    'negative seed': (ENGINE, ['-p', 'seed:=-1'], ['seed']),
    'unknown controller': (CONTROLLER, ['-p', 'controller:=pid'], ["'pid'", 'ls8']),
    'bad gain': (CONTROLLER, ['-p', 'gains.integral_gain:=-1.0'], ['integral_gain', '-1']),
    'preview': (
        'ddct_reference.reference_node',
        ['-p', 'preview_steps:=-1'],
        ['preview_steps', '-1'],
    ),
    'timeout': (
        'ddct_plant.nodes.driveline_node',
        ['-p', 'answer_timeout_s:=0.0'],
        ['answer_timeout_s is 0 s: it must be at least 0.1'],
    ),
    'duration off the grid': (
        'ddct_plant.nodes.driveline_node',
        ['-p', 'duration:=0.705'],
        ['duration is 0.705', 'multiple of 0.01'],
    ),
    'fail-safe': (
        'ddct_plant.nodes.actuator_node',
        ['-p', 'fail_safe_ramp_n_m_s:=0.0'],
        ['fail_safe_ramp_n_m_s is 0'],
    ),
    'unknown parameter': (
        ENGINE,
        ['-p', 'two_inputs:=true'],
        ['unknown parameter two_inputs', 'did you mean two_input?'],
    ),
    'unknown name of a controller': (
        CONTROLLER,
        ['-p', 'controler:=ls8'],
        ['unknown parameter controler', 'did you mean controller?'],
    ),
    'unknown gain': (CONTROLLER, ['-p', 'gains.derivative:=1.0'], ['gains.derivative', 'known: ']),
    'bad option': (
        CONTROLLER,
        ['-p', 'controller:=mpc3', '-p', 'gains.highest_torque_n_m:=high'],
        ["gains.highest_torque_n_m is 'high'", 'give a number in N m'],
    ),
    'behind the ROS arguments': (ENGINE, ['--', 'late'], ['unknown argument late']),
    'malformed': (ENGINE, ['-p', 'wear_gain'], ['wear_gain']),
    'missing parameter file': (ENGINE, ['--params-file', 'no/such.yaml'], ['no/such.yaml']),
}


def test_every_wrong_parameter_is_named(programs: Programs) -> None:
    started: dict[str, Program] = {
        case: programs.fork(module, '--ros-args', *arguments)
        for case, (module, arguments, _) in CASES.items()
    }
    for case, program in started.items():
        module, _, words = CASES[case]
        node = module.rpartition('.')[2].removesuffix('_node')
        assert program.wait() == 1, case
        assert_one_line(program.errors(), node, *words)


def test_an_argument_in_front_of_those_for_ros_is_refused(programs: Programs) -> None:
    wrong = ('--foo', 'two_input:=true')
    started = [
        programs.fork(ENGINE, argument, '--ros-args', '-p', 'seed:=1') for argument in wrong
    ]
    for argument, program in zip(wrong, started, strict=True):
        assert program.wait() == 1
        hint = 'parameters go behind --ros-args, as -p NAME:=VALUE'
        assert_one_line(program.errors(), 'engine', f'unknown argument {argument}', hint)


def test_a_parameter_file_may_hold_sections_of_other_nodes(
    programs: Programs, tmp_path: Path
) -> None:
    file = tmp_path / 'parameters.yaml'
    file.write_text(
        '/**: {ros__parameters: {wear_gain: -1.0, use_sim_time: false}}\n'
        '/**/driveline: {ros__parameters: {duration: 1.0}}\n',
        encoding='utf-8',
    )
    program = programs.fork(ENGINE, '--ros-args', '--params-file', str(file))
    assert program.wait() == 1
    assert_one_line(program.errors(), 'engine', 'wear_gain is -1: ')


def test_a_recorder_that_cannot_write_its_bag_ends_with_the_reason(
    graph_of: GraphOf, tmp_path: Path
) -> None:
    (tmp_path / 'file').write_text('mine', encoding='utf-8')
    graph = graph_of(plan())
    graph.add('recorder', {'out': str(tmp_path / 'file' / 'bag')})
    graph.add_all()
    node, complaint = graph.first_failure()
    assert node == 'recorder'
    assert str(tmp_path / 'file' / 'bag' / 'ls8_0.mcap') in complaint
    assert 'cannot write the recording (Not a directory)' in complaint


def test_a_recorder_does_not_write_over_a_bag(graph_of: GraphOf) -> None:
    graph = graph_of(plan())
    bag = graph.folder / 'ls8_0.mcap'
    bag.write_bytes(b'an earlier recording')
    graph.add_all()
    node, complaint = graph.first_failure()
    assert node == 'recorder'
    assert f'{bag}: already there' in complaint
    assert bag.read_bytes() == b'an earlier recording'

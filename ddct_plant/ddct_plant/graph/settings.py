# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The settings of a run as a node gets them, by its parameters or from files, and its role.

Nodes that a program starts read the files of the run. A value that is given besides must agree
with them.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.exceptions import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterNotDeclaredException,
)
from rclpy.node import Node
from rclpy.parameter import Parameter

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import Option, options_of
from ddct_plant.fail_safe.request_watch import FailSafeSettings
from ddct_plant.files.input_file import located
from ddct_plant.graph.node_names import name_in_graph
from ddct_plant.scenario.case import case_of_file, with_case
from ddct_plant.scenario.choices.scenarios import (
    CHOICES,
    DEFAULT_CAR,
    DEFAULT_SCENARIO,
    Choice,
)
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.recorded_settings import (
    CasePart,
    KnownPart,
    case_settings,
    known_settings,
    known_values,
    read_part,
    require_agreement,
    values_of,
    values_of_scenario,
)
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings, handover_name
from ddct_plant.shift.roles import OFF_GOING, ON_COMING, ROLES

_CHOICES = {
    'scenario': Option(
        DEFAULT_SCENARIO,
        'name of a packaged scenario, or path of a YAML file; with `drive` there is none unless '
        'given',
    ),
    'car': Option('', f'car in place of that of the scenario; without a scenario {DEFAULT_CAR}'),
    'drive': Option('', 'drive in place of that of the scenario'),
}
_KNOWN_FILE = Option(
    '',
    'JSON file with the known settings of the run, which the program that starts a run writes; '
    'other settings that are given must agree with it',
)
_CASE_FILE = Option(
    '',
    'file of what controllers do not know: beside `known` the JSON file of the same program, else '
    'a YAML file of keys, such as `vehicle.mass_kg: 1700`',
)
_OF_KNOWN = {**_CHOICES, **options_of(KnownSettings)}
"""Parameters of every node, besides the file `known`."""
_ROLE = Option(
    ON_COMING, 'side of a gear shift; a run without a shift has the first alone', choices=ROLES
)
_FAIL_SAFE = options_of(FailSafeSettings)


def declare_known(node: Node, defaults: Mapping[str, Any]) -> KnownSettings:
    """
    Return the known settings of a run that `node` has, from their file or from its parameters.

    The parameters are declared, with other `defaults` by name where given. Raise DdctError for a
    value out of range, for an unusable file, and for a value that does not agree with the file.
    """
    file = declare(node, 'known', _KNOWN_FILE)
    if file:
        known = known_settings(read_part(KnownPart, file).known)
        given = _given_beside_file(node, known)
        handover = given.get('handover', known.handover)
        _require_given(node, given, known_values(known))
        known = replace(known, handover=handover)
    else:
        values = _of_parameters(node, _OF_KNOWN, defaults)
        known = KnownSettings(_chosen(node, values).scenario(), **values)
    for line in known.scenario.adjusted:
        node.get_logger().info(line)
    return known


def declare_case(node: Node, known: KnownSettings, defaults: Mapping[str, Any]) -> RunSettings:
    """
    Return the true settings of a run of which `node` has the `known` ones, with those of its case.

    Raise the errors of `declare_known`.
    """
    file, in_files = declare(node, 'case', _CASE_FILE), has_files(node)
    if file.endswith('.json') != in_files:
        missing = 'case' if in_files else 'known'
        raise ParameterError(
            f'parameter {missing} is missing: give the JSON files of both parts of the settings, '
            'known and case, or none of them',
            key=missing,
        )
    options = options_of(CaseSettings)
    if not in_files:
        values = case_of_file(file) if file else {}
        with located('case'):
            own = {key: options[key].checked(key, values[key]) for key in values if key in options}
        return with_case(known, {**values, **_of_parameters(node, options, {**defaults, **own})})
    settings = RunSettings(known, case_settings(known, read_part(CasePart, file).case))
    # Only given ones are declared: true values stay out of what others can read.
    given = {
        name: declare(node, name, options[name])
        for name in options
        if name in node._parameter_overrides
    }
    _require_given(node, given, values_of(settings))
    return settings


def has_files(node: Node) -> bool:
    """Return whether a node has its settings from the files of a run, not by its parameters."""
    return bool(node.get_parameter('known').value)


def _of_parameters(
    node: Node, options: Mapping[str, Option], defaults: Mapping[str, Any]
) -> dict[str, Any]:
    return {
        name: declare(node, name, replace(each, default=defaults.get(name, each.default)))
        for name, each in options.items()
    }


def _given_beside_file(node: Node, known: KnownSettings) -> dict[str, Any]:
    """Return the parameters that are given; all have their values of the file as defaults."""
    given: dict[str, Any] = {}
    usual = {**vars(known), **dict.fromkeys(CHOICES, ''), 'scenario': known.scenario.name}
    for name, each in _OF_KNOWN.items():
        value = declare(node, name, replace(each, default=usual[name]))
        if name in node._parameter_overrides and value:
            given[name] = value
    return given


def _require_given(node: Node, given: dict[str, Any], run: Mapping[str, object]) -> None:
    """Raise ParameterError for a given parameter that is not that of the run."""
    ours: dict[str, object] = {}
    if {*CHOICES} & given.keys():
        ours |= values_of_scenario('scenario', _chosen(node, given).scenario())
    for name, value in given.items():
        ours[name] = handover_name(value) if name == 'handover' else value
    sections = tuple({f'{key.partition(".")[0]}.' for key in ours if '.' in key})
    compared = {key: run[key] for key in run if key in given or key.startswith(sections)}
    require_agreement(full_name(node), ours, compared)


def _chosen(node: Node, values: dict[str, Any]) -> ScenarioFile:
    """Return what the parameters choose, which are taken out of the values by name."""
    choice = Choice.taken_from(values)
    given = 'scenario' in node._parameter_overrides or not choice.drive
    return ScenarioFile.read(
        Choice(choice.scenario if given else None, choice.car or None, choice.drive or None)
    )


def full_name(node: Node) -> str:
    """Return the full name of a node."""
    return name_in_graph(node.get_fully_qualified_name())


def declare_role(node: Node, known: KnownSettings) -> str:
    """
    Declare the side of a gear shift on which a node is, as parameter `role`, and return it.

    Raise ParameterError for the off-going side in a run without a shift, and for a side other
    than that of the node's namespace.
    """
    role = declare(node, 'role', _ROLE)
    if role == OFF_GOING and not known.shift:
        raise ParameterError(
            f'parameter role is {role}, but scenario {known.scenario.name} is no gear shift: '
            'choose one with a section shift, such as upshift, or leave role out',
            key='role',
        )
    place = OFF_GOING if node.get_namespace().rpartition('/')[2] == OFF_GOING else ON_COMING
    if known.shift and role != place:
        raise ParameterError(
            f'node {full_name(node)} has the role {role}, but its name is that of the {place} '
            f'side: start it with --ros-args -p role:={place}, or in another namespace',
            key='role',
        )
    return role


def declare_timeout(node: Node, name: str, default: float, description: str) -> float:
    """Declare a timeout in s for real time, called `name`; return its value."""
    described = replace(_FAIL_SAFE['request_timeout_s'], default=default, meaning=description)
    return declare(node, name, described)


def declare_fail_safe(node: Node, name: str, default: float, description: str) -> FailSafeSettings:
    """Declare a timeout called `name`, and the rate at which the clutch opens after it."""
    return FailSafeSettings(
        declare_timeout(node, name, default, description),
        declare(node, 'fail_safe_ramp_n_m_s', _FAIL_SAFE['fail_safe_ramp_n_m_s']),
    )


def declare(node: Node, name: str, described: Option, *, read_only: bool = True) -> Any:
    """
    Declare one parameter as an option describes it, and return its checked value.

    A whole number is accepted wherever a number is. A parameter whose default is None has no
    value unless one is given; the result is then None.
    """
    descriptor = ParameterDescriptor(description=described.description, read_only=read_only)
    lowest = described.above if described.at_least is None else described.at_least
    # The node itself checks a change while it runs; its error is more precise than the range's.
    if read_only and lowest is not None and described.at_most is not None:
        ends = {
            'from_value': described.kind(lowest),
            'to_value': described.kind(described.at_most),
        }
        if described.kind is float:
            descriptor.floating_point_range = [FloatingPointRange(**ends)]
        else:
            descriptor.integer_range = [IntegerRange(**ends, step=1)]
    # In rclpy a parameter without a value needs dynamic typing; `checked` checks its kind.
    descriptor.dynamic_typing = described.default is None
    start = list(described.default) if described.many else described.default
    overrides = node._parameter_overrides
    if name in overrides:
        usual = described.kind()
        declared = Parameter.Type.from_parameter_value([usual] if described.many else usual)
        overrides[name] = as_declared(overrides[name], declared)
        described.checked(name, overrides[name].value)
    try:
        value = node.declare_parameter(name, start, descriptor).value
    except (InvalidParameterTypeException, InvalidParameterValueException) as error:
        raise ParameterError(f'parameter {name}: {error} ({described.description})') from error
    return None if value is None else described.checked(name, value)


def as_declared(given: Parameter, declared: Parameter.Type) -> Parameter:
    """
    Return a parameter whose numbers are whole with the type that is declared; others unchanged.

    rclpy refuses the whole number 5 for a parameter that is declared as 5.0.
    """
    types, value = (given.type_, declared), given.value
    if types == (Parameter.Type.INTEGER, Parameter.Type.DOUBLE):
        value = float(value)
    elif types == (Parameter.Type.INTEGER_ARRAY, Parameter.Type.DOUBLE_ARRAY):
        value = [float(each) for each in value]
    elif types == (Parameter.Type.DOUBLE, Parameter.Type.INTEGER) and value.is_integer():
        value = int(value)
    else:
        return given
    return Parameter(given.name, declared, value)


class UndeclaredParameterError(ParameterNotDeclaredException):
    """A parameter is set that the node does not have; unlike rclpy's error it names both."""

    def __init__(self, reason: ParameterError) -> None:
        Exception.__init__(self, str(reason))

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Command line of a node: its help, which is printed here, and the arguments of ROS."""

import inspect
import os
import shutil
import textwrap
from collections.abc import Callable, Sequence

import rclpy
from rclpy.context import Context
from rclpy.signals import SignalHandlerOptions

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.graph.domain import discover_locally, require_domain, require_ros
from ddct_plant.graph.half_made_ports import remove_half_made_ports
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.qos import QOS_OVERRIDES
from ddct_plant.program.command_line import ROS_ARGUMENTS, split_ros_arguments
from ddct_plant.program.help_text import filled

HELP = {'-h', '--help'}
_UNDER = ' ' * 6
"""Indentation of what a parameter means, below its name."""
_NO_LOGS = 'failed to initialize logging'


def require_ros_arguments(arguments: Sequence[str]) -> None:
    """Raise ParameterError for an argument outside `--ros-args`: a node has none of its own."""
    own, _ = split_ros_arguments(arguments)
    if own:
        # rcl would pass over it, or take NAME:=VALUE for the new name of a topic.
        raise ParameterError(
            f'unknown argument {own[0]}: parameters go behind {ROS_ARGUMENTS}, as -p NAME:=VALUE'
        )


def init_ros(arguments: Sequence[str] | None, context: Context | None = None) -> None:
    """
    Initialise rclpy, or one context of it, with the arguments; None takes the command line's.

    Raise DdctError for an argument or environment variable that rclpy refuses, and the errors of
    `require_ros`.
    """
    require_ros()
    remove_half_made_ports(require_domain() or 0)
    discover_locally()
    try:
        rclpy.init(
            args=None if arguments is None else list(arguments),
            context=context,
            signal_handler_options=SignalHandlerOptions.NO,
        )
    except RuntimeError as error:  # so rcl refuses arguments and environment variables
        reason = str(error).split(', at /')[0]
        advice = f'mend what stands behind {ROS_ARGUMENTS} or in ROS_*'
        if _NO_LOGS in reason:
            advice = 'ROS writes logs: set HOME or ROS_LOG_DIR to a folder that can be written'
        raise DdctError(f'{reason}: {advice}') from error


def require_declared(node: GraphNode) -> None:
    """Raise ParameterError for a parameter that was given and that the node does not declare."""
    undeclared = node.undeclared_parameters()
    for name in undeclared:
        if name.startswith(QOS_OVERRIDES):
            raise ParameterError(
                f'parameter {name}: node {node.get_name()} has no such override: give '
                f'{QOS_OVERRIDES}.TOPIC.publisher.depth or .subscription.depth, with the full '
                'name of a topic of this node',
                key=name,
            )
    node.require_parameters(undeclared)


def node_help(name: str, factory: Callable[[], GraphNode], arguments: Sequence[str]) -> str:
    """
    Return the text of `--help`: the task of a node, and the parameters that it declares.

    The node is built with the arguments, and discovery is off meanwhile. Raise DdctError when it
    cannot be built.
    """
    width = shutil.get_terminal_size().columns
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'OFF'
    try:
        given = [argument for argument in arguments if argument not in HELP]
        init_ros([*given, ROS_ARGUMENTS, '--log-level', 'warn'])
        node = factory()
        lines = _parameters(node, width)
        node.destroy_node()
    finally:
        rclpy.try_shutdown()
    program = f'ddct node {name}'
    before = [
        f'usage: {program} [--ros-args -p PARAMETER:=VALUE ...]',
        '',
        inspect.getdoc(type(node)) or '',
        '',
        'parameters, with their defaults or what is given:',
    ]
    after = [
        '',
        'examples:',
        f'  {program}',
        *(f'  {program} --ros-args {example}' for example in node.EXAMPLES),
        '',
        'All nodes of a graph take the same scenario, architecture, clutch, wear_gain, mode, seed '
        'and, in a gear shift, off_going_wear_gain and handover.',
    ]
    shown = [filled('\n'.join(before), width), *lines, filled('\n'.join(after), width)]
    return '\n'.join(shown)


def _parameters(node: GraphNode, width: int) -> list[str]:
    lines = []
    for parameter in node.get_parameters(node.own_parameters()):
        description = node.describe_parameter(parameter.name).description
        lines += [
            f'  {parameter.name}: {parameter.value!r}',
            *textwrap.wrap(description, width, initial_indent=_UNDER, subsequent_indent=_UNDER),
        ]
    return lines

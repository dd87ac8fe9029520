"""What `--help` of a node prints: its task, and the parameters that it declares."""

import inspect
import os
from collections.abc import Callable, Sequence
from pathlib import Path

import rclpy

from ddct_plant.graph.node import GraphNode

_ASKED = ('-h', '--help')
_ROS_ARGUMENTS = '--ros-args'
_FOREIGN = ('use_sim_time', 'start_type_description_service', 'qos_overrides')
"""Parameters that rclpy declares itself begin with one of these."""


def help_asked(arguments: Sequence[str]) -> bool:
    """Say whether `--help` is among the arguments that are not ROS's."""
    own = list(arguments)
    if _ROS_ARGUMENTS in own:
        own = own[: own.index(_ROS_ARGUMENTS)]
    return any(argument in _ASKED for argument in own)


def node_help(name: str, factory: Callable[[], GraphNode]) -> str:
    """Return the text; the node is built for it, but nobody can discover it."""
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'OFF'
    rclpy.init(args=[])
    try:
        node = factory()
        lines = _parameters(node)
        node.destroy_node()
    finally:
        rclpy.try_shutdown()
    package = Path(inspect.getfile(type(node))).parent.name
    return '\n'.join(
        [
            f'usage: ros2 run {package} {name} [--ros-args -p PARAMETER:=VALUE ...]',
            '',
            inspect.getdoc(type(node)) or '',
            '',
            'parameters, with their defaults:',
            *lines,
            '',
            'examples:',
            f'  ros2 run {package} {name}',
            f'  ros2 run {package} {name} --ros-args -p wear_gain:=0.7 -p mode:=realtime',
            '',
            'All nodes of a graph take the same scenario, architecture, clutch, wear_gain, mode',
            'and seed.',
        ]
    )


def _parameters(node: GraphNode) -> list[str]:
    names = [name for name in node.list_parameters([], 0).names if not name.startswith(_FOREIGN)]
    lines = []
    for parameter in node.get_parameters(names):
        description = node.describe_parameter(parameter.name).description
        lines += [f'  {parameter.name}: {parameter.value!r}', f'      {description}']
    return lines

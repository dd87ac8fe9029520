"""What `--help` of a node prints: its task, and the parameters that it declares."""

import inspect
import os
import sys
from collections.abc import Callable, Sequence

import rclpy

from ddct_plant.graph.arguments import HELP, init_ros
from ddct_plant.graph.node import GraphNode


def node_help(name: str, factory: Callable[[], GraphNode], arguments: Sequence[str]) -> str:
    """
    Return the text; the node is built for it as the arguments say, but nobody can discover it.

    Raise DdctError when the node cannot be built.
    """
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'OFF'
    try:
        init_ros([argument for argument in arguments if argument not in HELP])
        node = factory()
        lines = _parameters(node)
        node.destroy_node()
    finally:
        rclpy.try_shutdown()
    # Run by `python -m`, the module calls itself __main__; its spec keeps the real name.
    spec = sys.modules[type(node).__module__].__spec__
    package = spec.name.partition('.')[0] if spec else type(node).__module__
    program = f'ros2 run {package} {name}'
    return '\n'.join(
        [
            f'usage: {program} [--ros-args -p PARAMETER:=VALUE ...]',
            '',
            inspect.getdoc(type(node)) or '',
            '',
            'parameters, with their defaults or what is given:',
            *lines,
            '',
            'examples:',
            f'  {program}',
            *(f'  {program} --ros-args {example}' for example in node.EXAMPLES),
            '',
            'All nodes of a graph take the same scenario, architecture, clutch, wear_gain, mode',
            'and seed.',
        ]
    )


def _parameters(node: GraphNode) -> list[str]:
    lines = []
    for parameter in node.get_parameters(node.own_parameters()):
        description = node.describe_parameter(parameter.name).description
        lines += [f'  {parameter.name}: {parameter.value!r}', f'      {description}']
    return lines

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of the parameters that nodes declare, for the READMEs of the packages; needs ROS."""

import importlib
import os
from unittest.mock import patch

from rclpy.context import Context
from rclpy.logging import LoggingSeverity, get_logger_effective_level, set_logger_level

from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS
from ddct_plant.graph.arguments import init_ros
from ddct_plant.graph.node import GraphNode
from ddct_plant.program.table import TextTable
from ddct_plant.scenario.choices.scenarios import CHOICES
from ddct_plant.scenario.choices.settings import SETTINGS

HEADERS = ('parameter', 'default', 'meaning')
SHARED = {'known', 'case', *CHOICES, *SETTINGS}
"""Names of the parameters that every node has."""
OF_CONTROLLER = 'gains.'
"""Prefix of the parameters that differ with the chosen controller."""


def parameter_tables() -> dict[str, TextTable]:
    """Return the parameters of each node, by its name, without the shared ones."""
    tables = {}
    level = get_logger_effective_level('')
    set_logger_level('', LoggingSeverity.WARN)  # nodes say at their start what they wait for
    with patch.dict(os.environ, ROS_AUTOMATIC_DISCOVERY_RANGE='OFF'):
        context = Context()
        init_ros([], context)
        try:
            for spec in NODE_PROGRAMS:
                node_class = getattr(importlib.import_module(spec.module), spec.class_name)
                node: GraphNode = node_class(context=context)
                if rows := _rows(node):
                    tables[spec.name] = TextTable('', HEADERS, rows)
                node.destroy_node()
        finally:
            context.try_shutdown()
            set_logger_level('', level)
    return tables


def _rows(node: GraphNode) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = []
    for parameter in node.get_parameters(node.own_parameters()):
        if parameter.name not in SHARED and not parameter.name.startswith(OF_CONTROLLER):
            description = node.describe_parameter(parameter.name).description
            rows.append((f'`{parameter.name}`', _text(parameter.value), description))
    return rows


def _text(value: object) -> str:
    """Return a default as it is given behind `-p NAME:=`, a list without its brackets."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str | int | float):
        return str(value) or 'empty'
    return ', '.join(value) if isinstance(value, list) else str(value)

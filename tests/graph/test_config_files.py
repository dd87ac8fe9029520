# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The parameter files that the packages install list what the nodes declare."""

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
import rclpy
import yaml
from rclpy.context import Context
from rclpy.signals import SignalHandlerOptions

from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS, NodeSpec

ROOT = Path(__file__).resolve().parents[2]
FILES = sorted(ROOT.glob('ddct_*/config/*.yaml'))
SHARED = '/**'
ROS_OWN = {'use_sim_time', 'start_type_description_service'}


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    yield context
    context.try_shutdown()


def listed(section: str) -> dict[str, Any]:
    """Return the parameters that the files list for `/**` or for one node."""
    found: dict[str, Any] = {}
    for path in FILES:
        content = yaml.safe_load(path.read_text(encoding='utf-8'))
        found |= content.get(section, {}).get('ros__parameters', {})
    return found


@pytest.mark.parametrize('spec', NODE_PROGRAMS, ids=lambda spec: spec.name)
def test_a_node_declares_just_what_the_files_list_with_the_same_defaults(
    spec: NodeSpec, context: Context
) -> None:
    node = getattr(import_module(spec.module), spec.class_name)(context=context)
    declared = {
        name: list(parameter.value) if isinstance(parameter.value, list) else parameter.value
        for name, parameter in node.get_parameters_by_prefix('').items()
        if name not in ROS_OWN and not name.startswith(('qos_overrides', 'gains.'))
    }
    node.destroy_node()
    assert declared == listed(SHARED) | listed(f'/**/{spec.name}')


def test_every_section_belongs_to_a_node() -> None:
    sections = {
        section for path in FILES for section in yaml.safe_load(path.read_text(encoding='utf-8'))
    }
    assert sections <= {SHARED, *(f'/**/{spec.name}' for spec in NODE_PROGRAMS)}

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Imports of the warm parent before it forks nodes: slow modules that keep no state."""

import contextlib
import importlib

from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS

_LATER = (
    'daqp',
    'ddct_bringup.processes.guardian',
    'ddct_controllers.mpc.qp.solvers',
    'importlib.resources.readers',
    'rclpy.experimental.events_executor',
    'scipy.linalg',
    'scipy.optimize',
    'type_description_interfaces.msg',
)
"""Modules that this project's nodes import only when they need them."""
_SERVICES = (
    'DescribeParameters',
    'GetParameters',
    'GetParameterTypes',
    'ListParameters',
    'SetParameters',
    'SetParametersAtomically',
)
"""Parameter services that each node offers."""


def preload() -> None:
    """
    Import the nodes, the middleware's libraries and the messages.

    No third party's controller is imported: only the process of its node loads it.
    """
    for module in (*(node.module for node in NODE_PROGRAMS), *_LATER):
        # The node itself reports a missing package.
        with contextlib.suppress(ImportError):
            importlib.import_module(module)
    with contextlib.suppress(ImportError):
        _load_messages()


def _load_messages() -> None:
    import rcl_interfaces.msg
    import rcl_interfaces.srv
    from rclpy.type_support import check_for_type_support

    from ddct_plant.signals.topics import all_topics

    classes = [topic.message_class for topic in all_topics()]
    classes += [rcl_interfaces.msg.Log, rcl_interfaces.msg.ParameterEvent]
    classes += [getattr(rcl_interfaces.srv, name) for name in _SERVICES]
    for each in classes:
        check_for_type_support(each)

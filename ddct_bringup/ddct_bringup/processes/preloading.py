# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Imports of the warm parent before it forks nodes: slow modules, and the commit of the code."""

import contextlib
import importlib
import sys
from collections.abc import Iterator

from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS

_LATER = (
    'daqp',
    'ddct_bringup.processes.guardian',
    'ddct_controllers.mpc.qp.solvers',
    'importlib.resources.readers',
    'rclpy.experimental.events_executor',
    'scipy.linalg',
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
_DESCRIPTIONS = 'type_description_interfaces.srv'
"""Package of another service that each node offers."""
_GENERATOR = 'rosidl_generator_py'
"""Package that loads the libraries of messages, and that also imports what generates them."""


def preload() -> None:
    """
    Import the nodes, the middleware's libraries and the messages, and find the commit.

    No third party's controller is imported: only the process of its node loads it.
    """
    for module in (*(node.module for node in NODE_PROGRAMS), *_LATER):
        # The node itself reports a missing package.
        with contextlib.suppress(ImportError):
            importlib.import_module(module)
    with contextlib.suppress(ImportError), _without_generator():
        _load_messages()
    with contextlib.suppress(ImportError):
        importlib.import_module('ddct_plant.graph.rare_warnings').find_sources()
    with contextlib.suppress(ImportError):
        # For the recorders: each would call git between the start of its graph and the first tick.
        importlib.import_module('ddct_bringup.run.description').source_commit()


@contextlib.contextmanager
def _without_generator() -> Iterator[None]:
    """
    Import the loader of message libraries as where the generator of messages is not installed.

    The generator's parsers take as long as numpy, and no node generates messages. A later import
    of the package has all of it.
    """
    generator = f'{_GENERATOR}.generate_py_impl'
    if _GENERATOR in sys.modules:
        yield
        return
    sys.modules[generator] = None  # type: ignore[assignment]
    try:
        yield
    finally:
        for module in (generator, _GENERATOR):
            sys.modules.pop(module, None)


def _load_messages() -> None:
    import rcl_interfaces.msg
    import rcl_interfaces.srv
    from rclpy.type_support import check_for_type_support

    from ddct_plant.bag_file.message_definitions import load_definition
    from ddct_plant.signals.topics import all_topics

    for topic in all_topics():
        load_definition(topic.type)
    classes = [topic.message_class for topic in all_topics()]
    classes += [rcl_interfaces.msg.Log, rcl_interfaces.msg.ParameterEvent]
    classes += [getattr(rcl_interfaces.srv, name) for name in _SERVICES]
    # Of rclpy, in versions of ROS that have it.
    with contextlib.suppress(ImportError):
        classes.append(importlib.import_module(_DESCRIPTIONS).GetTypeDescription)
    for each in classes:
        check_for_type_support(each)

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Preloaded by the fork server: it imports this module once, and then forks every node.

What is not imported here is imported by each node itself. The server makes no ROS context and no
participant, so that a fork is as good as a new process.
"""

import atexit
import contextlib
import gc
import importlib
import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

from ddct_bringup.processes.fork_server import MARK, remove_socket
from ddct_bringup.processes.shared_memory import remove_dead_segments
from ddct_plant.program.signals import block_interrupts

_LATER = (
    'daqp',
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


def serve(program: int) -> None:
    """Prepare this process, the fork server of `program`, before it forks."""
    # A group of its own, which its nodes share: Ctrl-C in a terminal reaches the program alone.
    os.setpgrp()
    block_interrupts()
    # When the program is killed while a node is paused, the kernel sends this to the whole group
    # before it resumes that node, which shall then end as the others do.
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    with Path(os.devnull).open('wb') as nothing:
        for stream in (1, 2):  # a reader of the program's output shall not wait for the server
            os.dup2(nothing.fileno(), stream)
    atexit.register(_tidy, os.getpid(), program)
    # Imported objects stay: garbage collection takes a fifth of the time of the imports, and in a
    # node it would write to every page that it shares.
    gc.disable()
    _preload()
    gc.freeze()
    gc.enable()


def _tidy(server: int, program: int) -> None:
    """
    Remove what a killed program leaves: its socket, and shared memory of nodes that were killed.

    The server ends last: the nodes keep open what it waits for.
    """
    if os.getpid() != server or os.getppid() == program:
        return
    remove_dead_segments()
    remove_socket()


def _preload() -> None:
    """
    Import the nodes, the middleware's libraries and the messages, and find the commit.

    No third party's controller is imported: only the process of its node loads it. A node itself
    reports what cannot be imported.
    """
    from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS

    for module in (*(node.module for node in NODE_PROGRAMS), *_LATER):
        with contextlib.suppress(Exception):
            importlib.import_module(module)
    with contextlib.suppress(Exception), _without_generator():
        _load_messages()
    with contextlib.suppress(Exception):
        importlib.import_module('ddct_plant.graph.rare_warnings').find_sources()
    with contextlib.suppress(Exception):
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
    from ddct_plant.signals.topics import TOPICS

    for topic in TOPICS:
        load_definition(topic.type)
    classes = [topic.message_class for topic in TOPICS]
    classes += [rcl_interfaces.msg.Log, rcl_interfaces.msg.ParameterEvent]
    classes += [getattr(rcl_interfaces.srv, name) for name in _SERVICES]
    # Of rclpy, in versions of ROS that have it.
    with contextlib.suppress(ImportError):
        classes.append(importlib.import_module(_DESCRIPTIONS).GetTypeDescription)
    for each in classes:
        check_for_type_support(each)


if _program := os.environ.pop(MARK, ''):
    serve(int(_program))

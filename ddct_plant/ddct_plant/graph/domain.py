# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Requirements of a graph on ROS: its packages, and a domain of its own."""

import importlib.util
import os
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import sha256

from ddct_plant.base.errors import DdctError
from ddct_plant.program.operating_system import is_linux

SECURITY, STRATEGY = 'ROS_SECURITY_ENABLE', 'ROS_SECURITY_STRATEGY'
"""Environment variables: `true` asks for DDS security, without which `Enforce` starts no node."""
LAST_DOMAIN = 232
"""Highest ROS_DOMAIN_ID: beyond it DDS has no ports, and ends the process without a message."""
_DOMAINS = range(1, 100)
"""Domain ids whose DDS ports stay below the ephemeral ports of the kernel."""
_FIRST_PORT = 28400
"""TCP port that reserves domain 0; a domain is reserved by listening on this port plus its id."""
_turn = os.getpid()
"""Domain after which the search for a free one begins: discovery shows killed nodes for a while,
so the last domain is not used again at once."""


def require_ros() -> None:
    """
    Raise DdctError where ROS is not installed or does not run, or might lack requested security.

    Headless runs and scores do not need it.
    """
    if not is_linux():
        raise DdctError(
            f'the graph and its nodes run on Linux alone, and this is {sys.platform}: run '
            'headless, as with --headless'
        )
    if importlib.util.find_spec('rclpy') is None:
        raise DdctError(
            'the graph and its nodes need ROS 2, and its package rclpy is not installed: run '
            'headless, or set ROS up as docs/use/setup.md tells, from wheels on x86-64 Linux or '
            'from apt on Ubuntu 24.04'
        )
    if os.environ.get(SECURITY) == 'true' and os.environ.get(STRATEGY) != 'Enforce':
        raise DdctError(
            f'{SECURITY} is true without {STRATEGY}=Enforce, so a node that lacks keys, or a '
            f'middleware without security, would run unsecured: set it, or unset {SECURITY}',
            key=SECURITY,
        )


def require_domain() -> int | None:
    """Return ROS_DOMAIN_ID, None when it is not set; raise DdctError unless it is a domain."""
    text = os.environ.get('ROS_DOMAIN_ID')
    if not text:
        return None
    if not text.isdecimal() or int(text) > LAST_DOMAIN:
        raise DdctError(f'ROS_DOMAIN_ID is {text!r}: give a whole number from 0 to {LAST_DOMAIN}')
    return int(text)


def discover_locally() -> None:
    """
    Let nodes of this process and its children find those of this machine alone.

    A setting of the user wins: also ROS_LOCALHOST_ONLY, which ROS reads before the other.
    """
    os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')


@contextmanager
def own_domain() -> Iterator[int]:
    """
    Yield the domain for one graph and set it in the environment, with discovery kept local.

    A ROS_DOMAIN_ID that the user has set is respected; otherwise a free one is reserved.
    """
    discover_locally()
    given = require_domain()
    if given is not None:
        yield given
        return
    with _reserved() as domain:
        os.environ['ROS_DOMAIN_ID'] = str(domain)
        try:
            yield domain
        finally:
            os.environ.pop('ROS_DOMAIN_ID', None)


@contextmanager
def sole_graph(domain: int, clock: str) -> Iterator[None]:
    """
    Keep the topic of simulated time in a domain for one graph of this machine, within.

    Raise DdctError where another one has it. Two graphs in one domain can run at once where each
    has a namespace and a clock of its own.
    """
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as lock:
        # An abstract name: the kernel removes it with the process. It has at most 107 bytes.
        name = sha256(f'{domain} {clock}'.encode()).hexdigest()
        try:
            lock.bind(f'\0ddct_graph {name}')
        except OSError as error:
            raise DdctError(
                f'another graph runs on this machine with {clock} in ROS domain {domain}: wait '
                'for its end, use another ROS_DOMAIN_ID, or give this one names of its own, as '
                'with --ros-args -r __ns:=/car -r /clock:=/car/clock'
            ) from error
        yield


@contextmanager
def _reserved() -> Iterator[int]:
    global _turn
    for _ in _DOMAINS:
        _turn += 1
        domain = _DOMAINS[_turn % len(_DOMAINS)]
        with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as lock:
            try:
                lock.bind(('127.0.0.1', _FIRST_PORT + domain))
                lock.listen()
            except OSError:
                continue
            yield domain
            return
    raise DdctError('every ROS domain is taken: wait for a graph to end or set ROS_DOMAIN_ID')

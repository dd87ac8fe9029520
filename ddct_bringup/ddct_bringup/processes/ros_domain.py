"""Give each graph a ROS domain of its own, so that graphs on one machine do not mix."""

import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager

from ddct_plant.base.errors import DdctError
from ddct_plant.graph.domain import require_domain

_DOMAINS = range(1, 100)
"""Domain ids whose DDS ports stay below those that the kernel hands out."""
_FIRST_PORT = 28400
"""A domain is taken while somebody listens on this port plus its id."""
_turn = os.getpid()
"""After it the search for a free domain begins: nodes killed in the last one still haunt it."""


@contextmanager
def own_domain() -> Iterator[int]:
    """
    Yield the domain for one graph and set it in the environment, with discovery kept local.

    A ROS_DOMAIN_ID that the user has set is respected; otherwise a free one is reserved.
    """
    os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
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

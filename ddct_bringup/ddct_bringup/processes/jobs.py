# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Requests to the warm parent: processes to fork, and their descriptors."""

import json
import os
import socket
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypedDict

REQUEST_BYTE = b'r'
"""Byte sent through the channel for a request, whose text is in the first file beside it."""


class JobText(TypedDict):
    """Fields of a job that are no descriptors, in the text of a request."""

    module: str
    arguments: list[str]
    pulse: bool
    """Whether the job has a descriptor for the pulse."""
    outlives: bool


class ForkRequest(TypedDict):
    """Text of a request to the warm parent, as JSON."""

    supervisor: int
    """Process id of the program that sends it."""
    environment: dict[str, str]
    jobs: list[JobText]


@dataclass(frozen=True)
class Job:
    """Process to be forked: its module, arguments and descriptors."""

    module: str
    """Module whose `main` the process runs."""
    arguments: Sequence[str] = ()
    stdin: int | None = None
    """Descriptor of standard input; None for an empty one."""
    output: int | None = None
    """Descriptor of standard output and error; None to drop both."""
    pulse: int | None = None
    """Descriptor to which a running node writes its pulse; None for other programs."""
    outlives: bool = False
    """Whether the process continues when the supervisor is killed."""

    def text(self) -> JobText:
        """Return the fields that are not descriptors, for the text of a request."""
        return {
            'module': self.module,
            'arguments': list(self.arguments),
            'pulse': self.pulse is not None,
            'outlives': self.outlives,
        }


def send_request(channel: socket.socket, jobs: Sequence[Job], go: int, born: int) -> None:
    """
    Send jobs with this process's id and current environment; OSError without a reader.

    The descriptors are those of the text, of the pipe `go` at which the processes wait, of the
    pipe `born` for their ids, and three for each job.
    """
    request: ForkRequest = {
        'supervisor': os.getpid(),
        'environment': dict(os.environ),
        'jobs': [job.text() for job in jobs],
    }
    with _memory(json.dumps(request).encode()) as text, _nothing() as nothing:
        streams = [
            nothing if each is None else each
            for job in jobs
            for each in (job.stdin, job.output, job.pulse)
        ]
        socket.send_fds(channel, [REQUEST_BYTE], [text, go, born, *streams])


@contextmanager
def _memory(content: bytes) -> Iterator[int]:
    """Yield the descriptor of a file in memory with this content."""
    with os.fdopen(os.memfd_create('request'), 'wb') as file:
        file.write(content)
        file.flush()
        yield file.fileno()


@contextmanager
def _nothing() -> Iterator[int]:
    """Yield a descriptor of the null device."""
    descriptor = os.open(os.devnull, os.O_RDWR)
    try:
        yield descriptor
    finally:
        os.close(descriptor)

"""What the warm parent is asked for: processes to be forked, with what they get."""

import json
import os
import socket
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

REQUEST_BYTE = b'r'
"""All that goes through the channel itself: the request is in the first file beside it."""


@dataclass(frozen=True)
class Job:
    """A process to be forked, and the descriptors that it gets."""

    module: str
    """Whose `main` it runs."""
    arguments: Sequence[str] = ()
    stdin: int | None = None
    """None for nothing to read."""
    output: int | None = None
    """Standard output and error; None to drop them."""
    pulse: int | None = None
    """Where a node shows that it runs."""
    outlives: bool = False
    """Whether it goes on when we are killed."""

    def description(self) -> dict[str, Any]:
        """Return what is no descriptor of it."""
        return {
            'module': self.module,
            'arguments': list(self.arguments),
            'pulse': self.pulse is not None,
            'outlives': self.outlives,
        }


def send_request(channel: socket.socket, jobs: Sequence[Job], go: int) -> None:
    """
    Send jobs, our process id and our environment as it is now; OSError where nobody reads.

    The descriptors are those of the text, of the pipe `go` that the processes wait at, and three
    for each job.
    """
    request = {
        'supervisor': os.getpid(),
        'environment': dict(os.environ),
        'jobs': [job.description() for job in jobs],
    }
    with _memory(json.dumps(request).encode()) as text, _nothing() as nothing:
        streams = [
            nothing if each is None else each
            for job in jobs
            for each in (job.stdin, job.output, job.pulse)
        ]
        socket.send_fds(channel, [REQUEST_BYTE], [text, go, *streams])


@contextmanager
def _memory(content: bytes) -> Iterator[int]:
    """Give the descriptor of a file in memory with this content."""
    with os.fdopen(os.memfd_create('request'), 'wb') as file:
        file.write(content)
        file.flush()
        yield file.fileno()


@contextmanager
def _nothing() -> Iterator[int]:
    """Give a descriptor of the null device."""
    descriptor = os.open(os.devnull, os.O_RDWR)
    try:
        yield descriptor
    finally:
        os.close(descriptor)

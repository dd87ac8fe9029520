# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Gate before the server of the live view: it checks the first lines of each connection.

Foxglove's server checks no Origin. So it listens on an address of this machine that nobody can
guess, and this gate passes on the connections that may be there.
"""

import asyncio
import contextlib
import random
import threading
from collections.abc import Callable

from ddct_bringup.live.handshake import END, MOST_BYTES, Admission
from ddct_plant.base.errors import DdctError, printable

_HEAD_S = 10.0
"""Time for the first lines of a connection, s."""
_START_S = 10.0
_CHUNK = 1 << 16
_MOST_REASONS = 100
"""Largest number of different refusals that are printed."""


def secret_address() -> str:
    """Return a random one of the 2^24 addresses of this machine (Linux: 127.0.0.0/8)."""
    parts = random.SystemRandom().choices(range(1, 255), k=3)
    return '.'.join(map(str, (127, *parts)))


class Gate:
    """Listener in a thread of its own, which passes on connections to the server behind it."""

    def __init__(
        self,
        admission: Admission,
        port: int,
        inner: tuple[str, int],
        print_line: Callable[[str], object],
    ) -> None:
        """
        Listen on `admission.host` and `port`, and pass on to the address `inner`.

        Port 0 takes a free one. Each kind of refusal is printed once. Raise DdctError where the
        port cannot be taken.
        """
        self._admission, self._inner, self._print = admission, inner, print_line
        self._reasons: set[str] = set()
        self._loop = asyncio.new_event_loop()
        try:
            self._server = self._loop.run_until_complete(
                asyncio.start_server(self._pass_on, admission.host, port, limit=MOST_BYTES)
            )
        except (OSError, OverflowError, UnicodeError) as error:
            self._loop.close()
            reason = getattr(error, 'strerror', None) or error
            raise DdctError(
                f'cannot serve on port {port} of {admission.host} ({reason}): '
                'choose another --port or --host, or stop the program that has it'
            ) from error
        self.port: int = self._server.sockets[0].getsockname()[1]
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Stop listening and close every connection."""
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(_START_S)
        self._loop.run_until_complete(self._close())
        self._loop.close()

    async def _close(self) -> None:
        self._server.close()
        tasks = asyncio.all_tasks() - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _pass_on(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with contextlib.suppress(OSError, TimeoutError, asyncio.IncompleteReadError):
            try:
                head = await asyncio.wait_for(reader.readuntil(END), _HEAD_S)
            except asyncio.LimitOverrunError:
                head = b''
            status, reason = self._admission.refusal(head)
            if status:
                self._refuse(reason)
                writer.write(f'HTTP/1.1 {status} Refused\r\nConnection: close\r\n\r\n'.encode())
                await writer.drain()
            else:
                await self._join(head, reader, writer)
        writer.close()

    async def _join(
        self, head: bytes, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> None:
        """Copy both directions until one ends."""
        inner_reader, inner_writer = await asyncio.open_connection(*self._inner)
        try:
            inner_writer.write(head)
            copies = [
                asyncio.create_task(_copy(reader, inner_writer)),
                asyncio.create_task(_copy(inner_reader, writer)),
            ]
            await asyncio.wait(copies, return_when=asyncio.FIRST_COMPLETED)
            for copy in copies:
                copy.cancel()
        finally:
            inner_writer.close()

    def _refuse(self, reason: str) -> None:
        if reason not in self._reasons and len(self._reasons) < _MOST_REASONS:
            self._reasons.add(reason)
            self._print(f'a connection was refused: {printable(reason)}')


async def _copy(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    with contextlib.suppress(OSError):
        while data := await reader.read(_CHUNK):
            writer.write(data)
            await writer.drain()

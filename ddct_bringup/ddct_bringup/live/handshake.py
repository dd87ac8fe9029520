# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
First lines of a connection to the live view: who may connect.

A browser lets any web page connect to any address, also to those of this machine, and says in
`Origin` which page it is. `Host` has the name by which the page has found us: a name of the page's
own that leads to this machine is refused, too.
"""

import ipaddress
import socket
from collections.abc import Collection
from dataclasses import dataclass
from urllib.parse import urlsplit

MOST_BYTES = 8192
"""Largest size of the first lines in bytes."""
END = b'\r\n\r\n'
ORIGINS = ('https://app.foxglove.dev', 'file://')
"""Origins of Foxglove in a browser and on the desktop; programs that are no browser send none."""
PATH = '/'
_THIS_MACHINE = ('localhost', '127.0.0.1', '::1')


@dataclass(frozen=True)
class Admission:
    """Origins and hosts that may connect."""

    host: str
    """Address on which the live view listens."""
    origins: Collection[str] = ORIGINS

    def refusal(self, head: bytes) -> tuple[int, str]:
        """Return HTTP status and reason for which first lines are refused; (0, '') for none."""
        try:
            method, path, fields = _parsed(head)
        except ValueError:
            return 400, 'it is no HTTP'
        if method != 'GET' or 'websocket' not in fields.get('upgrade', '').lower():
            return 400, 'it is no WebSocket'
        if path != PATH:
            return 404, f'its path is {path!r}, not {PATH!r}'
        host = _name_in(fields.get('host', ''))
        if not self._is_ours(host):
            return 403, f'its Host is {fields.get("host", "")!r}: use an address of this machine'
        origin = fields.get('origin')
        if origin is not None and origin not in self.origins:
            return 403, f'its Origin is {origin!r}: allow it with --origin'
        return 0, ''

    def _is_ours(self, name: str) -> bool:
        """Return whether a name is one of ours; a web page cannot claim an address for itself."""
        if name in (*_THIS_MACHINE, self.host.lower(), socket.gethostname().lower()):
            return True
        return not _is_loopback(self.host) and _is_address(name)


def _parsed(head: bytes) -> tuple[str, str, dict[str, str]]:
    """Return method, path and fields by lower-case name; raise ValueError for anything unclear."""
    request, *lines = head.decode('ascii').removesuffix(END.decode()).split('\r\n')
    method, path, version = request.split(' ')
    if version != 'HTTP/1.1' or not ''.join((request, *lines)).isprintable():
        raise ValueError
    fields: dict[str, str] = {}
    for line in lines:
        name, colon, value = line.partition(':')
        if not colon or name != name.strip() or name.lower() in fields:
            raise ValueError
        fields[name.lower()] = value.strip()
    return method, path, fields


def _name_in(host: str) -> str:
    """Return the name or address in a Host field, in lower case; empty for none."""
    try:
        return urlsplit(f'//{host}').hostname or ''
    except ValueError:
        return ''


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _is_loopback(name: str) -> bool:
    return name in _THIS_MACHINE or (_is_address(name) and ipaddress.ip_address(name).is_loopback)

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Connection to a browser by its debugging protocol."""

import asyncio
import itertools
import json
from typing import Any

from waiting import WITHIN_S


class Connection:
    """Connection to the browser, or to one page of it."""

    def __init__(self, socket: Any) -> None:
        """Use a web socket."""
        self.errors: list[str] = []
        self.requests: list[str] = []
        self._socket = socket
        self._numbers = itertools.count(1)

    async def call(self, method: str, **params: Any) -> dict[str, Any]:
        """Call a method of the protocol and return its result, noting events until then."""
        number = next(self._numbers)
        await self._socket.write_message(
            json.dumps({'id': number, 'method': method, 'params': params})
        )
        while True:
            text = await asyncio.wait_for(self._socket.read_message(), WITHIN_S)
            assert text is not None, f'the browser ended during {method}'
            message = json.loads(text)
            if message.get('id') == number:
                assert 'error' not in message, (method, message['error'])
                return dict(message['result'])
            self._note(message.get('method', ''), message.get('params', {}))

    async def evaluate(self, script: str) -> Any:
        """Return the JSON value of an expression, awaited if it is a promise."""
        result = await self.call(
            'Runtime.evaluate', expression=script, awaitPromise=True, returnByValue=True
        )
        assert 'exceptionDetails' not in result, result['exceptionDetails']
        return result['result'].get('value')

    def _note(self, event: str, params: dict[str, Any]) -> None:
        if event == 'Runtime.exceptionThrown':
            self.errors.append(json.dumps(params['exceptionDetails']))
        elif event == 'Runtime.consoleAPICalled' and params['type'] in ('error', 'warning'):
            self.errors.append(json.dumps(params['args']))
        elif event == 'Log.entryAdded' and params['entry']['level'] in ('error', 'warning'):
            self.errors.append(params['entry']['text'])
        elif event == 'Network.requestWillBeSent':
            self.requests.append(params['request']['url'])


async def connected(address: str) -> Connection:
    """Return a connection to the browser or the page with this address."""
    from tornado.websocket import websocket_connect

    return Connection(await websocket_connect(address, max_message_size=2**28))

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A page in a headless Chromium, controlled over its debugging protocol."""

import asyncio
import base64
import contextlib
import itertools
import json
import os
import shutil
import subprocess
import tempfile
import time
import uuid
from collections.abc import AsyncIterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

WITHIN_S = 60.0
"""Longest time in s for one operation of the browser on a loaded machine."""

CLOSES_S = 20.0
"""Longest time in s for the browser to close before it is killed."""

HELPERS_S = 10.0
"""Longest time in s for its helper processes to end after it."""

MARK = 'DDCT_BROWSER'
"""Environment variable that marks a browser and every process that it starts."""

PRINT = 'print'
"""Script that prints the page, and returns the PDF file."""

PICTURE = 'picture'
"""Script that returns the whole page as a PNG file."""

_NAMES = ('chromium', 'chromium-browser', 'google-chrome')
_OPTIONS = (
    '--headless',
    '--no-sandbox',
    '--disable-gpu',
    '--disable-quic',
    '--disable-dev-shm-usage',
    '--no-first-run',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
    '--remote-debugging-port=0',
)
_READY = """new Promise((resolve) => {
  const look = () => window.reportReady === undefined ? setTimeout(look, 5) : resolve(reportReady);
  look();
})"""


def chromium() -> str | None:
    """Return the path of a Chromium, None where there is none."""
    return next(filter(None, map(shutil.which, _NAMES)), None)


@dataclass
class Visit:
    """Events while a page was open, and the results of the scripts."""

    errors: list[str] = field(default_factory=list)
    """Errors and warnings of the console, and exceptions."""
    requests: list[str] = field(default_factory=list)
    ready_ms: float = 0.0
    """Time in ms from the start of the navigation until every chart was drawn."""
    values: list[Any] = field(default_factory=list)
    """Return values of the scripts."""


def visit(page: Path, **options: Any) -> Visit:
    """Open a report as `_visit` does, and return the events."""
    return asyncio.run(asyncio.wait_for(_visit(page, **options), 3 * WITHIN_S))


async def _visit(
    page: Path,
    *,
    width: int = 1280,
    height: int = 900,
    scheme: str = 'light',
    scripts: Sequence[str] = (),
) -> Visit:
    async with _browser() as tab:
        for domain in ('Page', 'Runtime', 'Log', 'Network'):
            await tab.call(f'{domain}.enable')
        metrics = {'width': width, 'height': height, 'deviceScaleFactor': 1, 'mobile': width < 600}
        await tab.call('Emulation.setDeviceMetricsOverride', **metrics)
        feature = {'name': 'prefers-color-scheme', 'value': scheme}
        await tab.call('Emulation.setEmulatedMedia', features=[feature])
        await tab.call('Page.navigate', url=page.resolve().as_uri())
        result = Visit(tab.errors, tab.requests)
        result.ready_ms = await tab.evaluate(_READY)
        for script in scripts:
            if script == PRINT:
                printed = await tab.call('Page.printToPDF', preferCSSPageSize=True)
                result.values.append(base64.b64decode(printed['data']))
            elif script == PICTURE:
                layout = await tab.call('Page.getLayoutMetrics')
                clip = {**layout['cssContentSize'], 'scale': 1}
                taken = await tab.call(
                    'Page.captureScreenshot', captureBeyondViewport=True, clip=clip
                )
                result.values.append(base64.b64decode(taken['data']))
            else:
                result.values.append(await tab.evaluate(script))
        return result


class _Tab:
    """One page of the browser."""

    def __init__(self, socket: Any) -> None:
        """Use the tab's web socket."""
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


@contextlib.asynccontextmanager
async def _browser() -> AsyncIterator[_Tab]:
    """Start a browser with an empty profile, and end it after use."""
    from tornado.httpclient import AsyncHTTPClient
    from tornado.websocket import websocket_connect

    program = chromium()
    assert program is not None
    mark = uuid.uuid4().hex
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        process = subprocess.Popen(
            [program, *_OPTIONS, f'--user-data-dir={profile}', 'about:blank'],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, MARK: mark},
        )
        try:
            port = await _port(Path(profile) / 'DevToolsActivePort', process)
            answer = await AsyncHTTPClient().fetch(f'http://127.0.0.1:{port}/json/list')
            tabs = [tab for tab in json.loads(answer.body) if tab['type'] == 'page']
            socket = await websocket_connect(
                tabs[0]['webSocketDebuggerUrl'], max_message_size=2**28
            )
            tab = _Tab(socket)
            yield tab
            await tab.call('Browser.close')
        finally:
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(CLOSES_S)
            process.kill()
            process.wait()
            wait_for_helpers(mark)


def wait_for_helpers(mark: str, within_s: float = HELPERS_S) -> list[int]:
    """
    Wait until every process with this mark has ended; return those that still run, by id.

    The crash handler is in a session of its own. It ends by itself a moment after the browser,
    later on a loaded machine.
    """
    deadline = time.monotonic() + within_s
    while (left := _marked(mark)) and time.monotonic() < deadline:
        time.sleep(0.01)
    return left


def _marked(mark: str) -> list[int]:
    entry = f'{MARK}={mark}'.encode()
    found = []
    for folder in Path('/proc').iterdir():
        if folder.name.isdigit():
            with contextlib.suppress(OSError):  # it may end, or belong to another user
                if entry in (folder / 'environ').read_bytes().split(b'\0'):
                    found.append(int(folder.name))
    return found


async def _port(file: Path, process: subprocess.Popen[bytes]) -> int:
    """Return the port of the debugging protocol, once the browser has told it."""
    deadline = time.monotonic() + WITHIN_S
    while not (file.exists() and file.read_text().count('\n')):
        assert process.poll() is None, f'the browser ended with code {process.returncode}'
        assert time.monotonic() < deadline, 'the browser did not start'
        await asyncio.sleep(0.02)
    return int(file.read_text().splitlines()[0])

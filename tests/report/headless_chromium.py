# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A page in a headless Chromium, controlled over its debugging protocol."""

import asyncio
import base64
import contextlib
import os
import shutil
import subprocess
import tempfile
import time
import uuid
from collections.abc import AsyncIterator, Callable, Coroutine, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from report.browser_processes import MARK, wait_for_helpers
from report.devtools import Connection, connected
from waiting import WITHIN_S

CLOSES_S = 20.0
"""Longest time in s for the browser to close before it is killed."""

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


Visitor = Callable[..., Visit]
"""Function with the arguments of `visit`."""


def visit(page: Path, **options: Any) -> Visit:
    """Open a page in a new browser as `Browser.visit` does, and return the events."""
    with Browser() as browser:
        return browser.visit(page, **options)


class Browser:
    """Browser with an empty profile; it ends when the context does."""

    def __enter__(self) -> 'Browser':
        program = chromium()
        assert program is not None
        self._mark = uuid.uuid4().hex
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self._process = subprocess.Popen(
            [program, *_OPTIONS, f'--user-data-dir={self._profile.name}', 'about:blank'],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, MARK: self._mark},
        )
        try:
            self._address = self._listens()
        except BaseException:
            self._end()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(OSError):
            self._run(self._close())
        self._end()

    def visit(self, page: Path, **options: Any) -> Visit:
        """Open a page as `_visit` does, with storage of its own, and return the events."""
        visited: Visit = self._run(self._visit(page, **options))
        return visited

    def _run(self, coroutine: Coroutine[Any, Any, Any]) -> Any:
        return asyncio.run(asyncio.wait_for(coroutine, 2 * WITHIN_S))

    def _listens(self) -> str:
        """Return the address of the debugging protocol, once it is there."""
        file = Path(self._profile.name) / 'DevToolsActivePort'
        deadline = time.monotonic() + WITHIN_S
        while not (file.exists() and file.read_text().count('\n')):
            code = self._process.poll()
            assert code is None, f'the browser ended with code {code}'
            assert time.monotonic() < deadline, 'the browser did not start'
            time.sleep(0.02)
        port, path = file.read_text().splitlines()[:2]
        self._pages = f'ws://127.0.0.1:{port}/devtools/page'
        return f'ws://127.0.0.1:{port}{path}'

    async def _close(self) -> None:
        await (await connected(self._address)).call('Browser.close')

    def _end(self) -> None:
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(CLOSES_S)
        self._process.kill()
        self._process.wait()
        wait_for_helpers(self._mark)
        self._profile.cleanup()

    @contextlib.asynccontextmanager
    async def _tab(self) -> AsyncIterator['Connection']:
        """Open a tab with storage of its own, and close it after use."""
        whole = await connected(self._address)
        made = await whole.call('Target.createBrowserContext')
        target = await whole.call('Target.createTarget', url='about:blank', **made)
        try:
            yield await connected(f'{self._pages}/{target["targetId"]}')
        finally:
            await whole.call('Target.disposeBrowserContext', **made)

    async def _visit(
        self,
        page: Path,
        *,
        width: int = 1280,
        height: int = 900,
        scheme: str = 'light',
        scripts: Sequence[str] = (),
    ) -> Visit:
        async with self._tab() as tab:
            for domain in ('Page', 'Runtime', 'Log', 'Network'):
                await tab.call(f'{domain}.enable')
            metrics = {
                'width': width,
                'height': height,
                'deviceScaleFactor': 1,
                'mobile': width < 600,
            }
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

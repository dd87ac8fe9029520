# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write the files of options such as `--json FILE`, completely or not at all."""

import contextlib
import os
import sys
from pathlib import Path

from ddct_plant.base.errors import DdctError, ParameterError

STDOUT = '-'
"""File name for standard output."""
_PICTURES = ('.png', '.svg', '.html')


def require_place(option: str, target: str | None) -> None:
    """Raise DdctError, before long work, where the `target` of an option cannot be written."""
    if not target or target == STDOUT:
        return
    path = Path(target)
    if path.is_dir():
        raise DdctError(f'{option} {target} is a folder: name a file in it')
    if not path.parent.is_dir():
        raise DdctError(f'{option} {target}: there is no folder {path.parent}: make it first')
    replaced = path.is_file() or not path.exists()
    if not os.access(path.parent if replaced else path, os.W_OK):
        raise DdctError(f'{option} {target}: cannot be written: choose another place', key=option)


def require_new(option: str, target: str | Path, *, overwrite: bool) -> None:
    """Raise DdctError where `target`, named by an option, exists and may not be replaced."""
    if not overwrite and Path(target).exists():
        raise DdctError(
            f'{target} exists already: choose another {option} or add --overwrite', key=option
        )


def require_picture(option: str, target: str | None) -> None:
    """Raise DdctError, before long work, where no picture can be written to `target`."""
    if target and Path(target).suffix not in _PICTURES:
        raise ParameterError(
            f'{option} {target}: name a file that ends in .png, .svg or .html', key=option
        )
    require_place(option, target)


def require_one_for_stdout(json_target: str | None, csv_target: str | None) -> None:
    """Raise DdctError when --json and --csv are both for standard output."""
    if json_target == STDOUT and csv_target == STDOUT:
        raise DdctError('--json - and --csv - both want standard output: give one a file')


def write_text(target: str, text: str, advice: str = '') -> None:
    """
    Write `text` to the file `target`, or to standard output for `-`.

    A file is replaced completely or not at all; a device or pipe is written to. Raise DdctError,
    with the advice, by default to give another file, when it cannot be written.
    """
    if target == STDOUT:
        if sys.stdout is None:
            raise DdctError('standard output was closed before the start: give a file')
        sys.stdout.write(text)
    else:
        write_bytes(target, text.encode(), advice)


def write_bytes(target: str, content: bytes, advice: str = '') -> None:
    """Write bytes to the file `target`, with the guarantees of `write_text`."""
    path = Path(target).resolve()
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(content)
        else:
            _replace(path, content)
    except OSError as error:
        advice = advice or 'give another file'
        raise DdctError(f'cannot be written ({error.strerror}); {advice}', place=target) from error


def _replace(path: Path, content: bytes) -> None:
    temporary = path.with_name(f'.{path.name}.{os.getpid()}')
    try:
        temporary.write_bytes(content)
        temporary.replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise

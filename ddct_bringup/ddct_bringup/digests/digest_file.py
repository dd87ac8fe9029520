# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`digests.json`: the digests of a folder's files, and what repeating its runs needs."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from ddct_bringup.digests.environment import Environment
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.input_file import open_file, read_text_file, require_schema_version
from ddct_plant.files.json_records import parse_json
from ddct_plant.files.output_file import write_text

DIGESTS = 'digests.json'
SCHEMA_VERSION = 1
"""Schema version of `digests.json`."""
RUNS, CAMPAIGN, BENCHMARK, TUNING = 'runs', 'campaign', 'benchmark', 'tuning'
"""Kinds of folders: one bag or several with their scores, a campaign, a benchmark, a tuning."""
_MOST_BYTES = 50_000_000
"""Largest size of `digests.json` in bytes; a campaign has a thousandth of that."""


@dataclass(frozen=True)
class RunDigests:
    """Digests of one run, and where its controller comes from."""

    scenario: str
    """Digest of the scenario, as on `run_info`."""
    controller: str | None
    """
    Name of the controller, or the path of its file relative to the folder; None where it was an
    object of a Python program.
    """
    controller_files: Mapping[str, str]
    """SHA-256 of the files that the controller is made of, by their key on `run_info`."""
    handover: str | None = None
    """Path of the handover's Python file relative to the folder; None where it has no file."""
    handover_files: Mapping[str, str] = field(default_factory=dict)
    """SHA-256 of that file and of the modules beside it that it imports, by their key."""

    def __post_init__(self) -> None:
        """Raise ParameterError for a value of another type, as in an edited file."""
        for key in ('controller_files', 'handover_files'):
            if not isinstance(getattr(self, key), Mapping):
                raise ParameterError(f'{key} is no group of keys', key=key)
        for value in (self.controller, self.handover):
            if not isinstance(value, str | None):
                raise ParameterError(f'{value!r} is no text')

    def entry(self) -> dict[str, Any]:
        """Return the digests as JSON; a run without a handover file has no keys of one."""
        content = asdict(self)
        return {
            key: content[key] for key in content if not key.startswith('handover') or content[key]
        }


@dataclass(frozen=True)
class Digests:
    """Content of `digests.json`."""

    schema_version: int
    kind: str
    """Kind of the folder, such as RUNS."""
    files: Mapping[str, str]
    """SHA-256 of every file but this one, by its path in the folder."""
    environment: Environment
    runs: Mapping[str, RunDigests] = field(default_factory=dict)
    """Digests of each run of a folder of the kind RUNS, by the name of its bag."""

    def with_files(self, files: Mapping[str, str]) -> 'Digests':
        """Return the digests with these files, in place of those of the same path."""
        return replace(self, files=dict(sorted({**self.files, **files}.items())))

    def text(self) -> str:
        """Return the text of the file; its last key is the SHA-256 of the text without it."""
        runs = {name: run.entry() for name, run in self.runs.items()}
        content = {**asdict(self), 'runs': runs}
        return _text(
            {**content, 'own_digest': hashlib.sha256(_text(content).encode()).hexdigest()}
        )

    def write(self, folder: Path) -> None:
        """Write `digests.json` into a folder; raise DdctError when that fails."""
        write_text(str(folder / DIGESTS), self.text(), ours=True)


def read_digests(folder: Path) -> Digests:
    """
    Return the digests of a folder.

    Raise DdctError without the file, and for one of which any byte was altered.
    """
    path = folder / DIGESTS
    try:
        text = read_text_file(path, _MOST_BYTES)
        content = parse_json(text)
        require_schema_version(content, SCHEMA_VERSION)
        digests = _digests_of(content)
        if digests.text() != text:
            raise ParameterError('its own digest does not match its content')
    except FileNotFoundError as error:
        raise DdctError(f'{folder}: no {DIGESTS} in it') from error
    except OSError as error:
        raise DdctError(f'{path}: cannot be read ({error.strerror})') from error
    except (ParameterError, LookupError, TypeError, AttributeError, ValueError) as error:
        why = error if isinstance(error, ParameterError) else repr(error)
        raise DdctError(f'{path}: it is damaged ({why}): put the original back') from error
    return digests


def file_digest(path: Path) -> str:
    """Return the SHA-256 of a file; raise DdctError when it cannot be read."""
    try:
        with open_file(path) as file:
            return hashlib.file_digest(file, 'sha256').hexdigest()
    except OSError as error:
        raise DdctError(f'{path}: cannot be read ({error.strerror})') from error


def _digests_of(content: Mapping[str, Any]) -> Digests:
    known = {each.name: content[each.name] for each in fields(Digests)}
    runs = {name: RunDigests(**run) for name, run in known['runs'].items()}
    for text in (known['kind'], *known['files'], *known['files'].values()):
        if not isinstance(text, str):
            raise ParameterError(f'{text!r} is no text')
    for path in known['files']:
        if Path(path).is_absolute() or '..' in Path(path).parts:
            raise ParameterError(f'{path!r} is outside of the folder')
    return Digests(**{**known, 'environment': Environment(**known['environment']), 'runs': runs})


def _text(content: Any) -> str:
    return json.dumps(content, indent=2, allow_nan=False) + '\n'

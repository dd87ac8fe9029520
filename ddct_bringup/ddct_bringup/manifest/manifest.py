# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
`manifest.json`: what a result is computed from, and the SHA-256 of each of its files.

A result has one. It is written when the result is begun, and completed at its end.
"""

import hashlib
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

from ddct_bringup.manifest.inputs import InputFiles, full_path
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.run.output_folder import SUFFIX, is_ours
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.json_records import json_text, read_json, to_json
from ddct_plant.files.output_file import write_text
from ddct_plant.program.arithmetic import Arithmetic, arithmetic

MANIFEST = 'manifest.json'
SCHEMA_VERSION = 1
Kind = Literal['runs', 'campaign', 'benchmark', 'tuning']
RUNS: Kind = 'runs'
CAMPAIGN: Kind = 'campaign'
BENCHMARK: Kind = 'benchmark'
TUNING: Kind = 'tuning'
ITSELF = '.'
"""Name of a run or a campaign whose folder is that of the result."""
_RESTORE = 'put the original back'


@dataclass(frozen=True)
class Manifest:
    """Content of `manifest.json`."""

    schema_version: int
    kind: Kind
    state: Literal['running', 'done']
    origin: CodeOrigin
    """Code that computes the result."""
    arithmetic: Arithmetic | None
    """Libraries and versions that decide the last bits; None where several took part."""
    plan: Mapping[str, Any]
    """Settings and seeds, by the keys of the plan of this kind."""
    campaigns: Mapping[str, Any] = field(default_factory=dict)
    """Plans of the campaigns in the result, by their folders in it."""
    files: Mapping[str, str] = field(default_factory=dict)
    """SHA-256 of every other file, by its path in the result; first of the inputs alone."""
    own_digest: str = ''
    """SHA-256 of the text of this file without this key."""

    def text(self) -> str:
        """Return the text of the file."""
        bare = json_text(replace(self, own_digest=''))
        return json_text(replace(self, own_digest=hashlib.sha256(bare.encode()).hexdigest()))

    def write(self, result: Path) -> None:
        """Write the manifest of a result, completely or not; raise DdctError when that fails."""
        write_text(str(result / MANIFEST), self.text(), 'what was there stays')

    def with_files(self, files: Mapping[str, str]) -> 'Manifest':
        """Return the manifest with these digests, in place of those of the same path."""
        return replace(self, files=dict(sorted({**self.files, **files}.items())))


def read_manifest(result: Path) -> Manifest:
    """
    Return the manifest of a result.

    Raise DdctError without one, for one of another version, and where any byte was altered.
    """
    path = result / MANIFEST
    if not path.exists():
        raise DdctError(f'no {MANIFEST} in it: give the folder of a result', place=result)
    try:
        found = read_json(Manifest, path, newest=SCHEMA_VERSION)
        if found.text() != path.read_text(encoding='utf-8'):
            raise ParameterError('its own digest does not match its content', place=path)
    except (ParameterError, OSError, ValueError) as error:
        raise DdctError(f'{error}: {_RESTORE}') from error
    for name in found.files:
        if Path(name).is_absolute() or '..' in Path(name).parts:
            raise DdctError(f'{name!r} is outside of the result: {_RESTORE}', place=path)
    return found


def begin_manifest(
    result: Path,
    kind: Kind,
    plan: object,
    inputs: InputFiles,
    campaigns: Mapping[str, object] | None = None,
) -> Manifest:
    """
    Copy the inputs of a result into its folder, then write its manifest, and return that.

    Raise DdctError when a file cannot be written.
    """
    inputs.copy(result)
    found = Manifest(
        SCHEMA_VERSION,
        kind,
        'running',
        CodeOrigin.here(),
        arithmetic(),
        to_json(plan),
        to_json(campaigns or {}),
        inputs.digests(),
    )
    found.write(result)
    return found


def require_same_plan(
    what: str,
    begun: tuple[object, CodeOrigin],
    plan: object,
    differences: Mapping[str, str],
    result: Path,
) -> None:
    """
    Raise DdctError with the first difference of a plan, by this code, from one that was begun.

    `begun` is the plan and the origin in the manifest of the result, `what` its kind in words.
    `differences` has the meaning of another value of each key, in the order of the checks.
    """
    ours = {key: value for each in begun for key, value in to_json(each).items()}
    theirs = {**to_json(plan), **to_json(CodeOrigin.here())}
    for key, difference in differences.items():
        if ours[key] != theirs[key]:
            raise DdctError(
                f'it holds a {what} {difference}: finish it as it was started, or choose '
                'another --out',
                key=key,
                place=result,
            )


def require_same_inputs(result: Path, known: Manifest, inputs: InputFiles) -> None:
    """Raise DdctError where a result was begun with other files than these inputs."""
    ours = {name: known.files[name] for name in known.files if name.startswith(inputs.folder)}
    for name, digest in {**ours, **inputs.digests()}.items():
        if ours.get(name) != digest or inputs.digests().get(name) != digest:
            raise DdctError(
                f'{name} has changed since it was begun: put the old file back, or choose '
                'another --out',
                key=name,
                place=result,
            )


def resume_manifest(result: Path, known: Manifest, *, one_machine: bool = True) -> Manifest:
    """
    Mark a result as running again, and return its manifest.

    It keeps its arithmetic only if all of it is computed on `one_machine` with the same.
    """
    same = one_machine and known.arithmetic == arithmetic()
    found = replace(known, state='running', arithmetic=known.arithmetic if same else None)
    if found != known:
        found.write(result)
    return found


def add_campaign(result: Path, folder: str, plan: object) -> None:
    """Write the plan of a campaign in the `folder` of a result into its manifest."""
    known = read_manifest(result)
    campaigns = {**known.campaigns, folder: to_json(plan)}
    replace(known, campaigns=campaigns).write(result)


def finish_manifest(result: Path) -> None:
    """Write the digest of each file of a result, and that it is done; raise DdctError."""
    files = {name: file_digest(path) for name, path in files_in(result).items()}
    replace(read_manifest(result), files=files, state='done').write(result)


def keep_digests(paths: Iterable[Path | str]) -> None:
    """
    Renew the digests of files that a program has written into results.

    Files elsewhere have none. Raise DdctError when a file cannot be read or written.
    """
    by_result: dict[Path, list[Path]] = {}
    for path in paths:
        file = Path(os.path.realpath(path))
        if (result := result_around(file.parent)) is not None:
            by_result.setdefault(result, []).append(file)
    for result, files in by_result.items():
        digests = {each.relative_to(result).as_posix(): file_digest(each) for each in files}
        read_manifest(result).with_files(digests).write(result)


def result_around(folder: Path) -> Path | None:
    """Return the folder of the result that a folder is, or is in; None where it is in none."""
    path = full_path(folder)
    marked = (each for each in (path, *path.parents) if is_ours(each))
    return next((each for each in marked if (each / MANIFEST).is_file()), None)


def files_in(result: Path) -> dict[str, Path]:
    """Return the files of a result by their path in it, without its manifest."""
    return dict(sorted(_files(result, lambda path: path != result / MANIFEST)))


def _files(folder: Path, counts: Callable[[Path], bool]) -> Iterator[tuple[str, Path]]:
    for path in folder.rglob('*'):
        is_lock = path.name.startswith('.') and path.name.endswith(SUFFIX)
        if (path.is_symlink() or not path.is_dir()) and not is_lock and counts(path):
            yield path.relative_to(folder).as_posix(), path


def file_digest(path: Path) -> str:
    """Return the SHA-256 of a file; raise DdctError when it cannot be read."""
    try:
        with path.open('rb') as file:
            return hashlib.file_digest(file, 'sha256').hexdigest()
    except OSError as error:
        raise DdctError(f'cannot be read ({error.strerror})', place=path) from error

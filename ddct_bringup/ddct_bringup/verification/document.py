# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Document of `verify --json`: what was found of one result, or of several below a path."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ddct_bringup.manifest.file_states import FileState
from ddct_bringup.manifest.manifest import Kind
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.verification.folder import Verification
from ddct_bringup.verification.result import RepetitionResult
from ddct_bringup.verification.states import BOUND
from ddct_plant.files.json_records import Inline
from ddct_plant.program.arithmetic import Arithmetic, arithmetic


@dataclass(frozen=True)
class Environment:
    """Code, libraries and versions that computed a result."""

    origin: Inline[CodeOrigin]
    arithmetic: Arithmetic | None
    """None where several took part."""


@dataclass(frozen=True)
class FolderFacts:
    """What was found of a result as a whole."""

    folder: str
    kind: Kind
    same: bool
    """Whether nothing differs."""
    state: str
    """Worst state of the files and of what was made again."""
    error: str | None
    """Reason why it could not be made again; None in general."""
    environment: Environment
    environment_here: Environment
    environment_differences: Sequence[str]
    bound: float
    """Largest relative difference that counts as the same; 0 in the same environment."""
    by_digest: Sequence[str]
    """Names of files with times on the wall clock: their digests alone are checked."""


@dataclass(frozen=True)
class FolderDocument:
    """What was found of one result."""

    facts: Inline[FolderFacts]
    files: Sequence[FileState]
    runs: Sequence[RepetitionResult]
    """What was made again; nothing where a file was not the same."""


@dataclass(frozen=True)
class FoldersDocument:
    """What was found of several results; paths and runs begin with the folder."""

    same: bool
    state: str
    """Worst state of all."""
    files: Sequence[FileState]
    runs: Sequence[RepetitionResult]
    folders: Sequence[FolderFacts]


def document_of(found: Verification) -> FolderDocument:
    """Return what was found of one result."""
    facts = FolderFacts(
        folder=str(found.folder),
        kind=found.manifest.kind,
        same=found.same,
        state=found.state,
        error=found.error or None,
        environment=Environment(found.manifest.origin, found.manifest.arithmetic),
        environment_here=Environment(CodeOrigin.here(), arithmetic()),
        environment_differences=found.environment_differences,
        bound=BOUND if found.environment_differences else 0.0,
        by_digest=found.by_digest,
    )
    return FolderDocument(facts, found.files, found.runs)


def document_of_all(found: Sequence[Verification], state: str, *, same: bool) -> FoldersDocument:
    """Return what was found of several results, whose worst state is given."""
    folders = [document_of(each) for each in found]
    names = [each.facts.folder for each in folders]
    pairs = [*zip(names, folders, strict=True)]
    files = [
        replace(file, path=f'{name}/{file.path}') for name, each in pairs for file in each.files
    ]
    runs = [replace(run, run=f'{name}: {run.run}') for name, each in pairs for run in each.runs]
    return FoldersDocument(same, state, files, runs, [each.facts for each in folders])

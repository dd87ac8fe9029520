# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Compare the files of a result with those of its repetition, each by its kind."""

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from itertools import zip_longest
from os.path import commonprefix
from pathlib import Path, PurePosixPath
from typing import Any

import pyarrow as pa

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.campaign.arrow_columns import read_parquet
from ddct_bringup.campaign.columns import INDEX
from ddct_bringup.campaign.conduct import SHARDS
from ddct_bringup.manifest.inputs import INPUTS
from ddct_bringup.manifest.manifest import MANIFEST, RUNS, Manifest, files_in, read_manifest
from ddct_bringup.run.execution import WORK_FOLDER
from ddct_bringup.run.output_folder import MARKER
from ddct_bringup.run.timing_and_failure import NOTE_FILE, TIMING_FILE
from ddct_bringup.tuning.study import JOURNAL
from ddct_bringup.verification.comparison import Comparison, plain_json, recorded_json
from ddct_bringup.verification.repetition import Repeated
from ddct_bringup.verification.result import RepetitionResult
from ddct_plant.bag_file.metadata import METADATA_FILE, ROOT_KEY
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import parse_json
from ddct_plant.files.yaml_text import parse_yaml
from ddct_plant.scenario.recorded_settings import SETTINGS
from ddct_plant.signals.topics import RUN_INFO

BAG_SUFFIX = '.mcap'
OF_CODE = frozenset(
    {'version', 'commit', 'code', 'code_digest', 'spec_digest', 'shard_size', 'other_code'}
)
"""Keys, at whatever place in a file, that another code writes otherwise."""
_FOLDERS = re.compile(r'[^\s(]*/')
"""Folders of a path in a text, which are others in a scratch folder."""
_WALL_CLOCK = (TIMING_FILE, JOURNAL)
_LATER = 'written later by another program'
_PAGE = 'made again, but not compared'
_SHOWN = 30
"""Number of characters around the first difference of a line that are shown."""


@dataclass(frozen=True)
class FileComparison:
    """A result and its repetition in a scratch folder, and what was not as planned there."""

    result: Path
    scratch: Path
    manifest: Manifest
    repeated: Repeated
    same_environment: bool
    """Whether code, libraries and versions agree, so that only equal bits count as the same."""
    same_code: bool
    wall_clock: set[str] = field(default_factory=set)
    """Names that the comparison leaves out, as it finds them."""

    def results(self) -> Iterator[RepetitionResult]:
        """Yield the result of each run, table, document and page, in the order of their paths."""
        entries: dict[str, list[str]] = {}
        for path in sorted({*self.manifest.files, *files_in(self.scratch)}):
            is_input = path.startswith(f'{INPUTS}/') and INPUTS not in self._runs
            if not is_input and not path.endswith(MARKER):
                entries.setdefault(self._entry(path), []).append(path)
        if self.manifest.kind != RUNS:
            yield self._plans()
        for name in sorted({*entries, *map(self._shown, self.repeated.failed)}):
            if result := self._result(name, entries.get(name, [])):
                yield result

    @property
    def _runs(self) -> Collection[str]:
        """Folders of the bags of a result of the kind RUNS."""
        return self.manifest.plan.get('runs', ())

    def _entry(self, path: str) -> str:
        """Return the name of what a file is a part of: the run of a bag, the shards, itself."""
        folders = [each.as_posix() for each in PurePosixPath(path).parents]
        if self.manifest.kind == RUNS:
            run = next((each for each in folders if each in self._runs), None)
            return self._shown(run) if run else path
        return folders[0] if PurePosixPath(folders[0]).name == SHARDS else path

    def _shown(self, run: str) -> str:
        """Return the name of a run in results; a run's own folder has that of the folder."""
        return self.result.resolve().name if run == '.' else run

    def _result(self, name: str, paths: list[str]) -> RepetitionResult | None:
        """Return the result of an entry; None for one that has files of the wall clock only."""
        of_run = {self._shown(run): run for run in self._runs}
        run = of_run.get(name, '')
        note = self.repeated.notes.get(run or name, '')
        if run in self.repeated.failed:
            return RepetitionResult.failed(name, self.repeated.failed[run], note)
        if run in self.repeated.left_out:
            return RepetitionResult.not_repeated(name, self.repeated.left_out[run])
        if any(path.endswith(NOTE_FILE) for path in paths):  # the bag has what came before
            paths = [path for path in paths if path.endswith(NOTE_FILE)]
        comparison, compared = Comparison(), False
        # Signals first: the settings are in a bag and in its metadata.
        for path in sorted(paths, key=lambda path: not path.endswith(BAG_SUFFIX)):
            inner = PurePosixPath(path).relative_to(run)
            if inner.name in _WALL_CLOCK or inner.parts[0] == WORK_FOLDER:
                self.wall_clock.add(inner.name)
                continue
            if not (self.scratch / path).exists() and not run:
                why = 'a run failed' if self.repeated.failed else _LATER
                return RepetitionResult.not_repeated(name, why)
            if path.endswith('.html') and not self.same_environment and self._differs(path):
                return RepetitionResult.not_repeated(name, _PAGE)
            compared = True
            try:
                self._compare(comparison, path)
            except DdctError as error:
                return RepetitionResult.failed(name, error)
        if not compared:
            return None
        return RepetitionResult.of(
            name, comparison, same_environment=self.same_environment, note=note
        )

    def _differs(self, path: str) -> bool:
        return (self.result / path).read_bytes() != (self.scratch / path).read_bytes()

    def _compare(self, comparison: Comparison, path: str) -> None:
        """Add the difference of one file; raise DdctError for one that cannot be read."""
        ours, theirs = self.result / path, self.scratch / path
        for file, what in (
            (ours, 'the repetition has it alone'),
            (theirs, 'it is not made again'),
        ):
            if not file.exists():
                comparison.add({'file': path, 'reason': what}, True, False)
                return
        if not self._differs(path):
            return
        known = comparison.bits
        _BY_SUFFIX.get(ours.suffix, _compare_texts)(self, comparison, path)
        if comparison.bits is known and self.same_environment:
            reason = 'other bytes than those of the same content'
            comparison.add({'file': path, 'reason': reason}, False, True)

    def _plans(self) -> RepetitionResult:
        """Compare the plan in the manifest with that of the repetition."""
        comparison = Comparison()
        again = read_manifest(self.scratch)
        for key in ('plan', 'campaigns'):
            ours, theirs = getattr(self.manifest, key), getattr(again, key)
            comparison.add_nested(key, self._of_code(ours), self._of_code(theirs))
        return RepetitionResult.of(MANIFEST, comparison, same_environment=self.same_environment)

    def _of_code(self, content: Any) -> Any:
        """Return JSON without the keys that another code writes otherwise, where it is one."""
        if self.same_code:
            return content
        if isinstance(content, Mapping):
            return {k: self._of_code(content[k]) for k in content if k not in OF_CODE}
        return [*map(self._of_code, content)] if isinstance(content, list) else content

    def _compare_bags(self, comparison: Comparison, path: str) -> None:
        """Compare the signals at each step, then what the bag has about its run."""
        ours, theirs = read_bag(self.result / path), read_bag(self.scratch / path)
        comparison.add_trajectories(ours.trajectory, theirs.trajectory)
        about = _about if self.same_code else _facts
        comparison.add_nested('', about(ours), about(theirs))

    def _compare_json(self, comparison: Comparison, path: str) -> None:
        ours, theirs = (
            self._of_code(recorded_json(folder / path)) for folder in (self.result, self.scratch)
        )
        comparison.add_nested('', _without_folders(ours), _without_folders(theirs))

    def _compare_tables(self, comparison: Comparison, path: str) -> None:
        """Compare the columns that both tables have, row by row."""
        ours, theirs = _table(self.result / path), _table(self.scratch / path)
        comparison.add({'file': path, 'key': 'rows'}, ours.num_rows, theirs.num_rows)
        if self.same_code:
            comparison.add(
                {'file': path, 'key': 'columns'},
                ', '.join(ours.column_names),
                ', '.join(theirs.column_names),
            )
        indices = ours[INDEX].to_pylist() if INDEX in ours.column_names else range(ours.num_rows)
        columns = {
            name: (ours[name].to_pylist(), theirs[name].to_pylist())
            for name in ours.column_names
            if name in theirs.column_names
        }
        for place, index in enumerate(indices):
            if place == theirs.num_rows:
                return
            for name, (recorded, again) in columns.items():
                comparison.add(
                    {'file': path, 'row': index, 'signal': name},
                    _without_folders(recorded[place]),
                    _without_folders(again[place]),
                )

    def _compare_yaml(self, comparison: Comparison, path: str) -> None:
        """Compare two texts; metadata of a bag by another code without what is in the bag."""
        if self.same_code or PurePosixPath(path).name != METADATA_FILE:
            _compare_texts(self, comparison, path)
            return
        ours, theirs = (_metadata(folder / path) for folder in (self.result, self.scratch))
        comparison.add_nested('', ours, theirs)


def _compare_texts(found: FileComparison, comparison: Comparison, path: str) -> None:
    """Compare two texts line by line."""
    ours, theirs = (
        (folder / path).read_text(encoding='utf-8', errors='replace').splitlines()
        for folder in (found.result, found.scratch)
    )
    for line, (recorded, again) in enumerate(zip_longest(ours, theirs), start=1):
        if recorded != again:
            start = max(0, len(commonprefix([recorded or '', again or ''])) - _SHOWN)
            end = start + 2 * _SHOWN
            place = {'file': path, 'line': line}
            comparison.add(place, (recorded or '')[start:end], (again or '')[start:end])


_BY_SUFFIX = {
    BAG_SUFFIX: FileComparison._compare_bags,
    '.yaml': FileComparison._compare_yaml,
    '.json': FileComparison._compare_json,
    '.parquet': FileComparison._compare_tables,
}


def _metadata(path: Path) -> Any:
    """Return rosbag2's metadata of a bag without the custom data, which the bag has too."""
    content = parse_yaml(path.read_text(encoding='utf-8', errors='replace'))
    information = content.get(ROOT_KEY) if isinstance(content, dict) else None
    if isinstance(information, dict):
        information.pop('custom_data', None)
    return content


def _about(recorded: Recording) -> Mapping[str, object]:
    """Return all that a bag has about its run, as JSON."""
    settings = parse_json(recorded.custom_data[SETTINGS])
    run_info = plain_json(recorded.run_info)
    return {**recorded.custom_data, SETTINGS: settings, RUN_INFO.name: run_info}


def _facts(recorded: Recording) -> Mapping[str, object]:
    """Return the facts of a run, which bags of all versions have, as JSON."""
    return {'facts': plain_json(asdict(recorded.facts))}


def _table(path: Path) -> pa.Table:
    try:
        return read_parquet(path)
    except (OSError, pa.ArrowException) as error:
        raise DdctError(f'cannot be read ({error})', place=path) from error


def _without_folders(content: Any) -> Any:
    """Return values of JSON without the folders of paths in texts."""
    if isinstance(content, str):
        return _FOLDERS.sub('', content)
    if isinstance(content, Mapping):
        return {key: _without_folders(value) for key, value in content.items()}
    return [*map(_without_folders, content)] if isinstance(content, list) else content

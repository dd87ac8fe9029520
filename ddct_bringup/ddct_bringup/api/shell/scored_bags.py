# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Score recorded bags and logs, and write what is wanted of them to files."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.bag.measured_run import read_recording
from ddct_bringup.bag.recording import Recording
from ddct_bringup.logs.columns import load_columns
from ddct_bringup.manifest.manifest import keep_digests
from ddct_bringup.run.output_folder import is_ours, locked_folders
from ddct_bringup.scores.bags import bag_name, bags_in
from ddct_bringup.scores.csv_text import scores_csv
from ddct_bringup.scores.document import scores_document
from ddct_bringup.scores.floors import with_least
from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import unreadable_run
from ddct_bringup.scores.signal_files import signal_file_stems, write_signals
from ddct_bringup.verdict.limits import Limits
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import STDOUT, write_text
from ddct_plant.program.progress import with_progress

Bag = tuple[Path, Path | None]
"""A bag, and the folder in which it was found if one was searched."""


@dataclass(frozen=True)
class ScoreFiles:
    """Files that are written of scored bags; None, or no entry, for those that are not."""

    json: str | None = None
    csv: str | None = None
    signals: Mapping[str, Path] | None = None
    """Folders for the files of signals by their ending, `csv` or `mat`."""

    @property
    def texts(self) -> list[str]:
        """Files of scores, without standard output."""
        return [file for file in (self.json, self.csv) if file not in (None, STDOUT)]


@dataclass(frozen=True)
class BagScorer:
    """How bags are read and scored."""

    limits: Limits
    complain: Callable[[object], None]
    """Take a line on a bag: it cannot be read, or its values were adjusted."""
    columns: str | None = None
    """File with the column map of logs."""
    floors: bool = False

    def scores(self, recording: Recording, name: str) -> ScoredRun:
        """Return the scores of the bag called `name`; raise DdctError for unusable timing."""
        scored = score_recording(recording, name, self.limits)
        return (with_least(scored, self.limits) if self.floors else scored).scores


def score_bags(paths: Sequence[Path], scorer: BagScorer, files: ScoreFiles) -> list[ScoredRun]:
    """
    Score the bags at `paths` and write the files; return the scores, and print the progress.

    A bag that cannot be read is a run with its reason. Raise DdctError without any bag, and for
    a file that cannot be written.
    """
    bags = bags_in(paths)
    with locked_folders(*_run_folders(files)):
        written: list[Path | str] = []
        runs = _scored(bags, scorer, files.signals or {}, written)
        if files.json:
            write_json(files.json, scores_document(runs, scorer.limits))
        if files.csv:
            write_text(files.csv, scores_csv(runs))
        keep_digests([*written, *files.texts])
    return runs


def _run_folders(files: ScoreFiles) -> list[Path]:
    """Return the folders of runs into which is written."""
    folders = [Path(file).parent for file in files.texts]
    folders += (files.signals or {}).values()
    return list(filter(is_ours, folders))


def _scored(
    bags: Sequence[Bag],
    scorer: BagScorer,
    signals: Mapping[str, Path],
    written: list[Path | str],
) -> list[ScoredRun]:
    """Return the scores of bags; write their signals, and add these files to `written`."""
    runs = []
    stems = signal_file_stems(bags) if signals else {}
    columns = load_columns(scorer.columns) if scorer.columns else None
    for bag, folder in with_progress(bags, len(bags), 'scoring'):
        recording = None
        try:
            recording = read_recording(bag, columns)
            name = bag_name(bag, folder)
            for line in recording.settings.scenario.adjusted if recording.settings else ():
                scorer.complain(f'{name}: {line}')
            runs.append(scorer.scores(recording, name))
        except DdctError as error:
            unreadable = unreadable_run(bag, error, relative_to=folder)
            scorer.complain(unreadable.reason)
            runs.append(unreadable)
        if recording is None:
            continue
        for ending, target in signals.items():  # a full disk is no fault of the bag
            write_signals(target, f'{stems[bag]}.{ending}', recording)
            written.append(target / f'{stems[bag]}.{ending}')
    return runs

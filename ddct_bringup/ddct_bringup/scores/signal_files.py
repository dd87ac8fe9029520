# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write every signal of a run to a file for other tools: CSV, or MAT for MATLAB and Octave."""

import io
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from ddct_bringup.bag.recording import Recording
from ddct_bringup.scores.bags import bag_name
from ddct_bringup.scores.csv_text import signal_columns, signals_csv
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import write_bytes

_MAT_TEXT = b'MATLAB 5.0 MAT-file, written by ddct score'
_MAT_TEXT_BYTES = 116


def signals_mat(recording: Recording) -> bytes:
    """
    Return the columns of `signals_csv` as a MAT file of version 5: (N+1, 1) each, by name.

    The file contains no date, so the same run gives the same bytes.
    """
    from scipy.io import savemat

    buffer = io.BytesIO()
    savemat(buffer, signal_columns(recording.trajectory), format='5', oned_as='column')
    return _MAT_TEXT.ljust(_MAT_TEXT_BYTES) + buffer.getvalue()[_MAT_TEXT_BYTES:]


SIGNAL_FILES: Mapping[str, Callable[[Recording], bytes]] = {
    'csv': lambda recording: signals_csv(recording).encode(),
    'mat': signals_mat,
}
"""Functions that encode the signals of a recording, by file extension."""


def signal_file_stems(bags: Sequence[tuple[Path, Path | None]]) -> dict[Path, str]:
    """
    Return the file name of each bag without its extension; `bags` is a result of `bags_in`.

    It is the name in the scores; where bags share one, it is made of the whole path. Raise
    DdctError with two bags whose paths give the same name too.
    """
    short = [_stem(bag_name(bag, folder)) for bag, folder in bags]
    shared = {each for each in short if short.count(each) > 1}
    stems: dict[Path, str] = {}
    for (bag, _), stem in zip(bags, short, strict=True):
        name = _stem(bag.as_posix()) if stem in shared else stem
        for other, taken in stems.items():
            if taken == name:
                raise DdctError(
                    f'{other} and {bag}: the signals of both would be in {name}: write them into '
                    'two folders, one after the other'
                )
        stems[bag] = name
    return stems


def _stem(name: str) -> str:
    plain = name.strip('./').replace('/', '_').removesuffix('.mcap')
    return plain or Path(name).resolve().name


def write_signals(folder: Path, file: str, recording: Recording) -> None:
    """Write a run's signals to a file in a folder, made if need be, in its extension's format."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DdctError(f'{folder}: cannot make the folder: {error.strerror}') from error
    content = SIGNAL_FILES[file.rpartition('.')[2]](recording)
    write_bytes(str(folder / file), content)

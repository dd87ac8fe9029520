"""`failed_run.json`: the note in the folder of a run that failed, with or without a bag."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.bag.run_facts import RunFacts
from ddct_plant.base.errors import DdctError, printable
from ddct_plant.files.input_file import parse_json, read_text_file
from ddct_plant.files.output_file import write_json

NOTE_FILE = 'failed_run.json'


@dataclass(frozen=True)
class FailedRun:
    """What is known of a run that failed."""

    reason: str
    facts: RunFacts | None = None
    """What the run was to be; None where the note cannot be read."""


def note_failure(folder: Path, reason: str, custom_data: Mapping[str, str]) -> None:
    """
    Say in a run's folder why it failed; `custom_data` is what its bag should have held.

    Raise DdctError when that fails.
    """
    note = {'reason': reason, 'run': dict(custom_data)}
    write_json(str(folder / NOTE_FILE), note, 'choose another output folder')


def failed_run(folder: Path) -> FailedRun | None:
    """
    Return what the note in a run's folder says, None without one.

    A note that cannot be read still says that the run failed.
    """
    path = folder / NOTE_FILE
    try:
        note = parse_json(read_text_file(path))
        return FailedRun(printable(note['reason']), RunFacts.from_custom_data(note['run']))
    except FileNotFoundError:
        return None
    except (OSError, DdctError, LookupError, TypeError, AttributeError) as error:
        return FailedRun(printable(f'the run failed, and its {path} cannot be read ({error!r})'))

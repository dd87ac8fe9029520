"""The frequency-domain evidence that `compare` leaves beside the scores."""

from collections.abc import Sequence
from pathlib import Path

from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_plant.files.output_file import write_json
from ddct_plant.scenario.settings import RunSettings

FREQUENCY_FILE = 'frequency.json'


def write_frequency_evidence(folder: Path, names: Sequence[str], settings: RunSettings) -> None:
    """
    Write `frequency.json` for these controllers, in the loop as `settings` run it.

    Raise DdctError when it cannot be written or a controller's linear model cannot be used.
    """
    write_json(str(folder / FREQUENCY_FILE), frequency_evidence(names, settings))

"""The latched `run_info` message: what a node is and which settings it runs with."""

import importlib.metadata
from collections.abc import Mapping

from ddct_plant.scenario.file import scenario_digest
from ddct_plant.scenario.settings import RunSettings


def package_version() -> str:
    """Return the version of the installed packages, or 'unknown' in a bare source tree."""
    try:
        return importlib.metadata.version('ddct_plant')
    except importlib.metadata.PackageNotFoundError:
        return 'unknown'


def run_info_pairs(
    settings: RunSettings, extra: Mapping[str, str] | None = None
) -> tuple[tuple[str, str], ...]:
    """Return the (key, value) pairs that a node says of itself; the same in every layout."""
    return (
        ('version', package_version()),
        ('scenario', settings.scenario.name),
        ('scenario_digest', scenario_digest(settings.scenario)),
        ('architecture', settings.architecture),
        ('clutch', settings.clutch),
        ('wear_gain', repr(settings.wear_gain)),
        ('mode', settings.mode),
        ('seed', str(settings.seed)),
        *(extra or {}).items(),
    )

"""When a run may stand beside Table 5.1, and what is said of a predicted figure there."""

from ddct_bringup.thesis.predictions import predictions_for
from ddct_bringup.thesis.table_5_1 import FORMS, ThesisRow
from ddct_plant.scenario.file import load_scenario, scenario_digest
from ddct_plant.scenario.settings import RunSettings


def is_thesis_run(settings: RunSettings) -> bool:
    """
    Return whether a run has the thesis's own conditions.

    They are its scenario unchanged, the detailed architecture, and the linear clutch, new.
    """
    return (
        settings.detailed
        and settings.clutch == 'linear'
        and settings.wear_gain == 1.0
        and scenario_digest(settings.scenario) == scenario_digest(load_scenario('thesis'))
    )


def predicted_range(controller: str, name: str) -> str:
    """
    Return the range of a figure over the admissible scenarios, for a run under these conditions.

    Empty for a figure that is no prediction, and for all where the ranges are not those of the
    packaged scenario.
    """
    found = predictions_for(load_scenario('thesis')).get(f'5.1 {controller} {name}')
    return found.text(FORMS[name]) if found else ''


def verdict(row: ThesisRow, name: str, value: float | None) -> str:
    """Return in a word whether a predicted figure is within its tolerance of the print."""
    return 'hit' if row.hit(name, value) else 'miss'

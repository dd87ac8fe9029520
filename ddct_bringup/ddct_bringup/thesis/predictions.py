"""Predictions with their spread: the kept values of the frozen scenario and of every member."""

import importlib.resources
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from ddct_bringup.thesis.table_5_1 import FORMS
from ddct_plant.files.input_file import parse_json
from ddct_plant.scenario.file import load_scenario, scenario_digest
from ddct_plant.scenario.scenario import Scenario

FOLDER = 'admissible_scenarios'
FILE = 'predictions.json'
Value = float | str | None
"""A figure, None where it is not defined; hit or miss of a word of Table 5.2."""


@dataclass(frozen=True)
class Prediction:
    """One predicted value in the frozen scenario and in every member of the ensemble."""

    frozen: Value
    members: Mapping[str, Value]
    """By the member's name."""

    @property
    def values(self) -> tuple[Value, ...]:
        """All of them: the frozen scenario is admissible too."""
        return (self.frozen, *self.members.values())

    @property
    def numbers(self) -> tuple[float, ...]:
        """Those that are defined, of a figure."""
        return tuple(value for value in self.values if isinstance(value, (int, float)))

    def contains(self, value: float) -> bool:
        """Return whether a value is between the least and the largest."""
        return bool(self.numbers) and min(self.numbers) <= value <= max(self.numbers)

    def text(self, form: str) -> str:
        """
        Return the range, its ends in a format such as '.2f'; of words each with its count.

        The end of a figure that some members do not have, such as t_a without w_d = 0, is '-'.
        """
        words = Counter(value for value in self.values if isinstance(value, str))
        if words:
            return ', '.join(f'{word} ({count})' for word, count in words.most_common())
        if not self.numbers:
            return '-'
        ends = [format(end, form) for end in (min(self.numbers), max(self.numbers))]
        if None in self.values:
            ends[1] = '-'
        return ' to '.join(ends)


@dataclass(frozen=True)
class Predictions:
    """Every prediction by its id in the thesis gate, such as '5.1 mpc3 engagement_time_s'."""

    scenario_digest: str
    """Of the frozen scenario that they belong to."""
    by_id: Mapping[str, Prediction]

    def as_record(self) -> dict[str, Any]:
        """Return the content of FILE."""
        return {
            'scenario_digest': self.scenario_digest,
            'predictions': {
                name: {'frozen': one.frozen, 'members': dict(one.members)}
                for name, one in self.by_id.items()
            },
        }


def folder_of_members() -> Path:
    """Return the folder of the ensemble's files, which come with this package."""
    return Path(str(importlib.resources.files('ddct_bringup.thesis') / FOLDER))


@cache
def kept_predictions() -> Predictions:
    """Return the predictions that are kept with the ensemble."""
    content = parse_json((folder_of_members() / FILE).read_text(encoding='utf-8'))
    return Predictions(
        content['scenario_digest'],
        {
            name: Prediction(one['frozen'], one['members'])
            for name, one in content['predictions'].items()
        },
    )


def predictions_for(scenario: Scenario) -> Mapping[str, Prediction]:
    """Return the kept predictions by id; none for another scenario than the packaged one."""
    kept = kept_predictions()
    return kept.by_id if kept.scenario_digest == scenario_digest(scenario) else {}


def predicted_range(controller: str, name: str) -> str:
    """
    Return a figure's range over the admissible scenarios, for a run with the thesis's conditions.

    Empty for a figure that is no prediction, and for all where the ranges are not those of the
    packaged scenario.
    """
    found = predictions_for(load_scenario('thesis')).get(f'5.1 {controller} {name}')
    return found.text(FORMS[name]) if found else ''

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Predictions with their range: stored values of the frozen scenario and of every member."""

import importlib.resources
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ddct_bringup.thesis.table_5_1 import FORMS
from ddct_plant.files.json_records import read_json
from ddct_plant.scenario.file import load_scenario, scenario_digest
from ddct_plant.scenario.scenario import Scenario

FOLDER = 'admissible_scenarios'
FILE = 'predictions.json'
Value = float | str | None
"""Number, None where it is undefined; for Table 5.2 the text hit or miss."""


@dataclass(frozen=True)
class Prediction:
    """One predicted value in the frozen scenario and in every member of the ensemble."""

    frozen: Value
    members: Mapping[str, Value]
    """Predicted values by the name of the member."""

    @property
    def values(self) -> tuple[Value, ...]:
        """All values, including that of the frozen scenario, which is admissible too."""
        return (self.frozen, *self.members.values())

    @property
    def numbers(self) -> tuple[float, ...]:
        """All values that are defined numbers."""
        return tuple(value for value in self.values if isinstance(value, (int, float)))

    def contains(self, value: float) -> bool:
        """Return whether a value is between the smallest and the largest prediction."""
        return bool(self.numbers) and min(self.numbers) <= value <= max(self.numbers)

    def text(self, form: str) -> str:
        """
        Return the range with its ends in a format such as '.2f'; for hits and misses their counts.

        The end of a range is '-' where some members have no value, such as t_a without w_d = 0.
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
    """Content of FILE."""

    scenario_digest: str
    """Digest of the frozen scenario that the predictions belong to."""
    predictions: Mapping[str, Prediction]
    """Every prediction by its id in the thesis gate, such as '5.1 mpc3 engagement_time_s'."""


def folder_of_members() -> Path:
    """Return the folder of the ensemble's files, which come with this package."""
    return Path(str(importlib.resources.files('ddct_bringup.thesis') / FOLDER))


@cache
def kept_predictions() -> Predictions:
    """Return the predictions that are stored with the ensemble."""
    return read_json(Predictions, folder_of_members() / FILE)


def predictions_for(scenario: Scenario) -> Mapping[str, Prediction]:
    """Return the stored predictions by id; none for another scenario than the packaged one."""
    kept = kept_predictions()
    return kept.predictions if kept.scenario_digest == scenario_digest(scenario) else {}


def predicted_range(controller: str, name: str) -> str:
    """
    Return the range of a metric over the admissible scenarios for a run of the thesis.

    Empty for a metric without a prediction, and for all where the ranges do not belong to the
    packaged scenario.
    """
    found = predictions_for(load_scenario('thesis')).get(f'5.1 {controller} {name}')
    return found.text(FORMS[name]) if found else ''

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The packaged drives with the second car, unlike the C635 in mass, ratios and inertias."""

from ddct_bringup.campaign.rows import scored_headless
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.scenario.choices.scenarios import packaged_names
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

CAR = 'city7'
DRIVES = tuple(sorted({*packaged_names('drive')} - {'thesis'}))
"""Every packaged drive but that of the thesis, whose engine has no limits."""
OF_ENGINE = {'tip_in': ['engine.torque_share=[0.24, 1.0]']}
"""Demands in N m that are beyond the engine of the car, as shares of its own."""


def scenario_of(drive: str) -> Scenario:
    """Return the drive with the second car."""
    return load_scenario(drive=drive, car=CAR, overrides=OF_ENGINE.get(drive, ()))


def settings_of(drive: str) -> RunSettings:
    """Return the settings of a run of the drive with the second car."""
    return RunSettings(KnownSettings(scenario_of(drive)))


def scored(drive: str, controller: str) -> ScoredRun:
    """Return the scores of a run of the drive with the second car."""
    return scored_headless(settings_of(drive), controller, packaged_limits())

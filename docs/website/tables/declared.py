# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The tables of the pages by kind: each is declared in the code, or computed in a second."""

from collections.abc import Callable, Mapping
from functools import cache

from ddct_controllers.design.analysis.loops import continuous_loop, sampled_loop
from ddct_controllers.design.h_infinity.recipes import PRINTED_WEIGHTS, THESIS_SPECIFICATIONS
from ddct_controllers.design.h_infinity.record import (
    design_record,
    loop_record,
    uncertainty_record,
)
from ddct_controllers.design.h_infinity.record_types import LoopsEntry
from ddct_controllers.design.h_infinity.tables import design_tables, loop_table
from ddct_controllers.design.loop_shaping.record import thesis_record
from ddct_controllers.design.loop_shaping.tables import thesis_tables
from ddct_controllers.printed import H_INFINITY_CONTROLLERS
from ddct_controllers.registry import controller_names
from ddct_controllers.synthesised import SYNTHESISED, synthesised_design
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_controllers.workflows.margins_command import margins_table
from ddct_controllers.workflows.plant_command import paper_tables
from ddct_controllers.workflows.plant_on_paper import plant_on_paper
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.program.table import TextTable
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from website.tables.actuator_tables import other_actuators
from website.tables.missing_tables import missing_tables
from website.tables.option_tables import TABLES as OPTION_TABLES
from website.tables.parameter_tables import parameter_tables
from website.tables.score_tables import score_tables
from website.tables.tuning_tables import tuning_tables


def h_infinity_tables() -> Mapping[str, TextTable]:
    """Return our designs together with the printed controllers."""
    records = [
        design_record(name, recipe, THESIS_SPECIFICATIONS, synthesised_design(name))
        for name, recipe in SYNTHESISED.items()
    ]
    printed = {
        name: _both_loops(controller) for name, controller in H_INFINITY_CONTROLLERS.items()
    }
    return design_tables(records, uncertainty_record()) | {'printed': loop_table(printed)}


def _both_loops(controller: FactoredTransferFunction) -> LoopsEntry:
    """Return both loops of a printed controller, judged by the weights that the thesis prints."""
    sampled = sampled_loop(discretise_zoh(controller.to_state_space(), PERIOD_S))
    return LoopsEntry(
        continuous_loop=loop_record(
            continuous_loop(controller), PRINTED_WEIGHTS, THESIS_SPECIFICATIONS
        ),
        sampled_loop=loop_record(sampled, PRINTED_WEIGHTS, THESIS_SPECIFICATIONS),
    )


def plant_tables() -> Mapping[str, TextTable]:
    """Return the plant of the scenario `thesis`."""
    return paper_tables(plant_on_paper(load_scenario('thesis')))


def sampled_loops() -> TextTable:
    """Return the margins of every linear controller in the scenario `thesis`, new clutch."""
    settings = RunSettings(KnownSettings(load_scenario('thesis')))
    return margins_table(frequency_evidence(controller_names(), settings), settings)


def _margins() -> Mapping[str, TextTable]:
    return {'sampled_loops': sampled_loops(), 'other_actuators': other_actuators()}


_TABLES: Mapping[str, Callable[[], Mapping[str, TextTable]]] = {
    'options': lambda: OPTION_TABLES,
    'parameters': parameter_tables,
    'scores': score_tables,
    'plant': plant_tables,
    'loop-shaping': lambda: thesis_tables(thesis_record()),
    'h-infinity': h_infinity_tables,
    'margins': _margins,
    'tuning': tuning_tables,
    'missing': missing_tables,
}
KINDS = tuple(_TABLES)
"""Kinds of tables."""


@cache
def tables_of(kind: str) -> Mapping[str, TextTable]:
    """Return the tables of a kind by name, computed once."""
    return _TABLES[kind]()

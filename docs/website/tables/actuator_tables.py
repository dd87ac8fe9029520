# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Margins of the thesis's designs, which keep the printed actuator, with other actuators."""

from ddct_controllers.design.analysis.loop_quantities import LOOP_QUANTITY_OF
from ddct_controllers.design.analysis.loops import sampled_loop
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_controllers.registry import make_controller
from ddct_plant.files.json_records import to_json
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.program.table import TextTable
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

DESIGNS = ('pi', *PRINTED_CONTROLLERS, 'hinf_thesis', 'hinf_fitted')
ACTUATORS = (PRINTED_ACTUATOR, ActuatorParameters(0.02, 0.6), ActuatorParameters(0.005, 2.0))
_SHOWN = ('gain_margin_db', 'phase_margin_deg', 'delay_margin_s', 'sensitivity_peak')


def other_actuators() -> TextTable:
    """Return the margins of each design with each actuator in the scenario `thesis`."""
    quantities = [LOOP_QUANTITY_OF[key] for key in _SHOWN]
    return TextTable(
        '',
        ('controller', 'delay ms', 'bandwidth', 'stable', *(each.heading for each in quantities)),
        [_row(name, actuator) for name in DESIGNS for actuator in ACTUATORS],
    )


def _row(name: str, actuator: ActuatorParameters) -> list[str]:
    settings = RunSettings(KnownSettings(load_scenario('thesis')))
    model = make_controller(name, settings.known).linear_model()
    assert model is not None
    driveline = settings.scenario.driveline
    margins = loop_margins(sampled_loop(model, driveline, actuator=actuator))
    values = to_json(margins.limited())
    return [
        name,
        f'{1e3 * actuator.delay_s:g}',
        f'{actuator.bandwidth_factor:g}',
        'yes' if margins.stable else 'no',
        *(LOOP_QUANTITY_OF[key].cell(values) for key in _SHOWN),
    ]

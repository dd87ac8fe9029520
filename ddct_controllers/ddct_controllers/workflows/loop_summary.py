# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lines on the loop of a linear controller, such as one in a file, before its run."""

from dataclasses import replace

from ddct_controllers.design.analysis.loop_quantities import LOOP_QUANTITY_OF
from ddct_controllers.design.analysis.loops import sampled_loop
from ddct_controllers.design.analysis.margins import loop_margins, unstable_poles
from ddct_controllers.design.state_space import factored_form, factors_text, scaled
from ddct_controllers.linear import BILINEAR, LinearController
from ddct_controllers.registry import compiled_code, controller_label, make_controller
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.files.json_records import to_json
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.scenario.settings import RunSettings

_DIGITS = 6
_MARGINS = (
    ('gain margin', LOOP_QUANTITY_OF['gain_margin_db']),
    ('phase margin', replace(LOOP_QUANTITY_OF['phase_margin_deg'], form='.0f')),
    ('delay margin', LOOP_QUANTITY_OF['delay_margin_s']),
)


def loop_summary(name: str, settings: RunSettings) -> list[str]:
    """Return lines for a terminal on the controller called `name`; none unless it is linear."""
    if compiled_code(name):
        return []
    controller = make_controller(name, settings.known)
    if not isinstance(controller, LinearController):
        return []
    model, label = controller.linear_model(), controller_label(name)
    lines = [f'{label}: G_c(z) = {formula(factored_form(model), "z")}']
    given = controller.given
    if isinstance(given, FactoredTransferFunction) or given.period_s is None:
        factored = given if isinstance(given, FactoredTransferFunction) else factored_form(given)
        way = 'bilinear rule' if controller.discretisation == BILINEAR else 'zero-order hold'
        lines.insert(0, f'{label}: G_c(s) = {formula(factored, "s")}')
        lines[1] += f', by {way}'
    lines[-1] += f', every {1e3 * PERIOD_S:g} ms, from slip error in rpm to torque in N m'
    return [*lines, f'{label}: {_stability(model, settings)}']


def _stability(model: StateSpace, settings: RunSettings) -> str:
    scenario, wear_gain = settings.scenario, settings.case.wear_gain
    loop = sampled_loop(model, scenario.driveline, wear_gain, scenario.actuator)
    where = f'the sampled loop with its hold and delay, at wear gain {wear_gain:g},'
    if outside := unstable_poles(loop):
        turned = scaled(loop, -1.0)
        hint = '' if unstable_poles(turned) else '; -G_c is stable: is the sign wrong?'
        count = 'pole' if outside == 1 else 'poles'
        return (
            f'UNSTABLE: {where} has {outside} {count} on or outside the unit circle{hint} '
            '(the run goes on)'
        )
    margins = to_json(loop_margins(loop).limited())
    texts = (f'{words} {quantity.cell(margins)} {quantity.unit}' for words, quantity in _MARGINS)
    return f'{where} is stable: {", ".join(texts)}'


def formula(function: FactoredTransferFunction, variable: str) -> str:
    """Return a transfer function as text for a reader."""
    numerator, denominator = (
        factors_text(side, variable, _DIGITS)
        for side in (function.numerator, function.denominator)
    )
    above = f'{function.gain:.{_DIGITS}g} {numerator}'.rstrip()
    several = len(function.denominator) > 1
    return f'{above} / {f"[{denominator}]" if several else denominator}' if denominator else above

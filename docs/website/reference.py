# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Pages of the reference: the classes and functions that users call, out of their docstrings."""

from pathlib import Path

PAGES = {
    'Python interface': ('ddct_bringup.api',),
    'Controllers': (
        *('ddct_controllers.interface', 'ddct_controllers.policy'),
        'ddct_controllers.handover.interface',
    ),
    'Models of the plant': (
        *('ddct_plant.models.engine', 'ddct_plant.models.load', 'ddct_plant.models.clutch'),
        *('ddct_plant.models.actuator', 'ddct_plant.models.driveline'),
        *('ddct_plant.models.gearbox', 'ddct_plant.models.static_torque'),
    ),
    'Scenarios and plants of a run': (
        *('ddct_plant.scenario.scenario', 'ddct_plant.scenario.settings'),
        *('ddct_plant.scenario.file', 'ddct_plant.plant'),
    ),
    'Friction that sticks': ('ddct_plant.hybrid.integrator',),
    'Errors and options': ('ddct_plant.base.errors', 'ddct_plant.base.options'),
}
"""Modules by the heading of the page that documents them."""
_MODULE = """
.. automodule:: {module}
   :members:
   :show-inheritance:
   :member-order: bysource
"""


def write_reference(folder: Path) -> None:
    """Write a page for each heading into a folder, numbered in their order."""
    folder.mkdir()
    for number, (heading, modules) in enumerate(PAGES.items()):
        text = f'{heading}\n{"=" * len(heading)}\n'
        for module in modules:
            if len(modules) > 1:
                text += f'\n{module}\n{"-" * len(module)}\n'
            text += _MODULE.format(module=module)
        name = heading.lower().replace(' ', '_')
        (folder / f'{number}_{name}.rst').write_text(text, encoding='utf-8')

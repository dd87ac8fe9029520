# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Our H-infinity controllers are computed from the scenario's driveline, or refused."""

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.registry import make_controller
from ddct_controllers.synthesised import SYNTHESISED, synthesised_design
from ddct_plant.base.errors import DdctError
from ddct_plant.models.gearbox import Gearbox
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings


def model_in(name, *changes):
    return make_controller(name, KnownSettings(load_scenario('thesis', changes))).linear_model()


@pytest.mark.parametrize('name', SYNTHESISED)
def test_a_run_has_the_design_for_its_own_driveline(name):
    first_gear = synthesised_design(name, DrivelineParameters(gear=Gearbox().gear(1)))
    assert model_in(name, 'gear=1') is first_gear.sampled, 'computed once'
    identified = model_in(name)
    assert identified is synthesised_design(name, DrivelineParameters()).sampled
    assert identified.a.shape != first_gear.sampled.a.shape or not np.allclose(
        identified.a, first_gear.sampled.a
    )


def test_a_driveline_without_such_a_controller_is_named_in_one_line():
    undamped = ('driveline.halfshaft_damping=0', 'driveline.shaft_damping=0')
    with refused(DdctError, 'hinf_thesis') as caught:
        model_in('hinf_thesis', *undamped)
    message = str(caught.value)
    assert message.startswith("controller 'hinf_thesis' cannot be computed for the scenario's dr")
    assert message.endswith('or choose another controller')
    assert '\n' not in message

"""A trial of check-controller is on the true signals, whatever sensors the scenario has."""

from ddct_controllers.check.trial import closed_trial
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings


def slip(*changes: str) -> list[float]:
    settings = RunSettings(load_scenario('thesis', changes))
    return closed_trial(settings, make_controller('pi', settings)).slip


def test_trials_leave_the_sensors_of_a_scenario_out():
    assert slip('sensors.engine_speed.noise_rad_s=1') == slip()

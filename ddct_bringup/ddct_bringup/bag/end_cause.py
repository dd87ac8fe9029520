"""Why a recorded run ended before its time: the engine stalled or over-revved."""

from collections.abc import Mapping

from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.base.errors import DdctError
from ddct_plant.files.yaml_text import parse_yaml
from ddct_plant.scenario.file import scenario_from_mapping
from ddct_plant.scenario.plant import end_cause


def recorded_end_cause(trajectory: Trajectory, custom_data: Mapping[str, str]) -> str | None:
    """
    Return `stalled` or `over_revved`, None where the run's last state is no reason to end it.

    It follows from that state and from the engine's limits in the scenario that the bag keeps; a
    scenario that cannot be read gives no reason.
    """
    try:
        scenario = scenario_from_mapping(parse_yaml(custom_data.get('scenario_yaml', '')))
    except (DdctError, TypeError, ValueError):
        return None
    return end_cause(scenario, float(trajectory.joint_speed[-1, 0]))

"""Every study by its name."""

from collections.abc import Mapping

from ddct_bringup.reproduction.studies.admissible_scenarios import (
    admissible_scenarios,
    prediction_ranges,
    worn_ranges,
)
from ddct_bringup.reproduction.studies.clutch_torque_limit import clutch_torque_limit
from ddct_bringup.reproduction.studies.readings import readings
from ddct_bringup.reproduction.studies.score_windows import score_windows
from ddct_bringup.reproduction.studies.state_of_art import pedal_positions, state_of_art
from ddct_bringup.reproduction.studies.study import StudyFunction
from ddct_bringup.reproduction.studies.torsion_weight import torsion_weight
from ddct_bringup.reproduction.studies.two_input.engine_authority import engine_authority
from ddct_bringup.reproduction.studies.two_input.mpc4_readings import mpc4_readings
from ddct_bringup.reproduction.studies.two_input.torque_level import torque_level
from ddct_bringup.reproduction.studies.two_input.two_input_wear import two_input_wear
from ddct_bringup.reproduction.studies.wear import wear, wear_feedforward
from ddct_bringup.reproduction.studies.wear_estimate import wear_estimate

STUDIES: Mapping[str, StudyFunction] = {
    function.__name__: function
    for function in (
        admissible_scenarios,
        clutch_torque_limit,
        engine_authority,
        mpc4_readings,
        pedal_positions,
        prediction_ranges,
        readings,
        score_windows,
        state_of_art,
        torque_level,
        torsion_weight,
        two_input_wear,
        wear,
        wear_estimate,
        wear_feedforward,
        worn_ranges,
    )
}

"""The two-input controllers with a worn clutch, the rows of MPC4 in Table 5.2 in numbers."""

from ddct_bringup.studies.two_input_figures import HEADERS, cells
from ddct_bringup.thesis.runs import THESIS_SCENARIO, thesis_run
from ddct_controllers.design.study import Study
from ddct_plant.run_settings import RunSettings

CONTROLLERS = ('mpc4', 'mpc4_wear')
WEAR_GAINS = (0.7, 0.85, 0.95, 1.0, 1.05, 1.15, 1.3)


def two_input_wear() -> Study:
    """Return the figures of both controllers at each wear gain."""
    return Study(
        'Two inputs in the thesis scenario, by wear of the clutch',
        ('controller', 'K_usura', *HEADERS),
        [
            (
                controller,
                f'{gain:g}',
                *cells(
                    RunSettings(THESIS_SCENARIO, wear_gain=gain),
                    thesis_run(controller, 'detailed', gain),
                ),
            )
            for controller in CONTROLLERS
            for gain in WEAR_GAINS
        ],
    )

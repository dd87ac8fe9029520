"""The two-input controllers with a worn clutch, the rows of MPC4 in Table 5.2 in numbers."""

from ddct_bringup.reproduction.runs.runs import THESIS_SCENARIO, thesis_run
from ddct_bringup.reproduction.studies.study import Study
from ddct_bringup.reproduction.studies.two_input.two_input_figures import HEADERS, cells
from ddct_plant.scenario.settings import RunSettings

WEAR_GAINS = (0.7, 0.85, 0.95, 1.0, 1.05, 1.15, 1.3)
FAR_GAINS = (0.4, 0.5, *WEAR_GAINS, 1.5, 1.6, 2.0)
"""Up to and beyond the bounds of the estimate, 0.5 and 1.5."""
CASES = {'mpc4': WEAR_GAINS, 'mpc4_wear': FAR_GAINS}


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
            for controller, gains in CASES.items()
            for gain in gains
        ],
    )

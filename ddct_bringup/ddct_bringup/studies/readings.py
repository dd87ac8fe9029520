"""MPC1-3 under the readings that Table 4.1 and Section 4.2 of the thesis leave open."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

from ddct_bringup.scores.thesis_table import thesis_row
from ddct_bringup.studies.open_loop_readings import OpenLoopOff, OpenLoopUnknown
from ddct_bringup.studies.scored_run import FIGURE_HEADERS, figures, scored_run
from ddct_bringup.thesis.runs import THESIS_SCENARIO
from ddct_controllers.design.study import Study
from ddct_controllers.interface import Controller
from ddct_controllers.mpc.build import make_observer
from ddct_controllers.mpc.predictive_controller import PredictiveController
from ddct_controllers.mpc.settings import InputTerms, MpcSettings, OutputTerms
from ddct_controllers.mpc.thesis_mpc import TABLE_4_1, thesis_settings
from ddct_controllers.mpc.transmission_model import (
    REQUEST,
    SLIP_SPEED,
    TransmissionModel,
    transmission_model,
)
from ddct_plant.run_settings import RunSettings

SETTINGS = RunSettings(THESIS_SCENARIO)
MODEL = transmission_model(THESIS_SCENARIO.driveline)


def readings() -> Study:
    """Return the figures of MPC1-3 under each reading; the first is what the registry has."""
    rows = [
        (name, reading, *figures(scored_run(SETTINGS, make(thesis_settings(row)))))
        for name, row in TABLE_4_1.items()
        for reading, make in _READINGS.items()
    ]
    printed = thesis_row('mpc3')
    assert printed is not None
    print_out = tuple(format(value, 'g') for value in printed.figures().values())
    return Study(
        'MPC1-3 in the thesis scenario, by reading of Table 4.1',
        ('controller', 'reading', *FIGURE_HEADERS),
        [*rows, ('MPC3', 'as the thesis prints it', *print_out)],
    )


def _controller(settings: MpcSettings, model: TransmissionModel = MODEL) -> PredictiveController:
    return PredictiveController(model, make_observer(SETTINGS, model), settings)


def _held(settings: MpcSettings) -> MpcSettings:
    return replace(settings, preview=False)


def _per_rad_s(settings: MpcSettings) -> MpcSettings:
    """Take Q per rad/s."""
    weight = TABLE_4_1['mpc3'].output_weight
    return replace(settings, outputs=(OutputTerms(SLIP_SPEED, weight),))


def _not_squared(settings: MpcSettings) -> MpcSettings:
    """Take Q e^2 + R du^2, the norm of Section 4.1: the weights that are squared are roots."""
    row = TABLE_4_1['mpc3']
    # What is weighted stays in rpm: 0.26 becomes its root, the rpm per rad/s do not.
    weight = settings.outputs[0].weight / math.sqrt(row.output_weight)
    return replace(
        settings,
        outputs=(OutputTerms(SLIP_SPEED, weight),),
        inputs=(InputTerms(move_weight=math.sqrt(row.move_weight)),),
    )


def _without_actuator() -> TransmissionModel:
    """Return a model whose clutch transmits the request at once: P_1, P_2 and P_3 alone."""
    a, b = MODEL.a.copy(), MODEL.b.copy()
    a[:4, 4:] = 0.0
    b[:, REQUEST] += MODEL.clutch
    return TransmissionModel(a, b, MODEL.c, MODEL.d, MODEL.clutch)


_READINGS: Mapping[str, Callable[[MpcSettings], Controller]] = {
    'Q per rpm, preview': _controller,
    'Q per rpm, reference held': lambda settings: _controller(_held(settings)),
    'Q per rad/s, preview': lambda settings: _controller(_per_rad_s(settings)),
    'Q per rad/s, reference held': lambda settings: _controller(_per_rad_s(_held(settings))),
    'weights not squared': lambda settings: _controller(_not_squared(settings)),
    'no actuator in its model': lambda settings: _controller(settings, _without_actuator()),
    'C_fOL off from 0.6 s, its torque taken over': lambda settings: OpenLoopOff(
        _controller(settings)
    ),
    'C_fOL off from 0.6 s, moves from 0': lambda settings: OpenLoopOff(
        _controller(settings), from_zero=True
    ),
    'C_fOL on, unknown to it': lambda settings: OpenLoopUnknown(_controller(settings)),
}

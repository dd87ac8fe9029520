"""The predictive controllers by their names in the registry."""

from collections.abc import Callable
from functools import partial

from ddct_controllers.interface import Controller, ControllerContext
from ddct_controllers.mpc.offset_free_mpc import make_offset_free_mpc, make_torsion_mpc
from ddct_controllers.mpc.thesis_mpc import PREVIEW, TABLE_4_1, make_preview_mpc, make_thesis_mpc
from ddct_controllers.mpc.thesis_mpc4 import make_mpc4
from ddct_controllers.mpc.two_input_wear_mpc import make_two_input_wear_mpc
from ddct_controllers.mpc.wear_mpc import make_wear_mpc

PREDICTIVE: dict[str, Callable[[ControllerContext], Controller]] = {
    **{name: partial(make_thesis_mpc, name) for name in TABLE_4_1},
    'mpc4': make_mpc4,
    PREVIEW: make_preview_mpc,
    'mpc_offset_free': make_offset_free_mpc,
    'mpc_torsion': make_torsion_mpc,
    'mpc_wear': make_wear_mpc,
    'mpc4_wear': make_two_input_wear_mpc,
}
"""Factories, the thesis's first."""

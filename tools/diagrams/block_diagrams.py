# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The diagrams of docs/thesis/plant.md: the thesis's Figures 1.9 to 1.26 with our names."""

from diagrams.parts import Place, Signal, box, branch, end, sum_at, svg

Diagram = tuple[str, dict[str, Place], list[Signal]]

ACTUATOR: Diagram = (
    'From the torque request to the clutch torque',
    {
        'request': end(1, 2),
        'cut': box(7, 2, 'max(0, u)'),
        'delay': box(13.5, 2, 'delay 10 ms'),
        'g_a': box(19.5, 2, 'G_a(s)'),
        'wear': box(27, 2, 'K_usura'),
        'torque': end(32, 2),
    },
    [
        Signal('request', 'cut', 'request'),
        Signal('cut', 'delay'),
        Signal('delay', 'g_a'),
        Signal('g_a', 'wear', 'C_actuator'),
        Signal('wear', 'torque', 'C_f'),
    ],
)

DRIVELINE: Diagram = (
    'Engine, primary shaft, half-shaft and vehicle, with slip speed',
    {
        'c_m': end(1, 3),
        'engine_sum': sum_at(6, 3),
        'engine': box(11, 3, '1/(J_m s + c_m)'),
        'w_m': branch(33, 3),
        'c_f': branch(6, 8),
        'c_f_in': end(1, 8),
        'shaft_sum': sum_at(9, 8),
        'shaft': box(15, 8, '1/(J_p s + c_prim)'),
        'w_p': branch(21.5, 8),
        'ratio': box(24.5, 8, '1/tau'),
        'twist_sum': sum_at(29, 8),
        'half_shaft': box(29, 12, 'c_sa + k_sa/s'),
        'c_sa': branch(21, 12),
        'back': box(15, 12, '1/tau'),
        'vehicle_sum': sum_at(21, 16),
        'c_load': end(13, 16),
        'vehicle': box(26, 16, '1/(J_v s)'),
        'w_r': branch(33, 16),
        'out_r': end(39, 16),
        'slip_sum': sum_at(33, 5.5),
        'w_p_bend': Place(21.5, 5.5, kind='dot'),
        'w_d': end(39, 5.5),
    },
    [
        Signal('c_m', 'engine_sum', 'C_m', '+'),
        Signal('engine_sum', 'engine'),
        Signal('engine', 'w_m', 'w_m'),
        Signal('w_m', 'slip_sum', sign='+'),
        Signal('c_f_in', 'c_f', 'C_f'),
        Signal('c_f', 'engine_sum', sign='−'),
        Signal('c_f', 'shaft_sum', sign='+'),
        Signal('shaft_sum', 'shaft'),
        Signal('shaft', 'w_p', 'w_p'),
        Signal('w_p', 'ratio'),
        Signal('w_p', 'w_p_bend'),
        Signal('w_p_bend', 'slip_sum', sign='−'),
        Signal('ratio', 'twist_sum', sign='+'),
        Signal('twist_sum', 'half_shaft', 'w_sr'),
        Signal('half_shaft', 'c_sa', 'C_sa'),
        Signal('c_sa', 'back'),
        Signal('back', 'shaft_sum', sign='−'),
        Signal('c_sa', 'vehicle_sum', sign='+'),
        Signal('c_load', 'vehicle_sum', 'C_load', '−'),
        Signal('vehicle_sum', 'vehicle'),
        Signal('vehicle', 'w_r', 'w_r'),
        Signal('w_r', 'twist_sum', sign='−', across_first=False),
        Signal('w_r', 'out_r', 'V_x = r_w w_r'),
        Signal('slip_sum', 'w_d', 'w_d'),
    ],
)

LTI: Diagram = (
    'Three transfer functions and the free response add up to the slip speed',
    {
        'c_m': end(1, 2),
        'c_f': end(1, 6),
        'c_load': end(1, 10),
        'p_1': box(7, 2, 'P_1(s)'),
        'p_2': box(7, 6, 'P_2(s)'),
        'p_3': box(7, 10, 'P_3(s)'),
        'sum': sum_at(13, 6),
        'free_sum': sum_at(18, 6),
        'free': box(18, 2, 'free response'),
        'w_d': end(24, 6),
    },
    [
        Signal('c_m', 'p_1', 'C_m'),
        Signal('c_f', 'p_2', 'C_f'),
        Signal('c_load', 'p_3', 'C_load'),
        Signal('p_1', 'sum', sign='+'),
        Signal('p_2', 'sum', sign='+'),
        Signal('p_3', 'sum', sign='+'),
        Signal('sum', 'free_sum', sign='+'),
        Signal('free', 'free_sum', sign='+'),
        Signal('free_sum', 'w_d', 'w_d'),
    ],
)

DETAILED: Diagram = (
    'Architecture detailed: static controller and feedback',
    {
        'reference': box(3, 6, 'reference'),
        'error': sum_at(8, 6),
        'g_c': box(13.5, 6, 'controller G_c'),
        'sum': sum_at(20.5, 6),
        'static': box(20.5, 2, 'static controller'),
        'static_in': end(11, 2),
        'actuator': box(26.5, 6, 'actuator, clutch'),
        'plant': box(34.5, 6, 'driveline'),
        'disturbances': end(27, 2),
        'w_d': branch(40, 6),
        'out': end(42, 6),
        'below': branch(8, 10),
        'below_reference': branch(3, 10),
    },
    [
        Signal('reference', 'error', 'r', '+'),
        Signal('error', 'g_c', 'e'),
        Signal('g_c', 'sum', 'C_fCL', '+'),
        Signal('static_in', 'static', 'C_m, V_x'),
        Signal('static', 'sum', 'C_fOL', '+'),
        Signal('sum', 'actuator'),
        Signal('actuator', 'plant', 'C_f'),
        Signal('disturbances', 'plant', 'C_m, C_load'),
        Signal('plant', 'w_d', 'w_d'),
        Signal('w_d', 'out'),
        Signal('w_d', 'below', across_first=False),
        Signal('below', 'error', sign='−'),
        Signal('below', 'below_reference'),
        Signal('below_reference', 'reference'),
    ],
)

FEEDFORWARD: Diagram = (
    'Architectures base (without C_1 and C_2) and feedforward',
    {
        'reference': end(1, 8),
        'error': sum_at(5, 8),
        'g_c': box(9.5, 8, 'G_c'),
        'sum': sum_at(14.5, 8),
        'g_a': box(21, 8, 'G_a, delay'),
        'p_2': box(27, 8, 'P_2'),
        'slip': sum_at(32, 8),
        'w_d': branch(35, 8),
        'out': end(37, 8),
        'below': branch(5, 17),
        'engine_in': end(1, 2),
        'engine': branch(10, 2),
        'c_1': box(14.5, 4.5, 'C_1'),
        'p_1': box(27, 2, 'P_1'),
        'load_in': end(6, 14),
        'load': branch(10, 14),
        'c_2': box(14.5, 11.5, 'C_2'),
        'p_3': box(27, 14, 'P_3'),
    },
    [
        Signal('reference', 'error', 'r', '+'),
        Signal('error', 'g_c', 'e'),
        Signal('g_c', 'sum', sign='+'),
        Signal('sum', 'g_a', 'request'),
        Signal('g_a', 'p_2', 'C_f'),
        Signal('p_2', 'slip', sign='+'),
        Signal('slip', 'w_d', 'w_d'),
        Signal('w_d', 'out'),
        Signal('w_d', 'below', across_first=False),
        Signal('below', 'error', sign='−'),
        Signal('engine_in', 'engine', 'C_m'),
        Signal('engine', 'p_1'),
        Signal('engine', 'c_1', across_first=False),
        Signal('c_1', 'sum', sign='−'),
        Signal('p_1', 'slip', sign='+'),
        Signal('load_in', 'load', 'C_load'),
        Signal('load', 'p_3'),
        Signal('load', 'c_2', across_first=False),
        Signal('c_2', 'sum', sign='−'),
        Signal('p_3', 'slip', sign='+'),
    ],
)

DIAGRAMS: dict[str, Diagram] = {
    'plant_actuator': ACTUATOR,
    'plant_driveline': DRIVELINE,
    'plant_lti': LTI,
    'architecture_detailed': DETAILED,
    'architecture_feedforward': FEEDFORWARD,
}


def drawings() -> dict[str, str]:
    """Return the SVG of each diagram by file name."""
    return {f'{name}.svg': svg(*diagram) for name, diagram in DIAGRAMS.items()}

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The controller's `run_info` is the last, whatever the other nodes are called."""

from ddct_bringup.bag.run_info import run_info_order


def test_the_controller_comes_last_and_the_others_by_name() -> None:
    nodes = {'/recorder': 1, '/controller': 2, '/actuator': 3, '/load': 4}
    assert run_info_order(nodes) == ['/actuator', '/load', '/recorder', '/controller']


def test_a_graph_without_controller_has_an_order_too() -> None:
    assert run_info_order(['/load', '/engine']) == ['/engine', '/load']

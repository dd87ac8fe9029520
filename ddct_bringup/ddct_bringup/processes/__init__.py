# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Processes of the graph's nodes, one each or all in one: start, supervise and stop them."""

from typing import TYPE_CHECKING

from ddct_plant.base.late_names import late_names

if TYPE_CHECKING:
    from ddct_bringup.processes.fork_server import start_server
    from ddct_bringup.processes.live_process import RECEIVE_S, LiveView, live_view
    from ddct_bringup.processes.single_process import run_single_process
    from ddct_bringup.processes.supervisor import Supervisor
else:
    __getattr__, __dir__, __all__ = late_names(__name__)

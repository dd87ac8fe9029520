# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Preloaded by the fork server in place of the nodes: what every fork needs."""

import importlib
import os

from ddct_bringup.processes import fork_server, forked  # noqa: F401

if _program := os.environ.pop(fork_server.MARK, ''):
    preloaded = importlib.import_module('ddct_bringup.processes.preloaded')
    preloaded.__dict__['_preload'] = lambda: None
    preloaded.serve(int(_program))

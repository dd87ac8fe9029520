# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Specifications of tunings, each read for the controller that it is for."""

from collections.abc import Callable, Iterator
from importlib.resources import files
from pathlib import Path

from ddct_bringup.tuning.specification.spec import packaged_specs, read_tuning_spec
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_controllers.registry import controller_spec

_CONTROLLERS = {'mpc_thesis': 'mpc3', 'pi_launches': 'pi'}
"""Controllers of the packaged specifications."""


def tunings() -> Iterator[tuple[str, Callable[[Path], object], bytes]]:
    """Yield the name of each packaged specification, what reads one like it, and its text."""
    for name in packaged_specs():
        controller = controller_spec(_CONTROLLERS[name])
        text = (files('ddct_bringup.tuning') / 'packaged' / f'{name}.yaml').read_bytes()
        yield name, _reader(controller), text


def _reader(controller: ControllerSpec[Controller]) -> Callable[[Path], object]:
    return lambda file: read_tuning_spec(str(file), controller)

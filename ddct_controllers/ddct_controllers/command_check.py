# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Check of a controller's command before it is requested and published."""

from numbers import Real

from ddct_controllers.interface import Command, Controller
from ddct_controllers.places import place_of_method
from ddct_plant.base.errors import DdctError, require_signal


def checked_command(controller: Controller, name: str, command: object, step: int) -> Command:
    """
    Return what `update` returned at a step as a command with plain floats.

    Raise DdctError for an unusable one; `name` stands for the controller in the error.
    """
    try:
        return _plain(controller, name, command, step)
    except DdctError as error:
        place = place_of_method(controller, 'update')
        raise DdctError(f'{error}, in {place}', key=error.key) from None


def _plain(controller: Controller, name: str, command: object, step: int) -> Command:
    if not isinstance(command, Command):
        raise DdctError(
            f'{name}: its answer at step {step} is of type {type(command).__name__}: '
            'return a ddct_controllers.interface.Command'
        )
    if not _is_status(command.status):
        raise DdctError(
            f'{name}: its status at step {step} is {command.status!r}: give a tuple of '
            "pairs of printable text, (('key', 'value'),)",
            key='status',
        )
    clutch = _torque(f'{name}: its torque at step {step}', command.clutch_torque)
    engine = command.engine_torque
    if controller.commands_engine:
        engine = _torque(f'{name}: its engine torque at step {step}', engine)
    elif engine is not None:
        raise DdctError(
            f'{name}: it gave an engine torque at step {step}: set its commands_engine',
            key='commands_engine',
        )
    given = command.clutch_torque, command.engine_torque
    plain = type(command) is Command and clutch is given[0] and engine is given[1]
    return command if plain else Command(clutch, command.status, engine)


def _is_status(status: object) -> bool:
    """Return whether `status` can be published as `controller/status` and printed."""
    return type(status) is tuple and all(
        type(pair) is tuple
        and len(pair) == 2
        and all(type(text) is str and text.isprintable() for text in pair)
        for pair in status
    )


def _torque(source: str, torque: object) -> float:
    if type(torque) is not float:
        if not isinstance(torque, Real):
            raise DdctError(f'{source} is {torque!r}: give a number in N m', key=source)
        torque = float(torque)
    return require_signal(source, torque)

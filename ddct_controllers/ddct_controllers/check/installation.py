# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Checks before a controller runs: entry point, installation, constructor, options."""

import importlib.metadata
import inspect
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote, urlparse

from ddct_controllers.check.subject import CheckFailedError, CheckSkippedError, Subject, root_cause
from ddct_controllers.check.watch import RecordedGains
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_controllers.interface import Controller, ControllerContext
from ddct_controllers.plugins import CONTROLLERS
from ddct_controllers.registry import require_known_controllers
from ddct_controllers.template.package import install_command
from ddct_plant.base.errors import DdctError
from ddct_plant.base.options import close_name
from ddct_plant.files.json_records import parse_json


def entry_point(subject: Subject) -> str:
    """Check that the controller's name leads to code that can be imported."""
    if len(subject.entry_points) > 1:
        targets = ' and '.join(point.value for point in subject.entry_points)
        raise CheckFailedError(
            f'two packages have a controller of this name, {targets}: rename one'
        )
    try:
        spec = subject.spec
    except DdctError as error:
        raise CheckFailedError(f'{error}{_advice(subject, error)}') from error
    if not subject.entry_points:
        return f'{spec.name} is one of ours or in a file: it needs no entry point'
    return f'{subject.entry_points[0].value} can be imported'


def _advice(subject: Subject, error: DdctError) -> str:
    """Return the remedy for a name that leads to no code, to follow the error, or ''."""
    if is_controller_file(subject.name):
        return ''
    if not subject.entry_points:
        for folder, _ in _installed_from(subject.name):
            return (
                f'; {folder}/pyproject.toml has it, but was not installed since: install it '
                f'again, {install_command(str(folder))}'
            )
        return f'; if it is your own, install its package: {install_command("DIR")}'
    point, cause = subject.entry_points[0], root_cause(error)
    module = sys.modules.get(point.module)
    if module and isinstance(cause, AttributeError):
        classes = [
            name
            for name, value in vars(module).items()
            if inspect.isclass(value) and issubclass(value, Controller) and value is not Controller
        ]
        return f'; {module.__file__} has {", ".join(classes) or "no Controller"}'
    if isinstance(cause, ModuleNotFoundError) and cause.name and point.module == cause.name:
        return (
            f'; there is no module {cause.name}: it was renamed or moved after the package was '
            'installed, or pyproject.toml names it wrongly: mend that, then '
            f'{install_command("DIR")}'
        )
    return ''


def installation(subject: Subject) -> str:
    """Check that the installed code is the code in the folder that it was installed from."""
    if not subject.entry_points:
        raise CheckSkippedError('no package of its own')
    module = inspect.getmodule(subject.entry_points[0].load())
    file = Path(str(getattr(module, '__file__', '')))
    for folder, editable in _installed_from(subject.name):
        if editable:
            return f'linked to {folder}: an edited file runs at once'
        relative = Path(*file.parts[-subject.entry_points[0].module.count('.') - 1 :])
        for source in (folder / relative, folder / 'src' / relative):
            if source.is_file() and source.read_bytes() != file.read_bytes():
                raise CheckFailedError(
                    f'{source} was edited after it was installed, and {file} is what runs: '
                    f'install it linked, {install_command(str(folder))}'
                )
        return f'the same as in {folder}'
    return f'{file}; not installed from a folder, so there is nothing to compare'


def _installed_from(controller: str) -> Iterator[tuple[Path, bool]]:
    """Yield the installed folders that declare a controller, and whether each is linked."""
    for distribution in importlib.metadata.distributions():
        try:
            origin = parse_json(distribution.read_text('direct_url.json') or '{}')
            folder = Path(unquote(urlparse(origin['url']).path))
            text = (folder / 'pyproject.toml').read_text(encoding='utf-8')
            points = tomllib.loads(text)['project']['entry-points'][CONTROLLERS.group]
        except (LookupError, OSError, ValueError, TypeError):
            continue  # from an index, gone, or not one of this kind
        if controller in points:
            yield folder, bool(origin.get('dir_info', {}).get('editable'))


def constructor(subject: Subject) -> str:
    """Check that an object can be constructed."""
    try:
        controller = subject.sample
    except DdctError as error:
        raise subject.failure(error) from error
    return f'{type(controller).__name__} with {len(subject.spec.options or {})} options'


def options(subject: Subject) -> str:
    """Check that only declared options are read, and that every option set has a controller."""
    require_known_controllers(subject.settings.scenario, [subject.spec.name])
    declared = subject.spec.options or {}
    given = subject.settings.scenario.controllers.get(subject.spec.name, {})
    gains = RecordedGains(subject.spec.values(given))
    subject.spec.make(ControllerContext(subject.settings, gains))
    for name, place in gains.places.items():
        if name not in declared:
            known = close_name(name, declared) if declared else 'it declares none'
            raise CheckFailedError(
                f'{place}: asks for the gain {name!r}, which its `options` do not declare, so '
                f'that no --set reaches it and no typing error is noticed ({known}): declare it'
            )
    return f'{", ".join(declared) or "none"}; any other is refused'

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Another controller with values of its options, in a file; `ddct tune` writes such files."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ddct_controllers.from_file.controller_file import (
    YAML_SUFFIXES,
    ControllerFile,
    is_controller_file,
    mapping,
    read_controller_file,
)
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import require_known
from ddct_plant.files.input_file import named_in
from ddct_plant.files.yaml_text import dump_yaml

KIND = 'with_options'
_CHOSEN, _OPTIONS = 'controller', 'options'
Find = Callable[[str], ControllerSpec[Controller]]
"""Function that returns the specification of a controller by its name or file."""
_DIGEST = 'base_'
"""Prefix of the keys of the digests of the other controller's files."""


def with_options_spec(find: Find, file: ControllerFile) -> ControllerSpec[Controller]:
    """
    Return the controller behind `with_options: {controller: NAME or FILE, options: {...}}`.

    A file is relative to this one. The options of the other controller stay options, with these
    values as their defaults.
    """
    spec = find(base_of(file))
    prefix = f'{KIND}.{_OPTIONS}'
    given = mapping(prefix, _content(file)[_OPTIONS])
    known = spec.options or {}
    require_known(given, known, 'option', f'{prefix}.')
    options = {
        name: replace(option, default=option.checked(f'{prefix}.{name}', given[name]))
        if name in given
        else option
        for name, option in known.items()
    }
    add_base_digests(file, spec.digests)
    return replace(spec, name=file.name, options=options)


def base_of(file: ControllerFile) -> str:
    """Return the name, or the path of the file, of the other controller; raise DdctError."""
    return _chosen(file.path, _content(file)[_CHOSEN])


def add_base_digests(file: ControllerFile, digests: Mapping[str, str]) -> None:
    """Add the digests of the other controller's files to those of a file."""
    file.digests.update({f'{_DIGEST}{key}': value for key, value in digests.items()})


def with_options_text(name: str, controller: str, options: dict[str, float | int]) -> str:
    """Return the text of such a file."""
    return dump_yaml({'name': name, KIND: {_CHOSEN: controller, _OPTIONS: options}})


def _content(file: ControllerFile) -> Mapping[str, Any]:
    return mapping(KIND, file.keys(KIND)[KIND], (_CHOSEN, _OPTIONS))


def _chosen(file: Path, chosen: object) -> str:
    """Return a name, or the path of a file; raise ParameterError for files in a circle."""
    key = f'{KIND}.{_CHOSEN}'
    if not isinstance(chosen, str) or not chosen:
        raise ParameterError(f'{key} is {chosen!r}: give a name or a controller file', key=key)
    if not is_controller_file(chosen):
        return chosen
    seen, path = {file.resolve()}, named_in(file.parent, chosen)
    while (following := _following(path)) is not None:
        if path.resolve() in seen:
            raise ParameterError(f'{key}: {path} is made of itself: name another one', key=key)
        seen.add(path.resolve())
        path = following
    return str(named_in(file.parent, chosen))


def _following(path: Path) -> Path | None:
    """Return the file that a file of this kind names, None for another one."""
    if path.suffix not in YAML_SUFFIXES:
        return None
    content = read_controller_file(str(path)).content
    inner = content.get(KIND) if isinstance(content, dict) else None
    chosen = inner.get(_CHOSEN) if isinstance(inner, dict) else None
    return path.parent / chosen if isinstance(chosen, str) and is_controller_file(chosen) else None

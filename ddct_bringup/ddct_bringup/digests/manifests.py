# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Manifests: the JSON files in which folders of results keep the inputs that they come from."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.input_file import read_text_file, require_schema_version
from ddct_plant.files.json_records import parse_json

_KINDS = {
    str: 'a text',
    int: 'a whole number',
    bool: 'true or false',
    dict: 'a group of keys',
}


@contextmanager
def manifest_content(path: Path, newest: int, what: str) -> Iterator[Any]:
    """
    Yield the JSON of a manifest, with a schema version up to `newest`.

    Raise DdctError without the file, which a folder of a `what` has, and for unsuitable content,
    also where the caller finds that it is unsuitable.
    """
    try:
        content = parse_json(read_text_file(path))
        if not isinstance(content, dict):
            raise ParameterError('it is no group of keys')
        require_schema_version(content, newest)
        yield content
    except FileNotFoundError as error:
        raise DdctError(
            f'no {path.name} in it: give the folder of a {what}', place=path.parent
        ) from error
    except (OSError, ParameterError, LookupError, TypeError, AttributeError) as error:
        why = f'the key {error.args[0]} is missing' if isinstance(error, KeyError) else error
        raise DdctError(f'cannot be read ({why}): put the original back', place=path) from error


def require_kinds(manifest: object, kinds: Mapping[str, type], within: str = '') -> None:
    """
    Raise ParameterError for an attribute of a manifest that is not of its type.

    `within` is the key of the manifest that has the others.
    """
    for name, kind in kinds.items():
        value = getattr(manifest, name)
        if type(value) is not kind:
            key = f'{within}{name}'
            raise ParameterError(f'{key} is {value!r}: it must be {_KINDS[kind]}', key=key)


def require_texts(key: str, content: object) -> None:
    """Raise ParameterError unless a value of a manifest is a group of texts by their key."""
    values = content.values() if isinstance(content, dict) else [None]
    if not all(isinstance(each, str) for each in values):
        raise ParameterError(f'{key} is {content!r}: it must be a group of texts', key=key)


def require_same_inputs(
    ours: Mapping[str, Any],
    theirs: Mapping[str, Any],
    differences: Mapping[str, str],
    what: str,
    out: Path,
) -> None:
    """
    Raise DdctError with the first input in which `ours` differs from `theirs`, kept in `out`.

    `differences` has the keys of the inputs in the order of the checks, and for each the words for
    a folder of a `what` with another value.
    """
    for key, difference in differences.items():
        if ours[key] != theirs[key]:
            raise DdctError(
                f'it holds a {what} {difference}: finish it as it was started, or choose another '
                '--out',
                key=key,
                place=out,
            )

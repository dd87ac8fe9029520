# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What programs write, held against its schema by a validator that is not ours."""

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from ddct_bringup.schemas import DOCUMENTS


@cache
def _validator(name: str) -> Any:
    """Return the validator of a schema, which is valid."""
    jsonschema = pytest.importorskip('jsonschema', reason='it is not installed')
    schema = DOCUMENTS[name].schema
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def require_schema(name: str, document: Any) -> None:
    """Require a document to be as its schema, and the schema to say what its first key is."""
    validator = _validator(name)
    faults = validator.iter_errors(document)
    assert [f'{each.json_path}: {each.message}' for each in faults] == []
    assert not validator.is_valid({**document, next(iter(document)): [[]]})


def require_schemas(folder: Path, names: Mapping[str, str]) -> None:
    """Require files of a folder to be as their schemas, `names` by path in the folder."""
    for path, name in names.items():
        require_schema(name, json.loads((folder / path).read_text(encoding='utf-8')))

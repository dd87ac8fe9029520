# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Objects of libraries whose import takes long, for lists of parameters: a test makes its own."""

import pkgutil
from collections.abc import Callable
from functools import partial
from typing import Any


def later(name: str, *arguments: object, **options: object) -> Callable[[], Any]:
    """Return a function that calls that of a name such as `control.tf`, and imports it."""
    return partial(_call, name, *arguments, **options)


def _call(name: str, *arguments: object, **options: object) -> Any:
    return pkgutil.resolve_name(name)(*arguments, **options)

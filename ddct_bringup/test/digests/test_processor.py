# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The kind of processor has the kernels that OpenBLAS uses, also those of OPENBLAS_CORETYPE."""

import json
import os
import subprocess
import sys
from dataclasses import replace

import pytest

from ddct_bringup.digests.environment import this_environment
from ddct_bringup.digests.processor import this_processor

PROGRAM = """
import json
from ddct_bringup.digests.processor import this_processor
print(json.dumps(this_processor()))
"""


def processor_with(core: str) -> dict[str, str]:
    done = subprocess.run(
        [sys.executable, '-c', PROGRAM],
        env={**os.environ, 'OPENBLAS_CORETYPE': core, 'PYTHONPATH': ':'.join(sys.path)},
        capture_output=True,
        text=True,
        check=True,
    )
    found: dict[str, str] = json.loads(done.stdout)
    return found


@pytest.mark.process
def test_the_kernels_are_those_in_use() -> None:
    first, second = processor_with('Haswell'), processor_with('Prescott')
    kernels = [key for key in first if key.startswith('kernels of ')]
    if not kernels:
        pytest.skip('numpy and scipy have no OpenBLAS here')
    assert [first[key] for key in kernels] == ['Haswell'] * len(kernels)
    assert all(first[key] != second[key] for key in kernels)
    assert {key: first[key] for key in first if key not in kernels} == {
        key: second[key] for key in second if key not in kernels
    }


@pytest.mark.parametrize('key', ['machine', 'features', 'libc'])
def test_another_kind_of_processor_is_named(key: str) -> None:
    here = this_environment()
    assert here.differences(here) == []
    other = replace(here, processor={**this_processor(), key: 'other'})
    (found,) = other.differences(here)
    assert key in found


def test_versions_code_and_unknown_processors_are_differences() -> None:
    here = this_environment()
    numpy = {**here.packages, 'numpy': '0.1'}
    assert replace(here, packages=numpy).differences(here) == [
        f'numpy 0.1, here {here.packages["numpy"]}'
    ]
    assert replace(here, code='f' * 64).differences(here) == [
        f'code ffffffffff, here {here.code[:10]}'
    ]
    assert replace(here, processor=None).differences(here) == [
        'kinds of processor that are not known'
    ]

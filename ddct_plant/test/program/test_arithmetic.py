# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every process has the same kernel of linear algebra; a result names what decides its bits."""

import importlib.metadata
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib import import_module
from typing import Any

import pytest
import threadpoolctl

from ddct_plant.program import arithmetic as module
from ddct_plant.program import operating_system
from ddct_plant.program.arithmetic import (
    Arithmetic,
    arithmetic,
    choose_kernel,
    named_threads,
)

KERNEL, THREADS, HASWELL = 'OPENBLAS_CORETYPE', 'OPENBLAS_NUM_THREADS', 'Haswell'
HAS_HASWELL = bool(import_module('numpy._core._multiarray_umath').__cpu_features__.get('AVX2'))
PRINTED = (
    'import os\n'
    'from ddct_plant.program.arithmetic import arithmetic\n'
    'found = arithmetic()\n'
    'print(found.kernel, found.threads, *(os.environ[name] for name in'
    f' ({KERNEL!r}, {THREADS!r})), sep="|")\n'
)
FIRST_NUMPY = 'import numpy\n'
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
openblas = pytest.mark.skipif(
    'OpenBLAS' not in arithmetic().blas or not HAS_HASWELL,
    reason='needs OpenBLAS on x86-64 with AVX2',
)


def printed(code: str, **variables: str) -> list[str]:
    environment = {
        name: each for name, each in os.environ.items() if name not in (KERNEL, THREADS)
    }
    done = subprocess.run(
        [sys.executable, '-c', code],
        env={**environment, 'PYTHONPATH': ':'.join(sys.path), **variables},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip().split('|')


@openblas
@pytest.mark.process
def test_a_process_has_one_thread_and_the_haswell_kernel_unless_the_environment_names_others():
    assert printed(PRINTED) == [HASWELL, '1', HASWELL, '1']
    named = printed(PRINTED, **{KERNEL: 'Nehalem', THREADS: '2'})
    assert named == ['Nehalem', '2' if len(os.sched_getaffinity(0)) > 1 else '1', 'Nehalem', '2']


@openblas
@pytest.mark.process
def test_a_kernel_that_is_loaded_stays_and_is_named_and_child_processes_use_it_too():
    of_numpy = (
        'import numpy, threadpoolctl\n'
        'print(*{each["architecture"] for each in threadpoolctl.threadpool_info()})'
    )
    (own,) = printed(of_numpy)
    found, _, of_children, _ = printed(FIRST_NUMPY + PRINTED)
    assert (found, of_children) == (own, own)


@pytest.mark.process
def test_every_package_names_a_kernel_before_it_imports_numpy():
    code = (
        'import os, sys\n'
        f'for package in {PACKAGES}:\n'
        '    if os.fork() == 0:\n'
        '        __import__(package)\n'
        f'        found = {KERNEL!r} in os.environ, "numpy" in sys.modules\n'
        '        print(package, *found, sep="|", end="|", flush=True)\n'
        '        os._exit(0)\n'
        '    os.wait()'
    )
    named = [(package, str(HAS_HASWELL), 'False') for package in PACKAGES]
    assert printed(code)[:-1] == [word for words in named for word in words]


@pytest.mark.parametrize(
    ('machine', 'flags', 'chosen'),
    [
        ('x86_64', 'sse2 avx2 fma', HASWELL),
        ('x86_64', 'sse2 avx fma', None),
        ('x86_64', 'sse2 avx2', None),
        ('aarch64', 'avx2 fma', None),
    ],
)
def test_the_kernel_is_chosen_by_the_features_of_the_processor(
    monkeypatch, tmp_path, machine, flags, chosen
):
    processor = tmp_path / 'cpuinfo'
    processor.write_text(f'processor\t: 0\nflags\t\t: {flags}\n\nprocessor\t: 1\n')
    monkeypatch.setattr(operating_system, '_PROCESSOR', processor)
    monkeypatch.setattr(os, 'uname', lambda: os.uname_result(('Linux', 'here', '6', '1', machine)))
    monkeypatch.delitem(sys.modules, 'numpy')
    monkeypatch.delenv(KERNEL, raising=False)
    monkeypatch.delenv(THREADS, raising=False)
    choose_kernel()
    assert (os.environ.get(KERNEL), os.environ[THREADS]) == (chosen, '1')


@pytest.mark.parametrize(
    ('named', 'number'), [('3', 3), ('', 1), ('many', 1), ('0', 1), ('-2', 1), (None, 1)]
)
def test_the_number_of_threads_is_that_of_the_environment_or_one(monkeypatch, named, number):
    monkeypatch.delenv(THREADS, raising=False)
    if named is not None:
        monkeypatch.setenv(THREADS, named)
    assert named_threads() == number


@pytest.mark.parametrize('key', ['blas', 'kernel', 'threads', 'libc', 'machine'])
def test_what_decides_bits_is_a_difference(key: str) -> None:
    here = arithmetic()
    assert here.differences(here) == []
    another: Any = {key: 'another'}
    (found,) = replace(here, **another).differences(here)
    assert 'another' in found
    assert getattr(here, key) in found


def test_another_version_is_a_difference_and_another_processor_is_none():
    here = arithmetic()
    versions = {**here.versions, 'numpy': '0.1'}
    assert replace(here, versions=versions).differences(here) == [
        f'numpy 0.1, here {here.versions["numpy"]}'
    ]
    del versions['numpy']
    assert replace(here, versions=versions).differences(here) == [
        f'numpy none, here {here.versions["numpy"]}'
    ]
    other = replace(here, processor='another')
    assert (other.differences(here), other) == ([], here)


def found_library(path: str, **changes: Any) -> dict[str, Any]:
    usual = {
        **{'user_api': 'blas', 'internal_api': 'openblas', 'filepath': path, 'version': '0.3.30'},
        **{'architecture': 'Haswell', 'num_threads': 1},
    }
    return {**usual, **changes}


@pytest.fixture
def found_here(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Arithmetic]]:
    """Yield a function that returns the arithmetic with these libraries loaded."""

    def found(*libraries: dict[str, Any]) -> Arithmetic:
        monkeypatch.setattr(threadpoolctl, 'threadpool_info', lambda: list(libraries))
        return arithmetic.__wrapped__()

    yield found


def test_what_numpy_and_scipy_share_is_named_once_and_the_rest_with_its_user(found_here) -> None:
    found = found_here(
        found_library('/site/scipy.libs/libscipy_openblas.so'),
        found_library('/site/numpy.libs/libscipy_openblas64_.so', version='0.3.31', num_threads=2),
    )
    assert found.blas == 'OpenBLAS 0.3.31 (numpy), OpenBLAS 0.3.30 (scipy)'
    assert (found.kernel, found.threads) == ('Haswell', '2 (numpy), 1 (scipy)')


def test_libraries_that_no_run_uses_are_left_out(found_here) -> None:
    found = found_here(
        found_library('/usr/lib/libopenblas.so.0', architecture='Zen'),
        found_library('/site/slycot.libs/libopenblas.so', architecture='Nehalem'),
        found_library('/site/numpy.libs/libgomp.so', user_api='openmp', num_threads=8),
    )
    assert (found.blas, found.kernel, found.threads) == ('OpenBLAS 0.3.30', 'Zen', '1')


def test_a_library_without_names_of_kernels_or_version_is_named_as_far_as_it_is_known(
    found_here,
) -> None:
    mkl = found_library('/opt/mkl/libmkl_rt.so', internal_api='mkl', version=None)
    del mkl['architecture']
    found = found_here(mkl)
    assert (found.blas, found.kernel) == ('MKL of unknown version', '')
    assert found_here().blas == found_here().kernel == 'unknown'


def test_versions_are_those_of_the_installed_packages(found_here) -> None:
    here = found_here()
    assert here.versions['python'] == '.'.join(map(str, sys.version_info[:3]))
    assert here.versions['scipy'] == importlib.metadata.version('scipy')
    assert not {*here.versions} - {'python', *module._PACKAGES}
    assert here.processor and here.libc and here.machine == os.uname().machine

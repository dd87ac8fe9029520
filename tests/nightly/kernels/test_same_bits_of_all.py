# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Trajectories of all controllers have the same bits with the kernel of every process."""

import pytest
from support.trajectory_hashes import (
    FEATURES,
    HAS_HASWELL,
    HASWELL,
    KERNEL,
    Hashes,
    hashes_with,
)

from ddct_controllers.registry import own_controller_names

pytestmark = pytest.mark.skipif(not HAS_HASWELL, reason='needs x86-64 with AVX2')


@pytest.fixture(scope='module')
def usual() -> Hashes:
    return hashes_with(own_controller_names())


def test_all_controllers_have_the_stored_bits(usual: Hashes) -> None:
    assert usual.arithmetic.kernel == HASWELL
    assert usual.as_stored() in (usual.trajectories, None)


@pytest.mark.parametrize(
    'variables',
    [
        {KERNEL: 'Zen'},
        {'NPY_DISABLE_CPU_FEATURES': FEATURES[-1]},
        {'NPY_DISABLE_CPU_FEATURES': ' '.join(FEATURES[1:])},
        {'NPY_DISABLE_CPU_FEATURES': ' '.join(FEATURES)},
    ],
    ids=['zen', 'without newest', 'with avx2', 'without avx2'],
)
def test_neither_zens_kernel_nor_fewer_features_change_a_bit(
    usual: Hashes, variables: dict[str, str]
) -> None:
    found = hashes_with(own_controller_names(), **variables)
    # Wheels of numpy without a kernel for Zen use that of Haswell for it.
    assert found.arithmetic.kernel in (HASWELL, variables.get(KERNEL))
    assert found.trajectories == usual.trajectories


def test_the_kernel_of_newer_processors_has_other_bits_in_every_run(usual: Hashes) -> None:
    found = hashes_with(own_controller_names(), **{KERNEL: 'SkylakeX'})
    if found.arithmetic.kernel != 'SkylakeX':
        pytest.skip('needs AVX-512')
    for name, trajectory in found.trajectories.items():
        assert trajectory != usual.trajectories[name], name

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Trajectories have the same bits on each processor whose kernel is the same."""

import pytest
from support.trajectory_hashes import (
    FEATURES,
    HAS_HASWELL,
    HASWELL,
    KERNEL,
    Hashes,
    hashes_with,
)

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(not HAS_HASWELL, reason='needs x86-64 with AVX2'),
]
SAMPLE = ('pi', 'hinf_thesis', 'mpc_wear', 'least_jerk')


@pytest.fixture(scope='module')
def usual() -> Hashes:
    return hashes_with(SAMPLE)


def test_every_process_has_the_stored_bits(usual: Hashes) -> None:
    assert usual.arithmetic.kernel == HASWELL
    assert usual.as_stored() in (usual.trajectories, None)


@pytest.mark.nightly
def test_fewer_features_of_the_processor_change_no_bit(usual: Hashes) -> None:
    fewer = hashes_with(SAMPLE, NPY_DISABLE_CPU_FEATURES=' '.join(FEATURES))
    assert usual.arithmetic == fewer.arithmetic
    assert usual.trajectories == fewer.trajectories


@pytest.mark.nightly
def test_another_kernel_that_the_environment_names_has_other_bits(usual: Hashes) -> None:
    other = hashes_with(SAMPLE, **{KERNEL: 'Nehalem'})
    assert other.arithmetic.kernel == 'Nehalem'
    for name, found in other.trajectories.items():
        assert found != usual.trajectories[name], name

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Our H-infinity synthesis against SLICOT and against the LMIs of Gahinet and Apkarian."""

import time
from collections.abc import Callable

import numpy as np
import pytest
from samples import sampled
from scipy.linalg import block_diag, null_space
from support.slicot import slycot_optimum

from ddct_controllers.design.h_infinity.design import generalised_plant
from ddct_controllers.design.h_infinity.recipes import RECIPES, make_weights
from ddct_controllers.design.h_infinity.synthesis.gamma_iteration import (
    h_infinity_norm,
    synthesise,
    verified_norm,
)
from ddct_controllers.design.h_infinity.synthesis.generalised_plant import (
    GeneralisedPlant,
    balanced,
)
from ddct_controllers.design.h_infinity.synthesis.lmi import synthesise_by_lmi
from ddct_plant.linear.lti import StateSpace

pytestmark = pytest.mark.slow


def problem(recipe: str) -> GeneralisedPlant:
    return generalised_plant(make_weights(recipe))


@pytest.mark.parametrize('recipe', sampled(RECIPES, every=3))
def test_our_level_is_no_higher_than_slycots_and_the_lmis(recipe):
    """It is at most 1.001 times the better of both, each verified by its closed loop's norm."""
    slycot = pytest.importorskip('slycot', reason='slycot (GPL) is an oracle of the tests only')
    pytest.importorskip('clarabel', reason='the LMI method needs clarabel')
    plant = problem(recipe)
    ours = synthesise(plant, 1.0)
    slicot = min(slycot_optimum(slycot, plant), slycot_optimum(slycot, balanced(plant)))
    lmi = synthesise_by_lmi(plant)
    assert ours.optimum <= 1.001 * min(slicot, lmi.gamma)
    assert verified_norm(plant, ours.controller) == pytest.approx(ours.gamma, rel=1e-4)
    assert ours.gamma == pytest.approx(ours.optimum, rel=1e-3)


@pytest.mark.nightly
def test_the_lmis_have_the_optimum_that_cvxpy_finds():
    """The same three inequalities are written again with cvxpy; solvers agree within 0.1 %."""
    cvxpy = pytest.importorskip('cvxpy', reason='cvxpy is an oracle of the tests only')
    pytest.importorskip('clarabel', reason='the LMI method needs clarabel')
    plant = balanced(problem('thesis'))
    a, b1, c1, d11 = plant.system.a, plant.b1, plant.c1, plant.d11
    size, inputs, outputs = len(a), b1.shape[1], len(c1)
    r, s = (
        cvxpy.Variable((size, size), symmetric=True),
        cvxpy.Variable((size, size), symmetric=True),
    )
    gamma = cvxpy.Variable()
    n_r = block_diag(null_space(np.hstack([plant.b2.T, plant.d12.T])), np.eye(inputs))
    n_s = block_diag(null_space(np.hstack([plant.c2, plant.d21])), np.eye(outputs))
    g_w, g_z = gamma * np.eye(inputs), gamma * np.eye(outputs)
    first = cvxpy.bmat([[a @ r + r @ a.T, r @ c1.T, b1], [c1 @ r, -g_z, d11], [b1.T, d11.T, -g_w]])
    second = cvxpy.bmat(
        [[a.T @ s + s @ a, s @ b1, c1.T], [b1.T @ s, -g_w, d11.T], [c1, d11, -g_z]]
    )
    coupled = cvxpy.bmat([[r, np.eye(size)], [np.eye(size), s]])
    inequalities = [n_r.T @ first @ n_r << 0, n_s.T @ second @ n_s << 0, coupled >> 0]
    found = cvxpy.Problem(cvxpy.Minimize(gamma), inequalities).solve(solver='CLARABEL')
    assert synthesise_by_lmi(plant).lower_bound == pytest.approx(found, rel=1e-3)
    assert synthesise(plant, 1.0).optimum == pytest.approx(found, rel=2e-3)


def test_the_norm_is_that_of_slicot():
    pytest.importorskip('slycot', reason='control.linfnorm needs slycot')
    control = pytest.importorskip('control')
    rng = np.random.default_rng(7)
    for _ in range(20):
        a = rng.normal(size=(6, 6)) - 3.5 * np.eye(6)
        b, c, d = (rng.normal(size=shape) for shape in ((6, 2), (3, 6), (3, 2)))
        system = StateSpace(a, b, c, d)
        if np.linalg.eigvals(a).real.max() < 0.0:
            theirs, _ = control.linfnorm(control.ss(system.a, system.b, system.c, system.d))
            assert h_infinity_norm(system) == pytest.approx(theirs, rel=1e-6)


def seconds(task: Callable[[], object]) -> float:
    """Return the processor time of a task in s."""
    started = time.process_time()
    task()
    return time.process_time() - started


def test_a_synthesis_takes_less_than_half_a_second():
    """The bound is the project's; 0.02 s on an idle machine leaves room for a busy one."""
    plant = problem('thesis')
    assert min(seconds(lambda: synthesise(plant, 1.0)) for _ in range(3)) < 0.5
    assert synthesise(plant, 1.0).gamma == pytest.approx(1.105, abs=1e-3)

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Input that the quadratic programs refuse: bad structures, vectors, names, absent solvers."""

import math
import subprocess
import sys

import numpy as np
import pytest
from refusals import refused
from waiting import WITHIN_S

from ddct_controllers.mpc.qp.backend import BACKENDS, DEFAULT_BACKEND, make_backend
from ddct_controllers.mpc.qp.problem import QpStructure
from ddct_plant.base.errors import DdctError, ParameterError

INF = math.inf
ONE = QpStructure(np.eye(1), np.eye(1))

backends = pytest.mark.parametrize('name', BACKENDS)


@backends
@pytest.mark.parametrize(
    ('f', 'lower', 'upper', 'key'),
    [
        ([math.nan], [0.0], [1.0], 'f'),
        ([INF], [0.0], [1.0], 'f'),
        ([0.0], [math.nan], [1.0], 'row 0'),
        ([0.0], [0.0], [math.nan], 'row 0'),
        ([0.0], [2.0], [1.0], 'row 0'),
        ([0.0], [INF], [INF], 'row 0'),
        ([0.0], [-INF], [-INF], 'row 0'),
        ([0.0, 0.0], [0.0], [1.0], 'f'),
        ([0.0], [0.0, 0.0], [1.0], 'f'),
        ([0.0], [0.0], [], 'f'),
    ],
)
def test_bad_vectors_are_named_and_harm_nothing(name, f, lower, upper, key):
    backend = make_backend(name, ONE, 1000)
    with refused(ParameterError, key=key):
        backend.solve(f, lower, upper)
    assert backend.solve([-3.0], [0.0], [1.0]).z[0] == pytest.approx(1.0, rel=1e-5)


@pytest.mark.parametrize(
    ('hessian', 'key'),
    [
        ([[1.0, 0.0], [0.0, 0.0]], 'variable 1'),
        ([[1.0, 1.0], [1.0, 1.0]], 'hessian'),
        ([[1.0, 1.0], [1.0, 1.0 + 1e-12]], 'hessian'),
        ([[1.0, 2.0], [2.0, 1.0]], 'hessian'),
        ([[1.0, 0.5], [0.4, 1.0]], 'hessian'),
        ([[1.0, math.nan], [math.nan, 1.0]], 'hessian'),
        ([[1.0, 0.0]], 'hessian'),
        ([1.0, 2.0], 'hessian'),
    ],
)
def test_a_hessian_that_cannot_be_solved_is_refused_at_configuration(hessian, key):
    with refused(ParameterError, key):
        QpStructure(np.array(hessian), np.eye(2))


@pytest.mark.parametrize(
    ('arguments', 'key'),
    [
        ({'constraints': np.eye(3)}, 'constraints'),
        ({'hessian': np.eye(0), 'constraints': np.ones((1, 0))}, 'hessian'),
        ({'constraints': np.full((1, 2), INF)}, 'constraints'),
        ({'soft': np.array([True])}, 'soft'),
        ({'soft': np.array([0.0, 1.0])}, 'soft'),
        ({'soft': np.array([True, False])}, 'QP: soft_weight'),
        ({'soft': np.array([True, False]), 'soft_weight': 0.0}, 'QP: soft_weight'),
        ({'soft': np.array([True, False]), 'soft_weight': math.nan}, 'QP: soft_weight'),
    ],
)
def test_a_bad_structure_is_refused(arguments, key):
    with refused(ParameterError, key):
        QpStructure(**({'hessian': np.eye(2), 'constraints': np.eye(2)} | arguments))


def test_a_structure_keeps_its_own_copy():
    hessian = np.eye(2)
    structure = QpStructure(hessian, np.eye(2))
    hessian[0, 0] = 5.0
    assert structure.hessian[0, 0] == 1.0
    with pytest.raises(ValueError, match='read-only'):
        structure.hessian[0, 0] = 5.0


@pytest.mark.parametrize('limit', [0, -1, 2.5, True])
def test_an_iteration_limit_below_one_is_refused(limit):
    with refused(ParameterError, key='QP: iteration_limit'):
        make_backend(DEFAULT_BACKEND, ONE, limit)


def test_an_unknown_backend_is_refused_with_the_choices():
    with refused(ParameterError, key='QP backend'):
        make_backend('simplex', ONE, 1000)


@backends
def test_a_missing_solver_is_named(name, monkeypatch):
    monkeypatch.setitem(sys.modules, name, None)
    with refused(DdctError, key=name):
        make_backend(name, ONE, 1000)


@pytest.mark.process
def test_a_solver_is_imported_only_when_it_is_chosen():
    """Every process of a graph would pay for it."""
    program = (
        'import sys, numpy\n'
        'from ddct_controllers.mpc.qp.backend import make_backend\n'
        'from ddct_controllers.mpc.qp.problem import QpStructure\n'
        'assert not {"daqp", "osqp", "scipy"} & set(sys.modules)\n'
        'make_backend("daqp", QpStructure(numpy.eye(1), numpy.eye(1)), 10)\n'
        'assert "osqp" not in sys.modules\n'
    )
    subprocess.run([sys.executable, '-c', program], check=True, timeout=WITHIN_S)

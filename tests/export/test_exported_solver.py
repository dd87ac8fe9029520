# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The exported solver alone, on programs harder than the controllers' own."""

import ctypes
from pathlib import Path

import numpy as np
import pytest
from support.exported_mpc import STATUS, compile_c

from ddct_controllers.mpc.export.controller_tables import MEASURED_MACROS
from ddct_controllers.mpc.export.dual_form import dual_form
from ddct_controllers.mpc.export.export_controller import c_parts, constants, macros
from ddct_controllers.mpc.qp.backend import make_backend
from ddct_controllers.mpc.qp.problem import QpStructure

INF = np.inf
_VECTOR = np.ctypeslib.ndpointer(dtype=float, flags='C_CONTIGUOUS')
_CALL = """\
int call(const double *v, const double *lower, const double *upper, double *y, int *iterations);
int call(const double *v, const double *lower, const double *upper, double *y, int *iterations)
{
    return (int)solve(v, lower, upper, y, iterations);
}
"""


class ExportedSolver:
    """The solver for one structure, as C."""

    def __init__(self, structure: QpStructure, folder: Path, limit: int = 200) -> None:
        self._form = form = dual_form(structure)
        rows, size = form.normals.shape
        sizes = {'STATES': 1, 'REFERENCES': 1, 'MOVES': size, 'ITERATIONS': limit}
        header = c_parts('ddct_mpc.h').replace('@SIZES@', macros(sizes, 'DDCT_MPC_'))
        tables = {'NORMAL': form.normals, 'RELAXATION': form.relaxation}
        parts = [
            header,
            macros({'ROWS': rows, 'ACTIVE': form.capacity, **MEASURED_MACROS}),
            constants(tables),
            c_parts('doubles.c', 'solver.c'),
            _CALL,
        ]
        folder.mkdir()
        (folder / 'solver.c').write_text('\n'.join(parts))
        # Here the function of the controller's part that is not there is not used.
        flags = ('-O0', '-Wno-unused-function', '-shared', '-fPIC')
        compile_c(folder, *flags, 'solver.c', '-o', 'solver.so')
        self._call = ctypes.CDLL(str(folder / 'solver.so')).call
        self._call.argtypes = [*[_VECTOR] * 4, ctypes.POINTER(ctypes.c_int)]

    def solve(self, f, lower, upper) -> tuple[np.ndarray, int, str]:
        form = self._form
        y, iterations = np.empty(len(form.moves)), ctypes.c_int()
        bounds = (np.asarray(bound)[form.kept] * form.scale for bound in (lower, upper))
        status = self._call(form.to_dual @ f, *bounds, y, ctypes.byref(iterations))
        return form.moves @ y, iterations.value, STATUS[status]


def random_structure(seed: int, size: int, rows: int, soft: int) -> QpStructure:
    """Return a structure whose last rows are soft, in units some decades apart."""
    random = np.random.default_rng(seed)
    units = 10.0 ** random.uniform(-2.0, 2.0, size)
    root = random.normal(size=(size, size))
    hessian = (root @ root.T / size + 0.05 * np.eye(size)) / np.outer(units, units)
    constraints = random.normal(size=(rows, size)) / units
    return QpStructure(hessian, constraints, np.arange(rows) >= rows - soft, 50.0)


@pytest.mark.parametrize(
    ('size', 'rows', 'soft'), [(1, 1, 0), (4, 8, 0), (4, 30, 22), (16, 32, 0), (16, 40, 20)]
)
def test_random_programs_have_daqps_solution(tmp_path, size, rows, soft):
    """The hard rows have a common point, the soft ones may conflict with it and each other."""
    structure = random_structure(size + rows, size, rows, soft)
    solver = ExportedSolver(structure, tmp_path / 'c')
    backend = make_backend('daqp', structure, 1000)
    random = np.random.default_rng(rows)
    constraints, hessian = structure.constraints, structure.hessian
    units = 1.0 / np.sqrt(np.diag(hessian))
    is_soft = np.asarray(structure.soft)
    changes = 0
    for _ in range(40):
        inside = constraints @ (random.normal(size=size) * units)
        inside += np.where(is_soft, random.normal(size=rows), 0.0)
        lower, upper = inside - random.uniform(0.0, 1.0, rows), inside + random.random(rows)
        lower[random.random(rows) < 0.2] = -INF
        upper[random.random(rows) < 0.2] = INF
        f = -hessian @ (2.0 * random.normal(size=size) * units)
        z, iterations, status = solver.solve(f, lower, upper)
        expected = backend.solve(f, lower, upper)
        assert status == expected.status == 'solved'
        error = z - expected.z
        assert error @ hessian @ error <= 1e-16 * (expected.z @ hessian @ expected.z)
        changes += iterations
    assert changes >= 20


def solver(rows: list[list[float]], folder: Path, soft: list[bool] | None = None, limit: int = 20):
    """Return the solver of 1/2 z'z over the rows; soft ones have the weight 100."""
    constraints = np.array(rows)
    mask = None if soft is None else np.array(soft)
    structure = QpStructure(np.eye(constraints.shape[1]), constraints, mask, 100.0)
    return ExportedSolver(structure, folder / 'c', limit)


def test_rows_that_depend_on_each_other_are_solved(tmp_path):
    """The second row is twice the first, the last the sum of others; all bind at the optimum."""
    in_c = solver([[1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0]], tmp_path)
    f, upper = np.array([-5.0, -6.0]), [1.0, 2.0, 1.0, 2.0]
    z, _, status = in_c.solve(f, [-INF] * 4, upper)
    assert status == 'solved'
    np.testing.assert_allclose(z, [1.0, 1.0], rtol=1e-12)
    z, _, status = in_c.solve(f, [-INF, 1.0, -INF, -INF], [0.5, 2.0, 1.0, 2.0])
    assert status == 'solved'
    np.testing.assert_allclose(z, [0.5, 1.0], rtol=1e-12)


def test_equal_bounds_hold_a_row(tmp_path):
    in_c = solver([[1.0, 1.0], [1.0, 0.0]], tmp_path)
    z, _, status = in_c.solve(np.zeros(2), [2.0, -INF], [2.0, 0.5])
    assert status == 'solved'
    np.testing.assert_allclose(z, [0.5, 1.5], rtol=1e-12)


def test_hard_rows_in_conflict_are_infeasible_and_the_next_solve_is_right(tmp_path):
    in_c = solver([[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]], tmp_path)
    f = np.array([-3.0, -3.0])
    assert in_c.solve(f, [-INF, -INF, 3.0], [1.0, 1.0, 4.0])[2] == 'infeasible'
    z, _, status = in_c.solve(f, [-INF, -INF, 1.0], [1.0, 1.0, 4.0])
    assert status == 'solved'
    np.testing.assert_allclose(z, [1.0, 1.0], rtol=1e-12)


def test_soft_rows_in_conflict_share_the_violation_by_their_scale(tmp_path):
    """2 z <= 0 and z >= 3 give z + 4 w z - w (3 - z) = 0 with w = 100."""
    in_c = solver([[2.0], [1.0]], tmp_path, [True, True])
    z, _, status = in_c.solve(np.zeros(1), [-INF, 3.0], [0.0, INF])
    assert status == 'solved'
    assert z[0] == pytest.approx(300.0 / 501.0, rel=1e-12)


def test_a_row_of_zeros_restricts_nothing_or_everything(tmp_path):
    in_c = solver([[0.0], [0.0], [1.0]], tmp_path, [False, True, False])
    f = np.array([-3.0])
    z, _, status = in_c.solve(f, [-1.0, 5.0, -INF], [1.0, 6.0, 2.0])
    assert (z[0], status) == (pytest.approx(2.0), 'solved')
    assert in_c.solve(f, [1.0, 0.0, -INF], [2.0, 0.0, 2.0])[2] == 'infeasible'


def test_a_program_without_numbers_to_round_ends(tmp_path):
    z, iterations, status = solver([[1.0]], tmp_path).solve(np.zeros(1), [0.0], [0.0])
    assert (z[0], iterations, status) == (0.0, 0, 'solved')


def test_the_iteration_limit_is_kept_and_reported(tmp_path):
    structure = random_structure(1, 16, 32, 0)
    enough, short = (ExportedSolver(structure, tmp_path / str(limit), limit) for limit in (200, 3))
    f = -structure.hessian @ np.full(16, 10.0)
    bounds = np.full(32, -0.1), np.full(32, 0.1)
    assert enough.solve(f, *bounds)[1:] != short.solve(f, *bounds)[1:]
    assert enough.solve(f, *bounds)[2] == 'solved'
    assert short.solve(f, *bounds)[1:] == (3, 'iteration limit')

# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Both solvers of quadratic programs, against answers by hand, Clarabel and each other."""

import dataclasses
import math

import numpy as np
import pytest
from samples import sampled

from ddct_controllers.mpc.qp.backend import BACKENDS, DEFAULT_BACKEND, QpBackend, make_backend
from ddct_controllers.mpc.qp.problem import QpStructure

ERROR = {'daqp': 1e-7, 'osqp': 1e-4}
"""
Error of z relative to the oracle's by solver.

DAQP ends on the exact active set, OSQP on residuals of 1e-6.
"""
LIMIT = 20_000
INF = math.inf

backends = pytest.mark.parametrize('name', BACKENDS)


@dataclasses.dataclass(frozen=True)
class Program:
    """A program with all its data; `size` measures z by its quadratic cost, so without units."""

    structure: QpStructure
    f: np.ndarray
    lower: np.ndarray
    upper: np.ndarray

    def solve(self, backend: QpBackend):
        return backend.solve(self.f, self.lower, self.upper)

    def violation(self, z: np.ndarray) -> float:
        return violation(self.structure, z, self.lower, self.upper)

    def size(self, z: np.ndarray) -> float:
        return math.sqrt(z @ self.structure.hessian @ z)

    def backend(self, name: str) -> QpBackend:
        return make_backend(name, self.structure, LIMIT)


def violation(structure: QpStructure, z: np.ndarray, lower, upper) -> float:
    """Return the distance of the worst soft row from its bounds, in that row's unit."""
    values, soft = structure.constraints @ z, structure.soft_rows
    outside = np.maximum(values - upper, np.asarray(lower) - values)[soft]
    return max([0.0, *outside])


def scalar(name: str, rows: list[float], soft: list[bool] | None = None, weight: float = 100.0):
    """Return 1/2 z^2 + f z with one variable; `rows` are the coefficients of G."""
    mask = np.array(soft) if soft else None
    structure = QpStructure(np.eye(1), np.array(rows)[:, None], mask, weight)
    return make_backend(name, structure, LIMIT)


def random_program(
    seed: int,
    size: int,
    rows: int,
    *,
    soft: int = 0,
    decades: float = 0.0,
    soft_decades: float = 0.0,
) -> Program:
    """
    Return a program whose last `soft` rows are soft.

    Units of variables and hard rows lie within +-`decades` of 1, those of soft rows, which set
    their weights, within +-`soft_decades`. The hard rows have a common point other than 0; the
    soft ones are shifted from it, so that they may conflict.
    """
    random = np.random.default_rng(seed)
    units = 10.0 ** random.uniform(-decades, decades, size)
    mask = np.arange(rows) >= rows - soft
    row_units = 10.0 ** (random.uniform(-1.0, 1.0, rows) * np.where(mask, soft_decades, decades))
    root = random.normal(size=(size, size))
    hessian = (root @ root.T / size + 0.1 * np.eye(size)) / np.outer(units, units)
    constraints = random.normal(size=(rows, size)) / units * row_units[:, None]
    inside = random.normal(size=size) * units
    width = random.uniform(0.2, 1.0, (2, rows)) * row_units
    shift = np.where(mask, random.normal(size=rows), 0.0) * row_units
    f = -hessian @ (2.0 * random.normal(size=size) * units)
    lower, upper = constraints @ inside + shift - width[0], constraints @ inside + shift + width[1]
    return Program(QpStructure(hessian, constraints, mask, 50.0), f, lower, upper)


def oracle(program: Program) -> np.ndarray:
    """Return z by Clarabel, with a slack for each soft row and all in unit-free variables."""
    clarabel = pytest.importorskip('clarabel', reason='Clarabel is the oracle')
    from scipy import sparse

    structure = program.structure
    units = 1.0 / np.sqrt(np.diag(structure.hessian))
    size, slacks = len(units), structure.soft_rows
    row_units = 1.0 / np.linalg.norm(structure.constraints * units, axis=1)
    picks = np.zeros((len(row_units), len(slacks)))
    picks[slacks, np.arange(len(slacks))] = row_units[slacks]
    rows = np.hstack([structure.constraints * units * row_units[:, None], picks])
    weights = np.full(len(slacks), structure.soft_weight)
    cost = np.block(
        [
            [structure.hessian * np.outer(units, units), np.zeros((size, len(slacks)))],
            [np.zeros((len(slacks), size)), np.diag(weights)],
        ]
    )
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = 1e-11
    bounded = np.concatenate([np.isfinite(program.upper), np.isfinite(program.lower)])
    bounds = np.concatenate([program.upper * row_units, -program.lower * row_units])[bounded]
    solver = clarabel.DefaultSolver(
        sparse.triu(cost, format='csc'),
        np.concatenate([program.f * units, np.zeros(len(slacks))]),
        sparse.csc_matrix(np.vstack([rows, -rows])[bounded]),
        bounds,
        [clarabel.NonnegativeConeT(len(bounds))],
        settings,
    )
    found = solver.solve()
    assert str(found.status) in ('Solved', 'AlmostSolved')
    return np.array(found.x)[:size] * units


def require_same(program: Program, name: str, z: np.ndarray, expected: np.ndarray) -> None:
    assert program.size(z - expected) <= ERROR[name] * program.size(expected)


@backends
@pytest.mark.parametrize('decades', [0.0, 3.0])
@pytest.mark.parametrize(
    ('size', 'rows', 'soft'), [(4, 8, 0), (4, 26, 22), (20, 12, 4), (12, 24, 24)]
)
@pytest.mark.parametrize('seed', sampled(range(5), every=5))
def test_random_programs_have_the_oracles_solution(name, decades, size, rows, soft, seed):
    program = random_program(
        seed, size, rows, soft=soft, decades=decades, soft_decades=decades / 3.0
    )
    solution = program.solve(program.backend(name))
    assert solution.status == 'solved'
    assert 1 <= solution.iterations <= LIMIT
    require_same(program, name, solution.z, oracle(program))


@pytest.mark.parametrize('seed', range(5))
def test_soft_weights_over_twelve_decades_are_solved_by_the_default(seed):
    """OSQP takes more than 20 000 iterations for about half of these."""
    program = random_program(seed, 4, 26, soft=22, soft_decades=3.0)
    solution = program.solve(program.backend(DEFAULT_BACKEND))
    require_same(program, DEFAULT_BACKEND, solution.z, oracle(program))


@backends
@pytest.mark.parametrize('soft', [0, 6])
def test_inactive_rows_leave_the_free_optimum(name, soft):
    program = random_program(1, 6, 12, decades=2.0, soft=soft)
    wide = dataclasses.replace(program, lower=program.lower - 1e9, upper=program.upper + 1e9)
    free = np.linalg.solve(program.structure.hessian, -program.f)
    solution = wide.solve(wide.backend(name))
    require_same(program, name, solution.z, free)
    assert wide.violation(solution.z) == 0.0


@backends
def test_a_start_outside_all_bounds_is_no_obstacle(name):
    """2 <= z1 <= 3 and 5 <= z1 + z2 <= 6; the cost's optimum and the start are 0."""
    structure = QpStructure(np.eye(2), np.array([[1.0, 0.0], [1.0, 1.0]]))
    solution = make_backend(name, structure, LIMIT).solve([0.0, 0.0], [2.0, 5.0], [3.0, 6.0])
    np.testing.assert_allclose(solution.z, [2.5, 2.5], rtol=1e-5)


@backends
def test_a_hard_row_is_kept_to_the_tolerance(name):
    """The free optimum lies 1e-6 outside z <= 1."""
    solution = scalar(name, [1.0]).solve([-1.0 - 1e-6], [-INF], [1.0])
    assert solution.z[0] <= 1.0 + 0.1 * ERROR[name]


@backends
@pytest.mark.parametrize('weight', [1.0, 100.0, 1e6])
def test_a_soft_row_gives_way_by_its_stated_penalty(name, weight):
    """1/2 z^2 - 3 z + w/2 (z - 1)^2 for z > 1: z = (3 + w) / (1 + w)."""
    backend, bounds = scalar(name, [1.0], [True], weight), ([-INF], [1.0])
    solution = backend.solve([-3.0], *bounds)
    expected = (3.0 + weight) / (1.0 + weight)
    assert solution.z[0] == pytest.approx(expected, rel=1e-5)
    found = violation(backend._structure, solution.z, *bounds)
    assert found == pytest.approx(expected - 1.0, abs=2e-5)


@backends
def test_soft_rows_in_conflict_share_the_violation_by_their_scale(name):
    """2 z <= 0 and z >= 3: z + 4 w z - w (3 - z) = 0, the rows in their own units."""
    backend, bounds = scalar(name, [2.0, 1.0], [True, True], 100.0), ([-INF, 3.0], [0.0, INF])
    solution = backend.solve([0.0], *bounds)
    expected = 300.0 / 501.0
    assert solution.status == 'solved'
    assert solution.z[0] == pytest.approx(expected, rel=1e-5)
    found = violation(backend._structure, solution.z, *bounds)
    assert found == pytest.approx(3.0 - expected, rel=1e-5)


@backends
def test_a_hard_row_wins_over_a_soft_one(name):
    backend, bounds = scalar(name, [1.0, 1.0], [False, True], 1e6), ([2.0, -INF], [INF, 1.0])
    solution = backend.solve([0.0], *bounds)
    assert solution.z[0] == pytest.approx(2.0, rel=1e-5)
    found = violation(backend._structure, solution.z, *bounds)
    assert found == pytest.approx(1.0, rel=1e-5)


@backends
def test_hard_rows_in_conflict_are_infeasible_and_the_next_solve_is_right(name):
    backend = scalar(name, [1.0, 1.0])
    refused = backend.solve([0.0], [-INF, 2.0], [1.0, INF])
    assert refused.status == 'infeasible'
    assert np.isnan(refused.z).all()
    solution = backend.solve([-5.0], [-INF, 2.0], [3.0, INF])
    assert solution.status == 'solved'
    assert solution.z[0] == pytest.approx(3.0, rel=1e-5)


@backends
def test_equality_rows_in_conflict_are_infeasible(name):
    backend = scalar(name, [1.0, 1.0])
    assert backend.solve([0.0], [1.0, 2.0], [1.0, 2.0]).status == 'infeasible'
    assert backend.solve([0.0], [2.0, 2.0], [2.0, 2.0]).z[0] == pytest.approx(2.0, rel=1e-5)


@backends
@pytest.mark.parametrize('soft', [False, True])
def test_equality_rows_hold_and_open_again(name, soft):
    """An equality closes and opens between solves of one backend."""
    program = random_program(3, 8, 6, soft=2 if soft else 0)
    backend, row = program.backend(name), -1 if soft else 0
    upper = program.upper.copy()
    upper[row] = program.lower[row]
    closed = dataclasses.replace(program, upper=upper)
    for case in (program, closed, program, closed):
        solution = case.solve(backend)
        require_same(case, name, solution.z, oracle(case))
        if case is closed and not soft:
            value = program.structure.constraints[row] @ solution.z
            assert value == pytest.approx(upper[row], abs=1e-5)


@backends
@pytest.mark.parametrize('seed', range(8))
def test_bounds_that_close_open_and_vanish_between_solves_leave_it_right(name, seed):
    """Hard rows are fewer than variables, so none of it is infeasible."""
    random = np.random.default_rng(seed)
    program = random_program(seed, 8, 10, soft=4)
    backend = program.backend(name)
    for _ in range(10):
        lower, upper = program.lower.copy(), program.upper.copy()
        closed, no_lower, no_upper = random.random((3, 10)) < [[0.2], [0.3], [0.3]]
        upper[closed] = lower[closed]
        lower[no_lower], upper[no_upper] = -INF, INF
        f = program.f * random.normal()
        case = dataclasses.replace(program, f=f, lower=lower, upper=upper)
        solution = case.solve(backend)
        assert solution.status == 'solved'
        require_same(case, name, solution.z, oracle(case))


@backends
def test_an_active_bound_that_becomes_infinite_is_released(name):
    """DAQP calls this infeasible when it starts from its last active set."""
    backend = scalar(name, [1.0])
    assert backend.solve([-3.0], [-1.0], [1.0]).z[0] == pytest.approx(1.0, rel=1e-5)
    assert backend.solve([-3.0], [-1.0], [INF]).z[0] == pytest.approx(3.0, rel=1e-5)


@backends
def test_infinite_bounds_are_no_bounds(name):
    program = random_program(4, 5, 10, soft=4)
    lower, upper = program.lower.copy(), program.upper.copy()
    lower[::2], upper[1::3] = -INF, INF
    half = dataclasses.replace(program, lower=lower, upper=upper)
    require_same(half, name, half.solve(half.backend(name)).z, oracle(half))
    free = dataclasses.replace(program, lower=np.full(10, -INF), upper=np.full(10, INF))
    optimum = np.linalg.solve(program.structure.hessian, -program.f)
    require_same(free, name, free.solve(free.backend(name)).z, optimum)


@backends
def test_a_program_without_rows_is_solved(name):
    backend = make_backend(name, QpStructure(2.0 * np.eye(2), np.zeros((0, 2))), LIMIT)
    np.testing.assert_allclose(backend.solve([2.0, -4.0], [], []).z, [-1.0, 2.0], rtol=1e-5)


@backends
def test_a_row_of_zeros_restricts_nothing_or_everything(name):
    structure = QpStructure(np.eye(1), np.array([[0.0], [1.0]]))
    backend = make_backend(name, structure, LIMIT)
    assert backend.solve([-3.0], [-1.0, -INF], [1.0, 2.0]).z[0] == pytest.approx(2.0, rel=1e-5)
    assert backend.solve([-3.0], [1.0, -INF], [2.0, 2.0]).status == 'infeasible'
    soft = QpStructure(np.eye(1), np.array([[0.0], [1.0]]), np.array([True, False]), 10.0)
    bounds = [1.0, -INF], [INF, 2.0]
    solution = make_backend(name, soft, LIMIT).solve([-3.0], *bounds)
    assert solution.z[0] == pytest.approx(2.0, rel=1e-5)
    assert violation(soft, solution.z, *bounds) == 1.0


@backends
def test_the_iteration_limit_is_reported_and_not_raised(name):
    program = random_program(5, 20, 40, soft=10)
    solution = program.solve(make_backend(name, program.structure, 1))
    assert (solution.status, solution.iterations) == ('iteration limit', 1)
    assert np.isnan(solution.z).all()


@backends
def test_the_iterations_that_a_solve_takes_are_a_limit_that_suffices(name):
    """Five fewer are not enough; OSQP checks its residuals every fifth."""
    program = random_program(5, 20, 40, soft=10)
    free = program.solve(program.backend(name))
    enough = program.solve(make_backend(name, program.structure, free.iterations))
    assert enough.z.tobytes() == free.z.tobytes()
    short = program.solve(make_backend(name, program.structure, free.iterations - 5))
    assert short.status == 'iteration limit'


@backends
def test_a_warm_start_changes_the_effort_and_not_the_solution(name):
    program = random_program(6, 12, 24, soft=12)
    warm, cold_iterations, warm_iterations = program.backend(name), 0, 0
    for step in range(40):
        moved = dataclasses.replace(program, f=program.f * (1.0 + 0.5 * math.sin(0.1 * step)))
        after, before = moved.solve(warm), moved.solve(program.backend(name))
        require_same(moved, name, after.z, before.z)
        warm_iterations += after.iterations
        cold_iterations += before.iterations
    assert warm_iterations < 0.8 * cold_iterations


@backends
def test_a_reset_backend_repeats_a_new_one_to_the_bit(name):
    program = random_program(7, 12, 24, decades=1.0, soft=12)

    def run(backend: QpBackend) -> list:
        factors = [1.0, 1.5, -0.5, 0.9]
        solved = [backend.solve(k * program.f, program.lower, program.upper) for k in factors]
        return [(s.z.tobytes(), s.iterations, s.status) for s in solved]

    backend = program.backend(name)
    first = run(backend)
    backend.reset()
    assert run(backend) == first
    assert run(program.backend(name)) == first


@backends
def test_a_failed_solve_leaves_no_trace(name):
    """The first row is given twice, the second time with bounds that contradict the first."""
    program = random_program(8, 8, 16)
    rows = program.structure.constraints[[*range(16), 0]]
    structure = QpStructure(program.structure.hessian, rows)
    backend, new = make_backend(name, structure, LIMIT), make_backend(name, structure, LIMIT)
    lower, upper = np.append(program.lower, -INF), np.append(program.upper, INF)
    assert backend.solve(program.f, lower, upper).status == 'solved'
    contrary = np.append(program.lower, upper[0] + 1.0)
    assert backend.solve(program.f, contrary, upper).status == 'infeasible'
    after, expected = (each.solve(program.f, lower, upper) for each in (backend, new))
    assert after.z.tobytes() == expected.z.tobytes()


@backends
def test_a_solver_prints_nothing(name, capfd):
    program = random_program(9, 6, 12, soft=6)
    backend = program.backend(name)
    program.solve(backend)
    backend.reset()
    assert capfd.readouterr() == ('', '')


@backends
def test_a_hessian_of_tiny_or_huge_weights_is_no_singular_one(name):
    structure = QpStructure(np.diag([1e-14, 1e14]), np.eye(2))
    solution = make_backend(name, structure, LIMIT).solve(
        [-1e-7, -1e7], [-INF, -INF], [INF, 0.5e-7]
    )
    np.testing.assert_allclose(solution.z, [1e7, 0.5e-7], rtol=1e-5)


def test_a_hessian_just_inside_the_stated_condition_is_solved():
    structure = QpStructure(np.array([[1.0, 1.0 - 1e-9], [1.0 - 1e-9, 1.0]]), np.eye(2))
    free = Program(structure, np.array([-1.0, -2.0]), np.full(2, -INF), np.full(2, INF))
    solution = free.solve(free.backend(DEFAULT_BACKEND))
    assert solution.status == 'solved'
    expected = np.linalg.solve(structure.hessian, -free.f)
    require_same(free, DEFAULT_BACKEND, solution.z, expected)

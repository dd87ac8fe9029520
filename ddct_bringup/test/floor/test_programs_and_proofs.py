# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Bounds of linear programs: closed forms, weak duality, rays, and refused certificates."""

from dataclasses import replace

import numpy as np
import pytest
import scipy
from samples import sampled

from ddct_bringup.floor.program import highs as highs_module
from ddct_bringup.floor.program import solve as solve_module
from ddct_bringup.floor.program.highs import highs
from ddct_bringup.floor.program.linear_program import (
    RAY,
    WEAK_DUALITY,
    Certificate,
    LinearProgram,
    certified,
    proven,
    require_proof,
)
from ddct_bringup.floor.program.peak import late_peaks, peak_program
from ddct_bringup.floor.program.solve import ray_of, solve
from ddct_plant.base.errors import DdctError

pytestmark = pytest.mark.slow


def solution_of(program):
    """Return the solution with all variables free and all rows used."""
    none = np.zeros(len(program.cost), dtype=bool)
    return solve(program, none, np.zeros(len(none)), np.zeros(len(program.limits), dtype=bool))


def least_peak(rows, offset, equal_rows, equal_values, most):
    """Return the program of the least peak |rows u + offset| with equations and a box."""
    count = rows.shape[1]
    box = np.full(count, most)
    none = np.zeros((0, count)), np.zeros(0)
    return peak_program(rows, offset, *none, equal_rows, equal_values, -box, box)


def test_a_double_integrator_from_rest_to_rest_needs_four_times_the_way_over_the_time_squared():
    periods, period_s, way = 40, 0.05, 3.0
    left = np.arange(periods)[::-1]
    position = period_s**2 * (left + 0.5)
    ends = np.vstack([position, np.full(periods, period_s)])
    program = least_peak(np.eye(periods), np.zeros(periods), ends, np.array([way, 0.0]), 100.0)
    solution = solution_of(program)
    closed_form = 4.0 * way / (periods * period_s) ** 2
    assert solution.certificate.claim == pytest.approx(closed_form, rel=1e-6)
    assert program.cost @ solution.point == pytest.approx(closed_form, rel=1e-6)


def test_a_rigid_clutch_needs_a_constant_torque_to_lock_at_a_time():
    """J_r dw_d/dt = J_r a - C_f from a slip w_0: C_f = J_r (a + w_0/T) has the least peak."""
    joint, drive, slip, periods, period_s = 0.2, 30.0, 100.0, 50, 0.01
    sums = np.full((1, periods), period_s / joint)
    needed = np.array([slip + drive * periods * period_s])
    program = least_peak(np.eye(periods), np.zeros(periods), sums, needed, 1000.0)
    closed_form = joint * (drive + slip / (periods * period_s))
    assert solution_of(program).certificate.claim == pytest.approx(closed_form, rel=1e-6)


def random_program(random):
    """Return a program whose origin keeps all rows."""
    variables, rows = random.integers(2, 12), random.integers(1, 20)
    matrix = random.normal(size=(rows, variables))
    return LinearProgram(
        cost=random.normal(size=variables),
        constant=float(random.normal()),
        rows=matrix,
        limits=random.uniform(0.1, 2.0, size=rows),
        equal_rows=random.normal(size=(1, variables)),
        equal_values=np.zeros(1),
        low=-random.uniform(0.5, 3.0, size=variables),
        high=random.uniform(0.5, 3.0, size=variables),
    )


@pytest.mark.parametrize('seed', sampled(range(200), every=10))
def test_any_multipliers_bound_the_optimum_and_those_of_the_solver_attain_it(seed):
    random = np.random.default_rng(seed)
    program = random_program(random)
    optimum = scipy.optimize.linprog(
        program.cost,
        program.rows,
        program.limits,
        program.equal_rows,
        program.equal_values,
        np.column_stack([program.low, program.high]),
    )
    assert optimum.status == 0
    best = optimum.fun + program.constant
    any_rows = random.exponential(size=len(program.limits))
    any_equal = random.normal(size=1)
    assert proven(WEAK_DUALITY, program, any_rows, any_equal) <= best + 1e-9
    assert solution_of(program).certificate.claim == pytest.approx(best, abs=1e-6)


def impossible_program():
    """Return a program whose two rows exclude each other, x + y <= 1 and x + y >= 1.5."""
    return LinearProgram(
        cost=np.array([1.0, 0.0]),
        constant=0.0,
        rows=np.array([[1.0, 1.0], [-1.0, -1.0]]),
        limits=np.array([1.0, -1.5]),
        equal_rows=np.zeros((0, 2)),
        equal_values=np.zeros(0),
        low=np.zeros(2),
        high=np.full(2, 10.0),
    )


def test_an_infeasible_program_comes_with_its_ray():
    assert solution_of(impossible_program()) is None
    ray = ray_of(impossible_program())
    assert ray.kind == RAY
    assert ray.claim > 0.0
    require_proof(ray, impossible_program())


def test_late_rows_of_a_peak_count_where_the_peak_is_late():
    """Each request has a peak of its own: that of the last period is the highest."""
    periods = 80
    program = least_peak(
        np.eye(periods), np.linspace(-1.0, 3.0, periods), np.zeros((0, periods)), np.zeros(0), 1.0
    )
    deferred = late_peaks(periods, 0.1)
    assert deferred.any()
    assert not deferred.all()
    free = np.zeros(periods + 1, dtype=bool)
    solution = solve(program, free, np.zeros(periods + 1), deferred)
    assert solution.certificate.claim == pytest.approx(2.0, abs=1e-6)


@pytest.mark.parametrize('seed', sampled(range(20), every=2))
def test_without_a_point_the_multipliers_at_the_least_violation_are_a_ray(seed):
    program = random_program(np.random.default_rng(seed))
    beyond = replace(
        program,
        rows=np.vstack([program.rows, -program.rows]),
        limits=np.concatenate([program.limits, -program.limits - 0.5]),
    )
    assert solution_of(beyond) is None
    ray = ray_of(beyond)
    assert ray.claim > 0.0
    require_proof(ray, beyond)


def broken(certificate):
    """Yield certificates that no longer prove their claim, with words of the error."""
    yield replace(certificate, claim=certificate.claim + 1e-3), 'claims'
    yield replace(certificate, claim=np.nan), 'proves nothing'
    yield replace(certificate, kind='trust'), 'proves nothing'
    yield replace(certificate, row_multipliers=certificate.row_multipliers[:-1]), 'not one'
    yield replace(certificate, row_multipliers=certificate.row_multipliers - 1.0), 'below zero'
    yield replace(certificate, row_multipliers=0.0 * certificate.row_multipliers), 'claims'


def test_a_broken_certificate_is_refused():
    program = random_program(np.random.default_rng(4))
    certificate = solution_of(program).certificate
    assert np.any(certificate.row_multipliers > 0.0)
    require_proof(certificate, program)
    for wrong, words in broken(certificate):
        with pytest.raises(DdctError, match=words):
            require_proof(wrong, program)


def test_a_ray_that_excludes_nothing_is_refused():
    program = random_program(np.random.default_rng(5))
    rows = np.zeros(len(program.limits))
    empty = Certificate(RAY, 0.0, rows, np.zeros(1))
    with pytest.raises(DdctError, match='exclude'):
        require_proof(empty, program)
    assert certified(RAY, program, rows, np.zeros(1)).claim == 0.0


@pytest.mark.parametrize('seed', sampled(range(20), every=2))
def test_huge_multipliers_that_cancel_prove_nothing_by_rounding(seed):
    """Rows and their mirror images cancel, and no bound above the cost of a point is left."""
    random = np.random.default_rng(seed)
    half, point = random.normal(size=(40, 30)), random.uniform(900.0, 1000.0, size=30)
    program = LinearProgram(
        cost=np.zeros(30),
        constant=1.0,
        rows=np.vstack([half, -half]),
        limits=np.concatenate([half @ point, -half @ point]),
        equal_rows=np.zeros((0, 30)),
        equal_values=np.zeros(0),
        low=np.full(30, 900.0),
        high=np.full(30, 1000.0),
    )
    multipliers = np.tile(1e19 * random.uniform(size=40), 2)
    assert proven(WEAK_DUALITY, program, multipliers, np.zeros(0)) <= 1.0


def test_a_kept_variable_that_excludes_all_points_is_let_go():
    """With x kept at 0 a row x >= 0.5 excludes all; the program itself has points, and no ray."""
    program = LinearProgram(
        cost=np.array([1.0, 1.0]),
        constant=0.0,
        rows=np.array([[-1.0, 0.0]]),
        limits=np.array([-0.5]),
        equal_rows=np.zeros((0, 2)),
        equal_values=np.zeros(0),
        low=np.zeros(2),
        high=np.ones(2),
    )
    kept = np.array([True, False])
    solution = solve(program, kept, np.zeros(2), np.zeros(1, dtype=bool))
    assert solution.certificate.kind == WEAK_DUALITY
    assert solution.certificate.claim == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize('seed', sampled(range(20), every=2))
def test_both_methods_of_the_solver_find_the_same_optimum(seed, monkeypatch):
    program = random_program(np.random.default_rng(seed))
    found = []
    for method, presolve in tuple(highs_module._METHODS.items()):
        monkeypatch.setattr(highs_module, '_METHODS', {method: presolve})
        optimum = highs(program)
        certificate = certified(WEAK_DUALITY, program, optimum.rows, optimum.equal)
        value = program.cost @ optimum.point + program.constant
        assert certificate.claim == pytest.approx(value, abs=1e-5)
        found.append(value)
    assert found[0] == pytest.approx(found[1], abs=1e-6)


def test_where_one_method_stops_early_the_other_has_the_point(monkeypatch):
    program = random_program(np.random.default_rng(3))
    expected = solution_of(program).certificate.claim
    linprog, tried = scipy.optimize.linprog, []

    def stops(*arguments, **options):
        tried.append(arguments[6])
        if len(tried) == 1:
            options['options'] = {**options['options'], 'maxiter': 0}
        return linprog(*arguments, **options)

    monkeypatch.setattr(scipy.optimize, 'linprog', stops)
    assert solution_of(program).certificate.claim == pytest.approx(expected, abs=1e-6)
    assert tried == list(highs_module._METHODS)
    monkeypatch.setattr(highs_module, '_METHODS', {'highs-ds': False})
    tried.clear()
    with pytest.raises(DdctError, match='HiGHS'):
        solution_of(program)


@pytest.mark.parametrize('excess', [0.0, 1e-6])
def test_multipliers_of_a_peak_whose_sum_is_beyond_one_cost_no_bound(excess, monkeypatch):
    """The peak is below 1e6 only, so that an excess of 1e-6 would cost 1."""
    program = least_peak(np.eye(3), np.full(3, 2.0), np.zeros((0, 3)), np.zeros(0), 1.0)

    def inexact(given):
        found = highs(given)
        return replace(found, rows=found.rows * (1.0 + excess))

    monkeypatch.setattr(solve_module, 'highs', inexact)
    assert solution_of(program).certificate.claim == pytest.approx(1.0, abs=1e-8)


def test_a_variable_whose_box_has_no_width_keeps_its_value():
    program = replace(impossible_program(), rows=np.zeros((0, 2)), limits=np.zeros(0))
    program = replace(program, low=np.array([0.0, 2.0]), high=np.array([10.0, 2.0]))
    solution = solution_of(program)
    assert solution.point == pytest.approx([0.0, 2.0], abs=1e-6)
    assert solution.certificate.claim == pytest.approx(0.0, abs=1e-6)

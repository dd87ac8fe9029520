/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/*
 * Quadratic program: minimise 1/2 y'y + v'y + 1/2 sum of s_i^2 / RELAXATION[i]
 * subject to lower <= NORMAL y + s <= upper, s_i = 0 where RELAXATION[i] is 0.
 *
 * Dual active-set method of Goldfarb and Idnani (Mathematical Programming 27, 1983), started from
 * the unconstrained minimiser. y = -v - sum of m_i NORMAL[i] over the active rows i; the signed
 * multiplier m_i is positive at an upper bound, and s_i = -RELAXATION[i] m_i. The Gram matrix of
 * the active rows, plus RELAXATION on its diagonal, is kept as L D L'.
 */

/* Rows have unit length: below this, a row depends on the active ones. */
#define DEPENDENT 1e-12
/* Violation that counts as none, relative to the largest number it comes from. */
#define ROUNDING 1e-12

typedef struct {
    int count;
    int row[ACTIVE];
    double side[ACTIVE];
    double multiplier[ACTIVE];
    double factor[ACTIVE * (ACTIVE + 1) / 2];
} active_set;

static double dot(const double *a, const double *b, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

static double gram(int i, int j)
{
    const double product = dot(NORMAL[i], NORMAL[j], DDCT_MPC_MOVES);
    return i == j ? product + RELAXATION[i] : product;
}

/* Row i of L, with D_i in the place of its diagonal. */
static double *factor_row(active_set *set, int i)
{
    return set->factor + i * (i + 1) / 2;
}

static void factorise(active_set *set, int first)
{
    for (int i = first; i < set->count; ++i) {
        double *row = factor_row(set, i);
        for (int j = 0; j < i; ++j) {
            row[j] = gram(set->row[i], set->row[j]) - dot(row, factor_row(set, j), j);
        }
        row[i] = gram(set->row[i], set->row[i]);
        for (int j = 0; j < i; ++j) {
            const double scaled = row[j] / factor_row(set, j)[j];
            row[i] -= row[j] * scaled;
            row[j] = scaled;
        }
    }
}

static void solve_active(active_set *set, double *x)
{
    for (int i = 0; i < set->count; ++i) {
        x[i] -= dot(factor_row(set, i), x, i);
    }
    for (int i = set->count - 1; i >= 0; --i) {
        x[i] /= factor_row(set, i)[i];
        for (int j = i + 1; j < set->count; ++j) {
            x[i] -= factor_row(set, j)[i] * x[j];
        }
    }
}

static void add_row(double *y, int row, double factor)
{
    for (int j = 0; j < DDCT_MPC_MOVES; ++j) {
        y[j] += factor * NORMAL[row][j];
    }
}

static void minimiser(const active_set *set, const double *v, double *y)
{
    for (int j = 0; j < DDCT_MPC_MOVES; ++j) {
        y[j] = -v[j];
    }
    for (int i = 0; i < set->count; ++i) {
        add_row(y, set->row[i], -set->multiplier[i]);
    }
}

/* How far row i, with its slack, lies beyond its bound on that side. */
static double excess(int i, double side, double multiplier, const double *y, const double *lower,
                     const double *upper)
{
    const double value = dot(NORMAL[i], y, DDCT_MPC_MOVES) - RELAXATION[i] * multiplier;
    return side > 0.0 ? value - upper[i] : lower[i] - value;
}

/* Bring the active rows onto their bounds once more, which takes off what rounding has left. */
static void refine(active_set *set, const double *v, const double *lower, const double *upper,
                   double *y)
{
    double error[ACTIVE];
    minimiser(set, v, y);
    for (int i = 0; i < set->count; ++i) {
        error[i] = set->side[i]
            * excess(set->row[i], set->side[i], set->multiplier[i], y, lower, upper);
    }
    solve_active(set, error);
    for (int i = 0; i < set->count; ++i) {
        set->multiplier[i] += error[i];
    }
    minimiser(set, v, y);
}

static int is_active(const active_set *set, int row)
{
    for (int i = 0; i < set->count; ++i) {
        if (set->row[i] == row) {
            return 1;
        }
    }
    return 0;
}

/* Return the row that lies farthest beyond a bound, and which; -1 if none does. */
static int most_violated(const active_set *set, const double *v, const double *y,
                         const double *lower, const double *upper, double *side)
{
    double largest = 0.0;
    int found = -1;
    for (int j = 0; j < DDCT_MPC_MOVES; ++j) {
        largest = larger(largest, ROUNDING * larger(larger(v[j], -v[j]), larger(y[j], -y[j])));
    }
    for (int i = 0; i < ROWS; ++i) {
        const double above = excess(i, 1.0, 0.0, y, lower, upper);
        const double below = excess(i, -1.0, 0.0, y, lower, upper);
        if (larger(above, below) > largest && !is_active(set, i)) {
            largest = larger(above, below);
            found = i;
            *side = above > below ? 1.0 : -1.0;
        }
    }
    return found;
}

static void append(active_set *set, int row, double side, double multiplier)
{
    const int last = set->count++;
    set->row[last] = row;
    set->side[last] = side;
    set->multiplier[last] = multiplier;
    factorise(set, last);
}

static void drop(active_set *set, int index)
{
    --set->count;
    for (int i = index; i < set->count; ++i) {
        set->row[i] = set->row[i + 1];
        set->side[i] = set->side[i + 1];
        set->multiplier[i] = set->multiplier[i + 1];
    }
    factorise(set, index);
}

/* How the multipliers of the active rows answer to one of `row`; return the excess it takes off. */
static double direction(active_set *set, int row, double *change)
{
    double products[ACTIVE], curvature = gram(row, row);
    for (int i = 0; i < set->count; ++i) {
        products[i] = gram(set->row[i], row);
        change[i] = products[i];
    }
    solve_active(set, change);
    for (int i = 0; i < set->count; ++i) {
        curvature -= products[i] * change[i];
    }
    return curvature;
}

/* Return the first active row whose multiplier vanishes within `step`, and shorten the step to
 * there; -1 if none does. A negative step has no end. */
static int blocking_row(const active_set *set, double side, const double *change, double *step)
{
    int blocking = -1;
    for (int i = 0; i < set->count; ++i) {
        const double decrease = set->side[i] * side * change[i];
        const double left = larger(0.0, set->side[i] * set->multiplier[i]);
        if (decrease > 0.0 && (*step < 0.0 || left < *step * decrease)) {
            *step = left / decrease;
            blocking = i;
        }
    }
    return blocking;
}

static ddct_mpc_status solve(const double *v, const double *lower, const double *upper, double *y,
                             int *iterations)
{
    active_set set;
    double change[ACTIVE], side = 0.0, multiplier = 0.0;
    int row = -1;
    set.count = 0;
    minimiser(&set, v, y);
    for (*iterations = 0; *iterations < DDCT_MPC_ITERATIONS; ++*iterations) {
        if (row < 0) {
            row = most_violated(&set, v, y, lower, upper, &side);
            multiplier = 0.0;
        }
        if (row < 0) {
            return DDCT_MPC_SOLVED;
        }
        const double curvature = direction(&set, row, change);
        const double left = larger(0.0, excess(row, side, multiplier, y, lower, upper));
        double step = curvature > DEPENDENT ? left / curvature : -1.0;
        const int blocking = blocking_row(&set, side, change, &step);
        if (step < 0.0) {
            return DDCT_MPC_INFEASIBLE;
        }
        multiplier += side * step;
        for (int i = 0; i < set.count; ++i) {
            set.multiplier[i] -= side * step * change[i];
        }
        if (blocking >= 0) {
            drop(&set, blocking);
            minimiser(&set, v, y);
            add_row(y, row, -multiplier);
        } else {
            append(&set, row, side, multiplier);
            refine(&set, v, lower, upper, y);
            row = -1;
        }
    }
    return row < 0 && most_violated(&set, v, y, lower, upper, &side) < 0
        ? DDCT_MPC_SOLVED : DDCT_MPC_ITERATION_LIMIT;
}

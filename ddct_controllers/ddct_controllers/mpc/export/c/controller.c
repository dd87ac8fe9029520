/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/* Places in the vector of all that the program depends on. */
enum {
    STATE = 0,
    BEFORE = STATE + DDCT_MPC_STATES,
    ENGINE = BEFORE + INPUTS,
    LOAD,
    OPEN_LOOP,
    JUMP,
    DEVIATION,
    SLIP = DEVIATION + DDCT_MPC_COMMANDS_ENGINE,
    RATE = SLIP + SLIP_REFERENCES,
    KNOWN = RATE + RATE_REFERENCES
};

static int all_usable(const ddct_mpc_measurement *m)
{
    int good = usable(m->engine_speed) && usable(m->shaft_speed) && usable(m->wheel_speed)
        && usable(m->engine_torque) && usable(m->load_torque) && usable(m->open_loop_torque);
    for (int i = 0; i < SLIP_REFERENCES; ++i) {
        good = good && usable(m->slip_reference[FIRST_REFERENCE + i]);
    }
    for (int i = 0; i < RATE_REFERENCES; ++i) {
        good = good && usable(m->slip_reference_rate[FIRST_REFERENCE + i]);
    }
    return good;
}

/* x_(k|k) = x_(k|k-1) + GAIN (speeds - x_(k|k-1)[:3]). The estimate starts at zero, or the first
 * measurement starts it. */
static void correct(ddct_mpc *s, const ddct_mpc_measurement *m)
{
    const double speeds[MEASURED] = {m->engine_speed, m->shaft_speed, m->wheel_speed};
    double error[MEASURED];
    if (!s->started) {
        s->open_loop_torque = larger(m->open_loop_torque, 0.0);
        s->started = 1;
#if STARTS_AT_REST
        for (int i = 0; i < DDCT_MPC_STATES; ++i) {
            s->state[i] = AT_REST[i] + AT_REST_PER_LOAD[i] * m->load_torque;
        }
        for (int i = 0; i < MEASURED; ++i) {
            s->state[i] = speeds[i];
        }
        return;
#endif
    }
    for (int i = 0; i < MEASURED; ++i) {
        error[i] = speeds[i] - s->state[i];
    }
    for (int i = 0; i < DDCT_MPC_STATES; ++i) {
        s->state[i] += dot(GAIN[i], error, MEASURED);
    }
}

/* x_(k+1|k) = A x_(k|k) + B u_k; the actuator cuts the clutch torque off below 0. */
static void predict(ddct_mpc *s, double clutch_torque, double engine_torque, double load_torque)
{
    const double inputs[3] = {larger(clutch_torque, 0.0), engine_torque, load_torque};
    double next[DDCT_MPC_STATES];
    for (int i = 0; i < DDCT_MPC_STATES; ++i) {
        next[i] = dot(A[i], s->state, DDCT_MPC_STATES) + dot(B[i], inputs, 3);
    }
    for (int i = 0; i < DDCT_MPC_STATES; ++i) {
        s->state[i] = next[i];
    }
}

static void gather(const ddct_mpc *s, const ddct_mpc_measurement *m, double *known)
{
    for (int i = 0; i < DDCT_MPC_STATES; ++i) {
        known[STATE + i] = s->state[i];
    }
    known[BEFORE] = m->open_loop_torque + s->own_torque;
    known[ENGINE] = m->engine_torque;
    known[LOAD] = m->load_torque;
    known[OPEN_LOOP] = m->open_loop_torque;
    known[JUMP] = m->open_loop_torque - s->open_loop_torque;
#if DDCT_MPC_COMMANDS_ENGINE
    known[BEFORE + 1] = s->engine_asked;
    known[DEVIATION] = s->engine_deviation;
#endif
    for (int i = 0; i < SLIP_REFERENCES; ++i) {
        known[SLIP + i] = m->slip_reference[FIRST_REFERENCE + i];
    }
    for (int i = 0; i < RATE_REFERENCES; ++i) {
        known[RATE + i] = m->slip_reference_rate[FIRST_REFERENCE + i];
    }
}

/* The rate goes before the level: a level that it cannot keep from the last request gives way to the
 * nearest that it reaches. */
static void bounds(const ddct_mpc *s, const double *known, double *lower, double *upper)
{
#if LIMITS_RATE
    const double last = known[BEFORE] - known[JUMP];
    const double room = ROOM * (1.0 + larger(last, -last));
#endif
    for (int i = 0; i < ROWS; ++i) {
        const double shift = dot(SHIFT[i], known, SLIP);
        lower[i] = LOWER[i];
        upper[i] = UPPER[i];
#if LIMITS_RATE
        if (CLUTCH_PERIODS_AHEAD[i] > 0.0) {
            const double reach = CLUTCH_PERIODS_AHEAD[i] * CLUTCH_CHANGE - room;
            lower[i] = smaller(lower[i], SCALE[i] * (last + reach));
            upper[i] = larger(upper[i], SCALE[i] * (last - reach));
        }
#endif
#if DDCT_MPC_COMMANDS_ENGINE
        if (ENGINE_PERIODS_AHEAD[i] > 0.0) {
            const double demand = known[ENGINE], periods = ENGINE_PERIODS_AHEAD[i];
            lower[i] = SCALE[i] * reachable(s, demand, LEAST_ENGINE_TORQUE, periods);
            upper[i] = SCALE[i] * reachable(s, demand, MOST_ENGINE_TORQUE, periods);
        }
#endif
        lower[i] -= shift;
        upper[i] -= shift;
    }
    (void)s;
}

/* Take the next moves of the last plan, cut off at the levels and then at the rates. */
static void follow_plan(ddct_mpc *s, const double *known, double *moves)
{
    const double before = known[BEFORE], last = before - known[JUMP];
    double level;
    for (int i = 0; i < DDCT_MPC_MOVES; ++i) {
        const int next = i + INPUTS;
        s->plan[i] = next < DDCT_MPC_MOVES ? s->plan[next] : 0.0;
    }
    level = smaller(larger(before + s->plan[0], LEAST_CLUTCH), MOST_CLUTCH);
    moves[0] = smaller(larger(level, last - CLUTCH_CHANGE), last + CLUTCH_CHANGE) - before;
#if DDCT_MPC_COMMANDS_ENGINE
    const double demand = known[ENGINE], requested = known[BEFORE + 1];
    level = larger(requested + s->plan[1], reachable(s, demand, LEAST_ENGINE_TORQUE, 1.0));
    moves[1] = smaller(level, reachable(s, demand, MOST_ENGINE_TORQUE, 1.0)) - requested;
#endif
    if (s->fallbacks < ULONG_MAX) {
        ++s->fallbacks;
    }
}

/* Choose the first move of each input. */
static ddct_mpc_status choose(ddct_mpc *s, const double *known, double *moves, int *iterations)
{
    double v[DDCT_MPC_MOVES], y[DDCT_MPC_MOVES], lower[ROWS], upper[ROWS];
    for (int i = 0; i < DDCT_MPC_MOVES; ++i) {
        v[i] = dot(GRADIENT[i], known, KNOWN);
    }
    bounds(s, known, lower, upper);
    const ddct_mpc_status status = solve(v, lower, upper, y, iterations);
    if (status != DDCT_MPC_SOLVED) {
        follow_plan(s, known, moves);
        return status;
    }
    for (int i = 0; i < DDCT_MPC_MOVES; ++i) {
        s->plan[i] = dot(MOVES[i], y, DDCT_MPC_MOVES);
    }
    for (int i = 0; i < INPUTS; ++i) {
        moves[i] = s->plan[i];
    }
    return status;
}

void ddct_mpc_reset(ddct_mpc *s)
{
    for (int i = 0; i < DDCT_MPC_STATES; ++i) {
        s->state[i] = 0.0;
    }
    for (int i = 0; i < DDCT_MPC_MOVES; ++i) {
        s->plan[i] = 0.0;
    }
    s->own_torque = 0.0;
    s->open_loop_torque = 0.0;
    s->engine_request = 0.0;
    s->engine_asked = 0.0;
    s->engine_deviation = 0.0;
    s->fallbacks = 0;
    s->started = 0;
}

/* Let the observer and what is kept of the inputs go on by one period. */
static void advance(ddct_mpc *s, const ddct_mpc_measurement *m, double clutch_torque,
                    double engine_request)
{
    double engine_torque = engine_request;
    s->own_torque = clutch_torque - m->open_loop_torque;
    s->open_loop_torque = m->open_loop_torque;
#if DDCT_MPC_COMMANDS_ENGINE
    s->engine_request = engine_request;
    engine_torque = deliver(
        &s->engine_asked, &s->engine_deviation, m->engine_torque, engine_request);
#endif
    predict(s, clutch_torque, engine_torque, m->load_torque);
}

ddct_mpc_status ddct_mpc_hold(ddct_mpc *s, const ddct_mpc_measurement *m)
{
    if (!all_usable(m)) {
        return DDCT_MPC_BAD_MEASUREMENT;
    }
    correct(s, m);
    advance(s, m, m->open_loop_torque, m->engine_torque);
    /* The rate counts from what the actuator was given. */
    s->open_loop_torque = larger(m->open_loop_torque, 0.0);
    return DDCT_MPC_SOLVED;
}

ddct_mpc_command ddct_mpc_update(ddct_mpc *s, const ddct_mpc_measurement *m)
{
    ddct_mpc_command command = {0.0, 0.0, DDCT_MPC_BAD_MEASUREMENT, 0};
    if (all_usable(m)) {
        double known[KNOWN], moves[INPUTS], engine_request = m->engine_torque;
        correct(s, m);
        gather(s, m, known);
        command.status = choose(s, known, moves, &command.iterations);
#if DDCT_MPC_COMMANDS_ENGINE
        engine_request += s->engine_asked + moves[1];
#endif
        advance(s, m, known[BEFORE] + moves[0], engine_request);
    }
    command.clutch_torque = s->own_torque;
    command.engine_torque = s->engine_request;
    return command;
}

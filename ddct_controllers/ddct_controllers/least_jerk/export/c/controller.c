/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
enum { SLIPPING = 0, CONFIRMING = 1, CLOSED = 2 };

typedef struct {
    actuator model;
    carried_torque clutch;
    rigid_slip slip;
    demand_trend demand;
    torque_plan plan;
#if SHAPING_STEPS
    shaped_demand engine;
#endif
    double torque, torque_before, engine_torque;
    int phase, count, apart, opening, started, on;
} least_jerk;

const ddct_description ddct_controller = DDCT_DESCRIPTION(least_jerk, 0, SHAPING_STEPS > 0);

static int all_usable(const ddct_measurement *m)
{
    return usable(m->engine_speed) && usable(m->shaft_speed) && usable(m->wheel_speed)
        && usable(m->engine_torque) && usable(m->load_torque) && usable(m->open_loop_torque)
        && usable(m->slip_reference[0]) && usable(m->slip_reference_rate[0]);
}

/* The clutch torque of constant slip for C_m. */
static double constant_slip(const ddct_measurement *m, double engine_torque)
{
    double load_torque = m->load_torque;
#if COUNTS_DAMPING
    engine_torque = engine_torque - ENGINE_DAMPING * m->engine_speed;
    load_torque = load_torque + WHEEL_DAMPING * m->shaft_speed;
#endif
    const double resisting = ENGINE_INERTIA * load_torque / TOTAL_RATIO;
    return (engine_torque * VEHICLE_INERTIA + resisting) / (ENGINE_INERTIA + VEHICLE_INERTIA);
}

static double rise_of(const least_jerk *s, const ddct_measurement *m)
{
    const double more = constant_slip(m, s->demand.level + 1.0);
    return (more - constant_slip(m, s->demand.level)) * s->demand.rate;
}

void ddct_controller_reset(void *state)
{
    least_jerk *s = state;
    actuator_reset(&s->model, INITIAL_REQUEST);
    carried_reset(&s->clutch);
    slip_follow(&s->slip, 0.0, 0);
    s->demand.level = s->demand.rate = s->demand.mean = 0.0;
    s->demand.count = 0;
    s->plan.rate = 0.0;
    s->plan.falling = 0;
    plan_start(&s->plan, INITIAL_REQUEST);
#if SHAPING_STEPS
    shaped_reset(&s->engine);
#endif
    s->torque = s->torque_before = INITIAL_REQUEST;
    s->engine_torque = 0.0;
    s->phase = SLIPPING;
    s->opening = SHIFTS ? OPENING_STEPS : 0;
    s->count = s->apart = s->started = s->on = 0;
}

/* Update every estimate with the measurement and what was requested before. */
static void observe(least_jerk *s, const ddct_measurement *m, int learns)
{
    const double slip = m->engine_speed - m->shaft_speed;
    const int slips = !STICKS || slip > SLIPPING_SPEED;
    demand_update(&s->demand, m->engine_torque);
    if (!s->started) {
        s->started = 1;
        carried_follow(&s->clutch, m->engine_speed);
        slip_follow(&s->slip, slip, 0);
        return;
    }
    const double held = carried(&s->clutch, s->torque);
    const double change = s->clutch.gain * (s->torque - s->torque_before);
    if (learns && slips) {
        carried_update(&s->clutch, m->engine_speed, s->engine_torque, s->torque);
    } else {
        carried_follow(&s->clutch, m->engine_speed);
    }
    if (!slips) {
        slip_follow(&s->slip, slip, s->phase == SLIPPING);
    } else if (m->shaft_speed < STANDING_SPEED) {
        const double driven = s->engine_torque - ENGINE_DAMPING * m->engine_speed - held;
        slip_update_held_shaft(&s->slip, slip, driven / ENGINE_INERTIA);
    } else {
        slip_update(&s->slip, slip, held - constant_slip(m, s->engine_torque), change);
    }
}

/* Store what acts in the coming period. */
static void advance(least_jerk *s, const ddct_measurement *m, double request)
{
    s->torque_before = s->torque;
    s->torque = weighted(MEAN, &s->model);
    s->engine_torque = m->engine_torque;
    actuator_advance(&s->model, request);
}

/* Return whether locked plates have parted. */
static int lock_update(least_jerk *s, double slip)
{
    if (s->phase == SLIPPING) {
        s->count = size_of(slip) < LOCKED_SPEED ? s->count + 1 : 0;
        if (s->count >= DWELL_STEPS) {
            s->phase = CONFIRMING;
            s->count = s->apart = 0;
        }
        return 0;
    }
    s->apart = size_of(slip) > PARTED_SPEED ? s->apart + 1 : 0;
    if (s->apart >= PARTED_STEPS) {
        s->phase = SLIPPING;
        s->count = 0;
        return 1;
    }
    if (s->phase == CONFIRMING) {
        ++s->count;
        if (s->count > CONFIRMING_STEPS) {
            s->phase = CLOSED;
        }
    }
    return 0;
}

/* Start a plan for plates that have parted again. */
static void part(least_jerk *s, const ddct_measurement *m)
{
    const double held = carried(&s->clutch, s->model.request);
    const double needed = size_of(constant_slip(m, s->demand.level));
    plan_start(&s->plan, smaller(held, PARTED_SHARE * needed + PARTED_TORQUE));
    s->plan.hurries = 1;
    s->plan.falling = 0;
}

/* Move the plan by a period, to the time at which a new request acts. */
static void move(least_jerk *s, const ddct_measurement *m)
{
    const double level = s->demand.level, needed = constant_slip(m, level);
    const double rise = rise_of(s, m), ahead = LAG + SMOOTHING, error = s->slip.surplus_error;
    double passed = s->clutch.gain * weighted(TOTAL, &s->model);
    passed += AHEAD * (s->clutch.offset + error - needed - 0.5 * rise * LAG);
    double momentum = RIGID_INERTIA * s->slip.slip - PERIOD * passed;
    momentum -= SMOOTHING * (s->plan.smoothed + error - needed - rise * LAG);
    double left = time_left(m->slip_reference[0], m->slip_reference_rate[0]);
    if (STICKS) {
        const double least =
            earliest(m->engine_speed, m->shaft_speed, level, needed, s->plan.rate);
        left = larger(left, smaller(least, left + LATEST));
    }
    plan_move(&s->plan, momentum, needed + rise * ahead - error, left - ahead, rise);
    const double engine_torque = level + s->demand.rate * ahead;
    s->plan.torque = guarded(s->plan.torque, m->engine_speed, engine_torque);
}

int32_t ddct_controller_hold(void *state, const ddct_measurement *m)
{
    least_jerk *s = state;
    if (!all_usable(m)) {
        return -1;
    }
#if SHAPING_STEPS
    shaped_hold(&s->engine, m->engine_torque);
#endif
    observe(s, m, !SHIFTS && !s->on);
    if (s->on) {
        s->phase = CLOSED;
    }
    const double request = larger(m->open_loop_torque, 0.0);
    advance(s, m, request);
    /* The plan begins without the noise of C_m, which the open loop has. */
    double noise = constant_slip(m, m->engine_torque);
    noise -= constant_slip(m, s->demand.level);
    plan_start(&s->plan, s->clutch.applied_gain * larger(request - noise, 0.0)
                             + s->clutch.applied_offset);
    return 0;
}

int32_t ddct_controller_update(void *state, const ddct_measurement *m, ddct_command *command)
{
    least_jerk *s = state;
    if (!all_usable(m)) {
        return -1;
    }
#if SHAPING_STEPS
    ddct_measurement driven = *m;
    driven.engine_torque = shaped_update(&s->engine, m->engine_torque, s->phase == CLOSED);
    command->engine_torque = s->engine.mean;
    m = &driven;
#endif
    observe(s, m, s->phase == SLIPPING && !s->opening);
    s->opening = s->opening > 0 ? s->opening - 1 : 0;
    const double slip = m->engine_speed - m->shaft_speed;
    if (!s->on) {
        s->on = 1;
        if (SHIFTS) {
            plan_start(&s->plan, constant_slip(m, s->demand.level));
        }
        if (STICKS) {
            s->phase = size_of(slip) < AT_START_SPEED ? CLOSED : SLIPPING;
            s->count = s->apart = 0;
        }
    } else if (STICKS && lock_update(s, slip)) {
        part(s, m);
    }
    const double before = larger(s->plan.torque, s->plan.smoothed);
    if (s->phase == SLIPPING) {
        move(s, m);
    } else if (s->phase == CONFIRMING) {
        const double rate = larger(s->plan.rate, EASY_RATE) + larger(rise_of(s, m), 0.0);
        s->plan.torque = before + PERIOD * rate;
    } else {
        const double more = before + PERIOD * CLOSING_RATE;
        s->plan.torque = smaller(more, MOST_REQUEST * s->clutch.gain);
    }
    const double share = s->phase == SLIPPING ? SMOOTHING_SHARE : 1.0;
    s->plan.smoothed += share * (s->plan.torque - s->plan.smoothed);
    const double request =
        larger((s->plan.smoothed - s->clutch.applied_offset) / s->clutch.applied_gain, 0.0);
    advance(s, m, request);
    command->clutch_torque = request - m->open_loop_torque;
    return s->phase;
}

/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
static double size_of(double value)
{
    return value < 0.0 ? -value : value;
}

/* Torque of G_a(s) behind a delay of one period. */
typedef struct {
    double states[STATES];
    /* Request of the period before in N m, which acts in the coming one. */
    double request;
} actuator;

static void actuator_reset(actuator *s, double request)
{
    for (int i = 0; i < STATES; ++i) {
        s->states[i] = AT_REST[i] * request;
    }
    s->request = request;
}

static double weighted(const double *weights, const actuator *s)
{
    double sum = weights[0] * s->states[0];
    for (int i = 1; i < STATES; ++i) {
        sum += weights[i] * s->states[i];
    }
    return sum + weights[STATES] * s->request;
}

static void actuator_advance(actuator *s, double request)
{
    double next[STATES];
    for (int i = 0; i < STATES; ++i) {
        double sum = STEP[i][0] * s->states[0];
        for (int j = 1; j < STATES; ++j) {
            sum += STEP[i][j] * s->states[j];
        }
        next[i] = sum + HELD[i] * s->request;
    }
    for (int i = 0; i < STATES; ++i) {
        s->states[i] = next[i];
    }
    s->request = request;
}

/* Kalman filter of w_m, the wear gain and an offset of the torque that the clutch carries. */
typedef struct {
    double gain, offset, applied_gain, applied_offset;
    double speed, ss, sg, sd, gg, gd, dd;
} carried_torque;

static void carried_reset(carried_torque *s)
{
    s->gain = s->applied_gain = 1.0;
    s->offset = s->applied_offset = 0.0;
    s->speed = 0.0;
    s->ss = SPEED_VARIANCE;
    s->sg = s->sd = s->gd = 0.0;
    s->gg = INITIAL_GAIN_VARIANCE;
    s->dd = INITIAL_OFFSET_VARIANCE;
}

static double carried(const carried_torque *s, double torque)
{
    return s->gain * torque + s->offset;
}

static void carried_follow(carried_torque *s, double speed)
{
    s->speed = speed;
    s->ss = SPEED_VARIANCE;
    s->sg = s->sd = 0.0;
}

static void carried_update(carried_torque *s, double speed, double engine_torque, double torque)
{
    const double driven = engine_torque - ENGINE_DAMPING * s->speed - carried(s, torque);
    const double predicted = s->speed + SPEED_STEP * driven;
    /* Prediction of the covariance. */
    const double by_gain = SPEED_STEP * torque;
    const double spread_g = s->sg - by_gain * s->gg - SPEED_STEP * s->gd;
    const double spread_d = s->sd - by_gain * s->gd - SPEED_STEP * s->dd;
    double spread = s->ss - by_gain * (s->sg + spread_g) - SPEED_STEP * (s->sd + spread_d);
    spread += PROCESS_VARIANCE;
    const double gain_spread = s->gg + (torque > LEAST_TORQUE ? GAIN_DRIFT_VARIANCE : 0.0);
    const double offset_drift = OFFSET_DRIFT * torque / AT_TORQUE;
    const double offset_spread = s->dd + offset_drift * offset_drift;
    /* Correction by the measured speed. */
    const double innovation = spread + SPEED_VARIANCE;
    const double k_s = spread / innovation, k_g = spread_g / innovation;
    const double k_d = spread_d / innovation, error = speed - predicted;
    s->speed = predicted + k_s * error;
    s->gain = smaller(larger(s->gain + k_g * error, LOWEST_GAIN), HIGHEST_GAIN);
    s->offset += k_d * error;
    s->applied_gain += APPLIED_SHARE * (s->gain - s->applied_gain);
    s->applied_offset += APPLIED_SHARE * (s->offset - s->applied_offset);
    s->ss = spread - k_s * spread;
    s->sg = spread_g - k_s * spread_g;
    s->sd = spread_d - k_s * spread_d;
    s->gg = gain_spread - k_g * spread_g;
    s->gd -= k_g * spread_d;
    s->dd = offset_spread - k_d * spread_d;
}

/* Observer of the slip of a rigid car, and of an error of the surplus torque. */
typedef struct {
    double slip, surplus_error, torque_rate;
} rigid_slip;

static void slip_follow(rigid_slip *s, double measured, int keep)
{
    s->slip = measured;
    s->torque_rate = 0.0;
    if (!keep) {
        s->surplus_error = 0.0;
    }
}

static void slip_update(rigid_slip *s, double measured, double surplus, double change)
{
    s->torque_rate += TORQUE_RATE_SHARE * (change / PERIOD - s->torque_rate);
    const double predicted = s->slip - PERIOD / RIGID_INERTIA * (surplus + s->surplus_error);
    const double error = measured + SHAFT_TWIST * s->torque_rate - predicted;
    s->slip = predicted + SLIP_SHARE * error;
    s->surplus_error -= SURPLUS_SHARE * error;
}

static void slip_update_held_shaft(rigid_slip *s, double measured, double rate)
{
    const double predicted = s->slip + PERIOD * rate;
    s->slip = predicted + SLIP_SHARE * (measured - predicted);
    s->surplus_error = 0.0;
}

/* Level and rate of C_m: a line through its values since it last changed. */
typedef struct {
    double level, rate, mean;
    int count;
} demand_trend;

static void demand_update(demand_trend *s, double engine_torque)
{
    if (s->count == 0) {
        s->level = engine_torque;
        s->count = 1;
        return;
    }
    const double predicted = s->level + PERIOD * s->rate;
    const double error = engine_torque - predicted;
    s->mean += MEAN_SHARE * (error - s->mean);
    s->count = s->count < LONGEST ? s->count + 1 : LONGEST;
    if (size_of(error) > EXPLAINED) {
        s->count = s->count < AFTER_STEP ? s->count : AFTER_STEP;
    } else if (size_of(s->mean) > EXPLAINED_MEAN) {
        s->count = s->count < AFTER_DRIFT ? s->count : AFTER_DRIFT;
    }
    const double count = (double)s->count, both = count * (count + 1.0);
    s->level = predicted + 2.0 * (2.0 * count - 1.0) / both * error;
    s->rate += 6.0 / both / PERIOD * error;
}

/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/* Least |dy/dt| with which slip and surplus are zero after a time. */
static double least_rate(double momentum, double surplus, double time_s)
{
    time_s = larger(time_s, SHORTEST);
    const double half = 2.0 * larger(momentum, 0.0) - surplus * time_s;
    const double kept = surplus * time_s;
    return (half + sqrt(half * half + kept * kept)) / (time_s * time_s);
}

/* Rate of the fall after a rise at `rising`; the least rate where nothing is left to rise. */
static double falling_rate(double momentum, double surplus, double time_s, double rising)
{
    time_s = larger(time_s, SHORTEST);
    const double least = least_rate(momentum, surplus, time_s);
    const double missing = 2.0 * larger(momentum, 0.0) - surplus * time_s;
    if (rising <= least || surplus < 0.0 || missing <= 0.0) {
        return least;
    }
    const double rise = missing / (surplus + rising * time_s);
    return (surplus + rising * rise) / (time_s - rise);
}

/* Surplus from which a fall at `rate` ends the slip at the surplus `end`. */
static double final_surplus(double momentum, double rate, double end)
{
    const double corner = rate / BAND;
    if (end >= corner) {
        return sqrt(end * end + 2.0 * rate * larger(momentum, 0.0));
    }
    const double least = (corner - end) / BAND;
    if (momentum <= least) {
        return end + BAND * momentum;
    }
    return sqrt(corner * corner + 2.0 * rate * (momentum - least));
}

static double time_left(double speed, double rate)
{
    if (speed <= 0.0) {
        return 0.0;
    }
    return rate < 0.0 ? speed / -rate : LEVEL;
}

/* The planned torque, the same behind its low-pass, and the rate of the plan. */
typedef struct {
    double torque, smoothed, rate, needed, rise, least_time;
    int falling, has_needed, hurries, moves;
} torque_plan;

static void plan_start(torque_plan *s, double torque)
{
    s->torque = s->smoothed = torque;
    s->needed = s->rise = 0.0;
    s->has_needed = 0;
    s->least_time = LEAST_TIME;
    s->hurries = HURRIES;
    s->moves = 0;
}

/* J_r w_d at the rate of the way down, for J_r s. */
static double twisted_of(const torque_plan *s, double momentum)
{
    const double squared = BAND * BAND, ending = momentum / (1.0 - TWIST * squared);
    return ending * squared <= s->rate ? ending : momentum + TWIST * s->rate;
}

static double final_of(const torque_plan *s, double momentum)
{
    const double twisted = twisted_of(s, momentum);
    if (!STICKS) {
        return final_surplus(twisted, s->rate, 0.0);
    }
    return final_surplus(larger(twisted, 0.0), s->rate, END * (s->rate + s->rise));
}

static double way_down(const torque_plan *s, double momentum, double surplus)
{
    const double twisted = twisted_of(s, momentum);
    if (twisted * BAND * BAND <= s->rate) {
        return 0.0;
    }
    surplus = larger(surplus, 0.0);
    return surplus * surplus / (2.0 * twisted);
}

static void choose_rate(torque_plan *s, double momentum, double surplus, double left,
                        double refilling)
{
    double least = LEAST_SHARE * EASY_RATE;
    if (!STICKS) {
        const double sign = momentum < 0.0 ? -1.0 : 1.0;
        momentum = sign * momentum;
        surplus = sign * surplus;
        least = EASY_RATE;
    } else if (s->falling) {
        if (surplus < MISSED * final_of(s, momentum)) {
            s->falling = 0;
            s->hurries = 1;
        } else {
            const double steeper = way_down(s, momentum, surplus);
            if (steeper > CATCH_UP * s->rate) {
                s->rate = steeper;
            }
        }
        return;
    }
    const double twisted = twisted_of(s, momentum);
    const double late = falling_rate(twisted, surplus, left + LATEST, refilling);
    const double in_time = falling_rate(twisted, surplus, left, refilling);
    least = larger(least, way_down(s, momentum, surplus));
    s->rate = larger(smaller(larger(EASY_RATE, late), in_time), least);
}

static double rise_to(const torque_plan *s, double needed)
{
    return s->has_needed ? needed - s->needed : 0.0;
}

/* Follow the way down; errors are corrected the slower, the longer it still takes. */
static void plan_fall(torque_plan *s, double momentum, double needed, double final)
{
    const double surplus = s->torque - needed;
    double change = final_of(s, momentum - PERIOD * surplus) - final + rise_to(s, needed);
    const double share = smaller(CORRECTION * PERIOD * s->rate / larger(final, 1e-9), 1.0);
    change += share * (final - surplus);
    const double most = PERIOD * s->rate * CATCH_UP;
    s->torque += smaller(larger(change, -most), most);
}

static void plan_move(torque_plan *s, double momentum, double needed, double left, double rise)
{
    s->rise = larger(rise, 0.0);
    const double surplus = s->torque - needed;
    double refilling = 0.0;
    if (!s->hurries) {
        refilling = larger(needed, 0.0) * REFILL;
        left = larger(left, s->least_time);
        s->least_time -= PERIOD;
    }
    choose_rate(s, momentum, surplus, left, refilling);
    const double share = smaller(larger((double)(s->moves - OPENING) / REFILLING, 0.0), 1.0);
    s->moves += 1;
    const double final = final_of(s, momentum), aim = needed + final;
    if (!s->falling && s->torque >= aim) {
        s->falling = 1;
    }
    if (!s->falling) {
        const double rising = s->rate + share * larger(refilling - s->rate, 0.0);
        s->torque += smaller(aim - s->torque, PERIOD * rising);
    } else if (STICKS && twisted_of(s, momentum) <= 0.0 && surplus <= final + GENTLE * s->rate) {
        s->torque += PERIOD * s->rate + larger(rise_to(s, needed), 0.0);
    } else {
        plan_fall(s, momentum, needed, final);
    }
    s->needed = needed;
    s->has_needed = 1;
}

/* Keep the engine from a stall and from its limiter. */
static double guarded(double torque, double engine_speed, double engine_torque)
{
    const double least = engine_torque - PER_SPEED * (HIGHEST_SPEED - engine_speed);
    const double most = engine_torque + PER_SPEED * (engine_speed - LEAST_SPEED);
    return larger(smaller(smaller(larger(torque, least), most), MOST_TORQUE), 0.0);
}

/* Time until a lock leaves the engine above the speed of idle control. */
static double earliest(double engine_speed, double shaft_speed, double engine_torque,
                       double needed, double rate)
{
    const double driven = engine_torque - ENGINE_DAMPING * engine_speed - needed;
    if (driven <= 0.0 || IDLE_SPEED <= 0.0) {
        return 0.0;
    }
    const double dip = 0.5 * driven * driven / (ENGINE_INERTIA * larger(rate, LEAST_RATE));
    const double total = ENGINE_INERTIA * engine_speed + VEHICLE_INERTIA * shaft_speed;
    const double least = IDLE_SPEED + smaller(dip, MOST_DIP);
    return (least - total / (ENGINE_INERTIA + VEHICLE_INERTIA)) * ENGINE_INERTIA / driven;
}

/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/* The engine, as far as a controller may move it away from the driver's demand: the deviation
 * requested is limited, then its rate, then it passes a lag; last, the torque is limited. */

static double limited(double value, double limit)
{
    return smaller(larger(value, -limit), limit);
}

/* Return C_m over the coming period, and store the request. */
static double deliver(ddct_mpc *s, double demand, double request)
{
    const double requested = limited(request - demand, MOST_DEVIATION);
    s->engine_asked += limited(requested - s->engine_asked, MOST_CHANGE);
    s->engine_deviation += LAG_SHARE * (s->engine_asked - s->engine_deviation);
    return smaller(larger(demand + s->engine_deviation, LEAST_TORQUE), MOST_TORQUE);
}

/* The deviation nearest to that which gives `torque` that may be requested `periods` ahead. */
static double reachable(const ddct_mpc *s, double demand, double torque, double periods)
{
    const double deviation = limited(torque - demand, MOST_DEVIATION);
    return s->engine_asked + limited(deviation - s->engine_asked, periods * MOST_CHANGE);
}

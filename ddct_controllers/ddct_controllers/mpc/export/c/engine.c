/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/* The engine, as far as a controller may move it away from the driver's demand. */
static double limited(double value, double limit)
{
    return smaller(larger(value, -limit), limit);
}

/* Return C_m over the coming period: the deviation requested is limited, then its rate, which gives
 * the deviation asked for; that passes a lag; last, the torque is limited. */
static double deliver(double *asked, double *deviation, double demand, double request)
{
    const double requested = limited(request - demand, MOST_DEVIATION);
    *asked += limited(requested - *asked, MOST_CHANGE);
    *deviation += LAG_SHARE * (*asked - *deviation);
    return smaller(larger(demand + *deviation, LEAST_ENGINE_TORQUE), MOST_ENGINE_TORQUE);
}

/* The deviation nearest to that which gives `torque` that may be requested `periods` ahead. */
static double reachable(const ddct_mpc *s, double demand, double torque, double periods)
{
    const double deviation = limited(torque - demand, MOST_DEVIATION);
    return s->engine_asked + limited(deviation - s->engine_asked, periods * MOST_CHANGE);
}

/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/* The deviation nearest to that which gives `torque` that may be requested `periods` ahead. */
static double reachable(const ddct_mpc *s, double demand, double torque, double periods)
{
    const double deviation = limited(torque - demand, MOST_DEVIATION);
    return s->engine_asked + limited(deviation - s->engine_asked, periods * MOST_CHANGE);
}

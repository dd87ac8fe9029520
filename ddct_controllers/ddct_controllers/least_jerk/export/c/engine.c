/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/* The mean of the demands of the last steps, within the authority over the engine. */
typedef struct {
    double demands[SHAPING_STEPS], mean, last, asked, deviation;
    int next, waited;
} shaped_demand;

static void shaped_hold(shaped_demand *d, double demand)
{
    for (int i = 0; i < SHAPING_STEPS; ++i) {
        d->demands[i] = demand;
    }
    d->mean = d->last = demand;
    d->next = d->waited = 0;
    deliver(&d->asked, &d->deviation, demand, demand);
}

static void shaped_reset(shaped_demand *d)
{
    d->asked = d->deviation = 0.0;
    shaped_hold(d, 0.0);
}

/* Return C_m over the coming period; the request is the mean. */
static double shaped_update(shaped_demand *d, double demand, int closed)
{
    d->waited = closed ? 0 : d->waited + 1;
    if (d->waited == 0 || d->waited > WAIT_STEPS) {
        d->last = demand;
    }
    d->mean += (d->last - d->demands[d->next]) / SHAPING_STEPS;
    d->demands[d->next] = d->last;
    d->next = (d->next + 1) % SHAPING_STEPS;
    return deliver(&d->asked, &d->deviation, demand, d->mean);
}

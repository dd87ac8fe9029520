/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/* Functions of one and two numbers. As min and max of Python, the first two return the first one of
 * two that are equal. */
static double smaller(double first, double second)
{
    return second < first ? second : first;
}

static double larger(double first, double second)
{
    return second > first ? second : first;
}

/* Whether a measured value can be used: it is finite, and no absurd number. */
static int usable(double value)
{
    return value >= -MOST_MEASURED && value <= MOST_MEASURED;
}

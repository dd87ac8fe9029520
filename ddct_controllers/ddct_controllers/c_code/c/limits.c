/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/* As min and max of Python: the first one of two that are equal. */
static double smaller(double first, double second)
{
    return second < first ? second : first;
}

static double larger(double first, double second)
{
    return second > first ? second : first;
}

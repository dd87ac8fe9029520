/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/*
 * Read measurements from standard input, one a line, and print the commands.
 *
 *     cc -std=c99 -O2 ddct_mpc.c ddct_mpc_example.c -o example && ./example < measurements.csv
 *
 * Columns: 1 with feedback on and 0 with feedback off, then the fields of
 * ddct_mpc_measurement in their order, an array's entries one after the other. Printed are
 * clutch_torque, engine_torque, status and iterations.
 */
#include <stdio.h>
#include <stdlib.h>

#include "ddct_mpc.h"

enum { SCALARS = 6, COLUMNS = 1 + SCALARS + 2 * DDCT_MPC_REFERENCES };

static int read_line(char *text, double *values)
{
    for (int i = 0; i < COLUMNS; ++i) {
        char *end;
        values[i] = strtod(text, &end);
        if (end == text || *end != (i + 1 < COLUMNS ? ',' : '\n')) {
            return 0;
        }
        text = end + 1;
    }
    return 1;
}

static ddct_mpc_measurement measurement(const double *values)
{
    ddct_mpc_measurement m = {
        .engine_speed = values[0],
        .shaft_speed = values[1],
        .wheel_speed = values[2],
        .engine_torque = values[3],
        .load_torque = values[4],
        .open_loop_torque = values[5],
    };
    for (int i = 0; i < DDCT_MPC_REFERENCES; ++i) {
        m.slip_reference[i] = values[SCALARS + i];
        m.slip_reference_rate[i] = values[SCALARS + DDCT_MPC_REFERENCES + i];
    }
    return m;
}

int main(void)
{
    static char text[32 * COLUMNS];
    ddct_mpc controller;
    long line = 0;
    ddct_mpc_reset(&controller);
    while (fgets(text, (int)sizeof text, stdin) != NULL) {
        double values[COLUMNS];
        ++line;
        if (!read_line(text, values)) {
            fprintf(stderr, "line %ld does not hold %d numbers with commas between them\n", line,
                    (int)COLUMNS);
            return EXIT_FAILURE;
        }
        const ddct_mpc_measurement m = measurement(values + 1);
        if (values[0] != 0.0) {
            const ddct_mpc_command command = ddct_mpc_update(&controller, &m);
            printf("%.17g,%.17g,%d,%d\n", command.clutch_torque, command.engine_torque,
                   (int)command.status, command.iterations);
        } else {
            printf("0,0,%d,0\n", (int)ddct_mpc_hold(&controller, &m));
        }
    }
    return EXIT_SUCCESS;
}

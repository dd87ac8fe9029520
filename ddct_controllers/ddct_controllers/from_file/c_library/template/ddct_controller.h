/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/*
 * A clutch controller as a shared library, version 1 of the interface.
 *
 * A library holds the object `ddct_controller` and the functions below. All numbers are SI: rad/s,
 * rad/s^2, m/s, N m. A clutch torque above 0 slows the engine and drives the car. ddct calls
 * `update` (or `hold`) exactly once every 10 ms, in a process that has this run alone.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef DDCT_CONTROLLER_H
#define DDCT_CONTROLLER_H

#include <stdint.h>

#define DDCT_INTERFACE_VERSION 1

/* What is known at step k. */
typedef struct {
    /* k; time is k x 10 ms. */
    int64_t step;
    /* w_m, rad/s: measured speed of the engine. */
    double engine_speed;
    /* w_p, rad/s: measured speed of the primary shaft. Slip is w_d = w_m - w_p. */
    double shaft_speed;
    /* w_r, rad/s: measured speed of the driven wheel. */
    double wheel_speed;
    /* V_x, m/s. */
    double vehicle_speed;
    /* C_m, N m, over the coming period: what the engine delivers, or, where `commands_engine` is 1,
     * what the driver demands. */
    double engine_torque;
    /* C_load, N m: road load on the wheel, computed from vehicle speed and slope. */
    double load_torque;
    /* C_fOL, N m: what is added to the command's clutch_torque. */
    double open_loop_torque;
    /* rad/s: the wanted slip; entry i, up to `preview_steps`, is that of i periods ahead. */
    const double *slip_reference;
    /* rad/s^2: its derivative, as many entries. */
    const double *slip_reference_rate;
} ddct_measurement;

/* The answer, which holds over the coming period. Both are NaN before the call. */
typedef struct {
    /* N m: the request to the clutch is open_loop_torque + clutch_torque. */
    double clutch_torque;
    /* C_m, N m: read only where `commands_engine` is 1. */
    double engine_torque;
} ddct_command;

/* Description of the library; DDCT_DESCRIPTION fills it in. */
typedef struct {
    int32_t interface_version;
    int32_t measurement_bytes;
    int32_t command_bytes;
    /* Size of what `state` points to in the functions below. ddct allocates it, once for each
     * controller, so that two of them do not share it. */
    int32_t state_bytes;
    /* How many steps beyond the present one the reference is wanted for. */
    int32_t preview_steps;
    /* 1 for a controller that commands the engine too, else 0. */
    int32_t commands_engine;
} ddct_description;

#define DDCT_DESCRIPTION(state, preview_steps, commands_engine)                                 \
    {DDCT_INTERFACE_VERSION, (int32_t)sizeof(ddct_measurement), (int32_t)sizeof(ddct_command),  \
     (int32_t)sizeof(state), (preview_steps), (commands_engine)}

extern const ddct_description ddct_controller;

/* Return to the state before the first step. Called before all others. Every byte of the state is
 * 0xff before it, which makes each double NaN: set all that the others read. */
void ddct_controller_reset(void *state);

/* Advance by one period. Return 0, or a number above 0 that is recorded with the command, or one
 * below 0 to end the run. */
int32_t ddct_controller_update(void *state, const ddct_measurement *m, ddct_command *command);

/* Pass a period in which only open_loop_torque acts, so that an observer can follow; return as
 * `update` does. A library may leave this one out: `reset` is then called in its place. */
int32_t ddct_controller_hold(void *state, const ddct_measurement *m);

#endif

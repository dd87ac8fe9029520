/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
#ifndef DDCT_MPC_H
#define DDCT_MPC_H

@SIZES@

/* Inputs of the controller for one period. Every number must lie within +-1e9. */
typedef struct {
    /* w_m, rad/s: measured speed of the engine. */
    double engine_speed;
    /* w_p, rad/s: measured speed of the primary shaft. Slip is w_d = w_m - w_p. */
    double shaft_speed;
    /* w_r, rad/s: measured speed of the driven wheel. */
    double wheel_speed;
    /* C_m, N m, over the coming period: what the engine delivers, or, where
     * DDCT_MPC_COMMANDS_ENGINE is 1, what the driver demands. */
    double engine_torque;
    /* C_load, N m: road load on the wheel, computed from vehicle speed and slope. */
    double load_torque;
    /* C_fOL, N m: what the caller adds to the command's clutch_torque; 0 if nothing. */
    double open_loop_torque;
    /* rad/s: the wanted slip; entry i is that of i periods ahead, entry 0 that of now. */
    double slip_reference[DDCT_MPC_REFERENCES];
    /* rad/s^2: its derivative. Not read where DDCT_MPC_READS_REFERENCE_RATE is 0. */
    double slip_reference_rate[DDCT_MPC_REFERENCES];
} ddct_mpc_measurement;

typedef enum {
    DDCT_MPC_SOLVED = 0,
    /* No solution was found; the rest of the last plan is followed within the limits. */
    DDCT_MPC_ITERATION_LIMIT = 1,
    DDCT_MPC_INFEASIBLE = 2,
    /* A number is NaN or beyond +-1e9: the state is as before the call. */
    DDCT_MPC_BAD_MEASUREMENT = 3
} ddct_mpc_status;

typedef struct {
    /* N m. Ask the clutch for open_loop_torque + clutch_torque, at least 0, over the coming
     * period. After a bad measurement it is that of the period before. */
    double clutch_torque;
    /* Request for C_m in N m over the coming period; 0 and without meaning where
     * DDCT_MPC_COMMANDS_ENGINE is 0. */
    double engine_torque;
    ddct_mpc_status status;
    /* Changes of the solver's active set, at most DDCT_MPC_ITERATIONS. */
    int iterations;
} ddct_mpc_command;

/* State from call to call. The caller owns it and need not read it. */
typedef struct {
    /* Observer's estimate for the coming period, in the model's coordinates. */
    double state[DDCT_MPC_STATES];
    /* The solver's last solution, N m: moves still to come. */
    double plan[DDCT_MPC_MOVES];
    /* Torques of the period before, N m. */
    double own_torque;
    double open_loop_torque;
    /* Request for C_m, its deviation from the demand without and with the engine's lag; N m, 0
     * where DDCT_MPC_COMMANDS_ENGINE is 0. */
    double engine_request;
    double engine_asked;
    double engine_deviation;
    /* Number of steps on a plan for want of a solution; stays at its largest value. */
    unsigned long fallbacks;
    /* Whether there was a measurement since the reset. */
    int started;
} ddct_mpc;

/* Clear the state. Call it once before the first of the others. */
void ddct_mpc_reset(ddct_mpc *s);

/* Call every DDCT_MPC_PERIOD_S while only the open-loop torque acts on the clutch and the engine
 * follows the driver: the observer follows the plant. */
ddct_mpc_status ddct_mpc_hold(ddct_mpc *s, const ddct_mpc_measurement *m);

/* Call every DDCT_MPC_PERIOD_S while the controller acts. */
ddct_mpc_command ddct_mpc_update(ddct_mpc *s, const ddct_mpc_measurement *m);

#endif

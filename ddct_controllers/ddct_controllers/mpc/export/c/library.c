/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
/*
 * The controller behind the interface of ddct_controller.h, as ddct runs it from a file with
 * `c_library: {file: ddct_mpc.so}`:
 *
 *     cc -std=c99 -O2 -shared -fPIC ddct_mpc.c ddct_mpc_library.c -o ddct_mpc.so
 */
#include "ddct_controller.h"
#include "ddct_mpc.h"

const ddct_description ddct_controller =
    DDCT_DESCRIPTION(ddct_mpc, DDCT_MPC_REFERENCES - 1, DDCT_MPC_COMMANDS_ENGINE);

static ddct_mpc_measurement taken(const ddct_measurement *m)
{
    ddct_mpc_measurement taken = {
        .engine_speed = m->engine_speed,
        .shaft_speed = m->shaft_speed,
        .wheel_speed = m->wheel_speed,
        .engine_torque = m->engine_torque,
        .load_torque = m->load_torque,
        .open_loop_torque = m->open_loop_torque,
    };
    for (int i = 0; i < DDCT_MPC_REFERENCES; ++i) {
        taken.slip_reference[i] = m->slip_reference[i];
        taken.slip_reference_rate[i] = m->slip_reference_rate[i];
    }
    return taken;
}

/* A bad measurement ends the run, as in Python. */
static int32_t returned(ddct_mpc_status status)
{
    return status == DDCT_MPC_BAD_MEASUREMENT ? -1 : (int32_t)status;
}

void ddct_controller_reset(void *state)
{
    ddct_mpc_reset(state);
}

int32_t ddct_controller_hold(void *state, const ddct_measurement *m)
{
    const ddct_mpc_measurement measurement = taken(m);
    return returned(ddct_mpc_hold(state, &measurement));
}

int32_t ddct_controller_update(void *state, const ddct_measurement *m, ddct_command *command)
{
    const ddct_mpc_measurement measurement = taken(m);
    const ddct_mpc_command answer = ddct_mpc_update(state, &measurement);
    command->clutch_torque = answer.clutch_torque;
    command->engine_torque = answer.engine_torque;
    return returned(answer.status);
}

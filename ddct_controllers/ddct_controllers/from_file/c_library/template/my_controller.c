/* A PI controller of the slip, as a start for your own. */
#include "ddct_controller.h"

#define PERIOD_S 0.01
#define RPM_PER_RAD_S 9.549296585513721

/* N m/rpm and N m/(rpm s). The YAML file may give global variables other values, under `parameters`. */
double proportional_gain = 0.1, integral_gain = 0.1;

typedef struct {
    double integral_rpm_s;
} my_state;

const ddct_description ddct_controller = DDCT_DESCRIPTION(my_state, 0, 0);

void ddct_controller_reset(void *state)
{
    my_state *s = state;
    s->integral_rpm_s = 0.0;
}

int32_t ddct_controller_update(void *state, const ddct_measurement *m, ddct_command *command)
{
    my_state *s = state;
    const double slip = m->engine_speed - m->shaft_speed;
    const double error_rpm = (m->slip_reference[0] - slip) * RPM_PER_RAD_S;
    /* Too little slip, an error above 0, needs less torque. */
    command->clutch_torque =
        -(proportional_gain * error_rpm + integral_gain * s->integral_rpm_s);
    s->integral_rpm_s += PERIOD_S * error_rpm;
    return 0;
}

/* The loops of the tests, as a C programmer writes them. `tests/tests/capi/cases.rs` writes the same for the core. */
#ifndef CASES_H
#define CASES_H

#include "ctl.h"

enum { CASE_PID, CASE_ESTIMATOR, CASE_OBSERVER, CASE_FULL, CASE_OTHER_ESTIMATOR, CASES };

static void pid_case(ctl_config *c)
{
    c->kp = 2.0;
    c->ki = 1.0;
    c->kd = 0.2;
    c->tf = 0.05;
    c->output_lo = 0.0;
    c->output_hi = 3.0;
}

/* Eq. (13) of the chapter; 4.74 samples of dead time. */
static void estimator_case(ctl_config *c)
{
    c->kp = 2.35;
    c->ki = 1.88;
    c->kd = 0.48;
    c->tf = 0.119;
    c->c = 1.0;
    c->output_lo = -2.0;
    c->output_hi = 2.5;
    c->output_rate_up = 20.0;
    c->compensator = CTL_COMPENSATOR_ESTIMATOR;
    c->kfd = 0.69;
    c->tfd = 0.06;
    c->model_gain = 1.0;
    c->model_pole_count = 1;
    c->model_pole_a1[0] = 1.2;
    c->model_pole_a2[0] = 0.2;
    c->model_dead_time = 0.237;
}

/* Third order with a zero; dead time and latency are 2.2 samples together. */
static void observer_case(ctl_config *c)
{
    c->kp = 0.8;
    c->ki = 0.7;
    c->output_lo = -1.5;
    c->output_hi = 1.5;
    c->anti_windup = CTL_ANTI_WINDUP_CONDITIONAL;
    c->integral_rule = CTL_INTEGRAL_TRAPEZOID;
    c->compensator = CTL_COMPENSATOR_OBSERVER;
    c->alpha = 0.15;
    c->filter_order = 4;
    c->latency = 0.03;
    c->model_gain = 1.5;
    c->model_dead_time = 0.08;
    c->model_pole_count = 2;
    c->model_pole_a1[0] = 0.6;
    c->model_pole_a2[0] = 0.25;
    c->model_pole_a1[1] = 0.4;
    c->model_zero_count = 1;
    c->model_zero_a1[0] = 0.11;
}

/* Every field has a value of its own. */
static void full_case(ctl_config *c)
{
    c->action = CTL_ACTION_DIRECT;
    c->integral_rule = CTL_INTEGRAL_TRAPEZOID;
    c->anti_windup = CTL_ANTI_WINDUP_BACK_CALCULATION;
    c->setpoint_track = 1;
    c->fallback_action = CTL_FALLBACK_RAMP;
    c->fallback_return = CTL_RETURN_ACKNOWLEDGED;
    c->hold_samples = 3;
    c->compensator = CTL_COMPENSATOR_OBSERVER;
    c->filter_order = 3;
    c->model_integrators = 1;
    c->model_pole_count = 1;
    c->model_zero_count = 0;
    c->kp = 1.1;
    c->ki = 0.31;
    c->kd = 0.21;
    c->tf = 0.09;
    c->b = 0.7;
    c->c = 0.3;
    c->output_lo = -1.7;
    c->output_hi = 1.9;
    c->output_rate_up = 11.0;
    c->output_rate_down = 13.0;
    c->setpoint_lo = -0.8;
    c->setpoint_hi = 1.3;
    c->setpoint_rate_up = 4.0;
    c->setpoint_rate_down = 5.0;
    c->tt = 0.9;
    c->deadband = 0.01;
    c->measurement_lo = -6.0;
    c->measurement_hi = 7.0;
    c->offset_lo = -0.25;
    c->offset_hi = 0.35;
    c->fallback_output = 0.4;
    c->fallback_rate = 0.6;
    c->alarm_hi_hi = 1.1;
    c->alarm_hi = 0.9;
    c->alarm_lo = -0.3;
    c->alarm_lo_lo = -0.5;
    c->alarm_deviation = 0.45;
    c->alarm_hysteresis = 0.02;
    c->off_output = -0.15;
    c->initial_output = 0.22;
    c->latency = 0.013;
    c->alpha = 0.33;
    c->model_gain = -1.4;
    c->model_dead_time = 0.11;
    c->model_pole_a1[0] = 0.37;
}

/* A first-order model: another shape than CASE_ESTIMATOR, another dead time. */
static void other_estimator_case(ctl_config *c)
{
    estimator_case(c);
    c->kp = 1.9;
    c->anti_windup = CTL_ANTI_WINDUP_NONE;
    c->model_pole_a1[0] = 1.1;
    c->model_pole_a2[0] = 0.0;
    c->model_dead_time = 0.31;
}

static int32_t set_case(int number, ctl_config *c)
{
    int32_t error = ctl_config_default(c, sizeof *c);
    c->ts = 0.05;
    switch (number) {
    case CASE_PID: pid_case(c); break;
    case CASE_ESTIMATOR: estimator_case(c); break;
    case CASE_OBSERVER: observer_case(c); break;
    case CASE_FULL: full_case(c); break;
    default: other_estimator_case(c); break;
    }
    return error;
}

#endif

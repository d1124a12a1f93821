/*
 * DOB first order: the loop of loops.toml, exported by controller-sim export --format c.
 *
 * Do not change numbers here: they have passed checks that this file cannot repeat. Change the design file and export
 * it again.
 *
 *     static LOOP_DOB_FIRST_ORDER_STATE(block);
 *     ctl_config config;
 *     loop_dob_first_order_config(&config);
 *     ctl_f32_init(block, sizeof block, &config, NULL);
 *     every LOOP_DOB_FIRST_ORDER_TS seconds: ctl_f32_step(block, sizeof block, &in, &out);
 */
/* WARNING: a PV from -1000000.0 to 1000000.0 counts as good, also that of a broken sensor.
 * Write the range of the transmitter in the design file, key measurement with lo and hi; export again. */
#ifndef LOOP_DOB_FIRST_ORDER_H
#define LOOP_DOB_FIRST_ORDER_H

#include "ctl.h"

/* Sampling period [s]. */
#define LOOP_DOB_FIRST_ORDER_TS 0.01

/* Samples of delay that the block has room for. */
#define LOOP_DOB_FIRST_ORDER_DELAY 33

/* Declares the block. */
#define LOOP_DOB_FIRST_ORDER_STATE(name) CTL_F32_STATE(name, LOOP_DOB_FIRST_ORDER_DELAY)

/* Writes the whole configuration; CTL_OK, or the error of ctl_config_default. */
static inline int32_t loop_dob_first_order_config(ctl_config *config)
{
    int32_t error = ctl_config_default(config, sizeof *config);
    if (error != CTL_OK) {
        return error;
    }
    config->action = CTL_ACTION_REVERSE;
    config->integral_rule = CTL_INTEGRAL_TRAPEZOID;
    config->ts = 0.01;
    config->kp = 0.8;
    config->ki = 0.7;
    config->kd = 0.0;
    config->tf = 0.0;
    config->b = 1.0;
    config->c = 0.0;
    config->anti_windup = CTL_ANTI_WINDUP_BACK_CALCULATION;
    config->deadband = 0.0;
    config->output_lo = -10.0;
    config->output_hi = 10.0;
    config->setpoint_lo = -1000000.0;
    config->setpoint_hi = 1000000.0;
    config->setpoint_track = 0;
    config->measurement_lo = -1000000.0;
    config->measurement_hi = 1000000.0;
    config->offset_lo = -1000000.0;
    config->offset_hi = 1000000.0;
    config->hold_samples = 25;
    config->fallback_action = CTL_FALLBACK_HOLD;
    config->fallback_return = CTL_RETURN_AUTOMATIC;
    config->alarm_hysteresis = 0.0;
    config->initial_output = 0.0;
    config->compensator = CTL_COMPENSATOR_OBSERVER;
    config->alpha = 0.1;
    config->filter_order = 0;
    config->model_gain = 1.0;
    config->model_dead_time = 0.3333;
    config->model_integrators = 0;
    config->model_pole_count = 1;
    config->model_pole_a1[0] = 1.0;
    config->model_pole_a2[0] = 0.0;
    config->model_zero_count = 0;
    config->latency = 0.003;
    return CTL_OK;
}

#endif /* LOOP_DOB_FIRST_ORDER_H */

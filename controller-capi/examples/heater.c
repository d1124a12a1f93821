/*
 * A heater in C: PI controller with a disturbance observer on a tank that is simulated beside it.
 *
 *     cargo build -p controller-capi-staticlib --profile embedded
 *     cc -I controller-capi/include controller-capi/examples/heater.c target/embedded/libctl.a -o heater && ./heater
 *
 * At 60 s the set-point steps, at 300 s cold water takes 10 % of the heater's range.
 */
#include <stdio.h>

#include "ctl.h"

#define TS 1.0f
#define DELAY 5 /* dead time of the tank in samples */

/* A static block begins as zeros: not initialised until ctl_f32_init. */
static CTL_F32_STATE(loop, DELAY);

static int report(int32_t error, const ctl_faults *faults)
{
    fprintf(stderr, "%s\n", ctl_error_text(error));
    for (uint32_t i = 0; i < faults->count; i++) {
        const ctl_fault *f = &faults->list[i];
        fprintf(stderr, "  %s = %g %s\n", ctl_param_name(f->param), f->value, ctl_reason_text(f->reason));
    }
    return 1;
}

int main(void)
{
    ctl_config config;
    ctl_faults faults = {0}; /* stays so where init fails before it looks at the configuration */
    if (ctl_abi_version() != CTL_ABI_VERSION || ctl_config_default(&config, sizeof config) != CTL_OK) {
        return 1;
    }
    config.ts = TS;
    config.kp = 6.0;
    config.ki = 0.15;
    config.output_lo = 0.0;
    config.output_hi = 100.0;
    config.measurement_lo = 0.0;
    config.measurement_hi = 150.0;
    config.fallback_action = CTL_FALLBACK_SUBSTITUTE;
    config.fallback_output = 0.0; /* heater off when the sensor is gone */
    config.compensator = CTL_COMPENSATOR_OBSERVER;
    config.alpha = 8.0;
    config.model_gain = 0.8; /* 0.8 K per %, 40 s, dead time 5 s */
    config.model_pole_count = 1;
    config.model_pole_a1[0] = 40.0;
    config.model_dead_time = DELAY * TS;

    int32_t error = ctl_f32_init(loop, sizeof loop, &config, &faults);
    if (error != CTL_OK) {
        return report(error, &faults);
    }

    float temperature = 20.0f, heat[DELAY + 1] = {0};
    for (int k = 0; k <= 600; k++) {
        ctl_f32_input in = {0};
        ctl_f32_output out;
        in.r = k < 60 ? 20.0f : 60.0f;
        in.y = temperature;
        error = ctl_f32_step(loop, sizeof loop, &in, &out);
        if (error != CTL_OK) {
            fprintf(stderr, "%s\n", ctl_error_text(error));
            return 1;
        }
        if (k % 30 == 0) {
            printf("%4d s  %6.2f C  %6.2f %%  disturbance %6.2f %%  status %#x\n", k, (double)temperature,
                   (double)out.u, (double)out.d_hat, (unsigned)out.status);
        }
        heat[k % (DELAY + 1)] = out.u - (k < 300 ? 0.0f : 10.0f);
        temperature += TS / 40.0f * (20.0f + 0.8f * heat[(k + 1) % (DELAY + 1)] - temperature);
    }
    return 0;
}

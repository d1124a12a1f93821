// The header and the archive from C++: from rest, the first output of a PI controller with kp = 2, ki = 1,
// ts = 0.1 for a unit step is kp + ki*ts.
#include <cstdio>

#include "ctl.h"

int main()
{
    CTL_F64_STATE_WITHOUT_COMPENSATOR(loop) = {};
    ctl_config config;
    ctl_f64_input in = {};
    ctl_f64_output out;
    ctl_config_default(&config, sizeof config);
    config.ts = 0.1;
    config.kp = 2.0;
    config.ki = 1.0;
    if (ctl_f64_init(loop, sizeof loop, &config, nullptr) != CTL_OK) {
        return 1;
    }
    if (ctl_f64_settle(loop, sizeof loop, 0.0, 0.0, 0.0) != CTL_OK) {
        return 1;
    }
    in.r = 1.0;
    if (ctl_f64_step(loop, sizeof loop, &in, &out) != CTL_OK) {
        return 1;
    }
    std::printf("%.7f\n", out.u);
    return 0;
}

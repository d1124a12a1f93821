component ctl_loop "PID loop with disturbance estimator or observer, modes, limits and bumpless changes of parameters";

description """
A sampled loop with all that a process loop needs: a PID with one filter over all its terms and set-point weights, a
disturbance estimator or a disturbance observer that knows the dead time, range and rate of output and set-point, anti-windup
with read-back of what was really applied, manual, track, hold and cascade without a bump, and a rule for bad measurements.

\\fBts\\fR is the period of the thread. Gains, limits and all parameters may be changed at any time: the loop adopts them in
its next sample, without a bump. What it cannot run with it refuses: it goes on with what it had, says on the pins
\\fBrefused\\fR, \\fBfault-...\\fR and in the message log what is wrong, and tries again when something changes.

The first sample starts the loop at rest, at \\fBinitial-output\\fR or at what \\fBapplied\\fR says: the set-point that is
there when the loop starts makes no proportional kick.
""";

notes """
Modes in falling priority: \\fBenable\\fR false (off), \\fBtrack\\fR, fallback (no usable measurement), \\fBmanual\\fR,
\\fBhold\\fR, then automatic: on \\fBsetpoint-remote\\fR with \\fBcascade\\fR, else on \\fBsetpoint\\fR.

The model of the estimator or observer is model-gain * product(1 + model-zero-a1-N*s + model-zero-a2-N*s^2) *
exp(-model-dead-time*s) / (s^model-integrators * product(1 + model-pole-a1-N*s + model-pole-a2-N*s^2)). A factor whose a1 and
a2 are both 0 is absent.

Numbers of \\fBfault-code\\fR, \\fBfault-field\\fR, \\fBfault-reason\\fR, \\fBmode\\fR and the bits of \\fBstatus\\fR are
those of ctl.h: CTL_ERROR_..., CTL_PARAM_..., CTL_REASON_..., CTL_MODE_..., CTL_STATUS_....

Several values change together when \\fBparam-hold\\fR is true meanwhile. Adopting another model takes some 0.1 ms of one
period.
""";

see_also "\\fBpid\\fR(9), \\fBlowpass\\fR(9)";
author "The controller-core developers";
license "MIT OR Apache-2.0";

include "ctl.h";
include <rtapi_math.h>;

option no_convenience_defines yes;
option extra_setup yes;

modparam int max_delay = 1000 "Longest dead time and latency of a model, in samples; 8 bytes of HAL memory each, in every instance";

pin in float setpoint "Set-point in automatic";
pin in float setpoint-remote "Set-point with cascade";
pin in float feedback "Measurement; one that is not finite or out of its range is a bad sample";
pin in signed feedback-quality "0 good, 1 uncertain (used), 2 bad";
pin in float feed-forward "Added to the output, inside its limits";
pin in bit enable "False: the output goes to off-output; the loop follows, so that true makes no bump";
pin in bit manual "The output goes to manual-value";
pin in float manual-value "Output with manual";
pin in bit track "The output goes to track-value";
pin in float track-value "Output with track";
pin in bit hold "The output stays where it is";
pin in bit cascade "The loop is closed on setpoint-remote";
pin in float applied "What was really applied since the last sample";
pin in bit has-applied "applied is connected; false: the loop takes its own last output";
pin in bit compensate = 1 "The compensator's output is used; it runs in any case";
pin in bit inhibit-up "The integral term must not rise: blocked-up of the loop below";
pin in bit inhibit-down "The integral term must not fall: blocked-down of the loop below";
pin in bit acknowledge "Lets a latched fallback end";

pin in float kp "Proportional gain";
pin in float ki "Integral gain, per second";
pin in float kd "Derivative gain, times seconds; needs tf";
pin in float tf "Time constant of the filter over all terms [s]: 0, or at least half the thread's period";
pin in float b = 1.0 "Set-point weight of the proportional term, 0 to 2";
pin in float c "Set-point weight of the derivative term, 0 to 2";
pin in float output-lo = -1e6 "Lower limit of the output";
pin in float output-hi = 1e6 "Upper limit of the output";
pin in bit param-hold "True: changes of gains, limits and parameters wait";

pin out float output "Output, within its limits in every mode";
pin out float error "Working set-point minus the last usable measurement";
pin out float working-setpoint "Set-point after its range and rate";
pin out float output-unlimited "Output before its limits";
pin out float integral "Integral term";
pin out float compensation "Output of the compensator";
pin out float disturbance "Estimated disturbance at the plant input, relative to the start";
pin out signed mode "Mode in force";
pin out unsigned status "All status bits";
pin out bit saturated "The output is at a limit, or slower than the loop wants";
pin out bit limited-high "The output is at output-hi";
pin out bit limited-low "The output is at output-lo";
pin out bit bad-feedback "This measurement is not usable";
pin out bit in-fallback "No usable measurement for longer than hold-samples, or a latched fallback";
pin out bit compensating "The compensator's output is in use";
pin out bit blocked-up "A higher set-point cannot act: inhibit-up of the loop above";
pin out bit blocked-down "A lower set-point cannot act: inhibit-down of the loop above";
pin out bit ready "The loop runs; false until the first valid parameters, with the output untouched";
pin out bit refused "The gains, limits and parameters that are set now are refused";
pin out signed fault-code "Why they are refused; 0: they are not";
pin out signed fault-field "The first field that is wrong";
pin out signed fault-reason "What is wrong with it";
pin out float fault-value "The value as it is";
pin out unsigned adopted "How often parameters have been adopted, the first time included";

param rw signed action "0 reverse: gains as they are; 1 direct: gains with the opposite sign";
param rw signed integral-rule "0 backward, 1 trapezoid";
param rw signed anti-windup "0 back-calculation, 1 conditional, 2 none";
param rw float tt "Tracking time constant of back-calculation [s]; 0: max(kp/ki, tf, ts)";
param rw float deadband "Half width of the error deadband";
param rw bit setpoint-track "In off, manual and track the working set-point follows the measurement";
param rw float output-rate-up "Fastest rise of the output per second; 0: no limit";
param rw float output-rate-down "Fastest fall; 0: no limit";
param rw float setpoint-lo = -1e6 "Lower limit of the set-point";
param rw float setpoint-hi = 1e6 "Upper limit of the set-point";
param rw float setpoint-rate-up "Fastest rise of the set-point per second; 0: no limit";
param rw float setpoint-rate-down "Fastest fall; 0: no limit";
param rw float feedback-lo = -1e6 "Least valid measurement";
param rw float feedback-hi = 1e6 "Largest valid measurement";
param rw float off-output "Output without enable; nan: it stays where it is";
param rw float initial-output "Output before the first sample";
param rw signed hold-samples = 25 "Bad samples in a row that are held before the fallback";
param rw signed fallback "0 hold, 1 go to fallback-output, 2 go there at fallback-rate";
param rw float fallback-output "Output of the fallback";
param rw float fallback-rate "Its rate per second";
param rw bit fallback-latched "The fallback ends only with acknowledge";

param rw signed compensator "0 none, 1 disturbance estimator (kfd, tfd), 2 disturbance observer (alpha)";
param rw float kfd "Gain of the estimator, 0 to 1";
param rw float tfd "Filter time constant of the estimator [s]";
param rw float alpha "Filter time constant of the observer [s]";
param rw signed filter-order "Order of the observer's filter; 0: the smallest possible";
param rw float latency "Time from the measurement to the acting output, added to the model's dead time [s]";
param rw float model-gain "Gain of the model";
param rw float model-dead-time "Its dead time [s], any fraction of the period";
param rw signed model-integrators "Its integrators";
param rw float model-pole-a1-#[8] "Factors of its denominator [s]";
param rw float model-pole-a2-#[8] "[s^2]; 0: a first-order factor";
param rw float model-zero-a1-#[8] "Factors of its numerator [s]";
param rw float model-zero-a2-#[8] "[s^2]";
param r float ts "Sampling period: that of the thread [s]";

variable char name[48];
// The loop's memory, in bytes from the instance: an address would be another one in each process that maps HAL's memory.
variable long loop_offset;
variable long loop_size;
variable ctl_config tried;

function _ fp "One sample: reads the pins, gives the output";
;;

static int extra_setup(struct __comp_state *inst, char *prefix, long extra_arg)
{
    (void)extra_arg;
    if (ctl_abi_version() != CTL_ABI_VERSION) {
        rtapi_print_msg(RTAPI_MSG_ERR, "ctl_loop: header and archive are of different versions\n");
        return -EINVAL;
    }
    if (max_delay < 0 || max_delay > CTL_MAX_DELAY) {
        rtapi_print_msg(RTAPI_MSG_ERR, "ctl_loop: max_delay=%d is not in 0..%d\n", max_delay, CTL_MAX_DELAY);
        return -EINVAL;
    }
    long size = CTL_F64_SIZE((long)max_delay);
    char *loop = hal_malloc(size);
    if (!loop) {
        rtapi_print_msg(RTAPI_MSG_ERR, "ctl_loop: no HAL memory for %s: a smaller max_delay helps\n", prefix);
        return -ENOMEM;
    }
    memset(loop, 0, size);
    inst->loop_offset = loop - (char *)inst;
    inst->loop_size = size;
    rtapi_snprintf(inst->name, sizeof inst->name, "%s", prefix);
    return 0;
}

/* HAL has no word for "not given": where only values above 0 make sense, 0 says it. */
static double above_0(double x)
{
    return x == 0.0 ? NAN : x;
}

/* The place behind the last factor that is there; one that is absent between others is 1. */
static int32_t factors(const hal_float_t *a1, const hal_float_t *a2, double *to_a1, double *to_a2)
{
    int32_t count = 0;
    for (int i = 0; i < CTL_MAX_FACTORS; i++) {
        double x1 = a1[i], x2 = a2[i];
        if (x1 != 0.0 || x2 != 0.0) {
            to_a1[count] = x1;
            to_a2[count] = x2;
            count++;
        }
    }
    return count;
}

static void read_parameters(const struct __comp_state *inst, long period, ctl_config *config)
{
    ctl_config_default(config, sizeof *config);
    config->ts = (double)period / 1e9;
    config->action = inst->action;
    config->integral_rule = inst->integral_rule;
    config->anti_windup = inst->anti_windup;
    config->setpoint_track = inst->setpoint_track;
    config->kp = *inst->kp;
    config->ki = *inst->ki;
    config->kd = *inst->kd;
    config->tf = *inst->tf;
    config->b = *inst->b;
    config->c = *inst->c;
    config->tt = above_0(inst->tt);
    config->deadband = inst->deadband;
    config->output_lo = *inst->output_lo;
    config->output_hi = *inst->output_hi;
    config->output_rate_up = above_0(inst->output_rate_up);
    config->output_rate_down = above_0(inst->output_rate_down);
    config->setpoint_lo = inst->setpoint_lo;
    config->setpoint_hi = inst->setpoint_hi;
    config->setpoint_rate_up = above_0(inst->setpoint_rate_up);
    config->setpoint_rate_down = above_0(inst->setpoint_rate_down);
    config->measurement_lo = inst->feedback_lo;
    config->measurement_hi = inst->feedback_hi;
    config->off_output = inst->off_output;
    config->initial_output = inst->initial_output;
    config->hold_samples = inst->hold_samples;
    config->fallback_action = inst->fallback;
    config->fallback_return = inst->fallback_latched ? CTL_RETURN_ACKNOWLEDGED : CTL_RETURN_AUTOMATIC;
    if (config->fallback_action != CTL_FALLBACK_HOLD) {
        config->fallback_output = inst->fallback_output;
        config->fallback_rate = above_0(inst->fallback_rate);
    }
    config->compensator = inst->compensator;
    if (config->compensator == CTL_COMPENSATOR_NONE) {
        return;
    }
    if (config->compensator == CTL_COMPENSATOR_ESTIMATOR) {
        config->kfd = inst->kfd;
        config->tfd = inst->tfd;
    } else {
        config->alpha = inst->alpha;
        config->filter_order = inst->filter_order;
    }
    config->latency = inst->latency;
    config->model_gain = inst->model_gain;
    config->model_dead_time = inst->model_dead_time;
    config->model_integrators = inst->model_integrators;
    config->model_pole_count =
        factors(inst->model_pole_a1, inst->model_pole_a2, config->model_pole_a1, config->model_pole_a2);
    config->model_zero_count =
        factors(inst->model_zero_a1, inst->model_zero_a2, config->model_zero_a1, config->model_zero_a2);
}

static void say_refused(const struct __comp_state *inst, int32_t code, const ctl_faults *faults)
{
    rtapi_print_msg(RTAPI_MSG_ERR, "%s: parameters refused: %s\n", inst->name, ctl_error_text(code));
    for (uint32_t i = 0; i < faults->count; i++) {
        const ctl_fault *fault = &faults->list[i];
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: %s = %g %s", inst->name, ctl_param_name(fault->param), fault->value,
                        ctl_reason_text(fault->reason));
        if (fault->min < fault->max) {
            rtapi_print_msg(RTAPI_MSG_ERR, " (%g to %g)", fault->min, fault->max);
        }
        rtapi_print_msg(RTAPI_MSG_ERR, "\n");
    }
}

/* Starts the loop, or hands it the parameters that have changed. */
static void adopt_parameters(struct __comp_state *inst, void *loop, long period)
{
    ctl_config config;
    read_parameters(inst, period, &config);
    /* As bytes: two NaN are the same value here. */
    if (memcmp(&config, &inst->tried, sizeof config) == 0) {
        return;
    }
    inst->tried = config;
    inst->ts = config.ts;
    ctl_faults faults = {0};
    int32_t code = *inst->ready ? ctl_f64_adopt(loop, inst->loop_size, &config, &faults)
                                : ctl_f64_init(loop, inst->loop_size, &config, &faults);
    *inst->refused = code != CTL_OK;
    *inst->fault_code = code;
    *inst->fault_field = faults.count ? faults.list[0].param : 0;
    *inst->fault_reason = faults.count ? faults.list[0].reason : 0;
    *inst->fault_value = faults.count ? faults.list[0].value : 0.0;
    if (code == CTL_OK) {
        *inst->ready = 1;
        *inst->adopted += 1;
    } else {
        say_refused(inst, code, &faults);
    }
}

static int32_t wanted_mode(const struct __comp_state *inst)
{
    return !*inst->enable    ? CTL_MODE_OFF
           : *inst->track    ? CTL_MODE_TRACK
           : *inst->manual   ? CTL_MODE_MANUAL
           : *inst->hold     ? CTL_MODE_HOLD
           : *inst->cascade  ? CTL_MODE_CASCADE
                             : CTL_MODE_AUTO;
}

/* halcompile's own would come with a macro for every pin, and those would stand in for the fields of ctl_config. */
#define FUNCTION(name) static void name(struct __comp_state *inst, long period)

FUNCTION(_)
{
    void *loop = (char *)inst + inst->loop_offset;
    if (!*inst->ready || !*inst->param_hold) {
        adopt_parameters(inst, loop, period);
    }
    if (!*inst->ready) {
        return;
    }
    ctl_f64_input in = {0};
    in.r = *inst->setpoint;
    in.r_remote = *inst->setpoint_remote;
    in.y = *inst->feedback;
    in.u_applied = *inst->applied;
    in.manual = *inst->manual_value;
    in.track = *inst->track_value;
    in.offset = *inst->feed_forward;
    in.mode = wanted_mode(inst);
    in.quality = *inst->feedback_quality;
    in.has_u_applied = *inst->has_applied;
    in.has_manual = 1;
    in.compensator_off = !*inst->compensate;
    in.inhibit_up = *inst->inhibit_up;
    in.inhibit_down = *inst->inhibit_down;
    in.acknowledge = *inst->acknowledge;

    ctl_f64_output out;
    int32_t code = ctl_f64_step(loop, inst->loop_size, &in, &out);
    if (code != CTL_OK) {
        /* Somebody has written over the loop's memory: begin anew. */
        *inst->ready = 0;
        *inst->fault_code = code;
        memset(&inst->tried, 0, sizeof inst->tried);
        return;
    }
    *inst->output = out.u;
    if (!(out.status & CTL_STATUS_BAD_INPUT)) {
        *inst->error = out.r - in.y;
    }
    *inst->working_setpoint = out.r;
    *inst->output_unlimited = out.v;
    *inst->integral = out.i;
    *inst->compensation = out.u_f;
    *inst->disturbance = out.d_hat;
    *inst->mode = out.mode;
    *inst->status = out.status;
    uint32_t limited = CTL_STATUS_LIMITED_HIGH | CTL_STATUS_LIMITED_LOW | CTL_STATUS_RATE_LIMITED;
    *inst->saturated = (out.status & limited) != 0;
    *inst->limited_high = (out.status & CTL_STATUS_LIMITED_HIGH) != 0;
    *inst->limited_low = (out.status & CTL_STATUS_LIMITED_LOW) != 0;
    *inst->bad_feedback = (out.status & CTL_STATUS_BAD_INPUT) != 0;
    *inst->in_fallback = (out.status & CTL_STATUS_FALLBACK) != 0;
    *inst->compensating = (out.status & CTL_STATUS_COMPENSATING) != 0;
    *inst->blocked_up = out.blocked_up != 0;
    *inst->blocked_down = out.blocked_down != 0;
}

/*
 * The layout of the structures, the same on every machine and for every option about enumerations; 32-bit x86 aligns double
 * to 4 bytes, which changes no offset. One line a field: offset and size in bytes. `controller-capi/tests/header`
 * compares the lines with Rust's structures.
 */
#include "ctl.h"
#include "assert_layout.h"

ALL(ctl_config, 608, 8);
AT(ctl_config, struct_size, 0, 4);
AT(ctl_config, action, 4, 4);
AT(ctl_config, integral_rule, 8, 4);
AT(ctl_config, anti_windup, 12, 4);
AT(ctl_config, setpoint_track, 16, 4);
AT(ctl_config, fallback_action, 20, 4);
AT(ctl_config, fallback_return, 24, 4);
AT(ctl_config, hold_samples, 28, 4);
AT(ctl_config, compensator, 32, 4);
AT(ctl_config, filter_order, 36, 4);
AT(ctl_config, model_integrators, 40, 4);
AT(ctl_config, model_pole_count, 44, 4);
AT(ctl_config, model_zero_count, 48, 4);
AT(ctl_config, reserved, 52, 4);
AT(ctl_config, ts, 56, 8);
AT(ctl_config, kp, 64, 8);
AT(ctl_config, ki, 72, 8);
AT(ctl_config, kd, 80, 8);
AT(ctl_config, tf, 88, 8);
AT(ctl_config, b, 96, 8);
AT(ctl_config, c, 104, 8);
AT(ctl_config, output_lo, 112, 8);
AT(ctl_config, output_hi, 120, 8);
AT(ctl_config, output_rate_up, 128, 8);
AT(ctl_config, output_rate_down, 136, 8);
AT(ctl_config, setpoint_lo, 144, 8);
AT(ctl_config, setpoint_hi, 152, 8);
AT(ctl_config, setpoint_rate_up, 160, 8);
AT(ctl_config, setpoint_rate_down, 168, 8);
AT(ctl_config, tt, 176, 8);
AT(ctl_config, deadband, 184, 8);
AT(ctl_config, measurement_lo, 192, 8);
AT(ctl_config, measurement_hi, 200, 8);
AT(ctl_config, offset_lo, 208, 8);
AT(ctl_config, offset_hi, 216, 8);
AT(ctl_config, fallback_output, 224, 8);
AT(ctl_config, fallback_rate, 232, 8);
AT(ctl_config, alarm_hi_hi, 240, 8);
AT(ctl_config, alarm_hi, 248, 8);
AT(ctl_config, alarm_lo, 256, 8);
AT(ctl_config, alarm_lo_lo, 264, 8);
AT(ctl_config, alarm_deviation, 272, 8);
AT(ctl_config, alarm_hysteresis, 280, 8);
AT(ctl_config, off_output, 288, 8);
AT(ctl_config, initial_output, 296, 8);
AT(ctl_config, latency, 304, 8);
AT(ctl_config, kfd, 312, 8);
AT(ctl_config, tfd, 320, 8);
AT(ctl_config, alpha, 328, 8);
AT(ctl_config, model_gain, 336, 8);
AT(ctl_config, model_dead_time, 344, 8);
AT(ctl_config, model_pole_a1, 352, 64);
AT(ctl_config, model_pole_a2, 416, 64);
AT(ctl_config, model_zero_a1, 480, 64);
AT(ctl_config, model_zero_a2, 544, 64);

ALL(ctl_fault, 32, 8);
AT(ctl_fault, param, 0, 4);
AT(ctl_fault, reason, 4, 4);
AT(ctl_fault, value, 8, 8);
AT(ctl_fault, min, 16, 8);
AT(ctl_fault, max, 24, 8);

ALL(ctl_faults, 392, 8);
AT(ctl_faults, count, 0, 4);
AT(ctl_faults, total, 4, 4);
AT(ctl_faults, list, 8, 384);

ALL(ctl_f32_input, 60, 4);
AT(ctl_f32_input, r, 0, 4);
AT(ctl_f32_input, r_remote, 4, 4);
AT(ctl_f32_input, y, 8, 4);
AT(ctl_f32_input, u_applied, 12, 4);
AT(ctl_f32_input, manual, 16, 4);
AT(ctl_f32_input, track, 20, 4);
AT(ctl_f32_input, offset, 24, 4);
AT(ctl_f32_input, mode, 28, 4);
AT(ctl_f32_input, quality, 32, 4);
AT(ctl_f32_input, has_u_applied, 36, 4);
AT(ctl_f32_input, has_manual, 40, 4);
AT(ctl_f32_input, compensator_off, 44, 4);
AT(ctl_f32_input, inhibit_up, 48, 4);
AT(ctl_f32_input, inhibit_down, 52, 4);
AT(ctl_f32_input, acknowledge, 56, 4);

ALL(ctl_f64_input, 88, 8);
AT(ctl_f64_input, r, 0, 8);
AT(ctl_f64_input, r_remote, 8, 8);
AT(ctl_f64_input, y, 16, 8);
AT(ctl_f64_input, u_applied, 24, 8);
AT(ctl_f64_input, manual, 32, 8);
AT(ctl_f64_input, track, 40, 8);
AT(ctl_f64_input, offset, 48, 8);
AT(ctl_f64_input, mode, 56, 4);
AT(ctl_f64_input, quality, 60, 4);
AT(ctl_f64_input, has_u_applied, 64, 4);
AT(ctl_f64_input, has_manual, 68, 4);
AT(ctl_f64_input, compensator_off, 72, 4);
AT(ctl_f64_input, inhibit_up, 76, 4);
AT(ctl_f64_input, inhibit_down, 80, 4);
AT(ctl_f64_input, acknowledge, 84, 4);

ALL(ctl_f32_output, 44, 4);
AT(ctl_f32_output, u, 0, 4);
AT(ctl_f32_output, v, 4, 4);
AT(ctl_f32_output, i, 8, 4);
AT(ctl_f32_output, pd, 12, 4);
AT(ctl_f32_output, u_f, 16, 4);
AT(ctl_f32_output, d_hat, 20, 4);
AT(ctl_f32_output, r, 24, 4);
AT(ctl_f32_output, mode, 28, 4);
AT(ctl_f32_output, status, 32, 4);
AT(ctl_f32_output, blocked_up, 36, 4);
AT(ctl_f32_output, blocked_down, 40, 4);

ALL(ctl_f64_output, 72, 8);
AT(ctl_f64_output, u, 0, 8);
AT(ctl_f64_output, v, 8, 8);
AT(ctl_f64_output, i, 16, 8);
AT(ctl_f64_output, pd, 24, 8);
AT(ctl_f64_output, u_f, 32, 8);
AT(ctl_f64_output, d_hat, 40, 8);
AT(ctl_f64_output, r, 48, 8);
AT(ctl_f64_output, mode, 56, 4);
AT(ctl_f64_output, status, 60, 4);
AT(ctl_f64_output, blocked_up, 64, 4);
AT(ctl_f64_output, blocked_down, 68, 4);

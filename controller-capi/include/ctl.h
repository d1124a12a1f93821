/*
 * ctl.h: a PID controller with disturbance estimator or observer, for C99 to C++20.
 *
 * Two variants with the same functions: ctl_f32_... (float, REAL) and ctl_f64_... (double, LREAL). For equal inputs each
 * gives equal bits on every machine.
 *
 *     ctl_config config;
 *     ctl_config_default(&config, sizeof config);
 *     config.ts = 0.1;  config.kp = 2.0;  config.ki = 1.0;  config.output_lo = 0.0;  config.output_hi = 100.0;
 *
 *     CTL_F32_STATE(loop, 0);
 *     if (ctl_f32_init(loop, sizeof loop, &config, NULL) != CTL_OK) { ... }
 *
 *     every ts seconds:
 *         ctl_f32_input in = {0};  ctl_f32_output out;
 *         in.r = set_point;  in.y = measurement;
 *         if (ctl_f32_step(loop, sizeof loop, &in, &out) == CTL_OK) { write(out.u); }
 *
 * The block of memory that holds a loop belongs to the caller.
 *   - All bytes zero: a block that is not initialised. Every call says so (CTL_ERROR_NOT_INITIALISED).
 *   - It holds no address: between two calls it may be moved and copied as bytes, into any memory aligned to CTL_F32_ALIGN.
 *   - Only the library that wrote it can read it. For another build (new firmware) use save and restore.
 *   - `size` in each call is the number of bytes at `state`, as in `sizeof loop`.
 *   - Whatever bits it holds, no call reads or writes beyond it. Damage to its parameters is found, damage to its
 *     state where a number is no longer finite (CTL_ERROR_DAMAGED).
 *   - One block is used by one call at a time. Different blocks do not disturb each other: there are no globals.
 *
 * Every function with a status gives CTL_OK or an error, and on an error leaves outputs and block as they were; but a step
 * that finds its state damaged leaves the outputs alone and a block that gives CTL_ERROR_DAMAGED to every call until init.
 * Nothing allocates, calls back, or unwinds. Bad inputs of a step are no error: the output is written, and its status says so.
 *
 * Units: [y] that of the measurement and the set-point, [u] that of the output, [s] seconds.
 */
#ifndef CTL_H
#define CTL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Version of this header; ctl_abi_version() gives that of the archive. */
#define CTL_ABI_VERSION 1u

/* ---- Errors ---------------------------------------------------------------------------------------------------- */

#define CTL_OK 0
#define CTL_ERROR_NULL 1               /* a pointer is null */
#define CTL_ERROR_SIZE 2               /* the block is too small */
#define CTL_ERROR_ALIGN 3              /* an address is not aligned */
#define CTL_ERROR_NOT_INITIALISED 4    /* zero bytes, or something has written over the block's beginning */
#define CTL_ERROR_VERSION 5            /* the block was initialised by another build of the library */
#define CTL_ERROR_STRUCT_SIZE 6        /* struct_size is not that of the library's ctl_config */
#define CTL_ERROR_CONFIG 7             /* the configuration has faults */
#define CTL_ERROR_ARGUMENT 8           /* an argument is out of its range */
#define CTL_ERROR_BUFFER 9             /* the buffer is too short */
#define CTL_ERROR_SNAPSHOT_VERSION 10  /* not a snapshot of this version */
#define CTL_ERROR_SNAPSHOT_SHAPE 11    /* a snapshot of a block of another shape */
#define CTL_ERROR_SNAPSHOT_CHECKSUM 12 /* a damaged snapshot */
#define CTL_ERROR_SNAPSHOT_INVALID 13  /* an intact snapshot that this configuration cannot go on from */
#define CTL_ERROR_DAMAGED 14           /* something has written over the block's law or state; until init */

/* ---- Modes ----------------------------------------------------------------------------------------------------- */

#define CTL_MODE_AS_SET 0   /* in an input: the mode of ctl_..._set_mode, which is Auto after init */
#define CTL_MODE_OFF 1      /* the output goes to off_output, or stays */
#define CTL_MODE_MANUAL 2   /* the output is `manual` */
#define CTL_MODE_AUTO 3     /* closed loop on `r` */
#define CTL_MODE_CASCADE 4  /* closed loop on `r_remote` */
#define CTL_MODE_TRACK 5    /* the output is `track` */
#define CTL_MODE_HOLD 6     /* the output stays */
#define CTL_MODE_FALLBACK 7 /* in an output only: no good measurement */

/* ---- Quality of a measurement ---------------------------------------------------------------------------------- */

/* PV_QUALITY of the function blocks (ctl_fb.h) counts the other way: 2 is good there. */
#define CTL_QUALITY_GOOD 0
#define CTL_QUALITY_UNCERTAIN 1 /* used, with CTL_STATUS_UNCERTAIN */
#define CTL_QUALITY_BAD 2       /* not used; any other number counts as bad */

/* ---- Status bits ----------------------------------------------------------------------------------------------- */

#define CTL_STATUS_LIMITED_HIGH 0x1u               /* the output is at its upper limit */
#define CTL_STATUS_LIMITED_LOW 0x2u                /* the output is at its lower limit */
#define CTL_STATUS_RATE_LIMITED 0x4u               /* the output is slower than the loop wants */
#define CTL_STATUS_SETPOINT_LIMITED 0x8u           /* the set-point was outside its range */
#define CTL_STATUS_SETPOINT_RAMPING 0x10u          /* the working set-point is on its way */
#define CTL_STATUS_BAD_INPUT 0x20u                 /* the measurement is not finite, out of range or marked bad */
#define CTL_STATUS_UNCERTAIN 0x40u                 /* the measurement is used but uncertain */
#define CTL_STATUS_HELD 0x80u                      /* output and terms are held for a few bad samples */
#define CTL_STATUS_FALLBACK 0x100u                 /* the fallback is in force */
#define CTL_STATUS_AWAITING_ACKNOWLEDGEMENT 0x200u /* a good measurement, but the fallback waits */
#define CTL_STATUS_REJECTED 0x400u                 /* another input was not usable and was replaced */
#define CTL_STATUS_UNINITIALISED 0x800u            /* no good measurement since init */
#define CTL_STATUS_OVERRUN 0x1000u                 /* samples were lost (ctl_..._advance) */
#define CTL_STATUS_COMPENSATING 0x2000u            /* the compensator's output is in use */
#define CTL_STATUS_INHIBITED 0x4000u               /* inhibit_up or inhibit_down stops the integral term */
#define CTL_STATUS_ALARM_HI_HI 0x10000u
#define CTL_STATUS_ALARM_HI 0x20000u
#define CTL_STATUS_ALARM_LO 0x40000u
#define CTL_STATUS_ALARM_LO_LO 0x80000u
#define CTL_STATUS_ALARM_DEVIATION 0x100000u

/* ---- Configuration --------------------------------------------------------------------------------------------- */

#define CTL_ACTION_REVERSE 0 /* measurement rises, output falls: gains as they are written */
#define CTL_ACTION_DIRECT 1  /* measurement rises, output rises: gains with the opposite sign */

#define CTL_INTEGRAL_BACKWARD 0
#define CTL_INTEGRAL_TRAPEZOID 1

#define CTL_ANTI_WINDUP_BACK_CALCULATION 0
#define CTL_ANTI_WINDUP_CONDITIONAL 1
#define CTL_ANTI_WINDUP_NONE 2

#define CTL_FALLBACK_HOLD 0       /* the output stays where it is */
#define CTL_FALLBACK_SUBSTITUTE 1 /* it goes to fallback_output */
#define CTL_FALLBACK_RAMP 2       /* it goes there at fallback_rate */

#define CTL_RETURN_AUTOMATIC 0    /* with the first good measurement */
#define CTL_RETURN_ACKNOWLEDGED 1 /* with the first good measurement that comes with `acknowledge` */

#define CTL_COMPENSATOR_NONE 0
#define CTL_COMPENSATOR_ESTIMATOR 1 /* disturbance estimator: kfd/(1+tfd*s)^3 */
#define CTL_COMPENSATOR_OBSERVER 2  /* disturbance observer: 1/(1+alpha*s)^filter_order */

#define CTL_MAX_FACTORS 8

/*
 * Parameters of a loop; always begin with ctl_config_default. The numbers are double in both variants; the float variant
 * rounds each of them to float first. NaN in a number that is "optional" means: not given. "must be given" has no default
 * that would be accepted.
 *
 * The model (of a compensator) is
 *   model_gain * product(1 + zero_a1*s + zero_a2*s^2) * exp(-model_dead_time*s)
 *     / (s^model_integrators * product(1 + pole_a1*s + pole_a2*s^2)).
 */
typedef struct ctl_config {
    uint32_t struct_size;      /* sizeof(ctl_config); set by ctl_config_default */
    int32_t action;            /* CTL_ACTION_... */
    int32_t integral_rule;     /* CTL_INTEGRAL_... */
    int32_t anti_windup;       /* CTL_ANTI_WINDUP_... */
    int32_t setpoint_track;    /* not 0: in Off, Manual, Track the working set-point follows the measurement */
    int32_t fallback_action;   /* CTL_FALLBACK_... */
    int32_t fallback_return;   /* CTL_RETURN_... */
    int32_t hold_samples;      /* bad samples in a row that are held before the fallback, 0 to 65535; 25 */
    int32_t compensator;       /* CTL_COMPENSATOR_... */
    int32_t filter_order;      /* of the observer; 0: the smallest possible */
    int32_t model_integrators; /* of the model, 0 to 8 */
    int32_t model_pole_count;  /* factors of the denominator, 0 to CTL_MAX_FACTORS; order 8 at most */
    int32_t model_zero_count;  /* factors of the numerator, 0 to CTL_MAX_FACTORS; fewer zeros than poles */
    int32_t reserved;          /* 0 */

    double ts; /* sampling period [s]; must be given */
    double kp; /* proportional gain [u/y]; 0 */
    double ki; /* integral gain [u/y/s]; 0 */
    double kd; /* derivative gain [u/y*s], needs tf; 0 */
    double tf; /* filter over all terms [s]: 0, or at least ts/2; 0 */
    double b;  /* set-point weight of the proportional term, 0 to 2; 1 */
    double c;  /* set-point weight of the derivative term, 0 to 2; 0 */

    double output_lo;        /* range of the output [u], up to 1e12 in size; -1e6 */
    double output_hi;        /* 1e6 */
    double output_rate_up;   /* fastest rise [u/s], above 0; optional */
    double output_rate_down; /* fastest fall [u/s], above 0; optional */

    double setpoint_lo;        /* range of the set-point [y]; -1e6 */
    double setpoint_hi;        /* 1e6 */
    double setpoint_rate_up;   /* fastest rise [y/s], above 0; optional */
    double setpoint_rate_down; /* fastest fall [y/s], above 0; optional */

    double tt;       /* tracking time constant of back-calculation [s], above 0; optional: max(kp/ki, tf, ts) */
    double deadband; /* half width of the error deadband [y]; 0 */

    double measurement_lo; /* range of a valid measurement [y]; -1e6 */
    double measurement_hi; /* 1e6 */
    double offset_lo;      /* range of the offset [u]; -1e6 */
    double offset_hi;      /* 1e6 */

    double fallback_output; /* [u], within the output's range; must be given for substitute and ramp */
    double fallback_rate;   /* [u/s], above 0; must be given for ramp */

    double alarm_hi_hi;      /* alarm levels [y], in falling order; optional */
    double alarm_hi;         /* optional */
    double alarm_lo;         /* optional */
    double alarm_lo_lo;      /* optional */
    double alarm_deviation;  /* size of set-point minus measurement [y], above 0; optional */
    double alarm_hysteresis; /* how far a signal must come back [y]; 0 */

    double off_output;     /* output in mode Off [u], within the output's range; optional: it stays where it is */
    double initial_output; /* output before the first sample [u], moved into the output's range; 0 */

    double latency; /* time from reading y to acting u [s], added to the model's dead time; 0 */
    double kfd;     /* gain of the estimator, 0 to 1; must be given for an estimator */
    double tfd;     /* filter time constant of the estimator [s]; must be given for an estimator */
    double alpha;   /* filter time constant of the observer [s]; must be given for an observer */

    double model_gain;      /* [y/u/s^integrators], not 0, ki*model_gain not below 0; must be given for a compensator */
    double model_dead_time; /* [s], any fraction of ts; 0 */
    double model_pole_a1[CTL_MAX_FACTORS]; /* [s], above 0 */
    double model_pole_a2[CTL_MAX_FACTORS]; /* [s^2], 0 for a first-order factor */
    double model_zero_a1[CTL_MAX_FACTORS]; /* [s], any sign */
    double model_zero_a2[CTL_MAX_FACTORS]; /* [s^2] */
} ctl_config;

/* Fields that a fault can be about; ctl_param_name gives the name. */
#define CTL_PARAM_TS 1
#define CTL_PARAM_KP 2
#define CTL_PARAM_KI 3
#define CTL_PARAM_KD 4
#define CTL_PARAM_TF 5
#define CTL_PARAM_B 6
#define CTL_PARAM_C 7
#define CTL_PARAM_TT 8
#define CTL_PARAM_OUTPUT_LO 9
#define CTL_PARAM_OUTPUT_HI 10
#define CTL_PARAM_OUTPUT_RATE_UP 11
#define CTL_PARAM_OUTPUT_RATE_DOWN 12
#define CTL_PARAM_SETPOINT_LO 13
#define CTL_PARAM_SETPOINT_HI 14
#define CTL_PARAM_SETPOINT_RATE_UP 15
#define CTL_PARAM_SETPOINT_RATE_DOWN 16
#define CTL_PARAM_DEADBAND 17
#define CTL_PARAM_MEASUREMENT_LO 18
#define CTL_PARAM_MEASUREMENT_HI 19
#define CTL_PARAM_OFFSET_LO 20
#define CTL_PARAM_OFFSET_HI 21
#define CTL_PARAM_FALLBACK_OUTPUT 22
#define CTL_PARAM_FALLBACK_RATE 23
#define CTL_PARAM_OFF_OUTPUT 24
#define CTL_PARAM_INITIAL_OUTPUT 25
#define CTL_PARAM_ALARM_HI_HI 26
#define CTL_PARAM_ALARM_HI 27
#define CTL_PARAM_ALARM_LO 28
#define CTL_PARAM_ALARM_LO_LO 29
#define CTL_PARAM_ALARM_DEVIATION 30
#define CTL_PARAM_ALARM_HYSTERESIS 31
#define CTL_PARAM_MODEL_GAIN 32
#define CTL_PARAM_MODEL_POLES 33 /* model_pole_a1, model_pole_a2 */
#define CTL_PARAM_MODEL_ZEROS 34 /* model_zero_a1, model_zero_a2 */
#define CTL_PARAM_MODEL_ORDER 35 /* integrators and poles together */
#define CTL_PARAM_DEAD_TIME 36   /* model_dead_time */
#define CTL_PARAM_LATENCY 37
#define CTL_PARAM_KFD 38
#define CTL_PARAM_TFD 39
#define CTL_PARAM_ALPHA 40
#define CTL_PARAM_FILTER_ORDER 41
#define CTL_PARAM_CAPACITY 42 /* delay memory of the block; value, min and max are samples of delay */
#define CTL_PARAM_OVERFLOW 45 /* gains times ranges leave the number type */
#define CTL_PARAM_ACTION 128
#define CTL_PARAM_INTEGRAL_RULE 129
#define CTL_PARAM_ANTI_WINDUP 130
#define CTL_PARAM_FALLBACK_ACTION 131
#define CTL_PARAM_FALLBACK_RETURN 132
#define CTL_PARAM_HOLD_SAMPLES 133
#define CTL_PARAM_COMPENSATOR 134
#define CTL_PARAM_MODEL_INTEGRATORS 135
#define CTL_PARAM_MODEL_POLE_COUNT 136
#define CTL_PARAM_MODEL_ZERO_COUNT 137

/* What can be wrong with a field; ctl_reason_text says it in words. */
#define CTL_REASON_NOT_FINITE 1
#define CTL_REASON_OUT_OF_RANGE 2
#define CTL_REASON_INVERTED 3      /* the lower bound is not below the upper one */
#define CTL_REASON_SIGN_MISMATCH 4 /* ki * model_gain is negative */
#define CTL_REASON_NEEDS_FILTER 5  /* kd without tf */
#define CTL_REASON_UNSTABLE 6      /* not a stable factor */
#define CTL_REASON_TOO_LARGE 7
#define CTL_REASON_NOT_PROPER 8 /* no more poles than zeros */
#define CTL_REASON_MISMATCH 9

typedef struct ctl_fault {
    int32_t param;  /* CTL_PARAM_... */
    int32_t reason; /* CTL_REASON_... */
    double value;   /* as the variant rounds it */
    double min;     /* the allowed range; not below max: there is none to name */
    double max;
} ctl_fault;

#define CTL_MAX_FAULTS 12

/* All faults of a configuration at once. */
typedef struct ctl_faults {
    uint32_t count; /* entries of `list` in use */
    uint32_t total; /* faults found; on a microcontroller the search keeps no more than 12, and 1 for each choice */
    ctl_fault list[CTL_MAX_FAULTS];
} ctl_faults;

/* ---- Inputs and outputs ---------------------------------------------------------------------------------------- */

/*
 * What a step reads. All zeros is a valid input. Any value is allowed in any field; what is not usable is replaced as the
 * comment says, and the status tells.
 */
#define CTL_INPUT_FIELDS(real)                                                                                         \
    real r;                  /* local set-point [y]; moved into its range; not finite: the last good one */            \
    real r_remote;           /* set-point in mode Cascade [y]; treated like r */                                       \
    real y;                  /* measurement [y]; not finite or out of range: a bad sample */                           \
    real u_applied;          /* what was really applied since the last sample [u]; not finite: the own output */       \
    real manual;             /* output in mode Manual [u]; not finite: the output stays */                             \
    real track;              /* output in mode Track [u]; not finite: the output stays */                              \
    real offset;             /* feed-forward, added inside the limits [u]; not finite: the last good one */            \
    int32_t mode;            /* CTL_MODE_...; an unknown one: the last that was asked for, with CTL_STATUS_REJECTED */ \
    int32_t quality;         /* CTL_QUALITY_... of y */                                                                \
    int32_t has_u_applied;   /* not 0: u_applied is given; 0: the loop takes its own last output */                    \
    int32_t has_manual;      /* not 0: manual is given; 0: in mode Manual the output stays where it is */              \
    int32_t compensator_off; /* not 0: the compensator runs, but is not used; may change at any time without a bump */ \
    int32_t inhibit_up;      /* not 0: the integral term must not drive the output up */                               \
    int32_t inhibit_down;    /* not 0: ... down */                                                                     \
    int32_t acknowledge;     /* not 0: a latched fallback may end */

/* What a step gives. Every number is finite, u is in its range. */
#define CTL_OUTPUT_FIELDS(real)                                                                                        \
    real u;               /* output [u] */                                                                             \
    real v;               /* output before the limits [u] */                                                           \
    real i;               /* integral term [u] */                                                                      \
    real pd;              /* proportional and derivative terms, filtered [u] */                                        \
    real u_f;             /* output of the compensator [u] */                                                          \
    real d_hat;           /* estimated disturbance at the plant input [u], relative to the start */                    \
    real r;               /* working set-point [y]; the u_applied of a primary loop */                                 \
    int32_t mode;         /* mode in force, CTL_MODE_... */                                                            \
    uint32_t status;      /* CTL_STATUS_... */                                                                         \
    int32_t blocked_up;   /* 1: a higher set-point cannot act; inhibit_up of a primary loop */                         \
    int32_t blocked_down; /* 1: a lower set-point cannot act */

typedef struct ctl_f32_input {
    CTL_INPUT_FIELDS(float)
} ctl_f32_input;

typedef struct ctl_f32_output {
    CTL_OUTPUT_FIELDS(float)
} ctl_f32_output;

typedef struct ctl_f64_input {
    CTL_INPUT_FIELDS(double)
} ctl_f64_input;

typedef struct ctl_f64_output {
    CTL_OUTPUT_FIELDS(double)
} ctl_f64_output;

/* ---- Memory ---------------------------------------------------------------------------------------------------- */

/* Longest delay of a block [samples]. */
#define CTL_MAX_DELAY 16777215

/* Alignment of a block [bytes]. */
#define CTL_F32_ALIGN 8
#define CTL_F64_ALIGN 8

/* Bytes of a block that never has a compensator. */
#define CTL_F32_SIZE_WITHOUT_COMPENSATOR 352
#define CTL_F64_SIZE_WITHOUT_COMPENSATOR 640

/* Bytes of a block for up to `delay` samples of dead time and latency: floor((model_dead_time + latency) / ts). */
#define CTL_F32_SIZE(delay) (832 + ((delay) + 2) / 2 * 8)
#define CTL_F64_SIZE(delay) (1472 + ((delay) + 1) * 8)

/* The same in words of 8 bytes, for an array of uint64_t (LWORD). */
#define CTL_F32_WORDS(delay) (CTL_F32_SIZE(delay) / 8)
#define CTL_F64_WORDS(delay) (CTL_F64_SIZE(delay) / 8)

/* Words of 4 bytes that a snapshot of such a block takes at most. */
#define CTL_F32_SNAPSHOT_WORDS(delay) (70 + ((delay) + 2) / 2 * 2)
#define CTL_F64_SNAPSHOT_WORDS(delay) (129 + ((delay) + 1) * 2)

/* An aligned block: give `name` and `sizeof name` to the functions. `static CTL_F32_STATE(name, 20);` begins as zeros. */
#define CTL_F32_STATE(name, delay) uint64_t name[CTL_F32_WORDS(delay)]
#define CTL_F64_STATE(name, delay) uint64_t name[CTL_F64_WORDS(delay)]
#define CTL_F32_STATE_WITHOUT_COMPENSATOR(name) uint64_t name[CTL_F32_SIZE_WITHOUT_COMPENSATOR / 8]
#define CTL_F64_STATE_WITHOUT_COMPENSATOR(name) uint64_t name[CTL_F64_SIZE_WITHOUT_COMPENSATOR / 8]

/* ---- Functions of both variants -------------------------------------------------------------------------------- */

/* Version of the archive; compare with CTL_ABI_VERSION. */
uint32_t ctl_abi_version(void);

/* Writes the defaults; struct_size is sizeof(ctl_config). */
int32_t ctl_config_default(ctl_config *config, size_t struct_size);

/* Texts, which live as long as the program: of an error, of a fault's field, of its reason. Never null. */
const char *ctl_error_text(int32_t code);
const char *ctl_param_name(int32_t param);
const char *ctl_reason_text(int32_t reason);

/* ---- float (REAL) ---------------------------------------------------------------------------------------------- */

/* CTL_F32_SIZE as a function; 0 above CTL_MAX_DELAY. */
size_t ctl_f32_size(uint32_t delay);
size_t ctl_f32_size_without_compensator(void);
size_t ctl_f32_align(void);

/* The `delay` that CTL_F32_SIZE needs for this configuration; 0 without a compensator. */
int32_t ctl_f32_delay_samples(const ctl_config *config, uint32_t *samples);

/* Finds all faults of a configuration. `faults` may be null here, in init and in adopt. */
int32_t ctl_f32_check(const ctl_config *config, ctl_faults *faults);

/*
 * Builds the loop in the block, whatever is there, in mode Auto. On an error the block is as before. The first good sample
 * starts the loop at u_applied, or else at initial_output; ctl_f32_settle starts it anywhere.
 */
int32_t ctl_f32_init(void *state, size_t size, const ctl_config *config, ctl_faults *faults);

/* Puts the loop at rest at set-point r, measurement y, output u, each moved into its range: nothing moves until an input does. */
int32_t ctl_f32_settle(void *state, size_t size, float r, float y, float u);

/* The mode of steps whose input says CTL_MODE_AS_SET: CTL_MODE_OFF to CTL_MODE_HOLD. */
int32_t ctl_f32_set_mode(void *state, size_t size, int32_t mode);

/*
 * One sample. Fails only if it cannot run (null, alignment, size, not initialised, version) or finds damage
 * (CTL_ERROR_DAMAGED). Then the output is not written: leave the actuator as it is, or in its safe state. After damage every
 * call on the block gives this error until init; after init, restore or settle at the applied output.
 */
int32_t ctl_f32_step(void *state, size_t size, const ctl_f32_input *input, ctl_f32_output *output);

/*
 * Replaces all parameters between two samples, without a bump; also ts, the dead time, and the compensator for another or
 * for none. On an error the old parameters stay.
 */
int32_t ctl_f32_adopt(void *state, size_t size, const ctl_config *config, ctl_faults *faults);

/* Tells the loop that `samples` samples were lost while its last output was applied. */
int32_t ctl_f32_advance(void *state, size_t size, uint32_t samples);

/* What the last step gave; after init, settle and restore u, v, mode and status, the rest 0. */
int32_t ctl_f32_read(const void *state, size_t size, ctl_f32_output *output);

/*
 * The state as words, with version, shape and checksum, for memory that outlives the program. Parameters are not in it:
 * initialise with them, then restore. A loop restored with the same parameters goes on bit for bit.
 */
int32_t ctl_f32_snapshot_words(void *state, size_t size, size_t *count);
int32_t ctl_f32_save(void *state, size_t size, uint32_t *words, size_t capacity, size_t *written);
int32_t ctl_f32_restore(void *state, size_t size, const uint32_t *words, size_t count);

/* ---- double (LREAL), the same ---------------------------------------------------------------------------------- */

size_t ctl_f64_size(uint32_t delay);
size_t ctl_f64_size_without_compensator(void);
size_t ctl_f64_align(void);
int32_t ctl_f64_delay_samples(const ctl_config *config, uint32_t *samples);
int32_t ctl_f64_check(const ctl_config *config, ctl_faults *faults);
int32_t ctl_f64_init(void *state, size_t size, const ctl_config *config, ctl_faults *faults);
int32_t ctl_f64_settle(void *state, size_t size, double r, double y, double u);
int32_t ctl_f64_set_mode(void *state, size_t size, int32_t mode);
int32_t ctl_f64_step(void *state, size_t size, const ctl_f64_input *input, ctl_f64_output *output);
int32_t ctl_f64_adopt(void *state, size_t size, const ctl_config *config, ctl_faults *faults);
int32_t ctl_f64_advance(void *state, size_t size, uint32_t samples);
int32_t ctl_f64_read(const void *state, size_t size, ctl_f64_output *output);
int32_t ctl_f64_snapshot_words(void *state, size_t size, size_t *count);
int32_t ctl_f64_save(void *state, size_t size, uint32_t *words, size_t capacity, size_t *written);
int32_t ctl_f64_restore(void *state, size_t size, const uint32_t *words, size_t count);

#ifdef __cplusplus
}
#endif

#endif /* CTL_H */

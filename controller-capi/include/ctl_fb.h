/*
 * ctl_fb.h: the function block of IEC 61131-3 over ctl.h, for runtimes that can call C; C99 to C++20.
 *
 * Two variants: ctl_f32_fb (REAL) and ctl_f64_fb (LREAL). The Structured Text around them is iec/CTL_LOOP.st, what the block does is in
 * iec/README.md.
 *
 *     static uint64_t memory[CTL_F32_FB_WORDS(0)];   zero bytes: the first call builds the loop
 *     static ctl_f32_fb_vars vars;
 *     ctl_f32_fb_initial(&vars, sizeof vars);        the values that the variables begin with
 *
 *     every ts seconds:
 *         vars.sp = set_point;  vars.pv = measurement;
 *         ctl_f32_fb(memory, sizeof memory, &vars);
 *         write(vars.op);
 *
 * The memory of a block belongs to the caller. Between two calls it may be moved and copied as bytes, to any address.
 * Memory that has been damaged meanwhile is found: the block begins anew at vars.op, with CTL_FB_STATUS_STATE_LOST.
 * Parameters may change between any two calls. A set that is refused changes nothing; `status`, `error`, `error_param` and
 * `error_reason` say what is wrong.
 */
#ifndef CTL_FB_H
#define CTL_FB_H

#include "ctl.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Status bits, besides those of ctl.h ----------------------------------------------------------------------- */

#define CTL_FB_STATUS_PERIOD_OFF 0x01000000u      /* the measured period is more than 10 % off ts */
#define CTL_FB_STATUS_COMPENSATOR_OUT 0x02000000u /* it is, or was, more than 30 % off: the compensator is not used */
#define CTL_FB_STATUS_REFUSED 0x04000000u         /* the parameters were refused; the old ones are in force */
#define CTL_FB_STATUS_STATE_LOST 0x08000000u      /* the memory was not usable, the loop has begun anew; until ack */
#define CTL_FB_STATUS_NOT_RUNNING 0x10000000u     /* there is no loop: op is as it was */

/* ---- Variables ------------------------------------------------------------------------------------------------- */

/* pv_quality counts as CTL_QUALITY_... of ctl.h does not: here 2 is good and 0 is bad, there 0 is good and 2 is bad. */

/* Where a measurement is. */
#define CTL_FB_PV_ENGINEERING 0
#define CTL_FB_PV_COUNTS 1
#define CTL_FB_PV_PERCENT 2

/* Quality of a measurement; any other number: bad. */
#define CTL_FB_QUALITY_BAD 0
#define CTL_FB_QUALITY_UNCERTAIN 1
#define CTL_FB_QUALITY_GOOD 2

/*
 * The fields have the names of the variables in Structured Text and their types: real for REAL or LREAL, int32_t for DINT,
 * uint32_t for DWORD, uint8_t for BOOL. Any value is allowed in any field. There is no gap between two fields.
 */
#define CTL_FB_FIELDS(real)                                                                                                    \
    /* ---- Inputs */                                                                                                          \
    real sp;           /* local set-point [PV unit]; moved into its limits */                                                  \
    real sp_remote;    /* set-point with CAS [PV unit]; moved into the limits */                                               \
    real pv;           /* measurement [PV unit, or % of the span], see PV_SRC; outside the span and its margins: bad */        \
    real op_man;       /* output with MAN [OP unit]; moved into the limits */                                                  \
    real op_readback;  /* what the actuator, or the inner loop, really took [OP unit]; counts with RB_USE */                   \
    real trk_value;    /* output with TRK [OP unit]; moved into the limits */                                                  \
    real ff;           /* feed-forward, added inside the limits [OP unit]; up to the width of the span, up or down */          \
    real tcyc;         /* measured time since the last call [s], above 0; 0: not measured */                                   \
    /* ---- Parameters */                                                                                                      \
    real ts;           /* period of the law [s], above 0: SCAN_DIV periods of the task */                                      \
    real kp;           /* gain; only its size counts, DIRECT gives the direction [OP unit / PV unit], with KP_PERCENT [%/%] */ \
    real tn;           /* reset time [s], above 0; 0: no integral action */                                                    \
    real tv;           /* rate time [s], above 0, needs TF; 0: no derivative action */                                         \
    real tf;           /* filter time over all terms [s], at least TS/2; 0: no filter */                                       \
    real b;            /* set-point weight of the proportional term, 0 to 2 */                                                 \
    real c;            /* set-point weight of the derivative term, 0 to 2 */                                                   \
    real tt;           /* tracking time of the anti-windup [s], above 0; 0: the largest of TN, TF, TS */                       \
    real deadband;     /* half width of the error deadband [PV unit], 0 or more */                                             \
    real pv_lo;        /* measurement at PV_RAW_LO and at 0 % [PV unit]; not PV_HI */                                          \
    real pv_hi;        /* measurement at PV_RAW_HI and at 100 % [PV unit]; may be below PV_LO */                               \
    real pv_under;     /* how far beyond PV_LO a measurement is still valid [% of the span], 0 to 1000 */                      \
    real pv_over;      /* how far beyond PV_HI a measurement is still valid [% of the span], 0 to 1000 */                      \
    real sp_lim_lo;    /* lowest set-point [PV unit], below SP_LIM_HI; both 0: the span of PV */                               \
    real sp_lim_hi;    /* highest set-point [PV unit]; both 0: the span of PV */                                               \
    real sp_rate_up;   /* fastest rise of the set-point [PV unit/s], above 0; 0: any */                                        \
    real sp_rate_dn;   /* fastest fall of the set-point [PV unit/s], above 0; 0: any */                                        \
    real op_lo;        /* output at OP_RAW_LO and at 0 % [OP unit]; not OP_HI */                                               \
    real op_hi;        /* output at OP_RAW_HI and at 100 % [OP unit]; may be below OP_LO */                                    \
    real op_lim_lo;    /* lowest output [OP unit], inside the span, below OP_LIM_HI; both 0: the span */                       \
    real op_lim_hi;    /* highest output [OP unit], inside the span; both 0: the span */                                       \
    real op_rate_up;   /* fastest rise of the output [OP unit/s], above 0; 0: any */                                           \
    real op_rate_dn;   /* fastest fall of the output [OP unit/s], above 0; 0: any */                                           \
    real op_init;      /* output before the first good measurement [OP unit], moved into the limits */                         \
    real off_op;       /* output with OFF [OP unit], within the limits; counts without OFF_HOLD */                             \
    real fail_op;      /* output while the measurement is bad [OP unit], within the limits; counts with FAIL_ACT 1, 2 */       \
    real fail_rate;    /* rate towards FAIL_OP [OP unit/s], above 0; counts with FAIL_ACT 2 */                                 \
    real hh_lim;       /* alarm level, measurement very high [PV unit], above the next one; counts with HH_EN */               \
    real h_lim;        /* alarm level, measurement high [PV unit], above the next one; counts with H_EN */                     \
    real l_lim;        /* alarm level, measurement low [PV unit], above the next one; counts with L_EN */                      \
    real ll_lim;       /* alarm level, measurement very low [PV unit]; counts with LL_EN */                                    \
    real dev_lim;      /* alarm level, size of the deviation [PV unit], above 0; 0: no such alarm */                           \
    real alm_hyst;     /* how far a signal must come back before its alarm goes [PV unit], 0 or more */                        \
    real latency;      /* time from reading PV to acting OP [s], 0 or more */                                                  \
    real kfd;          /* gain of the disturbance estimator, above 0, up to 1; counts with COMP 1 */                           \
    real tfd;          /* filter time of the disturbance estimator [s], above 0; counts with COMP 1 */                         \
    real alpha;        /* filter time of the disturbance observer [s], above 0; counts with COMP 2 */                          \
    real m_gain;       /* gain of the model, with its sign, not 0 [PV unit / OP unit, / s for each integrator] */              \
    real m_dead;       /* dead time of the model [s], 0 or more */                                                             \
    real m_t1;         /* time constant of the model [s], above 0; 0: none */                                                  \
    real m_t2;         /* A second time constant [s], above 0; 0: none */                                                      \
    real m_t3;         /* A third time constant [s], above 0; 0: none */                                                       \
    real m_t4;         /* A fourth time constant [s], above 0; 0: none */                                                      \
    real m_a1;         /* factor 1 + M_A1*s + M_A2*s^2 of the model's denominator [s], above 0; both 0: none */                \
    real m_a2;         /* the coefficient of s^2 in that factor [s^2], 0 or more */                                            \
    real m_tz;         /* numerator 1 + M_TZ*s of the model [s], any sign; 0: none */                                          \
    /* ---- Outputs */                                                                                                         \
    real op;           /* output [OP unit], within its limits */                                                               \
    real op_percent;   /* output [% of the span] */                                                                            \
    real pv_eng;       /* the measurement that was used [PV unit]; while there is none, the last finite one */                 \
    real sp_working;   /* working set-point [PV unit] */                                                                       \
    real dev;          /* SP_WORKING - PV_ENG [PV unit] */                                                                     \
    real i_term;       /* integral term [OP unit] */                                                                           \
    real pd_term;      /* proportional and derivative terms, filtered [OP unit] */                                             \
    real uf;           /* output of the compensator, used or not [OP unit] */                                                  \
    real d_hat;        /* estimated disturbance at the plant's input, relative to the start [OP unit] */                       \
    real bkcal_out;    /* for a primary loop: its OP_READBACK and its TRK_VALUE [PV unit] */                                   \
    real period;       /* measured period of the law [s]; 0: not measured */                                                   \
    /* ---- Inputs */                                                                                                          \
    int32_t pv_raw;       /* measurement in counts, any; used with PV_SRC 1 */                                                 \
    int32_t pv_quality;   /* 2 good, 1 uncertain (used, and shown), any other: bad */                                          \
    /* ---- Parameters */                                                                                                      \
    int32_t scan_div;     /* the law runs in every n-th call, 0 to 65535; 0 and 1: in every call */                            \
    int32_t pv_src;       /* the measurement is: 0 PV, engineering unit; 1 PV_RAW, counts; 2 PV, per cent of the span */       \
    int32_t pv_raw_lo;    /* counts at PV_LO; not PV_RAW_HI */                                                                 \
    int32_t pv_raw_hi;    /* counts at PV_HI; may be below PV_RAW_LO */                                                        \
    int32_t op_raw_lo;    /* counts at OP_LO; not OP_RAW_HI */                                                                 \
    int32_t op_raw_hi;    /* counts at OP_HI; may be below OP_RAW_LO */                                                        \
    int32_t aw;           /* anti-windup: 0 back-calculation, 1 conditional integration, 2 none */                             \
    int32_t fail_act;     /* when the measurement stays bad: 0 hold the output, 1 go to FAIL_OP, 2 ramp to FAIL_OP */          \
    int32_t fail_hold;    /* bad samples in a row that are held before FAIL_ACT, 0 to 65535 */                                 \
    int32_t comp;         /* compensator: 0 none, 1 disturbance estimator, 2 disturbance observer */                           \
    int32_t filter_order; /* order of the observer's filter, up to 8; 0: the smallest possible */                              \
    int32_t m_integ;      /* integrators of the model, 0 to 8 */                                                               \
    /* ---- Outputs */                                                                                                         \
    int32_t op_raw;       /* output in counts, rounded, within its span */                                                     \
    int32_t mode;         /* mode in force: CTL_MODE_... */                                                                    \
    int32_t error;        /* CTL_OK, or CTL_ERROR_... */                                                                       \
    int32_t error_param;  /* the parameter that was refused; ctl_fb_param_name gives its name */                               \
    int32_t error_reason; /* CTL_REASON_... */                                                                                 \
    uint32_t status;       /* CTL_STATUS_... and CTL_FB_STATUS_... */                                                          \
    /* ---- Inputs: BOOL, 0 or not 0 */                                                                                        \
    uint8_t off;          /* out of service: OP goes to OFF_OP, or stays */                                                    \
    uint8_t trk;          /* OP follows TRK_VALUE */                                                                           \
    uint8_t man;          /* manual: OP is OP_MAN */                                                                           \
    uint8_t hold;         /* OP stays */                                                                                       \
    uint8_t cas;          /* closed loop on SP_REMOTE */                                                                       \
    uint8_t auto_;        /* AUTO (auto is a word of C): closed loop on SP. None of the six: as with HOLD */                   \
    uint8_t rb_use;       /* OP_READBACK is valid */                                                                           \
    uint8_t inhibit_up;   /* the integral term must not drive the output up */                                                 \
    uint8_t inhibit_dn;   /* the integral term must not drive the output down */                                               \
    uint8_t ack;          /* lets a latched fallback end; clears the bit that says that the state was lost */                  \
    uint8_t compensate;   /* use the compensator */                                                                            \
    uint8_t restart;      /* the plant has gone on without this block: begin anew at PV and OP. TRUE for one scan */           \
    /* ---- Parameters: BOOL */                                                                                                \
    uint8_t direct;       /* FALSE: PV rises, OP falls (reverse); TRUE: PV rises, OP rises (direct) */                         \
    uint8_t kp_percent;   /* KP is in per cent of the span of OP per per cent of the span of PV */                             \
    uint8_t trapezoid;    /* integral by the trapezoidal rule */                                                               \
    uint8_t sp_track;     /* with OFF, MAN, TRK the working set-point follows the measurement */                               \
    uint8_t off_hold;     /* with OFF the output stays */                                                                      \
    uint8_t fail_ack;     /* after a fallback wait for ACK */                                                                  \
    uint8_t hh_en;        /* HH_LIM counts */                                                                                  \
    uint8_t h_en;         /* H_LIM counts */                                                                                   \
    uint8_t l_en;         /* L_LIM counts */                                                                                   \
    uint8_t ll_en;        /* LL_LIM counts */                                                                                  \
    /* ---- Outputs: BOOL, 0 or 1 */                                                                                           \
    uint8_t in_auto;      /* the loop is closed: Auto or Cascade */                                                            \
    uint8_t in_cas;       /* the loop is closed on SP_REMOTE */                                                                \
    uint8_t blocked_up;   /* A higher set-point cannot act: INHIBIT_UP of a primary loop */                                    \
    uint8_t blocked_dn;   /* A lower set-point cannot act: INHIBIT_DN of a primary loop */                                     \
    uint8_t hh_alm;       /* alarm: measurement very high */                                                                   \
    uint8_t h_alm;        /* alarm: measurement high */                                                                        \
    uint8_t l_alm;        /* alarm: measurement low */                                                                         \
    uint8_t ll_alm;       /* alarm: measurement very low */                                                                    \
    uint8_t dev_alm;      /* alarm: deviation */                                                                               \
    uint8_t fault;        /* ERROR is not 0 */

typedef struct ctl_f32_fb_vars {
    CTL_FB_FIELDS(float)
} ctl_f32_fb_vars;

typedef struct ctl_f64_fb_vars {
    CTL_FB_FIELDS(double)
} ctl_f64_fb_vars;

/* ---- Memory ---------------------------------------------------------------------------------------------------- */

/* Bytes of a block for up to `delay` samples of dead time and latency: floor((m_dead + latency) / ts). */
#define CTL_F32_FB_SIZE(delay) (424 + CTL_F32_SIZE(delay))
#define CTL_F64_FB_SIZE(delay) (648 + CTL_F64_SIZE(delay))

/* Bytes of a block that never has a compensator. */
#define CTL_F32_FB_SIZE_WITHOUT_COMPENSATOR (424 + CTL_F32_SIZE_WITHOUT_COMPENSATOR)
#define CTL_F64_FB_SIZE_WITHOUT_COMPENSATOR (648 + CTL_F64_SIZE_WITHOUT_COMPENSATOR)

/* The same in words of 8 bytes, for an array of uint64_t (LWORD). */
#define CTL_F32_FB_WORDS(delay) (CTL_F32_FB_SIZE(delay) / 8)
#define CTL_F64_FB_WORDS(delay) (CTL_F64_FB_SIZE(delay) / 8)

/* Alignment of a block [bytes]: any address will do. */
#define CTL_F32_FB_ALIGN 1
#define CTL_F64_FB_ALIGN 1

/* ---- Functions ------------------------------------------------------------------------------------------------- */

/*
 * Name of the parameter that `error_param` is about; never null, lives as long as the program. 0: "no parameter"; a number
 * that error_param never has: "unknown parameter".
 */
const char *ctl_fb_param_name(int32_t param);

/* The macros above as functions; 0 above CTL_MAX_DELAY. */
size_t ctl_f32_fb_size(uint32_t delay);
size_t ctl_f32_fb_size_without_compensator(void);
size_t ctl_f32_fb_align(void);
size_t ctl_f64_fb_size(uint32_t delay);
size_t ctl_f64_fb_size_without_compensator(void);
size_t ctl_f64_fb_align(void);

/* Writes the values that the variables begin with; vars_size is sizeof *vars. */
int32_t ctl_f32_fb_initial(ctl_f32_fb_vars *vars, size_t vars_size);
int32_t ctl_f64_fb_initial(ctl_f64_fb_vars *vars, size_t vars_size);

/*
 * One scan: `size` bytes at `state`, zeroed before the first call. Gives what it writes to vars->error:
 *   CTL_OK; CTL_ERROR_CONFIG, CTL_ERROR_SIZE: the parameters were refused. With CTL_FB_STATUS_NOT_RUNNING there is no loop yet,
 *   and only the reports are written; without it the loop runs with the old parameters.
 *   CTL_ERROR_NULL, CTL_ERROR_ALIGN (vars), CTL_ERROR_SIZE: nothing was done.
 */
int32_t ctl_f32_fb(void *state, size_t size, ctl_f32_fb_vars *vars);
int32_t ctl_f64_fb(void *state, size_t size, ctl_f64_fb_vars *vars);

#ifdef __cplusplus
}
#endif

#endif /* CTL_FB_H */

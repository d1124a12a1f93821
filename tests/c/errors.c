/* Every error code, what a failed call leaves behind, and inputs that are no errors. */
#include <math.h>

#include "cases.h"
#include "variant.h"

#define DELAY 9

static uint64_t block[WORDS(DELAY)], copy[WORDS(DELAY)];
static uint64_t poison[64];

static void *const state = block;
static const size_t size = sizeof block;

static input_t in;
static output_t out;
static ctl_config config;
static ctl_faults faults;
static uint32_t words[SNAPSHOT_WORDS(DELAY)];
static size_t count;
static uint32_t samples;

static void start(int number)
{
    EXPECT(CTL_OK, set_case(number, &config));
    EXPECT(CTL_OK, FN(init)(state, size, &config, &faults));
    CHECK(faults.count == 0 && faults.total == 0);
    memset(&in, 0, sizeof in);
}

/* Every function that needs an initialised block, on this one. */
static void all_refuse(int32_t code, void *at, size_t bytes)
{
    memcpy(copy, block, sizeof block);
    memset(&out, 0xA5, sizeof out);
    count = 77;
    EXPECT(code, FN(settle)(at, bytes, 0, 0, 0));
    EXPECT(code, FN(set_mode)(at, bytes, CTL_MODE_AUTO));
    EXPECT(code, FN(step)(at, bytes, &in, &out));
    EXPECT(code, FN(adopt)(at, bytes, &config, &faults));
    EXPECT(code, FN(advance)(at, bytes, 1));
    EXPECT(code, FN(read)(at, bytes, &out));
    EXPECT(code, FN(snapshot_words)(at, bytes, &count));
    EXPECT(code, FN(save)(at, bytes, words, SNAPSHOT_WORDS(DELAY), &count));
    EXPECT(code, FN(restore)(at, bytes, words, SNAPSHOT_WORDS(DELAY)));
    CHECK(memcmp(&out, poison, sizeof out) == 0 && count == 77);
    CHECK(same_bytes(block, copy, sizeof block));
}

static void null_pointers(void)
{
    start(CASE_ESTIMATOR);
    all_refuse(CTL_ERROR_NULL, NULL, size);
    memcpy(copy, block, sizeof block);
    EXPECT(CTL_ERROR_NULL, ctl_config_default(NULL, sizeof config));
    EXPECT(CTL_ERROR_NULL, FN(delay_samples)(NULL, &samples));
    EXPECT(CTL_ERROR_NULL, FN(delay_samples)(&config, NULL));
    EXPECT(CTL_ERROR_NULL, FN(check)(NULL, &faults));
    EXPECT(CTL_ERROR_NULL, FN(init)(NULL, size, &config, &faults));
    EXPECT(CTL_ERROR_NULL, FN(init)(state, size, NULL, &faults));
    EXPECT(CTL_ERROR_NULL, FN(step)(state, size, NULL, &out));
    EXPECT(CTL_ERROR_NULL, FN(step)(state, size, &in, NULL));
    EXPECT(CTL_ERROR_NULL, FN(adopt)(state, size, NULL, &faults));
    EXPECT(CTL_ERROR_NULL, FN(read)(state, size, NULL));
    EXPECT(CTL_ERROR_NULL, FN(snapshot_words)(state, size, NULL));
    EXPECT(CTL_ERROR_NULL, FN(save)(state, size, NULL, 1000, &count));
    EXPECT(CTL_ERROR_NULL, FN(save)(state, size, words, 1000, NULL));
    EXPECT(CTL_ERROR_NULL, FN(restore)(state, size, NULL, 1000));
    CHECK(same_bytes(block, copy, sizeof block));
    /* Faults may be null. */
    EXPECT(CTL_OK, FN(check)(&config, NULL));
    EXPECT(CTL_OK, FN(adopt)(state, size, &config, NULL));
    EXPECT(CTL_OK, FN(init)(state, size, &config, NULL));
}

static void alignment(void)
{
    static uint64_t room[WORDS(DELAY) + 2], structures[128];
    EXPECT(CTL_OK, set_case(CASE_ESTIMATOR, &config));
    for (size_t offset = 1; offset < ALIGN; offset++) {
        unsigned char *place = (unsigned char *)room + offset;
        memset(room, 0, sizeof room);
        EXPECT(CTL_ERROR_ALIGN, FN(init)(place, size, &config, &faults));
        start(CASE_ESTIMATOR);
        memcpy(place, block, sizeof block);
        all_refuse(CTL_ERROR_ALIGN, place, size);
    }
    start(CASE_PID);
    for (size_t offset = 1; offset < sizeof(uint64_t); offset++) {
        void *place = (unsigned char *)structures + offset;
        memset(structures, 0, sizeof structures);
        EXPECT(CTL_ERROR_ALIGN, FN(check)(place, NULL));
        EXPECT(CTL_ERROR_ALIGN, ctl_config_default(place, sizeof config));
        EXPECT(CTL_ERROR_ALIGN, FN(check)(&config, place));
        if (offset % sizeof(real) != 0) {
            EXPECT(CTL_ERROR_ALIGN, FN(step)(state, size, place, &out));
            EXPECT(CTL_ERROR_ALIGN, FN(step)(state, size, &in, place));
            EXPECT(CTL_ERROR_ALIGN, FN(read)(state, size, place));
        }
        if (offset % sizeof(uint32_t) != 0) {
            EXPECT(CTL_ERROR_ALIGN, FN(delay_samples)(&config, place));
            EXPECT(CTL_ERROR_ALIGN, FN(save)(state, size, place, 1000, &count));
            EXPECT(CTL_ERROR_ALIGN, FN(restore)(state, size, place, 1000));
        }
        if (offset % sizeof(size_t) != 0) {
            EXPECT(CTL_ERROR_ALIGN, FN(snapshot_words)(state, size, place));
            EXPECT(CTL_ERROR_ALIGN, FN(save)(state, size, words, 1000, place));
        }
        for (size_t i = 0; i < sizeof structures; i++) {
            CHECK(((unsigned char *)structures)[i] == 0);
        }
    }
}

static void sizes(void)
{
    CHECK(FN(align)() == ALIGN);
    CHECK(FN(size_without_compensator)() == SIZE_PLAIN);
    for (uint32_t delay = 0; delay < 3000; delay++) {
        CHECK(FN(size)(delay) == (size_t)SIZE(delay));
        CHECK(SIZE(delay) % ALIGN == 0 && WORDS(delay) * 8 == SIZE(delay));
    }
    CHECK(FN(size)(CTL_MAX_DELAY) == (size_t)SIZE((size_t)CTL_MAX_DELAY));
    CHECK(FN(size)(CTL_MAX_DELAY + 1u) == 0 && FN(size)(UINT32_MAX) == 0);

    for (int number = 0; number < CASES; number++) {
        EXPECT(CTL_OK, set_case(number, &config));
        EXPECT(CTL_OK, FN(delay_samples)(&config, &samples));
        static const uint32_t expected[CASES] = {0, 4, 2, 2, 6};
        CHECK(samples == expected[number]);
        size_t least = number == CASE_PID ? SIZE_PLAIN : SIZE(samples);
        /* The macro rounds up to whole words; one cell fewer is too few. */
        size_t too_small = number == CASE_PID ? SIZE_PLAIN - 1 : SIZE(0) - ALIGN + (samples + 1) * sizeof(real) - 1;
        if (!SINGLE && number != CASE_PID) {
            too_small = least - 1;
        }
        memset(block, 0, sizeof block);
        EXPECT(CTL_ERROR_SIZE, FN(init)(state, 0, &config, &faults));
        EXPECT(CTL_ERROR_SIZE, FN(init)(state, too_small, &config, &faults));
        if (number != CASE_PID) {
            CHECK(faults.total == 1 && faults.list[0].param == CTL_PARAM_CAPACITY);
            CHECK(faults.list[0].reason == CTL_REASON_TOO_LARGE && faults.list[0].value == samples);
            CHECK(faults.list[0].max == samples - 1.0);
        }
        for (size_t i = 0; i < WORDS(DELAY); i++) {
            CHECK(block[i] == 0);
        }
        EXPECT(CTL_OK, FN(init)(state, least, &config, &faults));
        EXPECT(CTL_OK, FN(step)(state, least, &in, &out));
        all_refuse(CTL_ERROR_SIZE, state, too_small);
        all_refuse(CTL_ERROR_SIZE, state, 0);
        EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
    }
    /* A block without room for a compensator keeps its law. */
    EXPECT(CTL_OK, set_case(CASE_PID, &config));
    EXPECT(CTL_OK, FN(init)(state, SIZE_PLAIN, &config, NULL));
    EXPECT(CTL_OK, set_case(CASE_ESTIMATOR, &config));
    memcpy(copy, block, sizeof block);
    EXPECT(CTL_ERROR_SIZE, FN(adopt)(state, size, &config, &faults));
    CHECK(faults.total == 1 && faults.list[0].param == CTL_PARAM_CAPACITY);
    CHECK(same_bytes(block, copy, sizeof block));
}

static void not_initialised(void)
{
    EXPECT(CTL_OK, set_case(CASE_ESTIMATOR, &config));
    memset(block, 0, sizeof block);
    all_refuse(CTL_ERROR_NOT_INITIALISED, state, size);
    memset(block, 0xFF, sizeof block);
    all_refuse(CTL_ERROR_NOT_INITIALISED, state, size);
    for (size_t i = 0; i < sizeof block; i++) {
        ((unsigned char *)block)[i] = (unsigned char)(i * 37 + 11);
    }
    all_refuse(CTL_ERROR_NOT_INITIALISED, state, size);
    /* Each bit of the beginning that says what the block is: magic, build, kind, cells, checksum. */
    start(CASE_ESTIMATOR);
    for (int bit = 0; bit < 160; bit++) {
        ((unsigned char *)block)[bit / 8] ^= (unsigned char)(1 << bit % 8);
        all_refuse(CTL_ERROR_NOT_INITIALISED, state, size);
        ((unsigned char *)block)[bit / 8] ^= (unsigned char)(1 << bit % 8);
    }
    EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
}

/* Over the first words of a block: each is mixed in by a product and a shift. */
static uint32_t sum_of(const uint32_t *from)
{
    uint32_t sum = 0x9E3779B9u;
    for (int i = 0; i < 4; i++) {
        sum = (sum ^ from[i]) * 0x9E3779B1u;
        sum ^= sum >> 16;
    }
    return sum;
}

/* A block that another build has left behind: intact, but laid out in another way perhaps. */
static void other_build(void)
{
    uint32_t head[5];
    start(CASE_ESTIMATOR);
    memcpy(head, block, sizeof head);
    CHECK(head[4] == sum_of(head));
    head[1]++;
    head[4] = sum_of(head);
    memcpy(block, head, sizeof head);
    all_refuse(CTL_ERROR_VERSION, state, size);
    EXPECT(CTL_OK, FN(init)(state, size, &config, NULL));
    EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
}

static void bad_configurations(void)
{
    EXPECT(CTL_ERROR_STRUCT_SIZE, ctl_config_default(&config, sizeof config - 1));
    EXPECT(CTL_ERROR_STRUCT_SIZE, ctl_config_default(&config, 0));
    EXPECT(CTL_OK, ctl_config_default(&config, sizeof config));
    CHECK(config.struct_size == sizeof config);
    start(CASE_ESTIMATOR);
    EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
    memcpy(copy, block, sizeof block);
    config.struct_size--;
    EXPECT(CTL_ERROR_STRUCT_SIZE, FN(check)(&config, &faults));
    EXPECT(CTL_ERROR_STRUCT_SIZE, FN(init)(state, size, &config, &faults));
    EXPECT(CTL_ERROR_STRUCT_SIZE, FN(adopt)(state, size, &config, &faults));
    EXPECT(CTL_ERROR_STRUCT_SIZE, FN(delay_samples)(&config, &samples));

    struct {
        int32_t *choice;
        double *number;
        double bad;
        int32_t param, reason;
    } list[] = {
        {&config.action, NULL, 2, CTL_PARAM_ACTION, CTL_REASON_OUT_OF_RANGE},
        {&config.action, NULL, -1, CTL_PARAM_ACTION, CTL_REASON_OUT_OF_RANGE},
        {&config.integral_rule, NULL, 2, CTL_PARAM_INTEGRAL_RULE, CTL_REASON_OUT_OF_RANGE},
        {&config.anti_windup, NULL, 3, CTL_PARAM_ANTI_WINDUP, CTL_REASON_OUT_OF_RANGE},
        {&config.fallback_action, NULL, 3, CTL_PARAM_FALLBACK_ACTION, CTL_REASON_OUT_OF_RANGE},
        {&config.fallback_return, NULL, 2, CTL_PARAM_FALLBACK_RETURN, CTL_REASON_OUT_OF_RANGE},
        {&config.hold_samples, NULL, 65536, CTL_PARAM_HOLD_SAMPLES, CTL_REASON_OUT_OF_RANGE},
        {&config.hold_samples, NULL, -1, CTL_PARAM_HOLD_SAMPLES, CTL_REASON_OUT_OF_RANGE},
        {&config.compensator, NULL, 3, CTL_PARAM_COMPENSATOR, CTL_REASON_OUT_OF_RANGE},
        {&config.model_integrators, NULL, 9, CTL_PARAM_MODEL_INTEGRATORS, CTL_REASON_OUT_OF_RANGE},
        {&config.model_pole_count, NULL, 9, CTL_PARAM_MODEL_POLE_COUNT, CTL_REASON_OUT_OF_RANGE},
        {&config.model_zero_count, NULL, INT32_MIN, CTL_PARAM_MODEL_ZERO_COUNT, CTL_REASON_OUT_OF_RANGE},
        {&config.filter_order, NULL, 9, CTL_PARAM_FILTER_ORDER, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.ts, 0, CTL_PARAM_TS, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.ts, NAN, CTL_PARAM_TS, CTL_REASON_NOT_FINITE},
        {NULL, &config.kp, INFINITY, CTL_PARAM_KP, CTL_REASON_NOT_FINITE},
        {NULL, &config.ki, NAN, CTL_PARAM_KI, CTL_REASON_NOT_FINITE},
        {NULL, &config.ki, -1, CTL_PARAM_MODEL_GAIN, CTL_REASON_SIGN_MISMATCH},
        {NULL, &config.kd, NAN, CTL_PARAM_KD, CTL_REASON_NOT_FINITE},
        {NULL, &config.tf, 0.01, CTL_PARAM_TF, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.tf, 0, CTL_PARAM_KD, CTL_REASON_NEEDS_FILTER},
        {NULL, &config.b, 2.5, CTL_PARAM_B, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.c, -0.5, CTL_PARAM_C, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.tt, 0, CTL_PARAM_TT, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.output_lo, 3, CTL_PARAM_OUTPUT_LO, CTL_REASON_INVERTED},
        {NULL, &config.output_hi, 1e13, CTL_PARAM_OUTPUT_HI, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.output_rate_up, 0, CTL_PARAM_OUTPUT_RATE_UP, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.output_rate_down, INFINITY, CTL_PARAM_OUTPUT_RATE_DOWN, CTL_REASON_NOT_FINITE},
        {NULL, &config.setpoint_lo, NAN, CTL_PARAM_SETPOINT_LO, CTL_REASON_NOT_FINITE},
        {NULL, &config.setpoint_hi, -1e7, CTL_PARAM_SETPOINT_LO, CTL_REASON_INVERTED},
        {NULL, &config.setpoint_rate_up, -1, CTL_PARAM_SETPOINT_RATE_UP, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.setpoint_rate_down, -1, CTL_PARAM_SETPOINT_RATE_DOWN, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.deadband, -1, CTL_PARAM_DEADBAND, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.measurement_lo, NAN, CTL_PARAM_MEASUREMENT_LO, CTL_REASON_NOT_FINITE},
        {NULL, &config.measurement_hi, NAN, CTL_PARAM_MEASUREMENT_HI, CTL_REASON_NOT_FINITE},
        {NULL, &config.offset_lo, NAN, CTL_PARAM_OFFSET_LO, CTL_REASON_NOT_FINITE},
        {NULL, &config.offset_hi, NAN, CTL_PARAM_OFFSET_HI, CTL_REASON_NOT_FINITE},
        {NULL, &config.off_output, 99, CTL_PARAM_OFF_OUTPUT, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.initial_output, NAN, CTL_PARAM_INITIAL_OUTPUT, CTL_REASON_NOT_FINITE},
        {NULL, &config.alarm_hi_hi, 1e13, CTL_PARAM_ALARM_HI_HI, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.alarm_hi, INFINITY, CTL_PARAM_ALARM_HI, CTL_REASON_NOT_FINITE},
        {NULL, &config.alarm_lo, -INFINITY, CTL_PARAM_ALARM_LO, CTL_REASON_NOT_FINITE},
        {NULL, &config.alarm_lo_lo, -1e13, CTL_PARAM_ALARM_LO_LO, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.alarm_deviation, -1, CTL_PARAM_ALARM_DEVIATION, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.alarm_hysteresis, NAN, CTL_PARAM_ALARM_HYSTERESIS, CTL_REASON_NOT_FINITE},
        {NULL, &config.kfd, NAN, CTL_PARAM_KFD, CTL_REASON_NOT_FINITE},
        {NULL, &config.kfd, 1.5, CTL_PARAM_KFD, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.tfd, 0, CTL_PARAM_TFD, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.model_gain, 0, CTL_PARAM_MODEL_GAIN, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.model_dead_time, -1, CTL_PARAM_DEAD_TIME, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.model_dead_time, NAN, CTL_PARAM_DEAD_TIME, CTL_REASON_NOT_FINITE},
        {NULL, &config.model_dead_time, 1e9, CTL_PARAM_DEAD_TIME, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.latency, -1, CTL_PARAM_LATENCY, CTL_REASON_OUT_OF_RANGE},
        {NULL, &config.model_pole_a1[0], -1, CTL_PARAM_MODEL_POLES, CTL_REASON_UNSTABLE},
        {NULL, &config.model_pole_a2[0], NAN, CTL_PARAM_MODEL_POLES, CTL_REASON_NOT_FINITE},
        {&config.model_pole_count, NULL, 0, CTL_PARAM_MODEL_ORDER, CTL_REASON_OUT_OF_RANGE},
        {&config.model_zero_count, NULL, 2, CTL_PARAM_MODEL_ZEROS, CTL_REASON_OUT_OF_RANGE},
    };
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        EXPECT(CTL_OK, set_case(CASE_ESTIMATOR, &config));
        if (list[i].choice != NULL) {
            *list[i].choice = (int32_t)list[i].bad;
        } else {
            *list[i].number = list[i].bad;
        }
        for (int call = 0; call < 4; call++) {
            memset(&faults, 0xA5, sizeof faults);
            int32_t code = call == 0   ? FN(check)(&config, &faults)
                           : call == 1 ? FN(init)(state, size, &config, &faults)
                           : call == 2 ? FN(adopt)(state, size, &config, &faults)
                                       : FN(delay_samples)(&config, &samples);
            EXPECT(CTL_ERROR_CONFIG, code);
            if (call < 3) {
                int found = 0;
                CHECK(faults.count >= 1 && faults.count <= CTL_MAX_FAULTS && faults.total >= faults.count);
                for (uint32_t f = 0; f < faults.count && f < CTL_MAX_FAULTS; f++) {
                    found |= faults.list[f].param == list[i].param && faults.list[f].reason == list[i].reason;
                }
                if (!found) {
                    printf("entry %d: first fault %s %s\n", (int)i, ctl_param_name(faults.list[0].param),
                           ctl_reason_text(faults.list[0].reason));
                }
                CHECK(found);
            }
        }
        CHECK(same_bytes(block, copy, sizeof block));
    }
    /* Many faults: all counted, some listed. */
    EXPECT(CTL_OK, ctl_config_default(&config, sizeof config));
    for (double *x = &config.ts; x < &config.model_pole_a1[0]; x++) {
        *x = INFINITY;
    }
    config.compensator = CTL_COMPENSATOR_ESTIMATOR;
    config.action = 9;
    EXPECT(CTL_ERROR_CONFIG, FN(check)(&config, &faults));
    CHECK(faults.count == CTL_MAX_FAULTS && faults.total > CTL_MAX_FAULTS);
    CHECK(faults.list[0].param == CTL_PARAM_ACTION && faults.list[0].value == 9.0);
    /* A plain default lacks its sampling period only. */
    EXPECT(CTL_OK, ctl_config_default(&config, sizeof config));
    EXPECT(CTL_ERROR_CONFIG, FN(check)(&config, &faults));
    CHECK(faults.total == 1 && faults.list[0].param == CTL_PARAM_TS);
}

/* Inputs that no step refuses: finite output in its range, and a status that tells. */
static void bad_inputs(void)
{
    static const double odd[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e-320, -0.0};
    start(CASE_FULL);
    in.r = 0.5;
    for (int warm = 0; warm < 5; warm++) {
        EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
    }
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        real *fields[] = {&in.r, &in.r_remote, &in.y, &in.u_applied, &in.manual, &in.track, &in.offset};
        for (int32_t mode = -2; mode < 10; mode++) {
            for (size_t f = 0; f < 7; f++) {
                real before = *fields[f];
                *fields[f] = (real)odd[i];
                in.mode = mode;
                in.quality = mode - 1;
                in.has_u_applied = in.has_manual = mode & 1;
                EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
                CHECK(isfinite(out.u) && isfinite(out.v) && isfinite(out.i) && isfinite(out.pd));
                CHECK(isfinite(out.u_f) && isfinite(out.d_hat) && isfinite(out.r));
                CHECK(out.u >= (real)-1.7 && out.u <= (real)1.9);
                CHECK(out.mode >= CTL_MODE_OFF && out.mode <= CTL_MODE_FALLBACK);
                if (mode < 0 || mode > CTL_MODE_HOLD) {
                    CHECK((out.status & CTL_STATUS_REJECTED) != 0);
                }
                if (f == 2 && i < 5) {
                    CHECK((out.status & CTL_STATUS_BAD_INPUT) != 0);
                }
                *fields[f] = before;
            }
        }
    }
    /* An unknown mode keeps the one that was asked for last, also when that came with an input. */
    start(CASE_PID);
    in.has_manual = 1;
    in.manual = 1;
    in.mode = CTL_MODE_MANUAL;
    EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
    in.mode = 99;
    EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
    CHECK(out.mode == CTL_MODE_MANUAL && out.u == 1 && (out.status & CTL_STATUS_REJECTED) != 0);
    in.mode = CTL_MODE_AS_SET;
    EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
    CHECK(out.mode == CTL_MODE_AUTO && (out.status & CTL_STATUS_REJECTED) == 0);
}

#ifdef __arm__
#define RANDOM_CONFIGURATIONS 200
#else
#define RANDOM_CONFIGURATIONS 1000
#endif

static uint64_t chance = 1;

static uint32_t below(uint32_t n)
{
    chance = chance * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(chance >> 33) % n;
}

/* Configurations with a few fields of any kind: refused with a fault, or a loop whose outputs are finite and in range. */
static void random_configurations(void)
{
    static const double odd[] = {NAN, INFINITY, -INFINITY, 0, -0.0, 1e-320, -1, 0.5, 1, 3, 1e3, 1e12, -1e12, 1e300, 1e-12, 2e9};
    static const int32_t choice[] = {0, 1, 2, 3, 8, 9, -1, 65535, 65536, INT32_MIN, INT32_MAX};
    int accepted = 0;
    for (int i = 0; i < RANDOM_CONFIGURATIONS; i++) {
        EXPECT(CTL_OK, set_case((int)below(CASES), &config));
        int32_t *const choices = &config.action;
        double *const numbers = &config.ts;
        for (uint32_t change = 0, changes = 1 + below(3); change < changes; change++) {
            if (below(4) == 0) {
                choices[below(12)] = choice[below(sizeof choice / sizeof *choice)];
            } else {
                numbers[below(69)] = odd[below(sizeof odd / sizeof *odd)];
            }
        }
        int32_t code = FN(init)(state, size, &config, &faults);
        CHECK(code == CTL_OK || code == CTL_ERROR_CONFIG || code == CTL_ERROR_SIZE);
        CHECK((code == CTL_OK) == (faults.total == 0));
        if (code != CTL_OK) {
            continue;
        }
        accepted++;
        memset(&in, 0, sizeof in);
        for (int k = 0; k < 30; k++) {
            in.r = (real)odd[below(sizeof odd / sizeof *odd)];
            in.y = (real)(0.1 * k);
            in.has_u_applied = (int32_t)below(2);
            in.u_applied = (real)odd[below(sizeof odd / sizeof *odd)];
            in.mode = (int32_t)below(8);
            EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
            CHECK(isfinite(out.u) && isfinite(out.v) && isfinite(out.i) && isfinite(out.pd));
            CHECK(isfinite(out.u_f) && isfinite(out.d_hat) && isfinite(out.r));
            CHECK(out.u >= (real)config.output_lo && out.u <= (real)config.output_hi);
        }
    }
    CHECK(accepted > RANDOM_CONFIGURATIONS / 10 && accepted < RANDOM_CONFIGURATIONS);
}

static void arguments(void)
{
    static const int32_t unknown[] = {0, 7, 8, -1, INT32_MAX, INT32_MIN};
    start(CASE_ESTIMATOR);
    memcpy(copy, block, sizeof block);
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++) {
        EXPECT(CTL_ERROR_ARGUMENT, FN(set_mode)(state, size, unknown[i]));
    }
    EXPECT(CTL_ERROR_ARGUMENT, FN(settle)(state, size, (real)NAN, 0, 0));
    EXPECT(CTL_ERROR_ARGUMENT, FN(settle)(state, size, 0, (real)INFINITY, 0));
    EXPECT(CTL_ERROR_ARGUMENT, FN(settle)(state, size, 0, 0, (real)-INFINITY));
    CHECK(same_bytes(block, copy, sizeof block));
    EXPECT(CTL_OK, FN(settle)(state, size, 1, 1, 2));
    EXPECT(CTL_OK, FN(read)(state, size, &out));
    CHECK(out.u == 2 && out.mode == CTL_MODE_AUTO && out.status == 0);
    /* At rest nothing moves. */
    in.r = in.y = 1;
    EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
    CHECK(out.u == 2);
    EXPECT(CTL_OK, FN(advance)(state, size, UINT32_MAX));
    EXPECT(CTL_OK, FN(step)(state, size, &in, &out));
    CHECK((out.status & CTL_STATUS_OVERRUN) != 0);
}

static void texts(void)
{
    CHECK(ctl_abi_version() == CTL_ABI_VERSION);
    for (int32_t code = -5; code < 300; code++) {
        CHECK(strlen(ctl_error_text(code)) > 0);
        CHECK(strlen(ctl_param_name(code)) > 0);
        CHECK(strlen(ctl_reason_text(code)) > 0);
    }
    CHECK(strcmp(ctl_param_name(CTL_PARAM_OUTPUT_RATE_UP), "output_rate_up") == 0);
    CHECK(strcmp(ctl_param_name(CTL_PARAM_COMPENSATOR), "compensator") == 0);
    CHECK(strcmp(ctl_error_text(CTL_OK), ctl_error_text(1)) != 0);
}

/* A block of one number type is none of the other. */
static void other_type(void)
{
    static uint64_t large[CTL_F64_WORDS(DELAY)];
    EXPECT(CTL_OK, set_case(CASE_PID, &config));
#if SINGLE
    ctl_f64_output other;
    EXPECT(CTL_OK, ctl_f32_init(large, sizeof large, &config, NULL));
    EXPECT(CTL_ERROR_NOT_INITIALISED, ctl_f64_read(large, sizeof large, &other));
#else
    ctl_f32_output other;
    EXPECT(CTL_OK, ctl_f64_init(large, sizeof large, &config, NULL));
    EXPECT(CTL_ERROR_NOT_INITIALISED, ctl_f32_read(large, sizeof large, &other));
#endif
}

int main(void)
{
    memset(poison, 0xA5, sizeof poison);
    sizes();
    null_pointers();
    alignment();
    not_initialised();
    other_build();
    bad_configurations();
    bad_inputs();
    random_configurations();
    arguments();
    texts();
    other_type();
    return verdict();
}

/* What the table in controller-capi/README.md says the block does. */
#include <math.h>

#include "cases.h"
#include "variant.h"

#define DELAY 9

static uint64_t block[WORDS(DELAY)];
static ctl_config config;
static input_t in;
static output_t out;

static void start(void)
{
    memset(block, 0, sizeof block);
    EXPECT(CTL_OK, set_case(CASE_PID, &config));
    config.output_hi = 10.0;
    config.hold_samples = 3;
    config.fallback_action = CTL_FALLBACK_SUBSTITUTE;
    config.fallback_output = 0.5;
    config.off_output = 0.25;
    config.initial_output = 2.0;
    config.measurement_lo = -5.0;
    config.measurement_hi = 5.0;
    EXPECT(CTL_OK, FN(init)(block, sizeof block, &config, NULL));
    memset(&in, 0, sizeof in);
}

static uint32_t step(void)
{
    EXPECT(CTL_OK, FN(step)(block, sizeof block, &in, &out));
    return out.status;
}

static void restart(void)
{
    memset(block, 0, sizeof block);
    EXPECT(CTL_ERROR_NOT_INITIALISED, FN(step)(block, sizeof block, &in, &out));
    start();
    EXPECT(CTL_OK, FN(read)(block, sizeof block, &out));
    CHECK((out.status & CTL_STATUS_UNINITIALISED) != 0);
    /* No good measurement yet: the initial output, or what is applied. */
    in.y = (real)NAN;
    CHECK((step() & CTL_STATUS_UNINITIALISED) != 0 && out.u == 2);
    in.has_u_applied = 1;
    in.u_applied = 3;
    CHECK((step() & CTL_STATUS_UNINITIALISED) != 0 && out.u == 3);
    /* The first good one starts there, at rest but for the set-point's own part. */
    in.y = in.r = 1;
    CHECK((step() & CTL_STATUS_UNINITIALISED) == 0 && out.u == 3 && out.mode == CTL_MODE_AUTO);
    start();
    in.y = in.r = 1;
    step();
    CHECK(out.u == 2);
    EXPECT(CTL_OK, FN(settle)(block, sizeof block, 1, 1, 4));
    step();
    CHECK(out.u == 4);
}

static void bad_sensor(void)
{
    for (int kind = 0; kind < 3; kind++) {
        start();
        in.y = in.r = 1;
        step();
        in.y = kind == 0 ? (real)NAN : kind == 1 ? (real)5.5 : in.y;
        in.quality = kind == 2 ? CTL_QUALITY_BAD : CTL_QUALITY_GOOD;
        for (int k = 0; k < 3; k++) {
            uint32_t status = step();
            CHECK((status & CTL_STATUS_BAD_INPUT) != 0 && (status & CTL_STATUS_HELD) != 0 && out.u == 2);
            CHECK(out.mode == CTL_MODE_AUTO);
        }
        CHECK((step() & CTL_STATUS_FALLBACK) != 0 && out.u == (real)0.5 && out.mode == CTL_MODE_FALLBACK);
        /* Manual yields, Track and Off go on. */
        in.has_manual = 1;
        in.manual = 7;
        in.mode = CTL_MODE_MANUAL;
        step();
        CHECK(out.mode == CTL_MODE_FALLBACK && out.u == (real)0.5);
        in.mode = CTL_MODE_TRACK;
        in.track = 6;
        step();
        CHECK(out.mode == CTL_MODE_TRACK && out.u == 6);
        in.mode = CTL_MODE_OFF;
        step();
        CHECK(out.mode == CTL_MODE_OFF && out.u == (real)0.25);
        /* Back from where the output is. */
        in.mode = CTL_MODE_AUTO;
        in.y = 1;
        in.quality = CTL_QUALITY_GOOD;
        CHECK((step() & (CTL_STATUS_FALLBACK | CTL_STATUS_BAD_INPUT)) == 0 && out.u == (real)0.25);
    }
    start();
    config.fallback_return = CTL_RETURN_ACKNOWLEDGED;
    EXPECT(CTL_OK, FN(adopt)(block, sizeof block, &config, NULL));
    in.y = in.r = 1;
    step();
    in.y = (real)NAN;
    for (int k = 0; k < 5; k++) {
        step();
    }
    in.y = 1;
    CHECK((step() & CTL_STATUS_AWAITING_ACKNOWLEDGEMENT) != 0 && out.mode == CTL_MODE_FALLBACK);
    in.acknowledge = 1;
    CHECK((step() & CTL_STATUS_FALLBACK) == 0 && out.mode == CTL_MODE_AUTO);
}

static void online_change(void)
{
    start();
    config.c = config.b = 1;
    EXPECT(CTL_OK, FN(init)(block, sizeof block, &config, NULL));
    in.y = in.r = 1;
    for (int k = 0; k < 20; k++) {
        step();
    }
    CHECK(out.u == 2);
    /* At rest nothing moves, whatever is adopted: gains, period, a compensator, another, none. */
    static const int order[] = {CASE_ESTIMATOR, CASE_OTHER_ESTIMATOR, CASE_OBSERVER, CASE_ESTIMATOR, CASE_PID};
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        EXPECT(CTL_OK, set_case(order[i], &config));
        config.output_lo = 0.0;
        config.output_hi = 10.0;
        config.kp = 5.0 + (double)i;
        config.ts = 0.05 + 0.01 * (double)i;
        EXPECT(CTL_OK, FN(adopt)(block, sizeof block, &config, NULL));
        for (int k = 0; k < 20; k++) {
            step();
            /* Five adoptions of some eight roundings of numbers up to 16. */
            CHECK(fabs((double)out.u - 2.0) <= 40.0 * (SINGLE ? 9.6e-7 : 1.8e-15));
        }
    }
    /* A tighter limit holds at once. */
    config.output_hi = 1.5;
    EXPECT(CTL_OK, FN(adopt)(block, sizeof block, &config, NULL));
    CHECK((step() & CTL_STATUS_LIMITED_HIGH) != 0 && out.u == (real)1.5);
}

static void missed_scans(void)
{
    start();
    in.y = in.r = 1;
    step();
    EXPECT(CTL_OK, FN(advance)(block, sizeof block, 2));
    CHECK((step() & CTL_STATUS_OVERRUN) != 0 && out.u == 2);
    CHECK((step() & CTL_STATUS_OVERRUN) == 0);
    EXPECT(CTL_OK, FN(advance)(block, sizeof block, 50));
    in.y = 2;
    /* More than are held: it settles at the measurement, so that its jump moves nothing but the integral term. */
    CHECK((step() & CTL_STATUS_OVERRUN) != 0 && fabs((double)out.u - 2.0) <= 0.05 + 1e-6);
}

int main(void)
{
    restart();
    bad_sensor();
    online_change();
    missed_scans();
    return verdict();
}

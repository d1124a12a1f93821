/*
 * The function block on damaged memory: it begins anew at its output and says so until ACK, or what was damaged has no
 * meaning. The first argument is the step from bit to bit, 1 when there is none.
 */
#include <math.h>

#include "ctl_fb.h"
#include "variant.h"

#define DELAY 6
#define SAMPLES 30
#define GUARD 64

#if SINGLE
#define FB_WORDS CTL_F32_FB_WORDS(DELAY)
#else
#define FB_WORDS CTL_F64_FB_WORDS(DELAY)
#endif
#define vars_t FN(fb_vars)

static struct {
    uint64_t before[GUARD / 8];
    uint64_t state[FB_WORDS];
    uint64_t after[GUARD / 8];
} place;

static uint64_t good[FB_WORDS], older[FB_WORDS];
static vars_t vars, kept, undamaged, stale;
static unsigned long found, harmless;

static uint64_t seed = 1;

static uint32_t chance(void)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(seed >> 33);
}

static int32_t scan(void)
{
    return FN(fb)(place.state, sizeof place.state, &vars);
}

static int same_results(const vars_t *a, const vars_t *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

/* A scan on what is in the memory; then all is as it was. */
static void judge(void)
{
    vars = kept;
    EXPECT(CTL_OK, scan());
    CHECK(isfinite(vars.op) && vars.op >= 0 && vars.op <= 100);
    if ((vars.status & CTL_FB_STATUS_STATE_LOST) != 0) {
        /* At rest at the output: the first sample adds the integral of its error. */
        real step = kept.kp * kept.ts / kept.tn * (real)fabs((double)(kept.sp - kept.pv));
        CHECK(fabs((double)(vars.op - kept.op)) <= (double)step + 1e-3);
        EXPECT(CTL_OK, scan());
        CHECK((vars.status & CTL_FB_STATUS_STATE_LOST) != 0);
        vars.ack = 1;
        EXPECT(CTL_OK, scan());
        CHECK((vars.status & CTL_FB_STATUS_STATE_LOST) == 0);
        found++;
    } else {
        CHECK(same_results(&vars, &undamaged) || same_results(&vars, &stale));
        harmless++;
    }
    memcpy(place.state, good, sizeof good);
}

static void start(int comp)
{
    memset(&place, 0xA5, sizeof place);
    memset(place.state, 0, sizeof place.state);
    memset(&vars, 0, sizeof vars);
    EXPECT(CTL_OK, FN(fb_initial)(&vars, sizeof vars));
    vars.kp = (real)1.5;
    vars.tn = 4;
    vars.op_init = 30;
    vars.sp = 50;
    vars.comp = comp;
    vars.kfd = (real)0.69;
    vars.tfd = (real)0.3;
    vars.alpha = (real)0.4;
    vars.m_gain = 1;
    vars.m_a1 = (real)1.2;
    vars.m_a2 = (real)0.2;
    vars.m_dead = (real)0.55;
    vars.tcyc = (real)0.1;
    for (int k = 0; k < SAMPLES; k++) {
        if (k == SAMPLES - 1) {
            memcpy(older, place.state, sizeof older);
        }
        vars.pv = (real)(45 + 0.01 * (double)(chance() % 200));
        EXPECT(CTL_OK, scan());
    }
    memcpy(good, place.state, sizeof good);
    kept = vars;
    EXPECT(CTL_OK, scan());
    undamaged = vars;
    vars = kept;
    memcpy(place.state, older, sizeof older);
    EXPECT(CTL_OK, scan());
    stale = vars;
    memcpy(place.state, good, sizeof good);
    found = harmless = 0;
}

static void damaged(unsigned stride)
{
    for (size_t bit = 0; bit < 8 * sizeof place.state; bit += stride) {
        ((unsigned char *)place.state)[bit / 8] ^= (unsigned char)(1u << (bit % 8));
        judge();
    }
    if (stride == 1) {
        CHECK(found >= 8 * 120 * sizeof(real));
    }
    CHECK(found > 0 && harmless > 0);
    for (unsigned round = 0; round < 2000 / stride; round++) {
        for (unsigned hits = 2 + chance() % 20; hits > 0; hits--) {
            uint32_t word = chance() % 3 == 0 ? 0xFFFFFFFFu : chance() * 2u;
            memcpy((unsigned char *)place.state + 4 * (chance() % (sizeof place.state / 4)), &word, sizeof word);
        }
        judge();
    }
    for (size_t split = 0; split <= sizeof place.state; split += 4) {
        memcpy(place.state, older, split);
        judge();
        memcpy((unsigned char *)place.state + split, (unsigned char *)older + split, sizeof place.state - split);
        judge();
    }
    unsigned char guard[GUARD];
    memset(guard, 0xA5, sizeof guard);
    CHECK(memcmp(place.before, guard, GUARD) == 0 && memcmp(place.after, guard, GUARD) == 0);
}

/* Names that error_param can ask for, and others. */
static void names(void)
{
    const int32_t none[] = {0, -1, 99, 100, 150, 200, 202, 1000, INT32_MAX, INT32_MIN};
    CHECK(strcmp(ctl_fb_param_name(1), "ts") == 0 && strcmp(ctl_fb_param_name(101), "scan_div") == 0);
    CHECK(strcmp(ctl_fb_param_name(201), "state") == 0);
    CHECK(strcmp(ctl_fb_param_name(0), "no parameter") == 0);
    for (size_t i = 1; i < sizeof none / sizeof none[0]; i++) {
        CHECK(strcmp(ctl_fb_param_name(none[i]), "unknown parameter") == 0);
    }
}

int main(int argc, char **argv)
{
    unsigned stride = argc > 1 ? (unsigned)atoi(argv[1]) : 1;
    names();
    for (int comp = 0; comp < 3; comp++) {
        start(comp);
        damaged(stride);
    }
    return verdict();
}

/*
 * Damaged memory: one bit, some words, one part old and another one new. A block says that it is damaged or steps on within
 * its limits; nothing beyond it is touched, and no call fails in another way than by a code. The first argument is the step
 * from bit to bit, 1 when there is none.
 */
#include <math.h>

#include "cases.h"
#include "variant.h"

#define DELAY 9
#define GUARD 64

static struct {
    uint64_t before[GUARD / 8];
    uint64_t block[WORDS(DELAY)];
    uint64_t after[GUARD / 8];
} place;

static uint64_t good[WORDS(DELAY)], older[WORDS(DELAY)], once[WORDS(DELAY)];
static ctl_config config, other;
static input_t in;
static output_t out, undamaged;
static uint32_t words[SNAPSHOT_WORDS(DELAY)], saved[SNAPSHOT_WORDS(DELAY)];
static size_t saved_words;
static unsigned long found, harmless, changed;

static uint64_t seed = 1;

static uint32_t chance(void)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(seed >> 33);
}

static void damage(size_t byte, unsigned char flip)
{
    ((unsigned char *)place.block)[byte] ^= flip;
}

/* A code that says what has happened to the memory, or none. */
static int known(int32_t code)
{
    return code == CTL_OK || code == CTL_ERROR_NOT_INITIALISED || code == CTL_ERROR_VERSION ||
           code == CTL_ERROR_DAMAGED;
}

static int within(real x, double lo, double hi)
{
    return x >= (real)lo && x <= (real)hi;
}

/* A step on what is in the memory. */
static void step(void)
{
    memset(&out, 0xEE, sizeof out);
    memcpy(once, place.block, sizeof once);
    int32_t code = FN(step)(place.block, sizeof place.block, &in, &out);
    CHECK(known(code));
    if (code != CTL_OK) {
        unsigned char untouched[sizeof out];
        memset(untouched, 0xEE, sizeof untouched);
        CHECK(memcmp(&out, untouched, sizeof out) == 0);
        found++;
        return;
    }
    CHECK(within(out.u, config.output_lo, config.output_hi));
    CHECK(isfinite(out.v) && isfinite(out.i) && isfinite(out.pd) && isfinite(out.u_f) && isfinite(out.d_hat) &&
          isfinite(out.r));
    if (memcmp(&out, &undamaged, sizeof out) == 0) {
        harmless++;
    } else {
        changed++;
    }
    /* What a step has left is no worse than what it has found. */
    CHECK(known(FN(step)(place.block, sizeof place.block, &in, &out)));
}

/* Every other function, each on the same damage. */
static void others(void)
{
    size_t count = 0, written = 0;
    ctl_faults faults;
    CHECK(known(FN(read)(once, sizeof once, &out)));
    CHECK(known(FN(set_mode)(once, sizeof once, CTL_MODE_AUTO)));
    CHECK(known(FN(snapshot_words)(once, sizeof once, &count)));
    int32_t code = FN(save)(once, sizeof once, words, SNAPSHOT_WORDS(DELAY), &written);
    CHECK(known(code) && written <= SNAPSHOT_WORDS(DELAY));
    code = FN(restore)(once, sizeof once, saved, saved_words);
    CHECK(known(code) || (code >= CTL_ERROR_BUFFER && code <= CTL_ERROR_SNAPSHOT_INVALID));
    memcpy(once, place.block, sizeof once);
    CHECK(known(FN(advance)(once, sizeof once, 3)));
    CHECK(known(FN(advance)(once, sizeof once, 100000)));
    CHECK(known(FN(adopt)(once, sizeof once, &other, &faults)));
    CHECK(known(FN(adopt)(once, sizeof once, &config, &faults)));
    CHECK(known(FN(settle)(once, sizeof once, 0, 0, 0)));
}

static void all(void)
{
    step();
    memcpy(place.block, once, sizeof once);
    others();
    memcpy(place.block, good, sizeof good);
}

/* A loop at work, `older` as it was before its last samples. */
static void start(int number)
{
    memset(&place, 0xA5, sizeof place);
    memset(place.block, 0, sizeof place.block);
    EXPECT(CTL_OK, set_case(number == CASE_PID ? CASE_ESTIMATOR : CASE_PID, &other));
    EXPECT(CTL_OK, set_case(number, &config));
    EXPECT(CTL_OK, FN(init)(place.block, sizeof place.block, &config, NULL));
    memset(&in, 0, sizeof in);
    in.r = (real)0.5;
    for (int k = 0; k < 40; k++) {
        if (k == 34) {
            memcpy(older, place.block, sizeof older);
        }
        in.y = (real)(0.3 + 0.01 * (double)(chance() % 20));
        EXPECT(CTL_OK, FN(step)(place.block, sizeof place.block, &in, &out));
    }
    EXPECT(CTL_OK, FN(save)(place.block, sizeof place.block, saved, SNAPSHOT_WORDS(DELAY), &saved_words));
    memcpy(good, place.block, sizeof good);
    EXPECT(CTL_OK, FN(step)(place.block, sizeof place.block, &in, &undamaged));
    memcpy(place.block, good, sizeof good);
}

static void guards(void)
{
    unsigned char guard[GUARD];
    memset(guard, 0xA5, sizeof guard);
    CHECK(memcmp(place.before, guard, GUARD) == 0 && memcmp(place.after, guard, GUARD) == 0);
}

static void bits_of(int number, unsigned stride)
{
    start(number);
    found = harmless = changed = 0;
    for (size_t bit = 0; bit < 8 * sizeof place.block; bit += stride) {
        damage(bit / 8, (unsigned char)(1u << (bit % 8)));
        all();
    }
    guards();
    /* The header and the law are found; most of a block is law, room, or state whose bits matter. */
    CHECK(found > 0 && harmless > 0 && changed > 0);
    if (stride == 1) {
        CHECK(found >= 8 * (20 + 33 * sizeof(real)));
    }
}

static void words_of(int number, unsigned rounds)
{
    start(number);
    for (unsigned round = 0; round < rounds; round++) {
        for (unsigned hits = 2 + chance() % 20; hits > 0; hits--) {
            size_t at = 4 * (chance() % (sizeof place.block / 4));
            uint32_t word = chance() % 3 == 0 ? 0xFFFFFFFFu : chance() * 2u;
            /* Every other round spares the header. */
            if (at >= 32 || round % 2 == 0) {
                memcpy((unsigned char *)place.block + at, &word, sizeof word);
            }
        }
        all();
    }
    guards();
}

static void torn(int number)
{
    start(number);
    for (size_t split = 0; split <= sizeof place.block; split += 4) {
        memcpy(place.block, older, split);
        all();
        memcpy((unsigned char *)place.block + split, (unsigned char *)older + split, sizeof place.block - split);
        all();
    }
    guards();
}

int main(int argc, char **argv)
{
    unsigned stride = argc > 1 ? (unsigned)atoi(argv[1]) : 1;
    for (int number = CASE_PID; number <= CASE_OBSERVER; number++) {
        bits_of(number, stride);
        words_of(number, 2000 / stride);
        torn(number);
    }
    return verdict();
}

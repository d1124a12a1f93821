/* Snapshots that must be refused, and what a refusal leaves alone. */
#include <math.h>

#include "cases.h"
#include "variant.h"

#define DELAY 9

static uint64_t block[WORDS(DELAY)], before[WORDS(DELAY)], twin[WORDS(DELAY)];
static uint32_t words[SNAPSHOT_WORDS(DELAY)], bad[SNAPSHOT_WORDS(DELAY)];
static size_t count;
static input_t in;
static output_t out, other;
static ctl_config config;

static void run(void *state, int samples)
{
    for (int k = 0; k < samples; k++) {
        in.r = (real)(k % 7 < 4 ? 1.0 : -0.5);
        in.y = (real)(0.1 * (k % 5));
        EXPECT(CTL_OK, FN(step)(state, sizeof block, &in, &out));
    }
}

static void fresh(int number, void *state)
{
    EXPECT(CTL_OK, set_case(number, &config));
    EXPECT(CTL_OK, FN(init)(state, sizeof block, &config, NULL));
}

static void refused(int32_t code, const uint32_t *from, size_t length)
{
    memcpy(before, block, sizeof block);
    int32_t found = FN(restore)(block, sizeof block, from, length);
    CHECK(code == 0 ? found != CTL_OK : found == code);
    CHECK(same_bytes(block, before, sizeof block));
}

/* A number that is finite, but out of all proportion: refused, or the loop goes on with finite outputs in their range. */
static void refused_or_harmless(const uint32_t *from)
{
    memcpy(twin, block, sizeof block);
    int32_t code = FN(restore)(twin, sizeof twin, from, count);
    CHECK(code == CTL_OK || (code == CTL_ERROR_SNAPSHOT_INVALID && same_bytes(twin, block, sizeof twin)));
    for (int k = 0; k < 50; k++) {
        run(twin, 1);
        CHECK(isfinite(out.u) && isfinite(out.v) && isfinite(out.i) && isfinite(out.pd) && isfinite(out.u_f));
        CHECK(isfinite(out.d_hat) && isfinite(out.r) && out.u >= (real)-2 && out.u <= 3);
    }
}

/* CRC-32 of the core's words, to forge a snapshot that is intact. */
static uint32_t checksum(const uint32_t *from, size_t length)
{
    uint32_t crc = 0xFFFFFFFFu;
    for (size_t i = 0; i < 4 * length; i++) {
        crc ^= from[i / 4] >> 8 * (i % 4) & 0xFFu;
        for (int bit = 0; bit < 8; bit++) {
            crc = crc & 1u ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
        }
    }
    return ~crc;
}

static void forge(size_t word, uint32_t value)
{
    memcpy(bad, words, sizeof words);
    bad[word] = value;
    bad[count - 1] = checksum(bad + 3, count - 4);
}

int main(void)
{
    for (int number = 0; number < CASES; number++) {
        fresh(number, block);
        run(block, 40);
        EXPECT(CTL_OK, FN(set_mode)(block, sizeof block, CTL_MODE_HOLD));
        EXPECT(CTL_OK, FN(snapshot_words)(block, sizeof block, &count));
        CHECK(count <= SNAPSHOT_WORDS(DELAY));

        /* Too short a buffer is not touched. */
        memset(bad, 0xA5, sizeof bad);
        size_t written = 7;
        EXPECT(CTL_ERROR_BUFFER, FN(save)(block, sizeof block, bad, count - 1, &written));
        CHECK(written == 7 && bad[0] == 0xA5A5A5A5u && bad[count - 2] == 0xA5A5A5A5u);
        EXPECT(CTL_OK, FN(save)(block, sizeof block, words, SNAPSHOT_WORDS(DELAY), &written));
        CHECK(written == count);

        /* Restored into a fresh block: the same bits, in the mode that was set. */
        fresh(number, twin);
        EXPECT(CTL_OK, FN(restore)(twin, sizeof twin, words, count));
        EXPECT(CTL_OK, FN(read)(twin, sizeof twin, &other));
        CHECK(other.u == out.u && other.mode == out.mode);
        run(twin, 3);
        other = out;
        run(block, 3);
        CHECK(memcmp(&out, &other, sizeof out) == 0 && out.mode == CTL_MODE_HOLD);

        /* Every damaged bit, every missing word. */
        for (size_t bit = 0; bit < 32 * count; bit++) {
            memcpy(bad, words, sizeof words);
            bad[bit / 32] ^= (uint32_t)1 << bit % 32;
            refused(0, bad, count);
        }
        for (size_t length = 0; length < count; length++) {
            refused(CTL_ERROR_BUFFER, words, length);
        }

        /* Intact, but no state: not finite, out of proportion, an unknown mode, a place outside the line. */
        const uint32_t numbers = SINGLE ? 1 : 2;
        const uint32_t nan = SINGLE ? 0x7FC00000u : 0x7FF80000u, huge = SINGLE ? 0x7F000000u : 0x7FE00000u;
        for (uint32_t i = 0; i < 19; i++) {
            forge(5 + i * numbers + numbers - 1, nan);
            refused(CTL_ERROR_SNAPSHOT_INVALID, bad, count);
            forge(5 + i * numbers + numbers - 1, huge);
            refused_or_harmless(bad);
        }
        forge(5 + 19 * numbers, 0x0900u);
        refused(CTL_ERROR_SNAPSHOT_INVALID, bad, count);
        if (number != CASE_PID) {
            /* The last cell of the delay memory, then its place. */
            const size_t cells = DELAY + 1, last = count - 2, place = last - cells * numbers;
            forge(last, nan);
            refused(CTL_ERROR_SNAPSHOT_INVALID, bad, count);
            forge(last, huge);
            refused_or_harmless(bad);
            forge(place, (uint32_t)cells);
            refused(CTL_ERROR_SNAPSHOT_INVALID, bad, count);
        }

        /* Of another kind, of another shape. */
        fresh(number == CASE_PID ? CASE_ESTIMATOR : CASE_PID, block);
        refused(CTL_ERROR_SNAPSHOT_SHAPE, words, count);
        if (number == CASE_ESTIMATOR) {
            fresh(CASE_OTHER_ESTIMATOR, block);
            CHECK(FN(restore)(block, sizeof block, words, count) != CTL_OK);
            EXPECT(CTL_OK, set_case(CASE_ESTIMATOR, &config));
            EXPECT(CTL_OK, FN(init)(block, sizeof block - ALIGN, &config, NULL));
            CHECK(FN(restore)(block, sizeof block - ALIGN, words, count) != CTL_OK);
        }
        memcpy(bad, words, sizeof words);
        bad[0]++;
        refused(CTL_ERROR_SNAPSHOT_VERSION, bad, count);
    }
    return verdict();
}

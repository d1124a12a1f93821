/*
 * Replays scripts, several instances interleaved line by line, and prints every output as bits.
 *
 * A line of a script is a command:
 *   i CASE       initialise          a CASE  adopt       n COUNT  samples lost       m MODE  set the mode
 *   t R Y U      settle              w       save, restore into a fresh block, go on there
 *   s R RR Y A M T O MODE QUALITY HAS_A HAS_M OFF UP DOWN ACK   step; numbers as bits
 *
 * Before every call the block moves to another address, and what is left behind is poisoned.
 */
#include "cases.h"
#include "variant.h"

#define DELAY 9
#define INSTANCES 2

struct instance {
    FILE *script;
    int number;
    unsigned char *arena;
    void *state;
    unsigned moves;
};

static const size_t size = SIZE(DELAY);
/* Room for the block at 8 places. */
static const size_t arena_size = SIZE(DELAY) + 8 * ALIGN;

static void move(struct instance *it)
{
    unsigned char *arena = malloc(arena_size);
    if (arena == NULL) {
        exit(3);
    }
    memset(arena, 0x5A, arena_size);
    void *place = arena + ALIGN * (it->moves++ % 8);
    if (it->state != NULL) {
        memcpy(place, it->state, size);
    } else {
        memset(place, 0, size);
    }
    if (it->arena != NULL) {
        memset(it->arena, 0xA5, arena_size);
        free(it->arena);
    }
    it->arena = arena;
    it->state = place;
}

static real number(const char **text)
{
    char *end;
    bits pattern = (bits)strtoull(*text, &end, 16);
    real x;
    *text = end;
    memcpy(&x, &pattern, sizeof x);
    return x;
}

static int32_t whole(const char **text)
{
    char *end;
    long x = strtol(*text, &end, 10);
    *text = end;
    return (int32_t)x;
}

static void print(real x)
{
    bits pattern;
    memcpy(&pattern, &x, sizeof pattern);
#if SINGLE
    printf(" " BITS, (unsigned)pattern);
#else
    printf(" " BITS, (unsigned long long)pattern);
#endif
}

static void show(const struct instance *it, const output_t *out)
{
    printf("%d", it->number);
    print(out->u);
    print(out->v);
    print(out->i);
    print(out->pd);
    print(out->u_f);
    print(out->d_hat);
    print(out->r);
    printf(" %d %x %d %d\n", (int)out->mode, (unsigned)out->status, (int)out->blocked_up, (int)out->blocked_down);
}

static void step(struct instance *it, const char *text)
{
    input_t in;
    output_t out, again;
    in.r = number(&text);
    in.r_remote = number(&text);
    in.y = number(&text);
    in.u_applied = number(&text);
    in.manual = number(&text);
    in.track = number(&text);
    in.offset = number(&text);
    in.mode = whole(&text);
    in.quality = whole(&text);
    in.has_u_applied = whole(&text);
    in.has_manual = whole(&text);
    in.compensator_off = whole(&text);
    in.inhibit_up = whole(&text);
    in.inhibit_down = whole(&text);
    in.acknowledge = whole(&text);
    EXPECT(CTL_OK, FN(step)(it->state, size, &in, &out));
    EXPECT(CTL_OK, FN(read)(it->state, size, &again));
    CHECK(memcmp(&out, &again, sizeof out) == 0);
    show(it, &out);
}

static void through_words(struct instance *it, const ctl_config *config)
{
    uint32_t words[SNAPSHOT_WORDS(DELAY)];
    size_t count, written;
    EXPECT(CTL_OK, FN(snapshot_words)(it->state, size, &count));
    CHECK(count <= SNAPSHOT_WORDS(DELAY));
    EXPECT(CTL_OK, FN(save)(it->state, size, words, count, &written));
    CHECK(written == count);
    memset(it->state, 0, size);
    EXPECT(CTL_OK, FN(init)(it->state, size, config, NULL));
    EXPECT(CTL_OK, FN(restore)(it->state, size, words, written));
}

/* One line; 0 at the end of the script. */
static int run(struct instance *it, ctl_config *config)
{
    char line[512];
    if (fgets(line, sizeof line, it->script) == NULL) {
        return 0;
    }
    const char *text = line + 1;
    move(it);
    switch (line[0]) {
    case 'i':
        CHECK(set_case(whole(&text), config) == CTL_OK);
        EXPECT(CTL_OK, FN(init)(it->state, size, config, NULL));
        break;
    case 'a':
        CHECK(set_case(whole(&text), config) == CTL_OK);
        EXPECT(CTL_OK, FN(adopt)(it->state, size, config, NULL));
        break;
    case 'n':
        EXPECT(CTL_OK, FN(advance)(it->state, size, (uint32_t)whole(&text)));
        break;
    case 'm':
        EXPECT(CTL_OK, FN(set_mode)(it->state, size, whole(&text)));
        break;
    case 't': {
        real r = number(&text), y = number(&text), u = number(&text);
        EXPECT(CTL_OK, FN(settle)(it->state, size, r, y, u));
        break;
    }
    case 'w':
        through_words(it, config);
        break;
    default:
        step(it, text);
        break;
    }
    return 1;
}

int main(int argc, char **argv)
{
    struct instance list[INSTANCES];
    ctl_config configs[INSTANCES];
    memset(list, 0, sizeof list);
    if (argc != 1 + INSTANCES) {
        return 2;
    }
    for (int i = 0; i < INSTANCES; i++) {
        list[i].number = i;
        list[i].script = fopen(argv[1 + i], "r");
        if (list[i].script == NULL) {
            return 2;
        }
    }
    int goes_on = 1;
    while (goes_on) {
        goes_on = 0;
        for (int i = 0; i < INSTANCES; i++) {
            goes_on |= run(&list[i], &configs[i]);
        }
    }
    for (int i = 0; i < INSTANCES; i++) {
        fclose(list[i].script);
        free(list[i].arena);
    }
    return verdict();
}

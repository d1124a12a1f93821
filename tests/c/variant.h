/* One source for both number types: compiled with -DVARIANT=f32 or -DVARIANT=f64. */
#ifndef VARIANT_H
#define VARIANT_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ctl.h"

#define GLUE_(a, b, c) a##b##c
#define GLUE(a, b, c) GLUE_(a, b, c)
#define FN(name) GLUE(GLUE(ctl_, VARIANT, _), name, )
#define input_t FN(input)
#define output_t FN(output)

#define f32 1
#define f64 2
#if VARIANT == 1
#define SINGLE 1
#else
#define SINGLE 0
#endif
#undef f32
#undef f64

#if SINGLE
typedef float real;
typedef uint32_t bits;
#define BITS "%08x"
#define SIZE(delay) CTL_F32_SIZE(delay)
#define WORDS(delay) CTL_F32_WORDS(delay)
#define SNAPSHOT_WORDS(delay) CTL_F32_SNAPSHOT_WORDS(delay)
#define SIZE_PLAIN CTL_F32_SIZE_WITHOUT_COMPENSATOR
#define ALIGN CTL_F32_ALIGN
#else
typedef double real;
typedef uint64_t bits;
#define BITS "%016llx"
#define SIZE(delay) CTL_F64_SIZE(delay)
#define WORDS(delay) CTL_F64_WORDS(delay)
#define SNAPSHOT_WORDS(delay) CTL_F64_SNAPSHOT_WORDS(delay)
#define SIZE_PLAIN CTL_F64_SIZE_WITHOUT_COMPENSATOR
#define ALIGN CTL_F64_ALIGN
#endif

static int checks, failures;

#define CHECK(condition)                                                       \
    do {                                                                       \
        checks++;                                                              \
        if (!(condition)) {                                                    \
            failures++;                                                        \
            printf("%s:%d: %s\n", __FILE__, __LINE__, #condition);             \
        }                                                                      \
    } while (0)

/* The code of a call, and which it must be. */
#define EXPECT(expected, call)                                                 \
    do {                                                                       \
        int32_t code_ = (call);                                                \
        checks++;                                                              \
        if (code_ != (expected)) {                                             \
            failures++;                                                        \
            printf("%s:%d: %s is %d: %s\n", __FILE__, __LINE__, #call,         \
                   (int)code_, ctl_error_text(code_));                         \
        }                                                                      \
    } while (0)

/*
 * Whether two blocks are the same bytes. Between the fields of a block are bytes that nobody has written, over which
 * valgrind stumbles here, and only here: see valgrind.supp.
 */
static inline int same_bytes(const void *one, const void *other, size_t count)
{
    const unsigned char *a = (const unsigned char *)one, *b = (const unsigned char *)other;
    for (size_t i = 0; i < count; i++) {
        if (a[i] != b[i]) {
            return 0;
        }
    }
    return 1;
}

static int verdict(void)
{
    printf("%d checks, %d failures\n", checks, failures);
    return failures != 0;
}

#endif

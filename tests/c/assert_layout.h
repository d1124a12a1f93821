/* Offsets and sizes of fields, asserted by the compiler; C99 to C++20. */
#ifndef ASSERT_LAYOUT_H
#define ASSERT_LAYOUT_H

#include <stddef.h>

#if defined(__cplusplus)
#define ASSERT(condition) static_assert(condition, #condition)
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define ASSERT(condition) _Static_assert(condition, #condition)
#else
#define GLUE_(a, b) a##b
#define GLUE(a, b) GLUE_(a, b)
#define ASSERT(condition) extern char GLUE(assertion_, __LINE__)[(condition) ? 1 : -1]
#endif

#define AT(type, field, offset, size) ASSERT(offsetof(type, field) == offset && sizeof(((type *)0)->field) == size)
#define ALL(type, size, align)                                                 \
    struct type##_behind_a_byte {                                              \
        char byte;                                                             \
        type it;                                                               \
    };                                                                         \
    ASSERT(sizeof(type) == size && offsetof(struct type##_behind_a_byte, it) <= align)

#endif

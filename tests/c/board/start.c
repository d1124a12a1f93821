/*
 * The beginning of a C program on the emulated reference board (Cortex-M4F), before that of the C library, which asks the
 * debugger for its command line, its files and its memory.
 */
#include <stdint.h>

extern char stack_top[];
extern void _start(void);

void reset(void);
void reset(void)
{
    volatile uint32_t *const cpacr = (volatile uint32_t *)0xE000ED88u;
    *cpacr |= 0xFu << 20; /* the floating-point unit is off until it is asked for */
    __asm volatile("dsb\n isb");
    _start();
}

static void fault(void)
{
    for (;;) {
    }
}

typedef union {
    void *stack;
    void (*handler)(void);
} vector;

__attribute__((section(".vectors"), used)) static const vector vectors[16] = {
    {stack_top}, {.handler = reset}, {.handler = fault}, {.handler = fault},
    {.handler = fault}, {.handler = fault}, {.handler = fault},
};

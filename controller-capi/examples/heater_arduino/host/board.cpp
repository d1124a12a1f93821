// A board and a heater for the sketch on a laptop, eight minutes in a second. At 200 s a fan takes 10 % of the heater's
// power; at 300 s the sensor is broken for 3 s; at 400 s something keeps the processor for 35 ms.

#include <cstdio>

#include "Arduino.h"

static const uint32_t DEAD_TIME_MS = 1000;
static const double STEP_S = 0.001;

SerialPort Serial;
static uint32_t now_us = 0;
static double power[DEAD_TIME_MS];
static double percent = 0.0, temperature = 25.0;

// One millisecond of the heater: 3 C per percent, 60 s, in a room of 25 C.
static void pass_millisecond()
{
    uint32_t ms = now_us / 1000;
    double fan = ms < 200000 ? 0.0 : 10.0;
    double acts = power[ms % DEAD_TIME_MS];
    power[ms % DEAD_TIME_MS] = percent - fan;
    temperature += STEP_S / 60.0 * (25.0 + 3.0 * acts - temperature);
    now_us += 1000;
}

uint32_t micros() { return now_us; }
uint32_t millis() { return now_us / 1000; }
void analogWrite(int, int value) { percent = value / 2.55; }
void analogReadResolution(int) {}
void pinMode(int, int) {}

int analogRead(int)
{
    bool broken = millis() >= 300000 && millis() < 303000;
    return broken ? 0 : (int)(temperature / 400.0 * 4095.0 + 0.5);
}

void SerialPort::begin(long) {}
void SerialPort::print(const char *text) { std::fputs(text, stdout); }
void SerialPort::print(float x) { std::printf("%.2f", (double)x); }
void SerialPort::print(uint32_t x) { std::printf("%lu", (unsigned long)x); }
void SerialPort::println(const char *text) { std::puts(text); }
void SerialPort::println(uint32_t x) { std::printf("%lu\n", (unsigned long)x); }

int main()
{
    setup();
    while (millis() < 480000) {
        loop();
        for (int ms = millis() == 400000 ? 35 : 1; ms > 0; ms--) {
            pass_millisecond();
        }
    }
}

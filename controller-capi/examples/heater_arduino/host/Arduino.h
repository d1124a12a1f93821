/* What the sketch needs of Arduino's core, to compile it elsewhere; board.cpp simulates it. */
#ifndef ARDUINO_H
#define ARDUINO_H

#include <stdint.h>

enum { A0 = 14, OUTPUT = 1 };

uint32_t micros();
uint32_t millis();
int analogRead(int pin);
void analogWrite(int pin, int value);
void analogReadResolution(int bits);
void pinMode(int pin, int mode);

struct SerialPort {
    void begin(long baud);
    void print(const char *text);
    void print(float x);
    void print(uint32_t x);
    void println(const char *text);
    void println(uint32_t x);
};
extern SerialPort Serial;

void setup();
void loop();

#endif

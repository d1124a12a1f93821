// A heater as an Arduino sketch: PI with a disturbance observer, one sample every 10 ms.
//
// Written for boards with a Cortex-M core (Due, Zero, MKR, Nano 33, Portenta, Teensy); ../README.md says how the archive
// becomes a library of the Arduino IDE, and how to run the sketch on a laptop.

#include <ctl.h>

static const uint32_t TICK_US = 10000; // sampling period in microseconds
static const int SENSOR_PIN = A0;      // 0 to 4095 counts for 0 to 400 C
static const int HEATER_PIN = 9;       // PWM, 0 to 255

// Dead time of heater and sensor: 1 s, so 100 samples. A static block begins as zeros: not initialised.
static CTL_F32_STATE(block, 100);
static bool running = false;
static uint32_t next_tick = 0;

static void heat(float percent)
{
    analogWrite(HEATER_PIN, (int)(percent * 2.55f + 0.5f));
}

void setup()
{
    Serial.begin(115200);
    pinMode(HEATER_PIN, OUTPUT);
    heat(0.0f);
    analogReadResolution(12);

    ctl_config config;
    ctl_faults faults;
    ctl_config_default(&config, sizeof config);
    config.ts = TICK_US * 1e-6;
    config.kp = 4.0;
    config.ki = 0.07;
    config.output_lo = 0.0; // percent
    config.output_hi = 100.0;
    config.measurement_lo = 1.0; // a broken or a shorted sensor is outside
    config.measurement_hi = 395.0;
    config.hold_samples = 100; // one second
    config.fallback_action = CTL_FALLBACK_SUBSTITUTE;
    config.fallback_output = 0.0; // heater off when the sensor is gone
    config.compensator = CTL_COMPENSATOR_OBSERVER;
    config.alpha = 8.0;
    config.model_gain = 3.0; // C per percent, 60 s, dead time 1 s
    config.model_pole_count = 1;
    config.model_pole_a1[0] = 60.0;
    config.model_dead_time = 1.0;

    int32_t error = ctl_f32_init(block, sizeof block, &config, &faults);
    running = ctl_abi_version() == CTL_ABI_VERSION && error == CTL_OK;
    if (!running) {
        Serial.println(ctl_error_text(error));
        if (error == CTL_ERROR_CONFIG) {
            Serial.println(ctl_param_name(faults.list[0].param));
        }
    }
    next_tick = micros();
}

void loop()
{
    // Differences of the clock, so that its overflow after 71 minutes does no harm.
    uint32_t late = micros() - next_tick;
    if (!running || late >= 0x80000000u) {
        return; // heater off for good, or not yet time
    }
    // Something has kept the processor for longer than a period: say so, do not catch up.
    uint32_t lost = late / TICK_US;
    if (lost > 0) {
        ctl_f32_advance(block, sizeof block, lost);
    }
    next_tick += (lost + 1) * TICK_US;

    ctl_f32_input in = {};
    ctl_f32_output out;
    in.r = millis() < 10000 ? 25.0f : 180.0f;
    in.y = (float)analogRead(SENSOR_PIN) * (400.0f / 4095.0f);
    if (ctl_f32_step(block, sizeof block, &in, &out) != CTL_OK) {
        running = false; // somebody has written over the block
        heat(0.0f);
        return;
    }
    heat(out.u);

    static uint32_t samples = 0;
    if (samples++ % 2000 == 0) {
        Serial.print(millis() / 1000);
        Serial.print(" s  ");
        Serial.print(in.y);
        Serial.print(" C  ");
        Serial.print(out.u);
        Serial.print(" %  disturbance ");
        Serial.print(out.d_hat);
        Serial.print(" %  status ");
        Serial.println(out.status);
    }
}

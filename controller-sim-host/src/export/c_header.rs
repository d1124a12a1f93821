//! A loop as constants for the C interface: a header that fills a `ctl_config`.

use super::{Export, head};
use crate::scenario::CompensatorSpec;
use crate::simulate::Precision;
use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{Action, AntiWindupConfig, FallbackAction, FallbackReturn, IntegralRule};
use std::fmt::Write;

/// The header.
pub(super) fn text(export: &Export<'_>, origin: &str) -> String {
    let upper = head::name(export).replacen("FB_", "LOOP_", 1);
    let lower = upper.to_lowercase();
    let variant = match export.precision {
        Precision::F32 => "F32",
        Precision::F64 => "F64",
    };
    let calls = variant.to_lowercase();
    let compensated = export.compensator().is_some();
    let mut out = format!(
        "/*\n * {}: the loop of {}, exported by controller-sim export --format c.\n *\n \
         * Do not change numbers here: they have passed checks that this file cannot repeat. Change the design file and export\n \
         * it again.\n *\n *     static {upper}_STATE(block);\n *     ctl_config config;\n *     {lower}_config(&config);\n \
         *     ctl_{calls}_init(block, sizeof block, &config, NULL);\n *     every {upper}_TS seconds: ctl_{calls}_step(block, sizeof block, &in, &out);\n */\n",
        comment(export.name()),
        comment(origin)
    );
    for range in export.open_ranges() {
        let [what, cure] = range.warning();
        let _ = writeln!(out, "/* {what}\n * {} */", cure.trim_start());
    }
    let _ = write!(out, "#ifndef {upper}_H\n#define {upper}_H\n\n#include \"ctl.h\"\n\n");
    let _ = writeln!(out, "/* Sampling period [s]. */\n#define {upper}_TS {:?}\n", export.ts());
    if compensated {
        let delay = export.capacity().saturating_sub(1);
        let _ = writeln!(
            out,
            "/* Samples of delay that the block has room for. */\n#define {upper}_DELAY {delay}\n"
        );
        let _ = writeln!(
            out,
            "/* Declares the block. */\n#define {upper}_STATE(name) CTL_{variant}_STATE(name, {upper}_DELAY)\n"
        );
    } else {
        let _ = writeln!(
            out,
            "/* Declares the block. */\n#define {upper}_STATE(name) CTL_{variant}_STATE_WITHOUT_COMPENSATOR(name)\n"
        );
    }
    let _ = write!(
        out,
        "/* Writes the whole configuration; CTL_OK, or the error of ctl_config_default. */\n\
         static inline int32_t {lower}_config(ctl_config *config)\n{{\n    \
         int32_t error = ctl_config_default(config, sizeof *config);\n    if (error != CTL_OK) {{\n        return error;\n    }}\n"
    );
    let mut fields = Fields { out };
    fields.controller(export);
    fields.compensator(export);
    let mut out = fields.out;
    let _ = write!(out, "    return CTL_OK;\n}}\n\n#endif /* {upper}_H */\n");
    out
}

/// Text of a person within a comment: nothing that ends it.
fn comment(text: &str) -> String {
    head::plain(text).replace('/', "|")
}

struct Fields {
    out: String,
}

impl Fields {
    fn set(&mut self, field: &str, value: &str) {
        let _ = writeln!(self.out, "    config->{field} = {value};");
    }

    fn number(&mut self, field: &str, value: f64) {
        self.set(field, &format!("{value:?}"));
    }

    fn optional(&mut self, field: &str, value: Option<f64>) {
        if let Some(value) = value {
            self.number(field, value);
        }
    }

    fn controller(&mut self, export: &Export<'_>) {
        let c = &export.spec.config;
        let p = &c.pid;
        self.set(
            "action",
            match p.action {
                Action::Reverse => "CTL_ACTION_REVERSE",
                Action::Direct => "CTL_ACTION_DIRECT",
            },
        );
        self.set(
            "integral_rule",
            match p.integral_rule {
                IntegralRule::Backward => "CTL_INTEGRAL_BACKWARD",
                IntegralRule::Trapezoid => "CTL_INTEGRAL_TRAPEZOID",
            },
        );
        self.number("ts", export.ts());
        for (field, value) in [("kp", p.kp), ("ki", p.ki), ("kd", p.kd), ("tf", p.tf), ("b", p.b), ("c", p.c)]
        {
            self.number(field, value);
        }
        let (rule, tt) = match c.anti_windup {
            AntiWindupConfig::BackCalculation { tt } => ("CTL_ANTI_WINDUP_BACK_CALCULATION", tt),
            AntiWindupConfig::Conditional => ("CTL_ANTI_WINDUP_CONDITIONAL", None),
            AntiWindupConfig::None => ("CTL_ANTI_WINDUP_NONE", None),
        };
        self.set("anti_windup", rule);
        self.optional("tt", tt);
        self.number("deadband", c.deadband);
        self.number("output_lo", c.limits.lo);
        self.number("output_hi", c.limits.hi);
        self.optional("output_rate_up", c.limits.rate_up);
        self.optional("output_rate_down", c.limits.rate_down);
        self.number("setpoint_lo", c.setpoint.lo);
        self.number("setpoint_hi", c.setpoint.hi);
        self.optional("setpoint_rate_up", c.setpoint.rate_up);
        self.optional("setpoint_rate_down", c.setpoint.rate_down);
        self.set("setpoint_track", if c.setpoint.track { "1" } else { "0" });
        self.number("measurement_lo", c.measurement_lo);
        self.number("measurement_hi", c.measurement_hi);
        self.number("offset_lo", c.offset_lo);
        self.number("offset_hi", c.offset_hi);
        let (action, output, rate) = match c.fallback.action {
            FallbackAction::Hold => ("CTL_FALLBACK_HOLD", None, None),
            FallbackAction::Substitute { output } => ("CTL_FALLBACK_SUBSTITUTE", Some(output), None),
            FallbackAction::Ramp { output, rate } => ("CTL_FALLBACK_RAMP", Some(output), Some(rate)),
        };
        self.set("hold_samples", &c.fallback.hold_samples.to_string());
        self.set("fallback_action", action);
        self.optional("fallback_output", output);
        self.optional("fallback_rate", rate);
        self.set(
            "fallback_return",
            match c.fallback.back {
                FallbackReturn::Automatic => "CTL_RETURN_AUTOMATIC",
                FallbackReturn::Acknowledged => "CTL_RETURN_ACKNOWLEDGED",
            },
        );
        let a = &c.alarms;
        self.optional("alarm_hi_hi", a.hi_hi);
        self.optional("alarm_hi", a.hi);
        self.optional("alarm_lo", a.lo);
        self.optional("alarm_lo_lo", a.lo_lo);
        self.optional("alarm_deviation", a.deviation);
        self.number("alarm_hysteresis", a.hysteresis);
        self.optional("off_output", c.off_output);
        self.number("initial_output", c.initial_output);
    }

    fn compensator(&mut self, export: &Export<'_>) {
        match &export.spec.compensator {
            CompensatorSpec::None => return self.set("compensator", "CTL_COMPENSATOR_NONE"),
            CompensatorSpec::Estimator(e) => {
                self.set("compensator", "CTL_COMPENSATOR_ESTIMATOR");
                self.number("kfd", e.kfd);
                self.number("tfd", e.tfd);
                self.model(&e.to_compensator(0.0).model);
            }
            CompensatorSpec::Observer(o) => {
                self.set("compensator", "CTL_COMPENSATOR_OBSERVER");
                self.number("alpha", o.alpha);
                self.set("filter_order", &o.order.unwrap_or(0).to_string());
                self.model(&o.model);
            }
        }
        self.number("latency", export.scenario.latency);
    }

    fn model(&mut self, model: &PlantModel) {
        self.number("model_gain", model.gain);
        self.number("model_dead_time", model.dead_time);
        self.set("model_integrators", &model.integrators.to_string());
        self.factors("pole", &model.poles);
        self.factors("zero", &model.zeros);
    }

    fn factors(&mut self, what: &str, list: &[Factor]) {
        self.set(&format!("model_{what}_count"), &list.len().to_string());
        for (n, factor) in list.iter().enumerate() {
            self.number(&format!("model_{what}_a1[{n}]"), factor.a1);
            self.number(&format!("model_{what}_a2[{n}]"), factor.a2);
        }
    }
}

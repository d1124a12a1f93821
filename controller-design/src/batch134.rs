//! The 134 test processes of Tena et al. 2022, section 5.2: nine families that represent what the process industry
//! controls.
//!
//! `P7` with `T = 1` repeats three processes of `P1`: the list has 134 entries all the same, as published; those three are
//! marked. `controller-design/processes/` holds the list as CSV and JSON for other programs.
//!
//! ```
//! use controller_design::batch134::processes;
//! let list = processes();
//! assert_eq!(list.len(), 134);
//! assert_eq!((&*list[70].id, &*list[70].name), ("P6-03", "P6 T=0.05"));
//! assert_eq!(list.iter().filter(|process| process.duplicate_of.is_some()).count(), 3);
//! assert_eq!(list[70].expression, "exp(-0.05*s)/(s*(1+0.95*s))");
//! assert!(list.iter().all(|process| process.plant().is_ok()));
//! ```

use std::string::String;
use std::vec::Vec;

use crate::model::{ExpressionError, TransferFunction, parse};

/// The families, in the order of the paper: name, general form, and what the parameters mean.
pub const FAMILIES: [Family; 9] = [
    Family { name: "P1", form: "exp(-s)/(1+tau*s)", about: "lag with dead time" },
    Family { name: "P2", form: "exp(-s)/(1+tau*s)^2", about: "two equal lags with dead time" },
    Family { name: "P3", form: "1/((1+s)*(1+tau*s)^2)", about: "one lag and two equal ones" },
    Family { name: "P4", form: "1/(1+s)^n", about: "equal lags" },
    Family {
        name: "P5",
        form: "1/((1+s)*(1+tau*s)*(1+tau^2*s)*(1+tau^3*s))",
        about: "four lags of a geometric series",
    },
    Family { name: "P6", form: "exp(-T*s)/(s*(1+(1-T)*s))", about: "integrator with lag and dead time" },
    Family { name: "P7", form: "exp(-T*s)/((1+tau1*s)*(1+(1-T)*s))", about: "two lags with dead time" },
    Family { name: "P8", form: "(1-delta*s)/(1+s)^3", about: "zero in the right half-plane" },
    Family {
        name: "P9",
        form: "1/((1+s)*(1+1.4*tau*s+tau^2*s^2))",
        about: "one lag and a pair of complex poles",
    },
];

/// A family of the processes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Family {
    /// `P1` to `P9`.
    pub name: &'static str,
    /// The transfer function, with the parameters by their names.
    pub form: &'static str,
    /// What it is, in a few words.
    pub about: &'static str,
}

/// One of the processes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Process {
    /// Family and place in it, such as `P1-01`; never changes.
    pub id: String,
    /// Family and parameter, such as `P1 tau=0.02`.
    pub name: String,
    /// The family.
    pub family: &'static Family,
    /// Names and values of the parameters.
    pub parameters: Vec<(&'static str, &'static str)>,
    /// The transfer function as an expression; time unit s.
    pub expression: String,
    /// The id of an earlier process that is the same.
    pub duplicate_of: Option<String>,
}

impl Process {
    /// The transfer function.
    ///
    /// # Errors
    /// Never for the published list.
    pub fn plant(&self) -> Result<TransferFunction, Vec<ExpressionError>> {
        parse(&self.expression)
    }
}

const P1: [&str; 21] = [
    "0.02", "0.05", "0.1", "0.2", "0.3", "0.5", "0.7", "1", "1.3", "1.5", "2", "4", "6", "8", "10", "20",
    "50", "100", "200", "500", "1000",
];
const P2: [&str; 22] = [
    "0.01", "0.02", "0.05", "0.1", "0.2", "0.3", "0.5", "0.7", "1", "1.3", "1.5", "2", "4", "6", "8", "10",
    "20", "50", "100", "200", "500", "1000",
];
const P3: [&str; 10] = ["0.005", "0.01", "0.02", "0.05", "0.1", "0.2", "0.5", "2", "5", "10"];
const P4: [&str; 6] = ["3", "4", "5", "6", "7", "8"];
/// `tau`, `tau^2`, `tau^3`.
const P5: [[&str; 3]; 9] = [
    ["0.1", "0.01", "0.001"],
    ["0.2", "0.04", "0.008"],
    ["0.3", "0.09", "0.027"],
    ["0.4", "0.16", "0.064"],
    ["0.5", "0.25", "0.125"],
    ["0.6", "0.36", "0.216"],
    ["0.7", "0.49", "0.343"],
    ["0.8", "0.64", "0.512"],
    ["0.9", "0.81", "0.729"],
];
/// `T` and `tau = 1 - T`.
const P6: [[&str; 2]; 9] = [
    ["0.01", "0.99"],
    ["0.02", "0.98"],
    ["0.05", "0.95"],
    ["0.1", "0.9"],
    ["0.2", "0.8"],
    ["0.3", "0.7"],
    ["0.5", "0.5"],
    ["0.7", "0.3"],
    ["0.9", "0.1"],
];
const P7_TAU1: [&str; 4] = ["1", "2", "5", "10"];
/// `T` and `tau2 = 1 - T`.
const P7: [[&str; 2]; 8] = [
    ["0.01", "0.99"],
    ["0.02", "0.98"],
    ["0.05", "0.95"],
    ["0.1", "0.9"],
    ["0.3", "0.7"],
    ["0.5", "0.5"],
    ["0.7", "0.3"],
    ["0.9", "0.1"],
];
const P8: [&str; 11] = ["0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1", "1.1"];
/// `tau`, `1.4*tau`, `tau^2`.
const P9: [[&str; 3]; 9] = [
    ["0.1", "0.14", "0.01"],
    ["0.2", "0.28", "0.04"],
    ["0.3", "0.42", "0.09"],
    ["0.4", "0.56", "0.16"],
    ["0.5", "0.7", "0.25"],
    ["0.6", "0.84", "0.36"],
    ["0.7", "0.98", "0.49"],
    ["0.8", "1.12", "0.64"],
    ["0.9", "1.26", "0.81"],
];

/// The list, in the order of the paper.
#[must_use]
pub fn processes() -> Vec<Process> {
    let mut list: Vec<Process> = Vec::with_capacity(134);
    let mut number = 0;
    let mut add = |family: usize, parameters: &[(&'static str, &'static str)], expression: String| {
        let family = &FAMILIES[family - 1];
        number = if list.last().is_some_and(|last| last.family == family) { number + 1 } else { 1 };
        let words: Vec<String> = parameters.iter().map(|(name, value)| format!("{name}={value}")).collect();
        let same = list.iter().find(|other| other.expression == expression);
        let duplicate_of = same.map(|other| other.id.clone());
        list.push(Process {
            id: format!("{}-{number:02}", family.name),
            name: format!("{} {}", family.name, words.join(" ")),
            family,
            parameters: parameters.to_vec(),
            expression,
            duplicate_of,
        });
    };
    for tau in P1 {
        add(1, &[("tau", tau)], format!("exp(-s)/(1+{tau}*s)"));
    }
    for tau in P2 {
        add(2, &[("tau", tau)], format!("exp(-s)/(1+{tau}*s)^2"));
    }
    for tau in P3 {
        add(3, &[("tau", tau)], format!("1/((1+s)*(1+{tau}*s)^2)"));
    }
    for n in P4 {
        add(4, &[("n", n)], format!("1/(1+s)^{n}"));
    }
    for [tau, square, cube] in P5 {
        let expression = format!("1/((1+s)*(1+{tau}*s)*(1+{square}*s)*(1+{cube}*s))");
        add(5, &[("tau", tau)], expression);
    }
    for [dead_time, tau] in P6 {
        add(6, &[("T", dead_time)], format!("exp(-{dead_time}*s)/(s*(1+{tau}*s))"));
    }
    add(6, &[("T", "1")], String::from("exp(-s)/s"));
    for tau1 in P7_TAU1 {
        for [dead_time, tau2] in P7 {
            let expression = format!("exp(-{dead_time}*s)/((1+{tau1}*s)*(1+{tau2}*s))");
            add(7, &[("tau1", tau1), ("T", dead_time)], expression);
        }
        add(7, &[("tau1", tau1), ("T", "1")], format!("exp(-s)/(1+{tau1}*s)"));
    }
    for delta in P8 {
        add(8, &[("delta", delta)], format!("(1-{delta}*s)/(1+s)^3"));
    }
    for [tau, first, square] in P9 {
        add(9, &[("tau", tau)], format!("1/((1+s)*(1+{first}*s+{square}*s^2))"));
    }
    list
}

/// What the published files say of themselves.
pub const LICENSE: &str = "MIT OR Apache-2.0";

/// The list as a table: `id,family,name,parameters,expression,duplicate_of,license`, one process a line.
///
/// ```
/// use controller_design::batch134::csv;
/// assert_eq!(csv().lines().nth(1), Some("P1-01,P1,P1 tau=0.02,tau=0.02,exp(-s)/(1+0.02*s),,MIT OR Apache-2.0"));
/// ```
#[must_use]
pub fn csv() -> String {
    let mut text = String::from("id,family,name,parameters,expression,duplicate_of,license\n");
    for Process { id, name, family, parameters, expression, duplicate_of } in processes() {
        let words: Vec<String> = parameters.iter().map(|(name, value)| format!("{name}={value}")).collect();
        let (family, words) = (family.name, words.join(" "));
        let same = duplicate_of.unwrap_or_default();
        text.push_str(&format!("{id},{family},{name},{words},{expression},{same},{LICENSE}\n"));
    }
    text
}

/// The list as JSON: title, source, licence, families and processes. No text in it needs an escape.
#[must_use]
pub fn json() -> String {
    let mut text = format!(
        "{{\n  \"title\": \"134 test processes\",\n  \"source\": \"Tena, Peñarrocha-Alós, Sanchis 2022, section 5.2\",\n  \
         \"license\": \"{LICENSE}\",\n  \"time_unit\": \"s\",\n  \"families\": [\n"
    );
    let families: Vec<String> = FAMILIES
        .iter()
        .map(|Family { name, form, about }| {
            format!("    {{\"name\": \"{name}\", \"form\": \"{form}\", \"about\": \"{about}\"}}")
        })
        .collect();
    text.push_str(&families.join(",\n"));
    text.push_str("\n  ],\n  \"processes\": [\n");
    let one = |process: Process| {
        let Process { id, name, family, parameters, expression, duplicate_of } = process;
        let values: Vec<String> =
            parameters.iter().map(|(name, value)| format!("\"{name}\": {value}")).collect();
        let same = duplicate_of.map_or_else(|| String::from("null"), |id| format!("\"{id}\""));
        format!(
            "    {{\"id\": \"{id}\", \"family\": \"{}\", \"name\": \"{name}\", \"parameters\": {{{}}}, \
             \"expression\": \"{expression}\", \"duplicate_of\": {same}}}",
            family.name,
            values.join(", ")
        )
    };
    let list: Vec<String> = processes().into_iter().map(one).collect();
    text.push_str(&list.join(",\n"));
    text.push_str("\n  ]\n}\n");
    text
}

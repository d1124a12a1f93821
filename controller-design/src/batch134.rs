//! The 134 test processes of Tena et al. 2022, section 5.2: nine families that represent what the process industry
//! controls.
//!
//! `P7` with `T = 1` repeats three processes of `P1`: the list has 134 entries all the same, as published.
//!
//! ```
//! use controller_design::batch134::processes;
//! let list = processes();
//! assert_eq!(list.len(), 134);
//! assert_eq!(list[70].name, "P6 T=0.05");
//! assert_eq!(list[70].expression, "exp(-0.05*s)/(s*(1+0.95*s))");
//! assert!(list.iter().all(|process| process.plant().is_ok()));
//! ```

use std::string::String;
use std::vec::Vec;

use crate::model::{ExpressionError, TransferFunction, parse};

/// One of the processes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Process {
    /// Family and parameter, such as `P1 tau=0.02`.
    pub name: String,
    /// The transfer function as an expression; time unit s.
    pub expression: String,
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
    let mut list = Vec::with_capacity(134);
    let mut add = |name: String, expression: String| list.push(Process { name, expression });
    for tau in P1 {
        add(format!("P1 tau={tau}"), format!("exp(-s)/(1+{tau}*s)"));
    }
    for tau in P2 {
        add(format!("P2 tau={tau}"), format!("exp(-s)/(1+{tau}*s)^2"));
    }
    for tau in P3 {
        add(format!("P3 tau={tau}"), format!("1/((1+s)*(1+{tau}*s)^2)"));
    }
    for n in P4 {
        add(format!("P4 n={n}"), format!("1/(1+s)^{n}"));
    }
    for [tau, square, cube] in P5 {
        add(format!("P5 tau={tau}"), format!("1/((1+s)*(1+{tau}*s)*(1+{square}*s)*(1+{cube}*s))"));
    }
    for [dead_time, tau] in P6 {
        add(format!("P6 T={dead_time}"), format!("exp(-{dead_time}*s)/(s*(1+{tau}*s))"));
    }
    add(String::from("P6 T=1"), String::from("exp(-s)/s"));
    for tau1 in P7_TAU1 {
        for [dead_time, tau2] in P7 {
            let expression = format!("exp(-{dead_time}*s)/((1+{tau1}*s)*(1+{tau2}*s))");
            add(format!("P7 tau1={tau1} T={dead_time}"), expression);
        }
        add(format!("P7 tau1={tau1} T=1"), format!("exp(-s)/(1+{tau1}*s)"));
    }
    for delta in P8 {
        add(format!("P8 delta={delta}"), format!("(1-{delta}*s)/(1+s)^3"));
    }
    for [tau, first, square] in P9 {
        add(format!("P9 tau={tau}"), format!("1/((1+s)*(1+{first}*s+{square}*s^2))"));
    }
    list
}

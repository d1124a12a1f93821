//! The paper of Airikka 2021. It has no numbered tables; these gather its rules and figures.

mod optimum;
pub(super) mod process;
mod ratios;
mod robustness;
mod rules;

use super::{Definition, Paper};

macro_rules! table {
    ($name:literal, $title:literal, $cells:literal, $compute:path) => {
        Definition {
            paper: Paper::Pi,
            name: $name,
            title: $title,
            cells: include_str!(concat!("../data/", $cells)),
            compute: $compute,
        }
    };
}

pub(super) static TABLES: [Definition; 4] = [
    table!("optimum", "PI of least IAE, figures 2 and 3; r = theta/tau", "pi-optimum.csv", optimum::all),
    table!(
        "rules",
        "the rules (7), (8), (9) and how far they are from the optimum",
        "pi-rules.csv",
        rules::all
    ),
    table!("ratios", "peaks of the optimal response, figures 7, 8, 10, 11", "pi-ratios.csv", ratios::all),
    table!("robustness", "margins of the optimum, figure 12", "pi-robustness.csv", robustness::all),
];

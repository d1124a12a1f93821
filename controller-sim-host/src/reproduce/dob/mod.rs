//! The paper of Tena et al. 2022.

mod batch;
mod designs;
mod equations;
pub(super) mod loops;
mod ratios;
mod tank;
mod trade_off;
mod walk;

use super::{Definition, Paper};

macro_rules! table {
    ($name:literal, $title:literal, $cells:literal, $compute:path) => {
        Definition {
            paper: Paper::Dob,
            name: $name,
            title: $title,
            cells: include_str!(concat!("../data/", $cells)),
            compute: $compute,
        }
    };
}

pub(super) static TABLES: [Definition; 10] = [
    table!("1", "PI with the largest Ki at Ms = 1.2", "dob-1.csv", designs::first),
    table!("2", "PI with the largest Ki at Ms = 2", "dob-2.csv", designs::second),
    table!("3", "indices with observer over those without, PI for Ms = 1.2", "dob-3.csv", ratios::third),
    table!("4", "indices with observer over those without, PI for Ms = 2", "dob-4.csv", ratios::fourth),
    table!("5", "indices under a random walk over those without observer", "dob-5.csv", walk::all),
    table!("6", "PI for the tanks", "dob-6.csv", designs::tank),
    table!("7", "tanks: indices with observer over those without", "dob-7.csv", tank::all),
    table!("equations", "equations that must not be taken as printed", "dob-equations.csv", equations::all),
    table!("figure 10", "trade-off map of first order and dead time", "dob-figure-10.csv", trade_off::all),
    table!("figures 11, 12", "134 processes: largest ratios and counts", "dob-figures-11-12.csv", batch::all),
];

//! The chapter of Vrančić & Huba 2021.

mod adrc;
mod areas;
mod equations;
mod experiments;
mod figures;
mod gains;
mod passes;
mod process;
mod settings;

use super::{Definition, Paper};

macro_rules! table {
    ($name:literal, $title:literal, $cells:literal, $compute:path) => {
        Definition {
            paper: Paper::De,
            name: $name,
            title: $title,
            cells: include_str!(concat!("../data/", $cells)),
            compute: $compute,
        }
    };
}

pub(super) static TABLES: [Definition; 10] = [
    table!("1", "areas of GP1 and GP2; with * those with the filter TF = 0.1", "de-1.csv", areas::first),
    table!("2", "gains for GP1 and GP2", "de-2.csv", gains::first),
    table!("3", "areas of GP3 and GP4; with * those with the filter", "de-3.csv", areas::second),
    table!("4", "gains for GP3 and GP4 with noise gains of 4", "de-4.csv", gains::second),
    table!(
        "5",
        "controllers for GP5 and GP6 with noise gains of 20 and 4",
        "de-5.csv",
        settings::controllers
    ),
    table!("6", "estimators for GP5 and GP6", "de-6.csv", settings::estimators),
    table!("7", "ADRC for GP5 and GP6", "de-7.csv", adrc::settings),
    table!(
        "8",
        "IAE of unit steps of set-point and disturbance, without noise",
        "de-8.csv",
        experiments::all
    ),
    table!("equations", "numbers outside the tables, and the equations", "de-equations.csv", equations::all),
    table!("figures", "what figures 4, 6, 7, 11, 12, 14 show", "de-figures.csv", figures::all),
];

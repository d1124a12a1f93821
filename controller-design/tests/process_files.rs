//! The published files of the 134 processes are what the module says; the list itself is checked against that of the golden
//! values, which were made without it.

use std::collections::BTreeSet;

use controller_design::batch134::{FAMILIES, csv, json, processes};
use controller_design::model::Complex;

const CSV: &str = include_str!("../processes/ah134.csv");
const JSON: &str = include_str!("../processes/ah134.json");

#[test]
fn the_files_are_the_module() {
    assert!(
        CSV == csv(),
        "write controller-design/processes/ah134.csv anew: controller-sim batch --set ah134 --list"
    );
    assert!(JSON == json(), "write ah134.json anew: controller-sim batch --set ah134 --list --json");
}

#[test]
fn names_are_those_of_the_golden_values() {
    let golden = include_str!("golden/batch134.csv").lines().filter(|line| !line.starts_with('#')).skip(1);
    let golden: BTreeSet<&str> = golden.filter_map(|line| line.split(',').next()).collect();
    let list = processes();
    let ours: BTreeSet<&str> = list.iter().map(|process| &*process.name).collect();
    assert_eq!((ours.len(), list.len()), (134, 134));
    assert_eq!(ours, golden);
    let ids: BTreeSet<&str> = list.iter().map(|process| &*process.id).collect();
    assert_eq!(ids.len(), 134);
    let sizes =
        FAMILIES.map(|family| list.iter().filter(|process| process.family.name == family.name).count());
    assert_eq!(sizes, [21, 22, 10, 6, 9, 10, 36, 11, 9]);
}

/// Every process is its family's form with its parameters put in, and the marks are where two are the same function.
#[test]
fn members_follow_the_forms_and_duplicates_are_marked() {
    let list = processes();
    let at = |text: &str| {
        let plant = controller_design::model::parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}"));
        [0.03, 0.7, 11.0].map(|omega| plant.at(Complex::new(0.0, omega)))
    };
    for (i, process) in list.iter().enumerate() {
        let mut form = process.family.form.to_owned();
        for (name, value) in &process.parameters {
            form = match *name {
                // `T` stands in `1-T`, which the expressions do not take as a coefficient.
                "T" => {
                    let rest = 1.0 - value.parse::<f64>().expect("a number");
                    form.replace("(1-T)", &format!("{rest}")).replace("T*s", &format!("{value}*s"))
                }
                "tau" => {
                    let tau: f64 = value.parse().expect("a number");
                    let form = form.replace("tau^3", &format!("{}", tau.powi(3)));
                    let form = form.replace("tau^2", &format!("{}", tau.powi(2)));
                    form.replace("1.4*tau", &format!("{}", 1.4 * tau)).replace("tau", value)
                }
                name => form.replace(name, value),
            };
        }
        let (ours, wanted) = (at(&process.expression), at(&form));
        for (x, y) in ours.iter().zip(&wanted) {
            assert!((*x - *y).abs() < 1e-12 * y.abs(), "{}: {form}", process.name);
        }
        let first = list[..i].iter().find(|other| {
            at(&other.expression).iter().zip(&ours).all(|(x, y)| (*x - *y).abs() < 1e-12 * y.abs())
        });
        assert_eq!(process.duplicate_of.as_ref(), first.map(|other| &other.id), "{}", process.name);
    }
}

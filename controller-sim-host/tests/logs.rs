//! Logs as loggers, spreadsheets and control systems write them.

use controller_sim_host::log::{Column, Log, Role, read};
use controller_sim_host::scenario::{Fault, Place};

fn roles() -> [Role; 3] {
    [Role::time(Column::Usual), Role::input(Column::Usual), Role::output(Column::Usual)]
}

fn good(text: &str) -> Log {
    read("log.csv", text, &roles()).unwrap_or_else(|fault| panic!("{fault:?}\n{text}"))
}

fn bad(text: &str) -> (Fault, Place) {
    let fault = read("log.csv", text, &roles()).expect_err(text);
    let place = fault.place(text);
    (fault, place)
}

fn columns(log: &Log) -> (&[f64], &[f64], &[f64]) {
    let [Some(u), Some(y)] = &log.columns[..] else { panic!("{log:?}") };
    (&log.times, u, y)
}

const ROWS: (&[f64], &[f64], &[f64]) = (&[0.0, 1.0, 2.5], &[0.0, 50.0, 50.0], &[20.9, 20.9, 21.25]);

#[test]
fn the_same_table_in_many_hands() {
    for text in [
        "0,0,20.9\n1,50,20.9\n2.5,50,21.25\n",
        "time,u,y\n0,0,20.9\n1,50,20.9\n2.5,50,21.25",
        "\u{feff}time_s,heater_percent,temperature_c\r\n0,0,20.9\r\n1,50,20.9\r\n2.5,50,21.25\r\n",
        "Zeit;Heizung;Temperatur\ns;%;\u{b0}C\n0;0;20,9\n1;50;20,9\n2,5;50;21,25\n;;\n",
        "y\tu\ttime\n20,9\t0\t0\n20,9\t50\t1\n21,25\t50\t2,5\n",
        "# made by hand\n# time, u, y\n0,0,20.9\n# a remark in between\n1,50,20.9\n\n2.5,50,21.25\n",
        "Logger 7, serial 12\nStarted: Monday\n\n\"Time\",\"PV\",\"MV\"\n[s],[degC],[%]\n0,20.9,0\n1,20.9,50\n2.5,21.25,50\n",
        "  time   u    y\n  0.0   0.0  20.9\n  1.0  50.0  20.9\n  2.5  50.0  21.25\n",
        "n,Time [ms],PV,OP\n1,0,20.9,0\n2,1000,20.9,50\n3,2500,21.25,50\n",
        "timestamp,op,pv\n2024-02-28T23:59:59Z,0,20.9\n2024-02-29T00:00:00Z,50,20.9\n2024-02-29T01:00:01.5+01:00,50,21.25\n",
        "clock;t1;q1;date time\n7;20,9;0;23:59:59\n7;20,9;50;0:00:00\n7;21,25;50;00:00:01,5\n",
        "Zeit;Ventil;Istwert\n31.12.2023 23:59:59,000;0;20,9\n01.01.2024 00:00:00,000;50;20,9\n1.1.2024 0:00:01,5;50;21,25\n",
        "Datum;Uhrzeit;Ventil;Istwert\n29.02.2024;23:59:59;0;20,9\n01.03.2024;00:00:00;50;20,9\n01.03.2024;00:00:01,5;50;21,25\n",
        "29.02.2024;23:59:59;0;20,9\n01.03.2024;00:00:00;50;20,9\n01.03.2024;00:00:01,5;50;21,25\n",
        "Time,Date,u,y\n23:59:59,2024-02-29,0,20.9\n00:00:00,2024-03-01,50,20.9\n00:00:01.5,2024-03-01,50,21.25\n",
        "Datum;Istwert;Ventil\n29.02.2024 23:59:59;20,9;0\n01.03.2024 00:00:00;20,9;50\n01.03.2024 00:00:01,5;21,25;50\n",
        "time,u,y\n\"0,0\",\"0\",\"20,9\"\n\"1,0\",50,\"20,9\"\n\"2,5\",50,\"21,25\"\n",
    ] {
        let log = good(text);
        assert_eq!(columns(&log), ROWS, "{text}");
    }
}

/// With decimal commas a point parts thousands, and the other way round.
#[test]
fn thousands_are_read_by_the_decimal_sign_of_the_file() {
    for (text, y) in [
        ("t;u;y\n0;300,5;998\n1;400,5;1.098\n2;400,5;-12.345\n", [998.0, 1098.0, -12_345.0]),
        ("t;u;y\n0;30,0;12.502,00\n1;30,0;999,5\n2;30,0;1.234.567,25\n", [12_502.0, 999.5, 1_234_567.25]),
        ("t;u;y\n0;30;12,502.00\n1;30;999.5\n2;30;1,098\n", [12_502.0, 999.5, 1098.0]),
        ("t,u,y\n0,300.5,998\n1,400.5,\"1,098\"\n2,400.5,\"1,098.5\"\n", [998.0, 1098.0, 1098.5]),
        ("t;u;y\n0;30;1.234.567\n1;30;999\n2;30;1.098\n", [1_234_567.0, 999.0, 1098.0]),
        // Decimals, by the numbers of the column itself, by a file that only has them, and where a comma parts the cells.
        ("t;u;y\n0;300,5;0.998\n1;400,5;1.098\n2;400,5;1.1\n", [0.998, 1.098, 1.1]),
        ("t;u;y\n0,000;50,000;50,070\n0,500;50,000;49,980\n1,000;50,000;50,012\n", [50.07, 49.98, 50.012]),
        ("t;u;y\n0;30;21.500\n1;30;21.625\n2;30;21.500\n", [21.5, 21.625, 21.5]),
        ("t,u,y\n0,30,21\n1,30,21.625\n2,30,22\n", [21.0, 21.625, 22.0]),
    ] {
        let log = good(text);
        assert_eq!(columns(&log).2, y, "{text}");
        let remarks: Vec<_> =
            log.remarks.iter().filter(|r| r.message.contains("is taken for 1098")).collect();
        assert_eq!(!remarks.is_empty(), y[1..].contains(&1098.0), "{text}: {:?}", log.remarks);
    }
    for (text, line, cell) in [
        ("t;u;y\n0;300;998\n1;400;1.098\n2;400;1.099\n", 3, "1.098"),
        ("t;u;y\n0;300;1.098\n1;400;1,099\n2;400;1.099\n", 2, "1.098"),
        ("t,u,y\n0,300,998\n1,400,\"1,098\"\n2,400,\"1,099\"\n", 3, "1,098"),
    ] {
        let (fault, place) = bad(text);
        assert!(fault.message.contains("may be a decimal number or thousands"), "{fault:?}");
        assert!(fault.help.is_some_and(|help| help.contains("thousands")));
        assert_eq!((place.line, &*place.text), (line, cell));
    }
    // A column that is not read is none of our business.
    assert_eq!(good("t;u;y;z\n0;3;5;998\n1;4;6;1.098\n").columns.len(), 2);
}

/// Both columns are asked for by the name of either one; whole days count.
#[test]
fn a_date_beside_the_time_of_day_counts() {
    let text = "Nr;Datum;Uhrzeit;Ventil;Istwert\n1;28.02.2024;12:00:00;0;1\n2;01.03.2024;12:00:01;0;2\n";
    for name in ["Datum", "Uhrzeit", "2", "3"] {
        let roles = [
            Role::time(Column::from_text(name)),
            Role::input(Column::from_text("Ventil")),
            Role::output(Column::from_text("Istwert")),
        ];
        let log = read("log.csv", text, &roles).expect("a table");
        assert_eq!(log.times, [0.0, 2.0 * 86_400.0 + 1.0], "{name}");
    }
}

#[test]
fn dates_that_can_be_read_in_two_ways_are_refused_with_what_to_write() {
    for date in ["01/03/2024 12:00:00", "1-3-2024 12:00:00", "01.03.24 12:00:00"] {
        let text = format!("time;u;y\n{date};0;1\n{date};1;1\n{date};1;2\n");
        let (fault, place) = bad(&text);
        let help = fault.help.expect("help");
        assert!(help.contains("day or month first") && help.contains("01.03.2024"), "{help}");
        assert_eq!((place.line, place.column), (2, 1));
    }
}

/// Milliseconds of date-times are the numbers that a person would write, not what floating-point seconds since 1970 leave.
#[test]
fn milliseconds_of_dates_are_exact() {
    let rows: String = (0..1000)
        .map(|i| format!("2024-03-01T12:30:{:02}.{:03}Z,0,{i}\n", i / 100, i % 100 * 10 + 3))
        .collect();
    let log = good(&format!("time,u,y\n{rows}"));
    for (i, t) in log.times.iter().enumerate() {
        // Both are the nearest to the decimal number.
        assert_eq!(
            t.to_bits(),
            format!("{}.{:02}", i / 100, i % 100).parse::<f64>().expect("a number").to_bits(),
            "{i}: {t}"
        );
    }
}

#[test]
fn a_doubled_stamp_is_a_step_and_is_said() {
    let log = good("0.0,0.0,20.9\n0.0,50.0,20.9\n1.0,50.0,20.9\n2.0,50.0,21.2\n");
    assert_eq!(log.times, [0.0, 0.0, 1.0, 2.0]);
    let [remark] = &log.remarks[..] else { panic!("{:?}", log.remarks) };
    assert!(remark.message.contains("later row holds"), "{remark:?}");
    assert_eq!(remark.span, 13..26);
    let text: String = (0..40).map(|i| format!("{},1,{i}\n", i / 10)).collect();
    assert!(good(&text).remarks[0].help.as_deref().is_some_and(|help| help.contains("digits")));
}

#[test]
fn gaps_and_rows_that_are_left_out_are_said_with_their_lines() {
    let mut text = String::from("time,u,y\n");
    for i in 0..60 {
        match i {
            7 => text.push_str("7,1,\n"),
            8 => text.push_str("8,1,fault\n"),
            9 => text.push_str("9,1\n"),
            10..=12 => text.push_str(&format!("{i},NaN,2\n")),
            30..=45 => {}
            _ => text.push_str(&format!("{i},1,{i}\n")),
        }
    }
    let log = good(&text);
    assert_eq!(log.times.len(), 38);
    let shown: Vec<(usize, &str)> =
        log.remarks.iter().map(|r| (r.place(&text).line, r.message.as_str())).collect();
    assert_eq!(shown[0], (9, "the row is left out: column 3 (`y`): the cell is empty"));
    assert_eq!(shown[1].0, 10);
    assert!(shown[2].1.contains("the row ends after column 2"), "{shown:?}");
    assert!(shown[3].1.starts_with("3 more rows are left out"), "{shown:?}");
    assert!(shown[4].1.starts_with("a gap of") && shown[5].1.contains("17 s from 29 s"), "{shown:?}");
}

#[test]
fn faults_are_at_their_places() {
    let (fault, place) = bad("time,u,y\n0,0,1\n1,0,1\n0.5,0,1\n2,0,1\n");
    assert!(fault.message.contains("0.5 is before 1"), "{fault:?}");
    assert_eq!((place.line, place.column, &*place.text), (4, 1, "0.5"));
    let (fault, place) = bad("time;u;y\n0;0;1\n1;0;x\n2;0;x\n3;1;4\n");
    assert!(fault.message.contains("column 3 (`y`): this is no number"), "{fault:?}");
    assert_eq!((place.line, place.column, &*place.text), (3, 5, "x"));
    assert!(bad("").0.message.contains("no rows"));
    assert!(bad("time,u,y\n").0.message.contains("no rows"));
    let (fault, place) = bad("time,u,y\n0,0,1\n12:00:01,0,1\n2,0,1\n");
    assert!(fault.message.contains("another way") && place.line == 3, "{fault:?}");
}

#[test]
fn columns_by_name_by_number_and_not_at_all() {
    let text = "time,T1,T2,Q1,Q2\n0,20,21,0,0\n1,20,21,50,0\n2,25,21,50,0\n";
    let named = |input: &str, output: &str| {
        let roles = [
            Role::time(Column::Usual),
            Role::input(Column::from_text(input)),
            Role::output(Column::from_text(output)),
        ];
        read("log.csv", text, &roles)
    };
    assert_eq!(good(text).titles, ["time", "Q1", "T1"]);
    assert_eq!(named("Q2", "3").expect("both").titles, ["time", "Q2", "T2"]);
    assert_eq!(named("q1", "t2").expect("both").titles, ["time", "Q1", "T2"]);
    let fault = named("Q3", "T1").expect_err("no such column");
    assert!(fault.message.contains("no column `Q3` for `--input`"), "{fault:?}");
    assert_eq!((fault.place(text).line, fault.help.as_deref()), (1, Some("did you mean \"Q1\"?")));
    assert!(named("9", "T1").expect_err("no such column").message.contains("no column 9"));
    assert!(named("4", "Q1").expect_err("twice").message.contains("the same column"));
    let unclear = "time,alpha,beta,gamma\n0,1,2,3\n1,2,3,4\n";
    let (fault, place) = bad(unclear);
    assert!(fault.message.contains("which column is the input?") && place.line == 1, "{fault:?}");
    assert!(fault.help.is_some_and(|help| help.contains("--input") && help.contains("\"gamma\"")));
    // With a set-point, which need not be there.
    let with = [
        Role::time(Column::Usual),
        Role::setpoint(Column::Usual),
        Role::output(Column::Usual),
        Role::input(Column::Usual),
    ];
    let log = read("log.csv", "t,sp,pv,op\n0,1,2,3\n1,1,2,3\n", &with).expect("all four");
    assert_eq!(log.columns[0], Some(vec![1.0, 1.0]));
    let log = read("log.csv", "t,pv,op\n0,2,3\n1,2,3\n", &with).expect("three of four");
    assert_eq!((log.columns[0].as_ref(), log.columns[2].as_deref()), (None, Some(&[3.0, 3.0][..])));
}

#[test]
fn no_text_makes_it_panic() {
    let pieces = [
        "\"",
        ";",
        ",",
        "\n",
        "\r\n",
        "1",
        "-",
        ".",
        "e9",
        "time",
        "\u{b0}",
        "#",
        " ",
        "\t",
        "12:00",
        "nan",
        "2024-01-01T00:00",
    ];
    let mut state = 12345_u64;
    for _ in 0..3000 {
        let mut text = String::new();
        for _ in 0..40 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            text.push_str(pieces[(state >> 33) as usize % pieces.len()]);
        }
        if let Err(fault) = read("log.csv", &text, &roles()) {
            assert!(text.get(fault.span.clone()).is_some(), "{text:?} {fault:?}");
        }
    }
}

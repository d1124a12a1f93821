//! Signals and recordings.

use controller_sim_host::scenario::{
    Between, Change, Files, FolderFiles, NoFiles, Recording, Signal, code, read_with,
};
use controller_sim_host::simulate::Precision;
use std::collections::BTreeMap;

/// Files in memory.
struct InMemory(BTreeMap<&'static str, String>);

impl Files for InMemory {
    fn load(&self, path: &str) -> Result<String, String> {
        self.0.get(path).cloned().ok_or_else(|| format!("there is no file `{path}`"))
    }
}

fn with(path: &'static str, text: &str) -> InMemory {
    InMemory(BTreeMap::from([(path, text.to_owned())]))
}

fn scenario(event: &str) -> String {
    format!(
        "version = 1\nts = 0.5\nduration = 100\nplant.tf = \"1/(1+10*s)\"\n[[controller]]\nname = \"PI\"\n\
         pid = {{ kp = 1, ki = 0.1 }}\n[[event]]\nat = 1\n{event}\n"
    )
}

fn changes(event: &str, files: &dyn Files) -> Vec<Change> {
    let all = read_with("s.toml", &scenario(event), Precision::F64, files);
    let mut all = all.unwrap_or_else(|faults| panic!("{event}: {faults:?}"));
    assert_eq!((all.cases.len(), all.cases[0].label.take()), (1, None));
    all.cases.remove(0).scenario.events.remove(0).changes
}

/// `(message, help)` of the one fault.
fn fault(event: &str, files: &dyn Files) -> (&'static str, String) {
    let text = scenario(event);
    let faults = read_with("s.toml", &text, Precision::F64, files).expect_err(event);
    assert_eq!(faults.len(), 1, "{faults:?}");
    let place = faults[0].place(&text);
    assert!(place.line >= 10, "{faults:?}");
    (faults[0].code, format!("{} | {}", faults[0].message, faults[0].help.as_deref().unwrap_or("")))
}

#[test]
fn every_kind_of_signal() {
    let end = f64::INFINITY;
    let cases = [
        ("2", Signal::Step(2.0)),
        ("{ step = -2 }", Signal::Step(-2.0)),
        ("{ ramp = 0.5 }", Signal::Ramp { slope: 0.5, duration: end }),
        ("{ ramp = 0.5, duration = 4 }", Signal::Ramp { slope: 0.5, duration: 4.0 }),
        ("{ pulse = 3, duration = 4 }", Signal::Pulse { height: 3.0, duration: 4.0 }),
        ("{ sine = 3, period = 4 }", Signal::Sine { amplitude: 3.0, period: 4.0, phase: 0.0, duration: end }),
        (
            "{ sine = 3, period = 4, phase = -1.5, duration = 9 }",
            Signal::Sine { amplitude: 3.0, period: 4.0, phase: -1.5, duration: 9.0 },
        ),
        ("{ walk = 0.1 }", Signal::Walk { std: 0.1, every: 0.5, seed: 2, duration: end }),
        (
            "{ walk = 0.1, every = 2, seed = 7, duration = 30 }",
            Signal::Walk { std: 0.1, every: 2.0, seed: 7, duration: 30.0 },
        ),
    ];
    for (text, signal) in cases {
        assert_eq!(
            changes(&format!("setpoint = {text}"), &NoFiles),
            [Change::Setpoint(signal.clone())],
            "{text}"
        );
        let remote = changes(&format!("remote_setpoint = {text}"), &NoFiles);
        assert_eq!(remote, [Change::RemoteSetpoint(signal.clone())], "{text}");
        assert_eq!(
            changes(&format!("disturbance = {text}"), &NoFiles),
            [Change::Disturbance(signal)],
            "{text}"
        );
    }
    assert_eq!(changes("measurement = \"plant\"", &NoFiles), [Change::Measurement(None)]);
}

/// The recording that `keys` read from `text`.
fn recorded(text: &str, keys: &str) -> Recording {
    match &changes(&format!("disturbance = {{ csv = \"log.csv\"{keys} }}"), &with("log.csv", text))[..] {
        [Change::Disturbance(Signal::Recorded(recording))] => (**recording).clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn tables_as_people_have_them() {
    let expected: [&[f64]; 2] = [&[0.0, 0.5, 2.0], &[20.5, -21.0, 22.0]];
    for (text, keys) in [
        ("t,y\n0,20.5\n0.5,-21\n2,22\n", ""),
        ("0,20.5\n0.5,-21\n2,22", ""),
        ("\u{feff}t,y\r\n0,20.5\r\n0.5,-21\r\n2,22\r\n", ", column = \"y\""),
        ("t;y\n10;20,5\n10,5;-21,0\n12;22\n", ", column = 2"),
        ("t\ty\n10\t20,5\n10,5\t-21.0\n12\t+2.2e1\n", ""),
        (
            "# made by hand\n\n  t , y \n s , degC \n0 , 20.5\n\n# a break\n0.5, -21\n2,22\n,\n",
            ", column = \"y\"",
        ),
        ("# t, y\n0,20.5\n0.5,-21\n2,22\n", ", column = \"y\", time = \"t\""),
        // The value twice, the time last.
        ("y,z,t\n20.5,1,7\n-21,1,7.5\n22,1,9\n", ", column = 1, time = \"t\""),
        ("y,z,t\n20.5,,7\n-21,off,7.5\n22,1,9\n", ", column = \"y\", time = 3"),
        // A doubled time stamp: the last one holds.
        ("t,y\n0,1\n0,20.5\n0.5,3\n0.5,-21\n2,22\n", ""),
        ("\"t [s]\",\"y, filtered\"\n0,\"20.5\"\n0.5,-21\n2,22\n", ", column = \"y, filtered\""),
        // Columns that are called by numbers.
        ("t,1,2\n0,5,20.5\n0.5,5,-21\n2,5,22\n", ", column = \"2\""),
        ("t,y\n0,4.1\n0.5,-4.2\n2,4.4\n", ", scale = 5, offset = 0.0"),
        ("t,y\n0,0.5\n0.5,-41\n2,2\n", ", offset = 20"),
    ] {
        let recording = recorded(text, keys);
        assert_eq!([&*recording.times, &*recording.values], expected, "{text}");
        assert_eq!(recording.between, Between::Hold);
    }
    let line = recorded("t,y\n0,1\n2,3", ", column = \"y\", between = \"line\"");
    assert_eq!((line.between, &*line.name), (Between::Line, "log.csv: y"));
    assert_eq!(recorded("0,1", "").times, [0.0]);
}

#[test]
fn one_file_is_read_once_and_shared() {
    struct Once(std::cell::Cell<usize>);
    impl Files for Once {
        fn load(&self, _: &str) -> Result<String, String> {
            self.0.set(self.0.get() + 1);
            Ok("0,1\n1,2\n".to_owned())
        }
    }
    let files = Once(std::cell::Cell::new(0));
    let changes = changes("setpoint = { csv = \"a.csv\" }\nmeasurement = { csv = \"a.csv\" }", &files);
    let [Change::Setpoint(Signal::Recorded(a)), Change::Measurement(Some(b))] = &changes[..] else {
        panic!("{changes:?}")
    };
    assert!(std::sync::Arc::ptr_eq(a, b));
    assert_eq!(files.0.get(), 1);
}

#[test]
fn what_is_wrong_in_a_table_is_named() {
    let head = "t,y,z\n0,1,5\n";
    #[rustfmt::skip]
    let cases: &[(&str, &str, &str, &[&str])] = &[
        ("", "", code::RECORDING, &["`log.csv` has no rows"]),
        ("t,y\ns,degC\n", "", code::RECORDING, &["`log.csv` has no rows"]),
        ("# only\n\n", "", code::RECORDING, &["has no rows"]),
        ("1,2,3\n", "", code::UNKNOWN_NAME, &["`log.csv` has 3 columns; `column` says which one"]),
        (head, "", code::UNKNOWN_NAME, &["has 3 columns: \"t\", \"y\", \"z\"; `column`"]),
        (head, ", column = 4", code::UNKNOWN_NAME, &["has no column 4; there are 3", "from 1"]),
        (head, ", column = 1", code::UNKNOWN_NAME, &["column 1 of `log.csv` is that of the times"]),
        (head, ", column = \"Y\"", code::UNKNOWN_NAME, &["has no column `Y`", "did you mean \"y\"?"]),
        (head, ", column = \"pressure\"", code::UNKNOWN_NAME, &["no column `pressure`", "there are \"t\", \"y\", \"z\""]),
        (head, ", column = 2, time = \"tt\"", code::UNKNOWN_NAME, &["has no column `tt`"]),
        ("1,2\n", ", column = \"y\"", code::UNKNOWN_NAME, &["has no line with names", "give its number"]),
        ("t,y,y\n0,1,2\n", ", column = \"y\"", code::UNKNOWN_NAME, &["two columns `y`", "2 or 3"]),
        ("t,y\nmin,degC\n1,2\n", "", code::RECORDING, &["`log.csv`, column 1 (`t`): the times are in `min`; seconds are needed", "convert them"]),
        ("n,Zeit [ms],y\n1,2,3\n", ", time = 2, column = 3", code::RECORDING, &["column 2 (`Zeit [ms]`): the times are in `ms`", ""]),
        ("t,y\n# x\n\n1,2\n0.5,3\n", "", code::RECORDING, &["`log.csv`, line 5, column 1 (`t`): the time 0.5 is before 1", "sort the rows"]),
        ("t,y\n0,n/a\n1,2\n", "", code::RECORDING, &["line 2, column 2 (`y`): `n/a` is no number"]),
        ("0,1\n1,\n", "", code::RECORDING, &["line 2, column 2: the cell is empty", "rows may be missing"]),
        ("0,1\n1,NaN\n", "", code::RECORDING, &["line 2, column 2: `NaN` is no finite number"]),
        ("0,1\n1,inf\n", "", code::RECORDING, &["`inf` is no finite number"]),
        ("0,1\n1\n", "", code::RECORDING, &["line 2, column 2: the row ends after column 1"]),
        ("t,y\n2024-01-01 12:00,1\n", "", code::RECORDING, &["line 2, column 1 (`t`): `2024-01-01 12:00` is no number", "in seconds"]),
        ("t;y\n0;1.000,5\n", "", code::RECORDING, &["`1.000,5` is no number"]),
        ("t,y\n0,1e13\n", "", code::RECORDING, &["line 2, column 2 (`y`): the value 1e13 is out of range; allowed: -1e12 to 1e12"]),
        ("t,y\n0,1e6\n", ", scale = 1e9", code::RECORDING, &["the value 1e15 is out of range"]),
    ];
    for (text, keys, code, parts) in cases {
        for key in ["setpoint", "disturbance", "measurement"] {
            let (found, said) =
                fault(&format!("{key} = {{ csv = \"log.csv\"{keys} }}"), &with("log.csv", text));
            assert_eq!(found, *code, "{text}: {said}");
            for part in *parts {
                assert!(said.contains(part), "`{part}` is not in `{said}`");
            }
        }
    }
    let (found, said) = fault("setpoint = { csv = \"lag.csv\" }", &with("log.csv", ""));
    assert_eq!((found, &*said), (code::FILE, "there is no file `lag.csv` | "));
    let (found, said) = fault("setpoint = { csv = \"lag.csv\" }", &NoFiles);
    assert!(found == code::FILE && said.contains("cannot name files here"), "{said}");
}

#[test]
fn files_of_a_folder() {
    let folder = std::env::temp_dir().join(format!("scenario-signals-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("sub")).expect("a folder");
    std::fs::write(folder.join("heater.csv"), "0,1\n1,2\n").expect("a file");
    std::fs::write(folder.join("latin.csv"), b"0,1\n1,2 \xb0C\n").expect("a file");
    std::fs::File::create(folder.join("long.toml"))
        .and_then(|file| file.set_len((16 << 20) + 1))
        .expect("a file");
    let files = FolderFiles::beside(&folder.join("s.toml"));
    assert_eq!(files.load("heater.csv").as_deref(), Ok("0,1\n1,2\n"));
    assert_eq!(files.load("sub/../heater.csv").as_deref(), Ok("0,1\n1,2\n"));
    for (path, part) in [
        ("heatr.csv", "there is no file `heatr.csv` in the scenario's folder; did you mean `heater.csv`?"),
        ("sub", "`sub` is a directory"),
        ("", "empty"),
        (
            "latin.csv",
            "`latin.csv` is not UTF-8 text: line 2 has a byte that is no character; save it as UTF-8",
        ),
        ("long.toml", "`long.toml` is longer than 16 MiB"),
    ] {
        let problem = files.load(path).expect_err(path);
        assert!(problem.contains(part), "{problem}");
    }
    let (found, said) = fault("setpoint = { csv = \"heatr.csv\" }", &files);
    assert_eq!(found, code::FILE);
    assert!(said.ends_with("folder | did you mean `heater.csv`?"), "{said}");
    std::fs::remove_dir_all(&folder).expect("the folder goes away");
}

/// A real log, when it is there: a doubled first time stamp, rows of about a second.
#[test]
fn a_log_of_a_heater() {
    let files = FolderFiles::new("../../shared/data");
    if files.load("heater-step.csv").is_err() {
        return;
    }
    let changes = changes("measurement = { csv = \"heater-step.csv\", column = \"temperature_c\" }", &files);
    let [Change::Measurement(Some(recording))] = &changes[..] else { panic!("{changes:?}") };
    assert_eq!((recording.times.len(), recording.times[0], recording.values[0]), (800, 0.0, 20.9));
    assert!(recording.times.is_sorted_by(|a, b| a < b));
}

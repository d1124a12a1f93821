//! The same scenario gives the same bytes.

use crate::folder::{BASE, Folder};

/// Noise, a sweep of files, and all outputs: on repeated runs and for every number of threads.
#[test]
fn every_output_is_the_same_on_every_run_and_number_of_threads() {
    let noise = "\n[noise]\nstd = 0.01\nseed = 3\n";
    let mut first: Option<Vec<Vec<u8>>> = None;
    for (i, threads) in ["1", "1", "2", "7"].into_iter().enumerate() {
        let folder = Folder::new(&format!("same-{i}"));
        for (n, latency) in ["0.0", "0.003", "0.01", "0.05", "0.2"].into_iter().enumerate() {
            let text = BASE.replacen("duration = 20.0", &format!("duration = 20.0\nlatency = {latency}"), 1);
            folder.write(&format!("{n}.toml"), &format!("{text}{noise}"));
        }
        let scenarios = ["run", "0.toml", "1.toml", "2.toml", "3.toml", "4.toml", "--threads", threads];
        let run = |more: &[&str]| folder.done(&[&scenarios[..], more].concat()).into_bytes();
        let mut all = vec![run(&[]), run(&["--json"]), run(&["--json", "--precision", "f32"])];
        // With a file of samples the runs are made one after the other, without one side by side.
        all.push(run(&["--report", "r.html", "--svg", "p.svg", "--quiet"]));
        all.extend(["r.html", "p-1.svg", "p-5.svg"].map(|name| folder.bytes(name)));
        all.push(run(&["--csv", "s.csv", "--parquet", "s.parquet", "--svg", "q.svg", "--quiet"]));
        all.extend(["s.csv", "s.parquet"].map(|name| folder.bytes(name)));
        for n in 1..=5 {
            assert_eq!(folder.bytes(&format!("p-{n}.svg")), folder.bytes(&format!("q-{n}.svg")));
        }
        match &first {
            None => first = Some(all),
            Some(first) => {
                for (n, (a, b)) in first.iter().zip(&all).enumerate() {
                    assert!(a == b, "output {n} with {threads} threads");
                }
            }
        }
    }
}

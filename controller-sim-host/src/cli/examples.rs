//! The examples below the help of each command.

pub(super) const PROGRAM: &str = "\
Examples:
  controller-sim                                 run the built-in scenario
  controller-sim demo --save my.toml             write it to a file, to change it
  controller-sim run my.toml                     run a scenario and compare its controllers
  controller-sim run my.toml --report my.html    with plots, as a page for the browser
  controller-sim analyze my.toml                 margins and noise of its loops
  controller-sim export loop.toml --format rust  a loop for the target
  controller-sim demo --list                     everything that is built in
  controller-sim identify step.csv               a model from a recorded step
  controller-sim batch --set ah134               ten rules on 134 processes

In the source tree write `cargo sim` for `controller-sim`.

Exit codes: 0 done, 2 bad input, 3 refused, 4 a check failed, 130 stopped, 1 anything else.";

pub(super) const RUN: &str = "\
Examples:
  controller-sim run my.toml
  controller-sim run my.toml --report my.html              plots and tables on one page
  controller-sim run my.toml --report my.html --force      replace my.html
  controller-sim run fast.toml slow.toml --svg plot.svg    plot-1.svg and plot-2.svg
  controller-sim run my.toml --csv my.csv                  every sample
  controller-sim run my.toml --precision f32               as the target computes
  controller-sim run my.toml --precision f32 --pil         also in the emulated target: same bits?
  controller-sim run my.toml --set latency=0.05 --set 'plant.tf=\"exp(-s)/(1+2*s)\"'
  controller-sim run my.toml --set 'controller.\"PI + DOB\".observer.alpha=0.2'
  cat my.toml | controller-sim run - --json";

pub(super) const ANALYZE: &str = "\
Examples:
  controller-sim analyze my.toml                           each controller of a scenario or design file
  controller-sim analyze loop.toml --report my.html        loop card, plots
  controller-sim analyze loop.toml --card --board microbit the loop card on the screen
  controller-sim analyze loop.toml --save-card card.toml   its figures with bounds, to be kept beside the loop
  controller-sim analyze loop.toml --check card.toml       does the loop still keep them? in your own CI
  controller-sim analyze my.toml --set latency=0.05
  controller-sim analyze --plant 'exp(-0.2*s)/((1+0.2*s)*(1+s))' --kp 2 --ki 1.6 --ts 0.01
  controller-sim analyze --plant 'exp(-s)/(1+s)' --kp 0.6 --ki 0.5 --ts 0.05 --alpha 0.4 --json

The loop card is that of the law as it is flashed, f32 unless said otherwise. Its jitter margin is the lateness that every
output may have on top of the latency, another one in each sample: sufficient for stability, by Kao and Lincoln's criterion.

Exit codes: 0 done, 4 a figure does not keep the bounds of `--check` or is missing, 3 there is no stable loop, or no card, 2 bad input.";

pub(super) const DEMO: &str = "\
Examples:
  controller-sim demo                               run the first one
  controller-sim demo --list                        what there is
  controller-sim demo windup --report windup.html   run another one, with plots
  controller-sim demo windup --save my.toml         write it to a file, to change it
  controller-sim demo --save                        write the first one to demo.toml, or demo-2.toml, ...

A name that several names begin with runs all of them in order: `windup` all of `windup-...`.";

pub(super) const EXPORT: &str = "\
Examples:
  controller-sim export loop.toml --format rust                         to the screen
  controller-sim export loop.toml --format rust --save src/loop_law.rs
  controller-sim export my.toml --controller 'PI + DOB' --format rust --capacity 64
  controller-sim export loop.toml --format rust --set 'controller.\"DE-MOMI\".pid.kp=2'
  controller-sim export loop.toml --format st --save fb_loop.st         numbers are REAL; --precision f64: LREAL
  controller-sim export loop.toml --format st-test --save test_loop.st  a program that tests the block in the PLC
  controller-sim export loop.toml --format c --save loop.h              with controller-capi's ctl.h

The law is built in the target's number type before a line is written. The Rust module checks when it is compiled that
nobody changed a number since.

Structured Text is one function block without any C. KP, TN, TV, TF are inputs: a change becomes coefficients at the
next call, without a bump; what cannot be used is refused with a status bit, and the old values stay. It is not for
an ADRC (exit code 3).";

pub(super) const DESIGN: &str = "\
Examples:
  controller-sim design --plant 'exp(-0.2*s)/((1+0.2*s)*(1+s))' --method advise --ts 0.01
  controller-sim design --plant 'exp(-0.2*s)/((1+0.2*s)*(1+s))' --method de-momi --ts 0.01 --kpidn 4
  controller-sim design --plant '1.98*exp(-3.2*s)/(1+80.3*s)' --method dob --ms 1.2 --noise-ratio 3 --save loop.toml
  controller-sim run loop.toml --report loop.html

Exit code 3: the rule has no result for this plant or wish; the message says why and what helps.";
pub(super) const ASSESS: &str = "\
The experiment: in automatic, at rest, without error. Switch to manual, step the output, switch back to
automatic within the dead time. Record until the loop is at rest again.

Examples:
  controller-sim demo load-experiment --csv loop.csv    make a record by simulation
  controller-sim assess loop.csv --controller 'well tuned' --report loop.html
  controller-sim assess log.csv                         is this loop tuned for loads?
  controller-sim assess log.csv --report log.html       with the picture of the response
  controller-sim assess log.csv --time Zeit --setpoint SP --output PV --input OP
  controller-sim assess log.csv --step-at 754 --auto-at 757

Exit codes: 0 with a verdict, 3 when the record does not tell (with the reason), 2 bad input.";
pub(super) const IDENTIFY: &str = "\
Examples:
  controller-sim identify step.csv                            the columns by their names, or in this order
  controller-sim identify log.csv --time t --input MV --output PV
  controller-sim identify log.csv --input 4 --output 2 --report log.html
  controller-sim identify samples.csv --log-ts 0.1            rows 0.1 s apart, without a column of times
  logger | controller-sim identify - --json

The log shows a change of the input (a step, a ramp, a closed loop that moves) from one steady state to another.";

pub(super) const TUNE: &str = "\
Examples:
  controller-sim tune step.csv --report loop.html --save loop.toml --limits 0:100
  controller-sim tune step.csv --input heater --output temperature --method momi --kpidn 3
  controller-sim tune samples.csv --log-ts 0.1 --ts 0.5
                                                     rows 0.1 s apart, for a controller that runs every 0.5 s
  controller-sim run loop.toml --precision f32       the loop as the target computes it

The noise gain is 4/|K| or what is attainable; de-momi and dob keep Ms at 2 or below by the filter
of their block, the others warn of a larger one.
Exit code 3: the log or the rule gives no loop; the message says why and what helps.";
pub(super) const REPRODUCE: &str = "\
Examples:
  controller-sim reproduce                        every table of the three papers
  controller-sim reproduce --paper de --table 5   one of them
  controller-sim reproduce --paper pi             those of one paper
  controller-sim reproduce --json > tables.json
  controller-sim reproduce --figures              every figure: what draws it, or why nothing can
  controller-sim reproduce --figure dob-10 --report fig10.html
  controller-sim reproduce --figure pi-7 --svg fig7.svg --csv fig7.csv

Printed is what the paper says, true what an independent computation gives, ours what this program gives; the verdict
is about the paper. Exit code 1: ours differs from true by more than the tolerance of a cell.";

pub(super) const BATCH: &str = "\
Examples:
  controller-sim batch --set ah134                                  ten rules on 134 processes
  controller-sim batch --set ah134 --methods pi-ms,dob --ms 1.2,2.0 --noise-ratio 2 --out rows.csv
  controller-sim batch --set ah134 --list > my.csv                  the processes, to change them
  controller-sim batch --processes my.csv --methods momi,de-momi --out rows.parquet
  controller-sim batch --processes my.csv --out rows.csv --resume   go on after an interruption
  controller-sim batch --processes my.csv --shard 2/4 --out part2.csv
  controller-sim batch merge part*.csv --out rows.csv
  controller-sim batch sample loop.toml --vary gain=+-20% --vary lag=+-20%    how robust is a loop
  controller-sim batch map --help                                     contour lines over two parameters

Margins and indices are those of the continuous loop, exact but for de-momi with a reduced model
and adrc: these are simulated sampled with two periods and extrapolated. With `--ts` all are those
of the sampled loop as it runs. The rows do not depend on the number of threads, on interruptions
or on shards.

Exit codes: 0 every row has a result; 3 all rows are there, but some have none (refused by a rule,
or a plant that means nothing): each says why, and the summary counts them; 2 bad lists, nothing
is written.";

pub(super) const BATCH_SAMPLE: &str = "\
Examples:
  controller-sim batch sample loop.toml --vary gain=+-20% --vary lag=+-20% --vary dead_time=+-30%
  controller-sim batch sample loop.toml --vary 'lags=0.5..2 log' -n 10000 --out rows.parquet --report robust.html
  controller-sim batch sample loop.toml --vary gain=+-30% --worst worst    then: run worst/sample-7.toml
  controller-sim batch sample loop.toml --uncertainty plant.toml --precision f32 --seed 2
  controller-sim batch sample my.toml --vary 'actuator.hi=8..12 abs' --vary 'noise.std=0..0.02 abs'
  controller-sim batch sample loop.toml --vary gain=+-20% --out rows.csv --resume       go on after an interruption
  controller-sim batch sample loop.toml --vary gain=+-20% --shard 2/4 --out part2.csv   then: batch merge

Quantities: gain, dead_time, lag (each factor of the denominator by itself), lag1, lag2, .., lags (one factor on all), zero,
zero1, .., zeros; noise.std, sensor.resolution, actuator.lo, hi, rate, resolution, deadband. Ranges: `+-20 %`, `-10..30 %`,
`0.5..2` (times the nominal value), `0.2..0.6 s`, `1..3 abs` (values); behind it `uniform`, `log` or `normal` (cut at three
standard deviations, which are the ends). A factor of a higher degree becomes faster or slower as a whole.

A loop is unstable when the sampled closed loop has poles outside the unit circle or on it, counted from its frequency
response; the simulation does not decide. Indices and margins are summed up over stable loops, quantiles to 1e-4 or better
where the values span no more than a factor of four. A sample depends on the seed and its number only: threads,
interruptions and shards change no byte of the rows.

Exit codes: 0 every row has a result; 3 all rows are there, but some have none (refused, or not
simulated): each says why, and the summary counts them; 2 bad input.";
pub(super) const BATCH_MAP: &str = "\
Examples:
  controller-sim batch map --x L=0.05:0.95:19 --y alpha_ratio=0.01:100:17:log --at ms=1.4 --over pi-ms --report map.html
  controller-sim batch map --x L=0.02:0.98:25 --y alpha_ratio=0.01:100:25:log --each ms=1.2,1.6,2 --over pi-ms \\
      --metric load_iae,load_ise,ms,a_n --svg fig10.svg --out fig10.csv
  controller-sim batch map --plant 'exp(-T*s)/((1+s)*(1+r*s))' --method simc --metric ms --x T=0.05:2:20:log --y r=0:1:11 \\
      --x-label 'dead time [s]' --y-label 'ratio of the lags' --svg ms.svg
  controller-sim batch map --plant '1/(1+s)^n' --method pi-ms --x n=3:8:6 --y ms=1.2:2:9 --metric load_itae --report order.html
  controller-sim batch map --method de-momi --x L=0.05:0.6:12 --y kpidn=2:20:10:log --metric setpoint_iae,ms --out rows.parquet

Letters of the plant other than s are parameters, and so are ms, ms_max, alpha, alpha_ratio (alpha over dead time plus lags),
noise_ratio, tf, kpidn, tfd, kden, tau_c, b0 where the rule looks at them. A point that the rule refuses is a hole, grey in
the picture, with its reason in the rows. Rows, --resume, --shard and `batch merge` are as those of `batch`; a complete file is
drawn again by the same command with --resume.

Exit codes: 0 every point has a value; 3 the map is there, but has holes: each row says why, and the
summary counts them; 2 bad input.";

pub(super) const BATCH_MERGE: &str = "\
Examples:
  controller-sim batch merge part1.csv part2.csv --out rows.csv
  controller-sim batch merge part*.parquet --out rows.parquet

Rows that are missing or there twice, and shards of different studies, are refused: exit code 2.";

pub(super) const COMPLETIONS: &str = "\
Examples:
  controller-sim completions bash > ~/.local/share/bash-completion/completions/controller-sim
  controller-sim completions zsh > ~/.zfunc/_controller-sim
  controller-sim completions fish > ~/.config/fish/completions/controller-sim.fish";

pub(super) const MAN: &str = "\
Examples:
  controller-sim man | man -l -                       read it
  controller-sim man --dir ~/.local/share/man/man1    a page for each command";

pub(super) const SCHEMA: &str = "\
Examples:
  controller-sim schema > controller-sim.schema.json";

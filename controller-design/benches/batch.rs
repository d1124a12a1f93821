//! Where the time of a batch goes: the 134 processes at one sensitivity peak, each designed three times (PI, PI with observer at
//! the noise ratios 2 and 10) and simulated three times.
//!
//! Prints one line: seconds of the processor for designs, margins, simulations and the rows as text, the state updates of the
//! simulations, the time that their multiplications take at least, and the sum of `IAE*ki`, by which other programs see that
//! they did the same. Every phase is the shortest of several. `cargo xtask bench` runs this and puts it beside Python; by hand:
//! `cargo bench -p controller-design --bench batch`.

use std::fmt::Write;
use std::hint::black_box;
use std::time::{Duration, Instant};

use controller_core::PidConfig;
use controller_design::batch134::processes;
use controller_design::design::{Designer, Law, Method, ObserverFilter, Request};
use controller_design::margins::ContinuousLoop;
use controller_design::model::TransferFunction;
use controller_design::response::{ContinuousResponse, Indices, Load};

const MS: f64 = 1.2;
const REPETITIONS: usize = 7;
/// Rows and columns of a matrix as large as those of the simulations, for the floor.
const SIZE: (usize, usize) = (22, 13);

/// The three loops of a process: plant, PI, time constant of the observer.
type Loops = (TransferFunction, PidConfig, [Option<f64>; 3]);

fn designs(plant: &TransferFunction) -> Option<(PidConfig, [Option<f64>; 3])> {
    let designer = Designer::new(plant);
    let pi = Request { ms: Some(MS), ..Request::new(Method::PiMs, 1.0) };
    let Law::Pid { pid, .. } = designer.continuous(&pi).ok()?.law else { return None };
    let alpha = |ratio| {
        let filter = ObserverFilter::NoiseRatio(ratio);
        let request = Request { method: Method::Dob, observer_filter: filter, ..pi };
        let Law::Pid { observer, .. } = designer.continuous(&request).ok()?.law else { return None };
        observer.map(|observer| observer.alpha)
    };
    Some((pid, [None, Some(alpha(2.0)?), Some(alpha(10.0)?)]))
}

fn response(plant: &TransferFunction, pid: &PidConfig, alpha: Option<f64>) -> Option<ContinuousResponse> {
    let made = match alpha {
        None => ContinuousResponse::new(plant, pid, None),
        Some(alpha) => ContinuousResponse::with_alpha(plant, pid, alpha),
    };
    made.ok()
}

/// The shortest of several.
fn shortest<T>(mut work: impl FnMut() -> T) -> (Duration, T) {
    let mut once = || {
        let start = Instant::now();
        let result = black_box(work());
        (start.elapsed(), result)
    };
    let first = once();
    (1..REPETITIONS).fold(first, |best, _| {
        let next = once();
        if next.0 < best.0 { next } else { best }
    })
}

/// Seconds of one multiplication and addition in a product of matrix and vector of the simulations' size.
fn multiplication() -> f64 {
    let (rows, cols) = SIZE;
    let matrix: Vec<f64> = (0..rows * cols).map(|i| 1.0 / (i as f64 + 1.0)).collect();
    let (mut x, mut y) = (vec![1.0; cols], vec![0.0; rows]);
    const TIMES: usize = 100_000;
    let (time, _) = shortest(|| {
        for _ in 0..TIMES {
            y.fill(0.0);
            for (column, x) in matrix.chunks_exact(rows).zip(&x) {
                for (y, a) in y.iter_mut().zip(column) {
                    *y += a * x;
                }
            }
            x[0] = black_box(y[0]) * 1e-3;
        }
        y[0]
    });
    time.as_secs_f64() / (TIMES * rows * cols) as f64
}

fn main() {
    let plants: Vec<TransferFunction> =
        processes().iter().map(|process| process.plant().expect("published")).collect();
    let (design, loops) = shortest(|| -> Vec<Loops> {
        plants
            .iter()
            .map(|plant| {
                let (pid, alphas) = designs(plant).expect("every one has a design");
                (plant.clone(), pid, alphas)
            })
            .collect()
    });
    let each = || loops.iter().flat_map(|(plant, pid, alphas)| alphas.map(|alpha| (plant, pid, alpha)));
    // Those that the designs contain: of the PI, and of each loop with an observer.
    let (margins, _) = shortest(|| {
        each()
            .filter_map(|(plant, pid, alpha)| {
                let alone = ContinuousLoop::new(plant, pid);
                let whole = match alpha {
                    None => alone,
                    Some(alpha) => {
                        let model = plant.to_plant_model().ok()?;
                        let order = None;
                        alone.with_observer(&controller_core::ObserverConfig { model, alpha, order }).ok()?
                    }
                };
                whole.margins().ok()
            })
            .count()
    });
    let (simulation, indices) = shortest(|| -> Vec<Indices> {
        each()
            .map(|(plant, pid, alpha)| {
                let made = response(plant, pid, alpha).expect("a loop");
                made.indices(Load::Step).expect("a stable one")
            })
            .collect()
    });
    let (output, length) = shortest(|| {
        let mut text = String::new();
        for ((_, pid, alpha), i) in each().zip(&indices) {
            let numbers = [pid.kp, pid.ki, alpha.unwrap_or(0.0), i.ie, i.iae, i.ise, i.itae, i.e_max, i.tv];
            for x in numbers {
                let _ = write!(text, "{x:?},");
            }
            text.push('\n');
        }
        text.len()
    });
    let costs = each().filter_map(|(plant, pid, alpha)| response(plant, pid, alpha)?.cost(Load::Step).ok());
    let (updates, products) = costs
        .fold((0, 0), |(updates, products), cost| (updates + cost.elements, products + cost.multiplications));
    let floor = products as f64 * multiplication();
    let iae_ki: f64 = each().zip(&indices).map(|((_, pid, _), i)| i.iae * pid.ki).sum();
    let [design, margins, simulation, output] =
        [design, margins, simulation, output].map(|t| t.as_secs_f64());
    println!(
        "design_seconds={design:.6} margins_seconds={margins:.6} simulation_seconds={simulation:.6} \
         output_seconds={output:.6} updates={updates} floor_seconds={floor:.6} text_bytes={length} iae_ki={iae_ki:.9}"
    );
}

//! What can be drawn: gain, times and zeros of the plant; actuator, sensor and noise around it.

use super::spread::Spread;
use crate::scenario::{Noise, Scenario, closest};
use controller_design::model::{Polynomial, TransferFunction, parse};

/// Quantities that are no part of the plant.
const AROUND: [(&str, Around); 7] = [
    ("noise.std", Around::NoiseStd),
    ("sensor.resolution", Around::SensorResolution),
    ("actuator.lo", Around::ActuatorLo),
    ("actuator.hi", Around::ActuatorHi),
    ("actuator.rate", Around::ActuatorRate),
    ("actuator.resolution", Around::ActuatorResolution),
    ("actuator.deadband", Around::ActuatorDeadband),
];

/// The names of quantities, without those that are numbered.
pub const NAMES: [&str; 13] = [
    "gain",
    "dead_time",
    "lags",
    "lag",
    "zeros",
    "zero",
    "noise.std",
    "sensor.resolution",
    "actuator.lo",
    "actuator.hi",
    "actuator.rate",
    "actuator.resolution",
    "actuator.deadband",
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Around {
    NoiseStd,
    SensorResolution,
    ActuatorLo,
    ActuatorHi,
    ActuatorRate,
    ActuatorResolution,
    ActuatorDeadband,
}

/// In the order of the columns. Places of factors are from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Target {
    Gain,
    DeadTime,
    Lags,
    Lag(usize),
    Zeros,
    Zero(usize),
    Around(Around),
}

/// A quantity that is drawn for each sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Its name: `gain`, `dead_time`, `lags` (a factor on all of them), `lag1`, ..., `zeros`, `zero1`, ..., `actuator.hi` and
    /// so on.
    pub name: String,
    /// Its value in the scenario; of a factor on several times 1.
    pub nominal: f64,
    /// The least and the largest value.
    pub ends: (f64, f64),
    /// How it was asked for.
    pub spread: Spread,
    target: Target,
}

impl Quantity {
    /// The column of its values.
    #[must_use]
    pub fn column(&self) -> String {
        self.name.replace('.', "_")
    }
}

/// Checks the name of a quantity.
///
/// # Errors
/// No such quantity, with what may have been meant.
pub fn check_name(name: &str) -> Result<(), String> {
    if NAMES.contains(&name) || numbered(name).is_some() {
        return Ok(());
    }
    Err(match closest(name, &NAMES) {
        Some(meant) => format!("there is no quantity `{name}`; did you mean `{meant}`?"),
        None => {
            format!("there is no quantity `{name}`; there are {}, lag1, zero1 and so on", NAMES.join(", "))
        }
    })
}

/// `lag2` is the second lag: its word and its place from 0.
fn numbered(name: &str) -> Option<(&str, usize)> {
    let digits = name
        .strip_prefix("lag")
        .map(|n| ("lag", n))
        .or_else(|| name.strip_prefix("zero").map(|n| ("zero", n)));
    let (word, digits) = digits?;
    let is_number = digits.bytes().all(|b| b.is_ascii_digit()) && !digits.starts_with('0');
    let place: usize = digits.parse().ok().filter(|_| is_number)?;
    Some((word, place - 1))
}

/// The size of a factor with the constant term 1: its time constant with its sign, of a higher degree the time in which it is
/// `1 + .. + s^n`.
fn size(factor: &Polynomial) -> f64 {
    let n = factor.degree();
    let last = factor.coefficient(n);
    if n == 1 { last } else { libm::pow(last.abs(), 1.0 / n as f64) }
}

/// What is drawn around `scenario`, in the order of the columns; a later wish for the same quantity counts.
///
/// # Errors
/// For each wish that cannot be, its name and why.
pub fn quantities(
    scenario: &Scenario,
    wishes: &[(String, Spread)],
) -> Result<Vec<Quantity>, Vec<(String, String)>> {
    let (mut list, mut faults): (Vec<Quantity>, _) = (Vec::new(), Vec::new());
    // `lag` and `zero` are for those that are not named.
    let general = |wish: &&(String, Spread)| wish.0 == "lag" || wish.0 == "zero";
    let ordered = wishes.iter().filter(general).chain(wishes.iter().filter(|wish| !general(wish)));
    for (name, spread) in ordered {
        match targets(scenario, name) {
            Err(why) => faults.push((name.clone(), why)),
            Ok(targets) => {
                for (target, name, nominal) in targets {
                    match spread.ends(nominal).and_then(|ends| possible(target, nominal, ends)) {
                        Err(why) => faults.push((name, why)),
                        Ok(ends) => {
                            let drawn = Quantity { name, nominal, ends, spread: *spread, target };
                            list.retain(|other| other.target != target);
                            list.push(drawn);
                        }
                    }
                }
            }
        }
    }
    list.sort_by_key(|quantity| match quantity.target {
        Target::Gain => (0, 0),
        Target::DeadTime => (1, 0),
        Target::Lags => (2, 0),
        Target::Lag(i) => (3, i),
        Target::Zeros => (4, 0),
        Target::Zero(i) => (5, i),
        Target::Around(around) => (6, around as usize),
    });
    if faults.is_empty() { Ok(list) } else { Err(faults) }
}

/// What a name stands for in a scenario, with each one's own name and nominal value.
fn targets(scenario: &Scenario, name: &str) -> Result<Vec<(Target, String, f64)>, String> {
    check_name(name)?;
    let plant = &scenario.plant;
    let one = |target, nominal| Ok(vec![(target, name.to_owned(), nominal)]);
    if let Some((_, around)) = AROUND.iter().find(|(known, _)| *known == name) {
        return one(Target::Around(*around), nominal(scenario, *around));
    }
    let word = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let factors = if word.starts_with("lag") { plant.den() } else { plant.num() };
    let none = || {
        let what = if word.starts_with("lag") { "lags" } else { "zeros" };
        match factors.len() {
            0 => format!("the plant has no {what}"),
            1 => format!("the plant has 1 of its {what}"),
            n => format!("the plant has {n} {what}"),
        }
    };
    let target = |i: usize| if word == "lag" { Target::Lag(i) } else { Target::Zero(i) };
    match (name, numbered(name)) {
        ("gain", _) => one(Target::Gain, plant.gain()),
        ("dead_time", _) => one(Target::DeadTime, plant.dead_time()),
        _ if factors.is_empty() => Err(none()),
        ("lags", _) => one(Target::Lags, 1.0),
        ("zeros", _) => one(Target::Zeros, 1.0),
        (_, Some((_, i))) => match factors.get(i) {
            Some(factor) => one(target(i), size(factor)),
            None => Err(none()),
        },
        _ => {
            let each = factors.iter().enumerate();
            Ok(each.map(|(i, factor)| (target(i), format!("{word}{}", i + 1), size(factor))).collect())
        }
    }
}

fn nominal(scenario: &Scenario, around: Around) -> f64 {
    let (sensor, actuator) = (&scenario.sensor, &scenario.actuator);
    match around {
        Around::NoiseStd => scenario.noise.map_or(0.0, |noise| noise.std),
        Around::SensorResolution => sensor.resolution,
        Around::ActuatorLo => actuator.lo,
        Around::ActuatorHi => actuator.hi,
        Around::ActuatorRate => actuator.rate,
        Around::ActuatorResolution => actuator.resolution,
        Around::ActuatorDeadband => actuator.deadband,
    }
}

/// The ends, when at least one value between them can be simulated: of the others the rows say why there is no result.
fn possible(target: Target, nominal: f64, (from, to): (f64, f64)) -> Result<(f64, f64), String> {
    let never = match target {
        Target::Gain => from == 0.0 && to == 0.0,
        Target::Lags | Target::Zeros => to <= 0.0,
        Target::Lag(_) if nominal < 0.0 => from >= 0.0,
        Target::Lag(_) => to <= 0.0,
        Target::Around(Around::ActuatorRate) => to <= 0.0,
        Target::Around(Around::ActuatorLo | Around::ActuatorHi) | Target::Zero(_) => false,
        Target::DeadTime | Target::Around(_) => to < 0.0,
    };
    if never { Err(format!("no value from {from} to {to} is possible")) } else { Ok((from, to)) }
}

/// The scenario with these values of the quantities.
///
/// # Errors
/// Why there is none, without the numbers.
pub(super) fn changed(scenario: &Scenario, list: &[Quantity], values: &[f64]) -> Result<Scenario, String> {
    let mut changed = scenario.clone();
    let plant = &scenario.plant;
    let (mut gain, mut dead_time) = (plant.gain(), plant.dead_time());
    let [mut lags, mut zeros] =
        [plant.den(), plant.num()].map(|factors| factors.iter().map(size).collect::<Vec<f64>>());
    let (mut all_lags, mut all_zeros, mut is_plant) = (1.0, 1.0, false);
    let above = |name: &str, x: f64| if x > 0.0 { Ok(x) } else { Err(format!("{name} is not above 0")) };
    let not_negative = |name: &str, x: f64| if x >= 0.0 { Ok(x) } else { Err(format!("{name} is negative")) };
    for (Quantity { name, nominal, target, .. }, &x) in list.iter().zip(values) {
        is_plant |= !matches!(target, Target::Around(_));
        match target {
            Target::Gain if x == 0.0 => return Err("gain is 0".to_owned()),
            Target::Gain => gain = x,
            Target::DeadTime => dead_time = not_negative(name, x)?,
            Target::Lags => all_lags = above(name, x)?,
            Target::Zeros => all_zeros = above(name, x)?,
            Target::Lag(_) if *nominal < 0.0 && x >= 0.0 => return Err(format!("{name} is not below 0")),
            Target::Lag(i) if *nominal < 0.0 => lags[*i] = x,
            Target::Lag(i) => lags[*i] = above(name, x)?,
            // A time constant in the numerator may be any, a lead of higher degree has no sign to change.
            Target::Zero(i) if plant.num()[*i].degree() == 1 => zeros[*i] = x,
            Target::Zero(i) => zeros[*i] = above(name, x)?,
            Target::Around(around) => put(&mut changed, *around, name, x)?,
        }
    }
    let (sensor, actuator) = (&changed.sensor, &changed.actuator);
    if actuator.lo >= actuator.hi {
        return Err("actuator.lo is not below actuator.hi".to_owned());
    }
    for (name, width, range) in [
        ("sensor.resolution", sensor.resolution, sensor.hi - sensor.lo),
        ("actuator.resolution", actuator.resolution, actuator.hi - actuator.lo),
        ("actuator.deadband", actuator.deadband, actuator.hi - actuator.lo),
    ] {
        if width > range {
            return Err(format!("{name} is wider than the range from lo to hi"));
        }
    }
    if is_plant {
        lags.iter_mut().for_each(|size| *size *= all_lags);
        zeros.iter_mut().for_each(|size| *size *= all_zeros);
        changed.plant = rebuilt(plant, gain, dead_time, (&zeros, &lags))?;
    }
    Ok(changed)
}

fn put(scenario: &mut Scenario, around: Around, name: &str, x: f64) -> Result<(), String> {
    let (sensor, actuator) = (&mut scenario.sensor, &mut scenario.actuator);
    let is_signed = matches!(around, Around::ActuatorLo | Around::ActuatorHi);
    if x < 0.0 && !is_signed {
        return Err(format!("{name} is negative"));
    }
    match around {
        Around::NoiseStd => {
            let seed = scenario.noise.map_or(1, |noise| noise.seed);
            scenario.noise = Some(Noise { std: x, seed });
        }
        Around::SensorResolution => sensor.resolution = x,
        Around::ActuatorLo => actuator.lo = x,
        Around::ActuatorHi => actuator.hi = x,
        Around::ActuatorRate if x > 0.0 => actuator.rate = x,
        Around::ActuatorRate => return Err(format!("{name} is not above 0")),
        Around::ActuatorResolution => actuator.resolution = x,
        Around::ActuatorDeadband => actuator.deadband = x,
    }
    Ok(())
}

/// The keys of a scenario that quantities around the plant stand for, with their values there.
pub(super) fn keys(scenario: &Scenario, list: &[Quantity]) -> Vec<(&'static str, f64)> {
    let around = list.iter().filter_map(|quantity| match quantity.target {
        Target::Around(around) => Some(around),
        _ => None,
    });
    let named = |around| AROUND.iter().find(|(_, other)| *other == around).map(|(name, _)| *name);
    around.filter_map(|around| Some((named(around)?, nominal(scenario, around)))).collect()
}

/// The plant with another gain and dead time and factors of other sizes: of a higher degree `s` becomes `share*s`. It is read
/// from an expression, so that what is printed of it is it.
fn rebuilt(
    plant: &TransferFunction,
    gain: f64,
    dead_time: f64,
    (zeros, lags): (&[f64], &[f64]),
) -> Result<TransferFunction, String> {
    let factor = |(factor, new): (&Polynomial, &f64)| {
        if factor.degree() == 1 {
            return format!("*({})", Polynomial::new([1.0, *new]));
        }
        let (share, mut power) = (new / size(factor), 1.0);
        let scaled = factor.coefficients().iter().map(|c| {
            let c = c * power;
            power *= share;
            c
        });
        format!("*({})", Polynomial::new(scaled.collect::<Vec<_>>()))
    };
    let product = |factors: &[Polynomial], sizes: &[f64], origin: usize| -> String {
        let origin = if origin > 0 { format!("*s^{origin}") } else { String::new() };
        factors.iter().zip(sizes).map(factor).collect::<String>() + &origin
    };
    let delay = if dead_time > 0.0 { format!("*exp(-{dead_time:e}*s)") } else { String::new() };
    let top = product(plant.num(), zeros, plant.differentiators());
    let bottom = product(plant.den(), lags, plant.integrators());
    parse(&format!("({gain:e}){top}{delay}/(1{bottom})")).map_err(|errors| {
        errors.first().map_or_else(|| "it is no plant".to_owned(), |error| error.message.clone())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demo;
    use crate::scenario::read;
    use crate::simulate::Precision;

    fn scenario(plant: &str) -> Scenario {
        let nominal = read(demo::SCENARIO, Precision::F64).expect("the demo is valid").scenario;
        Scenario { plant: parse(plant).expect("a plant"), ..nominal }
    }

    fn wishes(list: &[(&str, &str)]) -> Vec<(String, Spread)> {
        let wish = |(name, text): &(&str, &str)| {
            ((*name).to_owned(), Spread::parse(text).unwrap_or_else(|e| panic!("{text}: {e}")))
        };
        list.iter().map(wish).collect()
    }

    #[test]
    fn quantities_have_the_values_of_the_plant() {
        let nominal = scenario("2*(1-0.3*s)*exp(-0.5*s)/((1+3*s)*(1+0.4*s+4*s^2))");
        let list = quantities(
            &nominal,
            &wishes(&[("lag2", "x0.5..1"), ("zero", "+-10 %"), ("lag", "+-20 %"), ("gain", "1..3 abs")]),
        );
        let list = list.expect("all there");
        let ends: Vec<_> = list.iter().map(|q| (q.name.as_str(), q.nominal, q.ends)).collect();
        let near = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs() < 1e-12 && (b - d).abs() < 1e-12;
        let want = [
            ("gain", 2.0, (1.0, 3.0)),
            ("lag1", 3.0, (2.4, 3.6)),
            ("lag2", 2.0, (1.0, 2.0)),
            ("zero1", -0.3, (-0.33, -0.27)),
        ];
        assert_eq!(ends.len(), want.len());
        for (have, want) in ends.iter().zip(want) {
            assert!(have.0 == want.0 && have.1 == want.1 && near(have.2, want.2), "{have:?} {want:?}");
        }
        let made = changed(&nominal, &list, &[1.5, 3.6, 1.0, -0.27]).expect("a plant").plant;
        // Half the time in the second factor: its damping stays.
        assert_eq!(made, parse("1.5*(1-0.27*s)*exp(-0.5*s)/((1+3.6*s)*(1+0.2*s+s^2))").expect("a plant"));
    }

    #[test]
    fn impossible_wishes_and_values_say_why() {
        let nominal = scenario("2/((1+3*s)*s)");
        for (name, text, part) in [
            ("lag2", "+-20 %", "has 1 of its lags"),
            ("zero", "+-20 %", "has no zeros"),
            ("dead_time", "+-20 %", "0..0.3 s"),
            ("dead_time", "-2..-1 s", "no value"),
            ("lags", "-2..0", "no value"),
            ("gian", "+-20 %", "did you mean `gain`"),
            ("lag0", "+-20 %", "no quantity"),
            ("actuator.hi", "+-20 %", "no nominal value"),
        ] {
            let faults = quantities(&nominal, &wishes(&[(name, text)])).expect_err(name);
            assert!(faults[0].1.contains(part), "{name}: {faults:?}");
        }
        let list = quantities(&nominal, &wishes(&[("lag", "-200..100 %"), ("gain", "-1..1")])).expect("some");
        let of = |gain: f64, lag: f64| changed(&nominal, &list, &[gain, lag]).map(|s| s.plant.to_string());
        assert_eq!(of(-1.0, 2.0), Ok("-1/(s*(1+2*s))".to_owned()));
        assert_eq!(of(1.0, -0.1), Err("lag1 is not above 0".to_owned()));
        assert_eq!(of(0.0, 1.0), Err("gain is 0".to_owned()));
        let list =
            wishes(&[("actuator.lo", "-1..1 abs"), ("actuator.hi", "0..2 abs"), ("noise.std", "0..1 abs")]);
        let list = quantities(&nominal, &list).expect("all there");
        let of = |values: [f64; 3]| changed(&nominal, &list, &values);
        assert!(of([0.1, -0.5, 0.7]).is_ok_and(|s| s.noise.is_some_and(|noise| noise.std == 0.1)));
        assert_eq!(of([0.1, 0.5, 0.2]), Err("actuator.lo is not below actuator.hi".to_owned()));
    }
}

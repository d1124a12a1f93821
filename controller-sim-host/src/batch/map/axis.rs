//! The values of a parameter.

use super::parameter::Parameter;

/// Most values of an axis.
const MOST: usize = 1000;

/// A parameter with its values, which rise.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What varies.
    pub parameter: Parameter,
    /// From the least to the largest, at least one.
    pub values: Vec<f64>,
    /// Equal ratios are equally far apart.
    pub log: bool,
}

impl Axis {
    /// Reads `NAME=FROM:TO:COUNT`, `NAME=FROM:TO:COUNT:log` or a list, `NAME=1,2,5` or `NAME=1,2,5:log`.
    ///
    /// ```
    /// use controller_sim_host::batch::map::Axis;
    /// assert_eq!(Axis::read("r=0:1:3").expect("an axis").values, [0.0, 0.5, 1.0]);
    /// assert_eq!(Axis::read("alpha=0.01:100:5:log").expect("an axis").values, [0.01, 0.1, 1.0, 10.0, 100.0]);
    /// assert_eq!(Axis::read("ms=1.2,1.6,2").expect("an axis").values, [1.2, 1.6, 2.0]);
    /// assert!(Axis::read("ms=2,1.6").is_err());
    /// ```
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(text: &str) -> Result<Self, String> {
        let form = "write NAME=FROM:TO:COUNT, such as `L=0.05:0.95:19`, or NAME=V1,V2,..; `:log` at the end spaces by ratios";
        let (name, rest) = text.split_once('=').ok_or(form)?;
        let parameter = Parameter::named(name.trim())?;
        let (rest, log) = match rest.trim().strip_suffix(":log") {
            Some(rest) => (rest, true),
            None => (rest.trim().strip_suffix(":lin").unwrap_or(rest.trim()), false),
        };
        let parts: Vec<&str> = rest.split(':').map(str::trim).collect();
        let values = match *parts {
            [list] => list.split(',').map(number).collect::<Result<Vec<_>, _>>()?,
            [from, to, count] => spaced(number(from)?, number(to)?, self::count(count)?, log)?,
            _ => return Err(form.to_owned()),
        };
        if values.len() > MOST {
            return Err(format!("{} values are too many: at most {MOST}", values.len()));
        }
        for value in &values {
            parameter.check(*value)?;
        }
        if let Some(pair) = values.windows(2).find(|pair| pair[0] >= pair[1]) {
            return Err(format!("values must rise: {} is followed by {}", show(pair[0]), show(pair[1])));
        }
        match values.first() {
            Some(first) if log && *first <= 0.0 => {
                Err(format!("an axis by ratios must begin above 0, not at {}", show(*first)))
            }
            _ => Ok(Self { parameter, values, log }),
        }
    }

    /// It as [`read`](Self::read) takes it, value by value.
    #[must_use]
    pub fn text(&self) -> String {
        let values: Vec<String> = self.values.iter().map(|value| show(*value)).collect();
        format!("{}={}{}", self.parameter, values.join(","), if self.log { ":log" } else { "" })
    }
}

fn show(x: f64) -> String {
    crate::batch::show(x)
}

fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err(format!("`{}` is no number", text.trim())),
    }
}

fn count(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(n) if (2..=MOST).contains(&n) => Ok(n),
        _ => Err(format!("the number of values is `{text}`: write 2 to {MOST}")),
    }
}

fn spaced(from: f64, to: f64, count: usize, log: bool) -> Result<Vec<f64>, String> {
    if from >= to {
        return Err(format!("the end, {}, must be above the beginning, {}", show(to), show(from)));
    }
    if log && from <= 0.0 {
        return Err(format!("an axis by ratios must begin above 0, not at {}", show(from)));
    }
    let (a, b) = if log { (libm::log10(from), libm::log10(to)) } else { (from, to) };
    let at = |i: usize| {
        let x = a + (b - a) * i as f64 / (count - 1) as f64;
        let value = if log { libm::pow(10.0, x) } else { x };
        // Twelve digits, by way of text: 0.3 and 10, not 0.30000000000000004 and 9.999999999999998.
        format!("{value:.11e}").parse().unwrap_or(value)
    };
    let mut values: Vec<f64> = (0..count).map(at).collect();
    (values[0], values[count - 1]) = (from, to);
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_round() {
        let values = |text: &str| Axis::read(text).map(|axis| axis.values);
        assert_eq!(values("n=1:6:6"), Ok(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(values("r=0.1:0.5:5"), Ok(vec![0.1, 0.2, 0.3, 0.4, 0.5]));
        assert_eq!(values("r=1:1000:4:log"), Ok(vec![1.0, 10.0, 100.0, 1000.0]));
        assert_eq!(values("r=-1:1:3"), Ok(vec![-1.0, 0.0, 1.0]));
        assert_eq!(values("r=1e-9:3e-9:2:lin"), Ok(vec![1e-9, 3e-9]));
        assert_eq!(values("ms=1.4"), Ok(vec![1.4]));
        for text in ["n=1:6:6", "alpha=0.01:100:9:log", "x=-1,2.5"] {
            let axis = Axis::read(text).expect("an axis");
            assert_eq!(Axis::read(&axis.text()), Ok(axis));
        }
    }

    #[test]
    fn mistakes_are_told() {
        for (text, part) in [
            ("L", "NAME=FROM:TO:COUNT"),
            ("L=1:2", "NAME=FROM:TO:COUNT"),
            ("L=1:2:3:4:5", "NAME=FROM:TO:COUNT"),
            ("L=1:2:1", "2 to 1000"),
            ("L=1:2:1001", "2 to 1000"),
            ("L=1:2:-3", "2 to 1000"),
            ("L=2:1:5", "the end, 1, must be above the beginning, 2"),
            ("L=1:1:5", "must be above"),
            ("L=0:1:5:log", "must begin above 0"),
            ("L=0,1:log", "must begin above 0"),
            ("L=1,1", "values must rise: 1 is followed by 1"),
            ("L=nan:1:5", "`nan` is no number"),
            ("L=1:inf:5", "`inf` is no number"),
            ("L=1,,2", "`` is no number"),
            ("L=", "`` is no number"),
            ("ms=0.9:2:5", "ms = 0.9 is out of range: 1.001 to 100"),
            ("noise_ratio=1,2", "1.000001"),
            ("b0=0", "not 0"),
            ("s=1:2:3", "`s` is no parameter"),
            ("=1:2:3", "is no parameter"),
        ] {
            let message = Axis::read(text).expect_err(text);
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}

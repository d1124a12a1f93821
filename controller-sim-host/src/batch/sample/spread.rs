//! How far a quantity is spread, as people write it.

use super::draw::Source;

/// What a range may look like, for messages.
pub const EXAMPLES: &str = "write `+-20 %`, `-10..30 %`, `0.5..2` (times the nominal value), `0.2..0.6 s` or `1..3 abs` (values); behind it `uniform`, `log` or `normal`";

/// Largest size of a number in a range.
const MOST: f64 = 1e15;
/// Where a normal distribution is cut, in standard deviations.
const CUT: f64 = 3.0;

/// How the values of a range are distributed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distribution {
    /// Every value is as likely as any other.
    Uniform,
    /// Every ratio is as likely as any other: the logarithm is uniform.
    Log,
    /// Normal, its mean in the middle, cut at both ends, three standard deviations away.
    Normal,
}

impl Distribution {
    /// As it is written.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Log => "log",
            Self::Normal => "normal",
        }
    }
}

/// The ends of a range.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Ends {
    /// Multiples of the nominal value.
    Times(f64, f64),
    /// The same, written as differences in per cent.
    Shares(f64, f64),
    /// Values.
    Values(f64, f64),
    /// As far from the nominal value to either side.
    Around(f64),
}

/// A range and the distribution in it.
///
/// ```
/// use controller_sim_host::batch::sample::Spread;
/// let ends = |text: &str, nominal: f64| Spread::parse(text).expect("a range").ends(nominal).expect("ends");
/// assert_eq!(ends("+-20 %", 5.0), (4.0, 6.0));
/// assert_eq!(ends("0.5..2 log", 3.0), (1.5, 6.0));
/// assert_eq!(ends("0.2..0.6 s normal", 3.0), (0.2, 0.6));
/// assert!(Spread::parse("2..0.5").is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    ends: Ends,
    /// The distribution between the ends.
    pub distribution: Distribution,
}

/// What stands behind the numbers.
#[derive(Clone, Copy, PartialEq)]
enum Unit {
    Bare,
    Percent,
    Values,
}

impl Spread {
    /// Reads a range: two numbers with `..` between them or one behind `+-`; a unit, `%` of the nominal value, `s` or `abs`
    /// for values themselves, none for multiples of the nominal value; a distribution, `uniform` if none is named.
    ///
    /// # Errors
    /// What is wrong with it, on one line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (body, distribution) = distribution(text.trim())?;
        let (body, unit) = unit(body);
        let body = body.strip_prefix(['x', '*']).map_or(body, str::trim_start);
        let ends = match body.strip_prefix("+-").or_else(|| body.strip_prefix('\u{b1}')) {
            Some(width) => {
                let width = number(width)?;
                if width < 0.0 {
                    return Err(format!("the width {width} is negative"));
                }
                match unit {
                    Unit::Percent => Ends::Shares(1.0 - width / 100.0, 1.0 + width / 100.0),
                    Unit::Values => Ends::Around(width),
                    Unit::Bare => return Err(format!("`+-{width}` has no unit; write `%`, `s` or `abs`")),
                }
            }
            None => {
                let (from, to) = body.split_once("..").ok_or("there is no range")?;
                let from = from.trim().trim_end_matches('%');
                let is_difference = [from, to.trim()].iter().any(|end| end.starts_with(['+', '-']));
                if unit == Unit::Percent && !is_difference {
                    let why = "per cent of the nominal value, or beyond it? write `+10..+30 %` for differences, or multiples such as `0.5..3`";
                    return Err(why.to_owned());
                }
                let (from, to) = (number(from)?, number(to)?);
                if from > to {
                    return Err(format!("the range is empty: {from} is above {to}"));
                }
                match unit {
                    Unit::Bare => Ends::Times(from, to),
                    Unit::Percent => Ends::Shares(1.0 + from / 100.0, 1.0 + to / 100.0),
                    Unit::Values => Ends::Values(from, to),
                }
            }
        };
        Ok(Self { ends, distribution })
    }

    /// The values at its ends for a nominal value, the lower one first.
    ///
    /// # Errors
    /// A share of nothing, or of what has no limit; a logarithm of what is not above 0.
    pub fn ends(&self, nominal: f64) -> Result<(f64, f64), String> {
        let relative = !matches!(self.ends, Ends::Values(..));
        if relative && !nominal.is_finite() {
            return Err("it has no nominal value; write a range of values, such as `1..3 abs`".to_owned());
        }
        let (a, b) = match self.ends {
            Ends::Times(..) | Ends::Shares(..) if nominal == 0.0 => {
                let why = "a share of its nominal value, 0, is 0; write a range of values, such as `0..0.3 s` or `1..3 abs`";
                return Err(why.to_owned());
            }
            Ends::Times(a, b) | Ends::Shares(a, b) => (nominal * a, nominal * b),
            Ends::Values(a, b) => (a, b),
            Ends::Around(width) => (nominal - width, nominal + width),
        };
        let (from, to) = if a <= b { (a, b) } else { (b, a) };
        if self.distribution == Distribution::Log && from <= 0.0 && to >= 0.0 {
            return Err(format!(
                "from {from} to {to} it has no uniform logarithm: both ends must be above 0"
            ));
        }
        Ok((from, to))
    }

    /// Whether it is of multiples that do not have the nominal value between them: values were probably meant.
    #[must_use]
    pub fn misses(&self) -> bool {
        matches!(self.ends, Ends::Times(a, b) if !(a..=b).contains(&1.0))
    }

    /// A value between the two ends.
    pub(super) fn draw(&self, (from, to): (f64, f64), source: Source) -> f64 {
        let value = match self.distribution {
            Distribution::Uniform => from + (to - from) * source.uniform(),
            Distribution::Log => from * libm::exp(source.uniform() * libm::log(to / from)),
            Distribution::Normal => {
                let half = 0.5 * (to - from);
                from + half + half / CUT * source.normal(CUT)
            }
        };
        // Rounding may lead beyond an end.
        if value < from {
            from
        } else if value > to {
            to
        } else {
            value
        }
    }
}

/// Takes the name of the distribution from the end.
fn distribution(text: &str) -> Result<(&str, Distribution), String> {
    let start = text
        .rfind(|c: char| !(c.is_ascii_alphabetic() || c == '-'))
        .map_or(0, |at| at + text[at..].chars().next().map_or(1, char::len_utf8));
    let (body, word) = text.split_at(start);
    let distribution = match word {
        "uniform" => Distribution::Uniform,
        "log" | "log-uniform" => Distribution::Log,
        "normal" => Distribution::Normal,
        "" | "s" | "abs" => return Ok((text, Distribution::Uniform)),
        other => return Err(format!("`{other}` is no distribution")),
    };
    Ok((body.trim_end(), distribution))
}

/// Takes the unit from the end.
fn unit(text: &str) -> (&str, Unit) {
    for (ending, unit) in [("%", Unit::Percent), ("abs", Unit::Values), ("s", Unit::Values)] {
        if let Some(body) = text.strip_suffix(ending) {
            return (body.trim_end(), unit);
        }
    }
    (text, Unit::Bare)
}

fn number(text: &str) -> Result<f64, String> {
    let text = text.trim();
    match text.parse::<f64>() {
        Ok(x) if x.abs() <= MOST => Ok(x),
        Ok(_) => Err(format!("`{text}` is out of range; allowed: -1e15 to 1e15")),
        Err(_) if text.is_empty() => Err("a number is missing".to_owned()),
        Err(_) => Err(format!("`{text}` is no number")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_read_as_people_write_them() {
        let ends = |text: &str| Spread::parse(text).and_then(|spread| spread.ends(2.0));
        assert_eq!(ends("+-25 %"), Ok((1.5, 2.5)));
        assert_eq!(ends("\u{b1}25%uniform"), Ok((1.5, 2.5)));
        assert_eq!(ends("-50..+100 %"), Ok((1.0, 4.0)));
        assert_eq!(ends("-50 %..100 % log"), Ok((1.0, 4.0)));
        assert_eq!(ends("+50..+100 %"), Ok((3.0, 4.0)));
        assert_eq!(ends("0.5..2"), Ok((1.0, 4.0)));
        assert_eq!(ends("x 0.5 .. 2 log-uniform"), Ok((1.0, 4.0)));
        assert_eq!(ends("0.5..2 s"), Ok((0.5, 2.0)));
        assert_eq!(ends("0.5..2abs normal"), Ok((0.5, 2.0)));
        assert_eq!(ends("+-0.5 s"), Ok((1.5, 2.5)));
        assert_eq!(ends("1e-3..1e3 abs log"), Ok((1e-3, 1e3)));
        // Of a negative gain the larger multiple is the lower end.
        assert_eq!(Spread::parse("0.5..2 log").and_then(|spread| spread.ends(-2.0)), Ok((-4.0, -1.0)));
        for wrong in [
            "",
            "..",
            "1",
            "1..",
            "2..1",
            "+-20",
            "+--3 %",
            "1..2 gauss",
            "1..2 m",
            "nan..1",
            "0..inf",
            "1..1e16",
            "a..b",
            "1...2..3",
            "0..1 log",
            "-1..1 log",
            "20 %",
            "50..300 %",
        ] {
            assert!(ends(wrong).is_err(), "{wrong}: {:?}", ends(wrong));
        }
        assert!(Spread::parse("+-20 %").is_ok_and(|spread| spread.ends(0.0).is_err()));
        let misses = |text: &str| Spread::parse(text).is_ok_and(|spread| spread.misses());
        assert!(misses("60..100") && !misses("0.9..1.1") && !misses("60..100 s") && !misses("+10..+20 %"));
    }

    #[test]
    fn no_value_is_beyond_the_ends() {
        for text in ["0.1..0.3", "0.1..0.3 log", "0.1..0.3 normal", "1..1"] {
            let spread = Spread::parse(text).expect("a range");
            let (from, to) = spread.ends(1.0).expect("ends");
            for sample in 0..2000 {
                let value = spread.draw((from, to), Source::new(7, sample, "x"));
                assert!((from..=to).contains(&value), "{text}: {value}");
            }
        }
    }
}

//! Times as people and machines write them.

use super::sign::Sign;

/// Nanoseconds: of a date-time seconds as a floating-point number would have lost digits.
const SECOND: i128 = 1_000_000_000;

/// A time as it is written in a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stamp {
    /// A number, in the unit of its column.
    Number(f64),
    /// `hh:mm` or `hh:mm:ss`: nanoseconds since midnight.
    Clock(i128),
    /// Date and clock time: nanoseconds since 1970.
    Date(i128),
}

/// The time in a cell; `sign` is the decimal sign of its column.
pub(super) fn parse(cell: &str, sign: Option<Sign>) -> Option<Stamp> {
    if let Some(number) = super::cells::number(cell, sign) {
        return Some(Stamp::Number(number));
    }
    if let Some(clock) = clock(cell) {
        return Some(Stamp::Clock(clock));
    }
    date_time(cell).map(Stamp::Date)
}

/// A date and a clock time that stand in two cells.
pub(super) fn joined(date: &str, time: &str) -> Option<Stamp> {
    Some(Stamp::Date(i128::from(days(date)?) * 86_400 * SECOND + clock(time)?))
}

pub(super) fn is_date(cell: &str) -> bool {
    days(cell).is_some()
}

pub(super) fn is_clock(cell: &str) -> bool {
    clock(cell).is_some()
}

/// Whether a cell begins like `01/03/2024` or `01-03-24`, of which nobody can tell the day from the month.
pub(super) fn is_unclear(cell: &str) -> bool {
    let date = cell.split([' ', 'T', '_']).next().unwrap_or("");
    let parts: Vec<&str> = date.split(['/', '-', '.']).collect();
    let number = |part: &&str| (1..=4).contains(&part.len()) && part.bytes().all(|b| b.is_ascii_digit());
    parts.len() == 3 && parts.iter().all(number) && days(date).is_none()
}

fn date_time(cell: &str) -> Option<i128> {
    let at = cell.find(['T', 't', ' ', '_'])?;
    let (date, rest) = (&cell[..at], cell[at + 1..].trim_start());
    let days = days(date)?;
    let (rest, offset) = zone(rest)?;
    Some((i128::from(days) * 86_400 - i128::from(offset)) * SECOND + clock(rest.trim_end())?)
}

/// Days since 1970 of `2024-03-01`, `2024/03/01` or `01.03.2024`: with dots the day is first.
fn days(date: &str) -> Option<i64> {
    let sign = date.chars().find(|c| !c.is_ascii_digit()).filter(|c| matches!(c, '-' | '/' | '.'))?;
    let parts: Vec<&str> = date.split(sign).collect();
    let [first, second, third] = parts[..] else { return None };
    let number = |text: &str, lengths: core::ops::RangeInclusive<usize>| -> Option<i64> {
        (lengths.contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit()))
            .then(|| text.parse().ok())?
    };
    let (year, month, day) = match sign {
        '.' => (number(third, 4..=4)?, number(second, 1..=2)?, number(first, 1..=2)?),
        _ => (number(first, 4..=4)?, number(second, 2..=2)?, number(third, 2..=2)?),
    };
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let lengths = [31, if leap { 29 } else { 28 }, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let length = lengths.get(usize::try_from(month - 1).ok()?)?;
    if !(1..=*length).contains(&day) {
        return None;
    }
    // The year begins in March, so that the leap day is its last.
    let (y, m) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    Some(
        y * 365 + y.div_euclid(4) - y.div_euclid(100) + y.div_euclid(400) + (153 * m + 2) / 5 + day
            - 1
            - 719_468,
    )
}

/// The zone at the end of a time, in seconds; 0 when there is none.
fn zone(text: &str) -> Option<(&str, i64)> {
    if let Some(rest) = text.strip_suffix(['Z', 'z']) {
        return Some((rest, 0));
    }
    let Some(at) = text.rfind(['+', '-']) else { return Some((text, 0)) };
    let (rest, zone) = text.split_at(at);
    let digits: String = zone[1..].chars().filter(|c| *c != ':').collect();
    if !digits.bytes().all(|b| b.is_ascii_digit()) || !matches!(digits.len(), 2 | 4) {
        return None;
    }
    let hours: i64 = digits[..2].parse().ok()?;
    let minutes: i64 = if digits.len() == 4 { digits[2..].parse().ok()? } else { 0 };
    let offset = 3600 * hours + 60 * minutes;
    Some((rest, if zone.starts_with('-') { -offset } else { offset }))
}

/// Nanoseconds since midnight of `12:30`, `12:30:05`, `12:30:05.25` or `12:30:05,25`.
fn clock(text: &str) -> Option<i128> {
    let mut parts = text.split(':');
    let whole = |part: &str, most: i128| -> Option<i128> {
        let fits = matches!(part.len(), 1 | 2) && part.bytes().all(|b| b.is_ascii_digit());
        fits.then(|| part.parse().ok())?.filter(|n| *n < most)
    };
    let (hours, minutes) = (whole(parts.next()?, 24)?, whole(parts.next()?, 60)?);
    let seconds = match parts.next() {
        None => 0,
        Some(text) => {
            let (seconds, digits) = text.split_once(['.', ',']).unwrap_or((text, ""));
            if !digits.bytes().all(|b| b.is_ascii_digit()) {
                return None;
            }
            // Digits beyond the ninth are none of a clock.
            let nine: String = digits.chars().chain("000000000".chars()).take(9).collect();
            whole(seconds, 61)? * SECOND + nine.parse::<i128>().ok()?
        }
    };
    parts.next().is_none().then_some((hours * 3600 + minutes * 60) * SECOND + seconds)
}

/// Makes seconds of the times of a column, those of clocks and dates since the first.
pub(super) struct Clock {
    scale: f64,
    unit: Option<&'static str>,
    first: Option<Stamp>,
    last: i128,
    days: i128,
}

impl Clock {
    /// For a column of numbers in the unit that the words below or behind its name say.
    pub(super) fn new(below: &[String], behind: &[String]) -> Self {
        let unit = unit(below).or_else(|| unit(behind));
        let (scale, unit) = (unit.map_or(1.0, |unit| unit.0), unit.map(|unit| unit.1));
        Self { scale, unit, first: None, last: i128::MIN, days: 0 }
    }

    /// Seconds of the next row. Differences of clock times are exact: the nearest number to the decimal one.
    pub(super) fn seconds(&mut self, stamp: Stamp) -> Result<f64, String> {
        const DAY: i128 = 86_400 * SECOND;
        let (first, now) = match (*self.first.get_or_insert(stamp), stamp) {
            (Stamp::Number(_), Stamp::Number(t)) => return Ok(self.scale * t),
            (Stamp::Date(first), Stamp::Date(now)) => (first, now),
            (Stamp::Clock(first), Stamp::Clock(now)) => {
                // After midnight.
                if now + self.days < self.last.saturating_sub(DAY / 2) {
                    self.days += DAY;
                }
                (first, now + self.days)
            }
            _ => return Err("the time is written in another way than in the first row".to_owned()),
        };
        self.last = now;
        Ok((now - first) as f64 / SECOND as f64)
    }

    /// What the numbers of the column are taken to be, when that is not seconds.
    pub(super) fn unit(&self) -> Option<&'static str> {
        self.unit.filter(|_| matches!(self.first, Some(Stamp::Number(_))))
    }
}

/// What one unit of a time column is in seconds, as its name or its unit says.
fn unit(words: &[String]) -> Option<(f64, &'static str)> {
    let of = |word: &String| match &**word {
        "ns" | "nanoseconds" => Some((1e-9, "nanoseconds")),
        "us" | "\u{b5}s" | "\u{3bc}s" | "microseconds" => Some((1e-6, "microseconds")),
        "ms" | "msec" | "millis" | "milliseconds" => Some((1e-3, "milliseconds")),
        "min" | "mins" | "minute" | "minutes" => Some((60.0, "minutes")),
        "h" | "hr" | "hrs" | "hour" | "hours" => Some((3600.0, "hours")),
        "d" | "day" | "days" => Some((86_400.0, "days")),
        _ => None,
    };
    words.iter().find_map(of)
}

#[cfg(test)]
mod tests {
    use super::{Clock, SECOND, Stamp, is_unclear, joined, parse, unit};

    #[test]
    fn dates_are_days_since_1970() {
        // Printed by `date -u -d ... +%s`.
        for (text, milliseconds) in [
            ("1970-01-01T00:00:00Z", 0),
            ("2000-02-29 12:00", 951_825_600_000),
            ("2024-03-01T12:30:05.25+01:00", 1_709_292_605_250),
            ("2024/03/01 12:30:05,25", 1_709_296_205_250),
            ("01.03.2024 12:30:05,25", 1_709_296_205_250),
            ("1.3.2024 12:30", 1_709_296_200_000),
            ("29.02.2000 12:00:00", 951_825_600_000),
            ("1999-12-31T23:59:60-0530", 946_704_600_000),
        ] {
            assert_eq!(parse(text, None), Some(Stamp::Date(milliseconds * SECOND / 1000)), "{text}");
        }
        for wrong in [
            "2023-02-29 12:00",
            "2024-13-01 12:00",
            "2024-03-01 25:00",
            "2024-03-01T12:0x",
            "12:61",
            "31.04.2024 12:00",
            "03.13.2024 12:00",
            "01.03.24 12:00",
            "01/03/2024 12:00",
            "2024.03.01 12:00",
            "01.03.2024",
            "01.03.2024 ",
            "12:30:05.",
            "\u{e4}.\u{e4}.2024 12:00",
        ] {
            let number = wrong == "12:30:05.";
            assert_eq!(parse(wrong, None).is_some(), number, "{wrong}");
        }
        assert_eq!(parse("7:05:01,5", None), Some(Stamp::Clock(25_501_500_000_000)));
        assert_eq!(joined("01.03.2024", "12:30:05"), parse("2024-03-01 12:30:05", None));
        assert!(is_unclear("01/03/2024 12:00") && is_unclear("1-3-24") && !is_unclear("2024-03-01"));
        assert!(!is_unclear("fault") && !is_unclear("12:00") && !is_unclear("1.5"));
    }

    #[test]
    fn milliseconds_between_dates_are_exact() {
        let mut clock = Clock::new(&[], &[]);
        for (text, seconds) in [
            ("31.12.2099 23:59:59,998", 0.0),
            ("31.12.2099 23:59:59,999", 0.001),
            ("2100-01-01T00:00:00.1", 0.102),
            ("2100-01-01T01:00:00.123456789Z", 3_600.125_456_789),
        ] {
            let stamp = parse(text, None).expect(text);
            assert_eq!(clock.seconds(stamp).map(f64::to_bits), Ok(f64::to_bits(seconds)), "{text}");
        }
    }

    #[test]
    fn units_are_words_of_the_name() {
        let words = |list: &[&str]| list.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>();
        assert_eq!(unit(&words(&["time", "ms"])).map(|u| u.0), Some(1e-3));
        assert_eq!(unit(&words(&["time", "s"])), None);
    }
}

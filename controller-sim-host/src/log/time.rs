//! Times as people and machines write them.

/// How the times of a table are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Number,
    /// `hh:mm` or `hh:mm:ss`, since midnight.
    Clock,
    /// Date and clock time.
    Date,
}

/// The seconds of a time and how it is written: of a number as it is, of a clock time since midnight, of a date-time since
/// 1970.
pub(super) fn parse(cell: &str, comma_is_decimal: bool) -> Option<(f64, Kind)> {
    if let Some(number) = super::cells::number(cell, comma_is_decimal) {
        return Some((number, Kind::Number));
    }
    if let Some(clock) = clock(cell) {
        return Some((clock, Kind::Clock));
    }
    date_time(cell).map(|t| (t, Kind::Date))
}

fn date_time(cell: &str) -> Option<f64> {
    let bytes = cell.as_bytes();
    if !cell.is_ascii() || bytes.len() < 16 || !matches!(bytes.get(10), Some(b'T' | b't' | b' ' | b'_')) {
        return None;
    }
    let (date, rest) = (&cell[..10], &cell[11..]);
    let days = days(date)?;
    let (rest, offset) = zone(rest)?;
    Some(days as f64 * 86_400.0 - offset + clock(rest.trim_end())?)
}

/// Days since 1970 of `2024-03-01` or `2024/03/01`.
fn days(date: &str) -> Option<i64> {
    let sign = if date.contains('/') { '/' } else { '-' };
    let mut parts = date.split(sign);
    let mut part = |length: usize| -> Option<i64> {
        let text = parts.next()?;
        (text.len() == length && text.bytes().all(|b| b.is_ascii_digit())).then(|| text.parse().ok())?
    };
    let (year, month, day) = (part(4)?, part(2)?, part(2)?);
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let lengths = [31, if leap { 29 } else { 28 }, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let length = lengths.get(usize::try_from(month - 1).ok()?)?;
    if parts.next().is_some() || !(1..=*length).contains(&day) {
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
fn zone(text: &str) -> Option<(&str, f64)> {
    if let Some(rest) = text.strip_suffix(['Z', 'z']) {
        return Some((rest, 0.0));
    }
    let Some(at) = text.rfind(['+', '-']) else { return Some((text, 0.0)) };
    let (rest, zone) = text.split_at(at);
    let digits: String = zone[1..].chars().filter(|c| *c != ':').collect();
    if !digits.bytes().all(|b| b.is_ascii_digit()) || !matches!(digits.len(), 2 | 4) {
        return None;
    }
    let hours: f64 = digits[..2].parse().ok()?;
    let minutes: f64 = if digits.len() == 4 { digits[2..].parse().ok()? } else { 0.0 };
    let offset = 3600.0 * hours + 60.0 * minutes;
    Some((rest, if zone.starts_with('-') { -offset } else { offset }))
}

/// Seconds since midnight of `12:30`, `12:30:05`, `12:30:05.25` or `12:30:05,25`.
fn clock(text: &str) -> Option<f64> {
    let mut parts = text.split(':');
    let mut whole = |most: f64| -> Option<f64> {
        let part = parts.next()?;
        let fits = matches!(part.len(), 1 | 2) && part.bytes().all(|b| b.is_ascii_digit());
        fits.then(|| part.parse().ok())?.filter(|n| *n < most)
    };
    let (hours, minutes) = (whole(24.0)?, whole(60.0)?);
    let seconds = match parts.next() {
        None => 0.0,
        Some(text) if text.starts_with(|c: char| c.is_ascii_digit()) => {
            super::cells::number(text, true).filter(|s| (0.0..61.0).contains(s))?
        }
        Some(_) => return None,
    };
    parts.next().is_none().then_some(hours * 3600.0 + minutes * 60.0 + seconds)
}

/// What one unit of a time column is in seconds, as its name or its unit says.
pub(super) fn unit(words: &[String]) -> Option<(f64, &'static str)> {
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
    use super::{Kind, parse, unit};

    #[test]
    fn dates_are_days_since_1970() {
        // Printed by `date -u -d ... +%s`.
        for (text, seconds) in [
            ("1970-01-01T00:00:00Z", 0.0),
            ("2000-02-29 12:00", 951_825_600.0),
            ("2024-03-01T12:30:05.25+01:00", 1_709_292_605.25),
            ("2024/03/01 12:30:05,25", 1_709_296_205.25),
            ("1999-12-31T23:59:60-0530", 946_704_600.0),
        ] {
            assert_eq!(parse(text, false), Some((seconds, Kind::Date)), "{text}");
        }
        for wrong in ["2023-02-29 12:00", "2024-13-01 12:00", "2024-03-01 25:00", "2024-03-01T12:0x", "12:61"]
        {
            assert_eq!(parse(wrong, false), None, "{wrong}");
        }
        assert_eq!(parse("7:05:01,5", false), Some((25_501.5, Kind::Clock)));
    }

    #[test]
    fn units_are_words_of_the_name() {
        let words = |list: &[&str]| list.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>();
        assert_eq!(unit(&words(&["time", "ms"])).map(|u| u.0), Some(1e-3));
        assert_eq!(unit(&words(&["time", "s"])), None);
    }
}

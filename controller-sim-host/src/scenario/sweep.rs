//! `[sweep]`: one scenario for each of several values of one key.

use super::fault::{Fault, code};
use super::number::{Allowed, show};
use super::override_key::Edit;
use super::table::{Located, Table};
use super::value::shortened;
use std::ops::Range;

/// Most values.
const MOST: usize = 1000;

const EXAMPLE: &str = "`[sweep]` and below it `key = \"latency\"` and `values = [0.0, 0.1, 0.2]`";

/// What is swept.
#[derive(Debug)]
pub(super) struct Sweep {
    /// The path of the key, as it is written.
    pub(super) key: Located<String>,
    pub(super) values: Vec<Value>,
}

/// A value of the key.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Value {
    /// As TOML.
    pub(super) text: String,
    /// Where it is, or where it follows from.
    pub(super) span: Range<usize>,
    /// Whether it is written there.
    pub(super) is_written: bool,
}

impl Sweep {
    /// What a case is called.
    pub(super) fn label(&self, value: &Value) -> String {
        format!("{} = {}", self.key.value, shortened(&value.text))
    }
}

/// Reads `[sweep]`; nothing comes back only with a fault.
pub(super) fn read(root: &Table<'_>) -> Option<Sweep> {
    let table = root.table("sweep", EXAMPLE)?;
    if table.span("key").is_none() {
        table.missing("key", "the key that is swept: `key = \"latency\"`");
    }
    let key = table.text("key").and_then(|key| {
        let first = key.value.split('.').next().unwrap_or("").trim();
        if ["sweep", "version"].contains(&first) {
            let message = format!("`{first}` cannot be swept");
            table.log.fault(Fault::new(code::CONFLICT, key.span, message));
            return None;
        }
        Some(Located { value: key.value.trim().to_owned(), span: key.span })
    });
    let range = ["from", "to", "count", "scale"].into_iter().find_map(|key| table.key_span(key));
    let values = match (table.key_span("values"), range) {
        (Some(list), Some(range)) => {
            let message = "a sweep has either `values`, or `from`, `to` and `count`";
            let fault = Fault::new(code::CONFLICT, range, message).help("remove one of the two");
            table.log.fault(fault.related(list, "the values"));
            None
        }
        (_, Some(_)) => spread(&table),
        _ => written(&table),
    };
    table.finish();
    Some(Sweep { key: key?, values: values? })
}

/// `values = [...]`.
fn written(table: &Table<'_>) -> Option<Vec<Value>> {
    if table.span("values").is_none() {
        table.missing_one_of(
            &["values", "from", "to", "count"],
            "`values = [0.0, 0.1, 0.2]`, or `from`, `to` and `count`",
        );
        return None;
    }
    let values = table.list("values", "`values = [0.0, 0.1, 0.2]`")?;
    if !(2..=MOST).contains(&values.len()) {
        let message = format!("`sweep.values` has {} values; allowed: 2 to {MOST}", values.len());
        table.log.fault(Fault::new(code::OUT_OF_RANGE, table.span("values")?, message));
        return None;
    }
    let before = table.log.count();
    let values: Vec<Value> = values
        .into_iter()
        .map(|item| Value { text: table.log.slice(&item.span).to_owned(), span: item.span, is_written: true })
        .collect();
    let mut order: Vec<&Value> = values.iter().collect();
    order.sort_by(|a, b| (&a.text, a.span.start).cmp(&(&b.text, b.span.start)));
    for pair in order.windows(2) {
        let [first, second] = pair else { continue };
        if first.text == second.text {
            let message = format!("the value `{}` is there twice", shortened(&second.text));
            let fault =
                Fault::new(code::DUPLICATE, second.span.clone(), message).help("remove one of the two");
            table.log.fault(fault.related(first.span.clone(), "the first one"));
        }
    }
    (table.log.count() == before).then_some(values)
}

/// `from`, `to`, `count`, `scale`.
fn spread(table: &Table<'_>) -> Option<Vec<Value>> {
    for (key, example) in [("from", "`from = 0.1`"), ("to", "`to = 10.0`"), ("count", "`count = 5`")] {
        if table.span(key).is_none() {
            table.missing(key, example);
        }
    }
    let (from, to) = (
        table.number_in("from", Allowed::new(-1e15, 1e15, "")),
        table.number_in("to", Allowed::new(-1e15, 1e15, "")),
    );
    let count = table.integer_in("count", 2, MOST as u64);
    let scales = [("linear", false), ("log", true)];
    let is_log = table.choice("scale", &scales).is_some_and(|scale| scale.value);
    let (from, to, count) = (from?, to?, count?);
    let raw = |place: &Range<usize>| table.log.slice(place);
    if from.value == to.value {
        let message = format!("`sweep.to = {}` is `from`; a sweep has different values", raw(&to.span));
        table.log.fault(Fault::new(code::CONFLICT, to.span, message).related(from.span, "`from`"));
        return None;
    }
    if is_log {
        for (name, end) in [("from", &from), ("to", &to)].into_iter().filter(|(_, end)| end.value <= 0.0) {
            let message = format!(
                "`sweep.{name} = {}` is out of range; allowed: above 0 for `scale = \"log\"`",
                raw(&end.span)
            );
            table.log.fault(Fault::new(code::OUT_OF_RANGE, end.span.clone(), message));
        }
        if from.value <= 0.0 || to.value <= 0.0 {
            return None;
        }
    }
    let n = usize::try_from(count.value).ok()?;
    let last = n - 1;
    let values = round_values(&points([from.value, to.value], n, is_log));
    let place = |index: usize| match index {
        0 => from.span.clone(),
        _ if index == last => to.span.clone(),
        _ => count.span.clone(),
    };
    let value = |(index, x): (usize, f64)| Value {
        text: number(x),
        span: place(index),
        is_written: index == 0 || index == last,
    };
    Some(values.into_iter().enumerate().map(value).collect())
}

/// `n` values at equal distances or equal ratios, both ends exactly.
fn points([from, to]: [f64; 2], n: usize, is_log: bool) -> Vec<f64> {
    let last = n - 1;
    #[allow(clippy::cast_precision_loss)] // at most a thousand
    let share = |index: usize| index as f64 / last as f64;
    (0..n)
        .map(|index| match index {
            0 => from,
            _ if index == last => to,
            _ if is_log => from * libm::exp(share(index) * libm::log(to / from)),
            _ => from + share(index) * (to - from),
        })
        .collect()
}

/// The values with as few digits as keep them apart: what is run is what the label says.
fn round_values(values: &[f64]) -> Vec<f64> {
    let rounded = |digits: usize| -> Vec<f64> {
        let inner = 1..values.len().saturating_sub(1);
        let round = |x: f64| format!("{x:.digits$e}").parse().unwrap_or(x);
        values.iter().enumerate().map(|(k, &x)| if inner.contains(&k) { round(x) } else { x }).collect()
    };
    let good = |list: &Vec<f64>| {
        let near = |k: usize| {
            let gap = values.get(k + 1).zip(values.get(k)).map_or(0.0, |(b, a)| (b - a).abs());
            let moved = list.get(k).zip(values.get(k)).map_or(0.0, |(a, b)| (a - b).abs());
            k + 1 >= values.len() || moved <= 1e-3 * gap
        };
        (0..values.len()).all(near)
    };
    (5..17).map(rounded).find(good).unwrap_or_else(|| values.to_vec())
}

/// A number as TOML; a whole one as keys for whole numbers take it.
fn number(x: f64) -> String {
    if x.fract() == 0.0 && x.abs() < 1e15 { format!("{x:.0}") } else { show(x) }
}

/// A text in which a case has another value, and how faults of that text are those of what was written.
#[derive(Debug)]
pub(super) struct Change<'a> {
    /// The included file whose text it is; none: the scenario itself.
    pub(super) file: Option<&'a str>,
    pub(super) edit: Edit,
}

impl Change<'_> {
    /// The place in the written text of a place in the text with a value of `length` put in; none: it is in that.
    pub(super) fn back(&self, span: &Range<usize>, length: usize) -> Option<Range<usize>> {
        let put = self.edit.span.start..self.edit.span.start + length;
        if span.start >= put.start && span.end <= put.end && put.start < put.end {
            return None;
        }
        let back = |at: usize| match at {
            _ if at <= put.start => at,
            _ if at >= put.end => at - put.end + self.edit.span.end,
            _ => self.edit.span.end,
        };
        Some(back(span.start)..back(span.end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_short_and_apart() {
        let spread = |ends, n, log| -> Vec<String> {
            round_values(&points(ends, n, log)).into_iter().map(number).collect()
        };
        assert_eq!(spread([0.0, 0.3], 4, false), ["0", "0.1", "0.2", "0.3"]);
        assert_eq!(spread([1.0, 2.0], 4, false), ["1", "1.33333", "1.66667", "2"]);
        assert_eq!(spread([0.01, 100.0], 5, true), ["0.01", "0.1", "1", "10", "100"]);
        assert_eq!(spread([10.0, 1.0], 3, true), ["10", "3.16228", "1"]);
        let close = spread([1.0, 1.000_01], 1000, false);
        assert!(close.windows(2).all(|pair| pair[0] != pair[1]), "{close:?}");
        assert_eq!(spread([1e15, 2.0], 2, false), ["1e15", "2"]);
    }
}

//! The distribution of a number, in memory that does not grow with how many there are.

use std::collections::BTreeMap;

/// Most classes that are kept.
const CLASSES: usize = 1 << 14;
/// Bits of a double that a class has at first: its sign, its exponent and 13 bits of its mantissa.
const FIRST_SHIFT: u32 = 52 - 13;

/// Counts numbers in classes of equal relative width: neighbouring doubles whose first bits are the same.
///
/// A quantile is that of the class it falls into, off by at most half of its width: a 16 384th of its value as long as the
/// numbers fill no more than 16 384 classes, as they do when the largest is four times the smallest. When there are more,
/// classes are joined in pairs. Which numbers came decides about the classes, their order does not. Least, largest, number and
/// sum are exact; the sum is compensated and depends on the order by rounding only.
#[derive(Debug, Clone)]
pub struct Sketch {
    classes: BTreeMap<i64, u64>,
    shift: u32,
    count: u64,
    min: f64,
    max: f64,
    sum: f64,
    rest: f64,
}

impl Default for Sketch {
    fn default() -> Self {
        Self {
            classes: BTreeMap::new(),
            shift: FIRST_SHIFT,
            count: 0,
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
            sum: 0.0,
            rest: 0.0,
        }
    }
}

/// A double as an integer that is in the same order; both zeros are the same.
fn key(x: f64) -> i64 {
    let bits = (x + 0.0).to_bits().cast_signed();
    if bits < 0 { i64::MIN.wrapping_sub(bits) } else { bits }
}

fn number(key: i64) -> f64 {
    let bits = if key < 0 { i64::MIN.wrapping_sub(key) } else { key };
    f64::from_bits(bits.cast_unsigned())
}

impl Sketch {
    /// Adds a number; what is none is left out.
    pub fn add(&mut self, x: f64) {
        if x.is_nan() {
            return;
        }
        self.count += 1;
        self.min = if x < self.min { x } else { self.min };
        self.max = if x > self.max { x } else { self.max };
        let sum = self.sum + x;
        // Two-sum: the part of x or of the sum that rounding took; of infinite ones there is none.
        let back = sum - self.sum;
        let lost = (self.sum - (sum - back)) + (x - back);
        self.sum = sum;
        self.rest += if lost.is_finite() { lost } else { 0.0 };
        *self.classes.entry(key(x) >> self.shift).or_default() += 1;
        while self.classes.len() > CLASSES {
            self.shift += 1;
            let finer = std::mem::take(&mut self.classes);
            for (class, count) in finer {
                *self.classes.entry(class >> 1).or_default() += count;
            }
        }
    }

    /// How many there are.
    #[must_use]
    pub const fn count(&self) -> u64 {
        self.count
    }

    /// The least one; `None` without any.
    #[must_use]
    pub fn min(&self) -> Option<f64> {
        (self.count > 0).then_some(self.min)
    }

    /// The largest one.
    #[must_use]
    pub fn max(&self) -> Option<f64> {
        (self.count > 0).then_some(self.max)
    }

    /// Their mean.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then(|| (self.sum + self.rest) / self.count as f64)
    }

    /// The `share` quantile, 0 to 1: the least number that this share of all does not exceed.
    #[must_use]
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let rank = (share * self.count as f64).ceil().clamp(1.0, self.count.max(1) as f64) as u64;
        let mut below = 0;
        for (class, count) in &self.classes {
            below += count;
            if below >= rank {
                return Some(self.middle(*class));
            }
        }
        None
    }

    /// The share of numbers up to each class, at the middle of the class: the cumulative distribution, in order.
    #[must_use]
    pub fn cumulative(&self) -> Vec<(f64, f64)> {
        let mut below = 0;
        let classes = self.classes.iter().map(|(class, count)| {
            below += count;
            (self.middle(*class), below as f64 / self.count as f64)
        });
        classes.collect()
    }

    /// The middle of a class, within the numbers that came.
    fn middle(&self, class: i64) -> f64 {
        // The class of 0 has nothing else above 1e-300.
        if class == 0 {
            return 0.0_f64.clamp(self.min, self.max);
        }
        let first = class << self.shift;
        let middle = number(first + (1 << (self.shift - 1)));
        let middle = if middle.is_nan() { number(first) } else { middle };
        middle.clamp(self.min, self.max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_keys_is_that_of_numbers() {
        let list = [f64::NEG_INFINITY, -1e300, -1.0, -5e-324, 0.0, 5e-324, 1e-9, 1.0, 2.0, f64::INFINITY];
        assert!(list.windows(2).all(|pair| key(pair[0]) < key(pair[1])));
        assert_eq!(key(-0.0), key(0.0));
        assert!(list.iter().all(|x| number(key(*x)) == *x));
    }

    /// Against the sorted list, over sets that are narrow, wide, signed and with few values.
    #[test]
    fn quantiles_are_near_those_of_the_sorted_list() {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let narrow: Vec<f64> = (0..50_000).map(|_| 1.5 + next()).collect();
        let wide: Vec<f64> = (0..50_000).map(|_| libm::exp(60.0 * next() - 30.0)).collect();
        let signed: Vec<f64> = (0..50_000).map(|_| next() - 0.5).collect();
        let few: Vec<f64> = (0..999).map(|i| f64::from(i % 3)).collect();
        // 2^-14 relative in the narrow set, of classes that were joined a few times in the others.
        for (mut list, tolerance) in [(narrow, 1.0 / 16384.0), (wide, 1e-2), (signed, 1e-2), (few, 1e-4)] {
            let mut sketch = Sketch::default();
            list.iter().for_each(|x| sketch.add(*x));
            let mut backwards = Sketch::default();
            list.iter().rev().for_each(|x| backwards.add(*x));
            list.sort_by(f64::total_cmp);
            for share in [0.0, 0.01, 0.05, 0.5, 0.95, 1.0] {
                let exact = list[((share * list.len() as f64).ceil() as usize).max(1) - 1];
                let found = sketch.quantile(share).expect("not empty");
                assert!(
                    (found - exact).abs() <= tolerance * exact.abs() * 1.000_001,
                    "{share}: {found} {exact}"
                );
                assert_eq!(backwards.quantile(share).map(f64::to_bits), Some(found.to_bits()));
            }
            assert!(sketch.classes.len() <= CLASSES);
            assert_eq!((sketch.min(), sketch.max()), (list.first().copied(), list.last().copied()));
            let mean = list.iter().sum::<f64>() / list.len() as f64;
            let size = list.iter().map(|x| x.abs()).sum::<f64>() / list.len() as f64;
            assert!((sketch.mean().expect("not empty") - mean).abs() <= 1e-11 * size);
            assert_eq!(sketch.cumulative().last().map(|last| last.1), Some(1.0));
        }
    }

    #[test]
    fn what_is_not_finite_has_its_place() {
        let mut sketch = Sketch::default();
        assert_eq!((sketch.quantile(0.5), sketch.mean()), (None, None));
        for x in [1.0, f64::INFINITY, f64::NAN, f64::INFINITY] {
            sketch.add(x);
        }
        assert_eq!(sketch.count(), 3);
        let low = sketch.quantile(0.3).expect("not empty");
        assert!((low - 1.0).abs() < 1e-4);
        assert_eq!([0.5, 1.0].map(|share| sketch.quantile(share)), [Some(f64::INFINITY); 2]);
        assert_eq!(sketch.mean(), Some(f64::INFINITY));
    }
}

//! Numbers of twice the working precision, for results that are small differences of large terms.
//!
//! A number is carried as the unevaluated sum of two `f64` (Dekker 1971), some 106 bits. No fused operation is
//! used, so that every machine gives the same bits. Sizes above 1e300 overflow; nothing here guards against it.

/// The number `hi + lo`, `|lo|` at most half a unit in the last place of `hi`.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Double {
    pub(crate) hi: f64,
    pub(crate) lo: f64,
}

impl Double {
    pub(crate) const fn new(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }

    /// `a + b` exactly, `|a| >= |b|`.
    pub(crate) fn renormalised(a: f64, b: f64) -> Self {
        let hi = a + b;
        Self { hi, lo: b - (hi - a) }
    }

    pub(crate) fn add(self, other: Self) -> Self {
        let sum = self.hi + other.hi;
        let part = sum - self.hi;
        // What the addition of the high parts lost, exactly.
        let lost = (self.hi - (sum - part)) + (other.hi - part);
        Self::renormalised(sum, lost + (self.lo + other.lo))
    }

    pub(crate) fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }

    pub(crate) fn sub(self, other: Self) -> Self {
        self.add(other.neg())
    }

    pub(crate) fn times(self, factor: f64) -> Self {
        let product = self.hi * factor;
        let ((a, b), (c, d)) = (halves(self.hi), halves(factor));
        let lost = ((a * c - product) + a * d + b * c) + b * d;
        Self::renormalised(product, lost + self.lo * factor)
    }

    pub(crate) fn mul(self, other: Self) -> Self {
        let product = self.times(other.hi);
        Self::renormalised(product.hi, product.lo + self.hi * other.lo)
    }

    /// The quotient; `other` is not 0.
    pub(crate) fn div(self, other: Self) -> Self {
        let first = self.hi / other.hi;
        let rest = self.sub(other.times(first));
        let second = rest.hi / other.hi;
        let rest = rest.sub(other.times(second));
        Self::renormalised(first, second).add(Self::new(rest.hi / other.hi))
    }

    /// The square root; 0 for what is not positive.
    pub(crate) fn sqrt(self) -> Self {
        if self.hi.is_nan() || self.hi <= 0.0 {
            return Self::default();
        }
        let root = libm::sqrt(self.hi);
        let rest = self.sub(Self::new(root).times(root));
        Self::renormalised(root, rest.hi / (2.0 * root))
    }

    /// `self * 2^exponent`, exact but at the ends of the range.
    pub(crate) fn scaled(self, exponent: i32) -> Self {
        Self { hi: libm::scalbn(self.hi, exponent), lo: libm::scalbn(self.lo, exponent) }
    }

    /// The nearest `f64`.
    pub(crate) fn value(self) -> f64 {
        self.hi + self.lo
    }
}

/// The number as a sum of two with 26 bits each, whose products are exact (Veltkamp).
fn halves(x: f64) -> (f64, f64) {
    let shifted = 134_217_729.0 * x;
    let high = shifted - (shifted - x);
    (high, x - high)
}

/// The `e` with `2^(e-1) <= |x| < 2^e`; 0 for 0.
pub(crate) fn exponent(x: f64) -> i32 {
    libm::frexp(x).1
}

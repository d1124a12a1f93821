//! Areas of a plant that was written as an expression.

use std::vec;
use std::vec::Vec;

use super::{Areas, series};
use crate::Refusal;
use crate::double::Double;
use crate::model::{Polynomial, TransferFunction};

impl TransferFunction {
    /// The areas `A_0, A_1, ...`, `count` of them; `A_k` in `[y/u] s^k` (Vrančić & Huba 2021, eq. (5)). They are
    /// computed from the factors as they were written: relative error 1e-15 for any order and scale of time.
    ///
    /// ```
    /// use controller_design::model::parse;
    /// let plant = parse("1/(1+s)^8").expect("a valid plant");
    /// assert_eq!(plant.areas(7).expect("a stable plant")[6], 1716.0);
    /// assert!(parse("1/s").expect("a valid plant").areas(3).is_err());
    /// ```
    ///
    /// # Errors
    /// Poles or zeros at `s = 0`, poles in the right half-plane or on its edge, areas beyond the range of `f64`.
    pub fn areas(&self, count: usize) -> Result<Vec<f64>, Refusal> {
        let mut areas = vec![Double::default(); count];
        self.series(&mut areas)?;
        Ok(areas.into_iter().map(Double::value).collect())
    }

    /// The areas `A_0..A_5` with the digits that the tuning rules need; see [`areas`](Self::areas).
    ///
    /// ```
    /// use controller_design::model::parse;
    /// let plant = parse("exp(-0.2*s)/((1+0.2*s)*(1+s))").expect("a valid plant");
    /// assert!((plant.areas6().expect("a stable plant").of(1) - 1.4).abs() < 1e-15);
    /// ```
    ///
    /// # Errors
    /// As for [`areas`](Self::areas).
    pub fn areas6(&self) -> Result<Areas, Refusal> {
        let mut areas = [Double::default(); 6];
        self.series(&mut areas)?;
        Ok(Areas::computed(&areas))
    }

    fn series(&self, out: &mut [Double]) -> Result<(), Refusal> {
        if self.integrators() > 1 {
            return Err(Refusal::Plant {
                must: "have no pole at s = 0: the areas of an integrating plant are infinite",
                help: "close an inner loop around one of the integrators and design for that loop",
            });
        }
        if self.integrators() > 0 {
            return Err(Refusal::Plant {
                must: "have no pole at s = 0: the areas of an integrating plant are infinite",
                help: "use a rule for integrating plants",
            });
        }
        if self.differentiators() > 0 {
            return Err(Refusal::Plant {
                must: "have a gain at s = 0: with a zero there no constant input moves its output",
                help: "control another output, or one that is integrated",
            });
        }
        if !self.den().iter().all(|p| series::is_stable(p.coefficients())) {
            return Err(series::UNSTABLE);
        }
        let lists = |p: &'_ [Polynomial]| p.iter().map(|p| p.coefficients().to_vec()).collect::<Vec<_>>();
        series::areas(self.gain(), &lists(self.num()), &lists(self.den()), self.dead_time(), out)
    }
}

//! From a plant and a rule to a row.

use super::list::NamedPlant;
use super::responses::{Both, Continuous, extrapolated, is_exact, sampled};
use super::row::{Row, Status};
use super::study::{Point, Study};
use controller_design::Refusal;
use controller_design::design::{
    AdrcGain, ContinuousDesign, Design, Designer, Law, Method, ObserverFilter, Request,
};
use controller_design::margins::{ContinuousLoop, Margins};

/// Makes the rows of one plant.
pub(super) struct Evaluator<'a> {
    study: &'a Study,
    name: &'a str,
    plant: &'a NamedPlant,
    designer: Designer<'a>,
    continuous: Continuous,
}

/// What is said of a design whichever loop was looked at.
struct Judged {
    law: Law,
    margins: Margins,
    responses: Result<Both, String>,
    how: &'static str,
}

impl<'a> Evaluator<'a> {
    /// `name` is that of the study.
    pub(super) fn new(study: &'a Study, name: &'a str, plant: &'a NamedPlant) -> Self {
        let designer = Designer::new(&plant.plant);
        Self { study, name, plant, designer, continuous: Continuous::default() }
    }

    /// The row `number`, from 1.
    pub(super) fn row(&mut self, number: usize, point: Point) -> Row {
        let ts = self.study.ts.unwrap_or_else(|| self.plant.period());
        let mut row = Row::new(self.name, number, (&self.plant.name, &self.plant.family), point);
        match self.judged(point, ts) {
            Err(refusal) => row.end(Status::Refused, &refusal.to_string()),
            Ok(Judged { law, margins, responses, how }) => {
                row.put_loop(how, ts);
                row.put_law(&law);
                row.put_margins(&margins, self.noise_gain(&law));
                match responses {
                    Ok([setpoint, load]) => row.put_responses(setpoint, load),
                    Err(why) => row.end(Status::Failed, &why),
                }
            }
        }
        row
    }

    fn judged(&mut self, point: Point, ts: f64) -> Result<Judged, Refusal> {
        let request = Request {
            ms: point.ms,
            observer_filter: point.noise_ratio.map_or(ObserverFilter::Default, ObserverFilter::NoiseRatio),
            // As in a comparison of all rules: that of the model compares badly on plants with dead time.
            b0: AdrcGain::Search,
            ..Request::new(point.method, ts)
        };
        if self.study.ts.is_some() {
            let made = self.designer.design(&request)?;
            let responses = sampled(&made);
            return Ok(Judged { margins: made.sampled.margins, law: made.law, responses, how: "sampled" });
        }
        if !matches!(point.method, Method::DeMomi | Method::Adrc) {
            let ContinuousDesign { law, robustness, .. } = self.designer.continuous(&request)?;
            return Ok(self.exact(law, robustness));
        }
        let made: Design = self.designer.design(&request)?;
        if is_exact(&self.plant.plant, &made.law) {
            return Ok(self.exact(made.law, made.robustness));
        }
        let responses = extrapolated(&made);
        Ok(Judged { margins: made.robustness, law: made.law, responses, how: "extrapolated" })
    }

    fn exact(&mut self, law: Law, margins: Margins) -> Judged {
        let responses = self.continuous.responses(&self.plant.plant, &law);
        Judged {
            law,
            margins,
            responses: responses.map_err(|refusal| refusal.to_string()),
            how: "continuous",
        }
    }

    /// `A_n`, of a PID alone or with an observer: the gain that fast noise meets. That of an estimator falls off beyond its
    /// peak, as that of an ADRC does.
    fn noise_gain(&self, law: &Law) -> Option<f64> {
        let Law::Pid { pid, estimator: None, observer } = law else { return None };
        let alone = ContinuousLoop::new(&self.plant.plant, pid);
        match observer {
            None => Some(alone.noise_gain()),
            Some(observer) => Some(alone.with_observer(observer).ok()?.noise_gain()),
        }
    }
}

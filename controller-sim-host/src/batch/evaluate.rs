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
use controller_design::model::TransferFunction;

/// Makes the rows of one process.
pub(super) struct Evaluator<'a> {
    study: &'a Study,
    name: &'a str,
    process: &'a NamedPlant,
    /// Or why its plant means nothing.
    loops: Result<Loops<'a>, &'a str>,
}

/// The loops of one plant.
struct Loops<'a> {
    plant: &'a TransferFunction,
    designer: Designer<'a>,
    continuous: Continuous,
}

/// What is said of a design whichever loop was looked at.
struct Judged {
    law: Law,
    /// Its period, or the one that the noise gains of a continuous loop are for \[s\].
    ts: f64,
    margins: Margins,
    responses: Result<Both, String>,
    how: &'static str,
}

impl<'a> Evaluator<'a> {
    /// `name` is that of the study.
    pub(super) fn new(study: &'a Study, name: &'a str, process: &'a NamedPlant) -> Self {
        let plant = process.plant.as_ref().map_err(String::as_str);
        let loops = plant.map(|plant| Loops {
            plant,
            designer: Designer::new(plant),
            continuous: Continuous::default(),
        });
        Self { study, name, process, loops }
    }

    /// The row `number`, from 1.
    pub(super) fn row(&mut self, number: usize, point: Point) -> Row {
        let mut row = Row::new(self.name, number, (&self.process.name, &self.process.family), point);
        let loops = match &mut self.loops {
            Ok(loops) => loops,
            Err(why) => {
                row.end(Status::Failed, why);
                return row;
            }
        };
        match loops.judged(point, self.study.ts) {
            Err(refusal) => row.end(Status::Refused, &refusal.to_string()),
            Ok(Judged { law, ts, margins, responses, how }) => {
                row.put_loop(how, ts);
                row.put_law(&law);
                row.put_margins(&margins, loops.noise_gain(&law));
                match responses {
                    Ok([setpoint, load]) => row.put_responses(setpoint, load),
                    Err(why) => row.end(Status::Failed, &why),
                }
            }
        }
        row
    }
}

impl Loops<'_> {
    /// The loop of `point`, sampled with the period that is given or as the continuous one.
    fn judged(&mut self, point: Point, given: Option<f64>) -> Result<Judged, Refusal> {
        let ts = given.unwrap_or_else(|| NamedPlant::period(self.plant));
        let request = Request {
            ms: point.ms,
            observer_filter: point.noise_ratio.map_or(ObserverFilter::Default, ObserverFilter::NoiseRatio),
            // As in a comparison of all rules: that of the model compares badly on plants with dead time.
            b0: AdrcGain::Search,
            ..Request::new(point.method, ts)
        };
        if given.is_some() {
            let made = self.designer.design(&request)?;
            let responses = sampled(&made);
            return Ok(Judged {
                margins: made.sampled.margins,
                law: made.law,
                ts,
                responses,
                how: "sampled",
            });
        }
        if !matches!(point.method, Method::DeMomi | Method::Adrc) {
            let ContinuousDesign { law, robustness, .. } = self.designer.continuous(&request)?;
            return Ok(self.exact(law, ts, robustness));
        }
        let made: Design = self.designer.design(&request)?;
        if is_exact(self.plant, &made.law) {
            return Ok(self.exact(made.law, ts, made.robustness));
        }
        let responses = extrapolated(&made);
        Ok(Judged { margins: made.robustness, law: made.law, ts, responses, how: "extrapolated" })
    }

    fn exact(&mut self, law: Law, ts: f64, margins: Margins) -> Judged {
        let responses = self.continuous.responses(self.plant, &law);
        Judged {
            law,
            ts,
            margins,
            responses: responses.map_err(|refusal| refusal.to_string()),
            how: "continuous",
        }
    }

    /// `A_n`, of a PID alone or with an observer: the gain that fast noise meets. That of an estimator falls off beyond its
    /// peak, as that of an ADRC does.
    fn noise_gain(&self, law: &Law) -> Option<f64> {
        let Law::Pid { pid, estimator: None, observer } = law else { return None };
        let alone = ContinuousLoop::new(self.plant, pid);
        match observer {
            None => Some(alone.noise_gain()),
            Some(observer) => Some(alone.with_observer(observer).ok()?.noise_gain()),
        }
    }
}

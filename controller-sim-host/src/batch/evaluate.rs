//! From a plant and a rule to a row.

use super::list::NamedPlant;
use super::responses::{Both, Continuous as Responses, extrapolated, is_exact, sampled};
use super::row::{Row, Status};
use super::study::{Point, Study};
use controller_design::Refusal;
use controller_design::design::{
    AdrcGain, ContinuousDesign, Design, Designer, Law, Method, ObserverFilter, Request,
};
use controller_design::margins::{ContinuousLoop, Margins};
use controller_design::model::TransferFunction;

/// Makes the rows of one plant.
pub(super) struct Evaluator<'a> {
    study: &'a Study,
    name: &'a str,
    process: &'a NamedPlant,
    /// Or why its plant means nothing.
    loops: Result<Loops<'a>, &'a str>,
}

impl<'a> Evaluator<'a> {
    /// `name` is that of the study.
    pub(super) fn new(study: &'a Study, name: &'a str, process: &'a NamedPlant) -> Self {
        let plant = process.plant.as_ref().map_err(String::as_str);
        Self { study, name, process, loops: plant.map(Loops::new) }
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
        let ts = self.study.ts.unwrap_or_else(|| NamedPlant::period(loops.plant));
        let request = Request {
            ms: point.ms,
            observer_filter: point.noise_ratio.map_or(ObserverFilter::Default, ObserverFilter::NoiseRatio),
            ..Request::new(point.method, ts)
        };
        let view = if self.study.ts.is_some() { View::Sampled } else { View::Continuous };
        loops.fill(&mut row, request, view);
        row
    }
}

/// Which loop is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum View {
    /// The continuous one, its responses to their ends.
    Continuous,
    /// The continuous one, its responses up to this time \[s\].
    Until(f64),
    /// The sampled one, as it runs.
    Sampled,
}

/// What is said of a design whichever loop was looked at.
struct Judged {
    law: Law,
    margins: Margins,
    responses: Result<Both, String>,
    how: &'static str,
}

/// The loops of one plant.
pub(super) struct Loops<'a> {
    plant: &'a TransferFunction,
    designer: Designer<'a>,
    continuous: Responses,
}

impl<'a> Loops<'a> {
    pub(super) fn new(plant: &'a TransferFunction) -> Self {
        Self { plant, designer: Designer::new(plant), continuous: Responses::default() }
    }

    /// Designs and judges what is asked for, and puts it into a row. An ADRC whose gain is not given has it searched for, as in
    /// any comparison of rules: that of the model compares badly on plants with dead time.
    pub(super) fn fill(&mut self, row: &mut Row, request: Request, view: View) {
        let b0 = if request.b0 == AdrcGain::Model { AdrcGain::Search } else { request.b0 };
        match self.judged(&Request { b0, ..request }, view) {
            Err(refusal) => row.end(Status::Refused, &refusal.to_string()),
            Ok(Judged { law, margins, responses, how }) => {
                row.put_loop(how, request.ts);
                row.put_law(&law);
                row.put_margins(&margins, self.noise_gain(&law));
                match responses {
                    Ok([setpoint, load]) => row.put_responses(setpoint, load),
                    Err(why) => row.end(Status::Failed, &why),
                }
            }
        }
    }

    fn judged(&mut self, request: &Request, view: View) -> Result<Judged, Refusal> {
        if view == View::Sampled {
            let made = self.designer.design(request)?;
            let responses = sampled(&made);
            return Ok(Judged { margins: made.sampled.margins, law: made.law, responses, how: "sampled" });
        }
        if !matches!(request.method, Method::DeMomi | Method::Adrc) {
            let ContinuousDesign { law, robustness, .. } = self.designer.continuous(request)?;
            return Ok(self.exact(law, robustness, view));
        }
        let made: Design = self.designer.design(request)?;
        if is_exact(self.plant, &made.law) {
            return Ok(self.exact(made.law, made.robustness, view));
        }
        let responses = match view {
            View::Until(_) => Err("only a law with exact responses has indices up to a horizon".to_owned()),
            _ => extrapolated(&made),
        };
        Ok(Judged { margins: made.robustness, law: made.law, responses, how: "extrapolated" })
    }

    fn exact(&mut self, law: Law, margins: Margins, view: View) -> Judged {
        let horizon = if let View::Until(horizon) = view { Some(horizon) } else { None };
        let responses = self.continuous.responses(self.plant, &law, horizon);
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
        let alone = ContinuousLoop::new(self.plant, pid);
        match observer {
            None => Some(alone.noise_gain()),
            Some(observer) => Some(alone.with_observer(observer).ok()?.noise_gain()),
        }
    }
}

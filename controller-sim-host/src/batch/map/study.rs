//! What is asked of a map, and the order of its rows.

use super::digest::digest;
use super::parameter::{Parameter, Setting};
use super::{Axis, Template};
use crate::batch::Point;
use crate::batch::evaluate::{Loops, View};
use crate::batch::list::NamedPlant;
use crate::batch::row::{Row, Status};
use crate::batch::work::{Stopped, items_in_order};
use crate::simulate::Control;
use controller_design::design::{Method, Request};
use controller_design::model::{ExpressionError, TransferFunction, parse};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Most values of the third parameter.
const EACH: usize = 24;
/// Points of one plant that a thread takes at a time.
const TOGETHER: usize = 32;

/// A rule, and perhaps another one to compare it with, on a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct MapStudy {
    /// The plant, with letters for numbers.
    pub plant: Template,
    /// The rule.
    pub method: Method,
    /// The rule that it is compared with.
    pub over: Option<Method>,
    /// From left to right.
    pub x: Axis,
    /// From below.
    pub y: Axis,
    /// A map for each of these values.
    pub each: Option<Axis>,
    /// What is the same everywhere.
    pub at: Vec<(Parameter, f64)>,
    /// Sampling period \[s\]: the sampled loop is simulated; `None`: loops are continuous.
    pub ts: Option<f64>,
    /// Indices up to this time after each step \[s\], of continuous loops; `None`: to the end of the response.
    pub horizon: Option<f64>,
}

/// What is wrong with a map before anything is computed.
#[derive(Debug, Clone, PartialEq)]
pub enum MapFault {
    /// Something in words, and what helps.
    Usage(String, String),
    /// The plant cannot be read, whatever values its letters have: its text with values, and its mistakes.
    Plant(String, Vec<ExpressionError>),
}

/// The place of a point: numbers of the values of x, y and each.
type Place = [usize; 3];

impl MapStudy {
    /// The rule and the one that it is compared with.
    pub(super) fn methods(&self) -> Vec<Method> {
        [Some(self.method), self.over].into_iter().flatten().collect()
    }

    /// x, y and each.
    #[must_use]
    pub fn axes(&self) -> [Option<&Axis>; 3] {
        [Some(&self.x), Some(&self.y), self.each.as_ref()]
    }

    /// Everything that is wrong with it at once.
    #[must_use]
    pub fn faults(&self) -> Vec<MapFault> {
        let mut faults = Vec::new();
        let mut usage = |message: String, help: &str| faults.push(MapFault::Usage(message, help.to_owned()));
        let used: Vec<&Parameter> = self.parameters().collect();
        for (i, one) in used.iter().enumerate() {
            if used[..i].contains(one) {
                usage(format!("`{one}` is given twice"), "give each parameter once, on an axis or a value");
            } else if let Some(other) = used[..i].iter().find(|other| excludes(one, other)) {
                usage(format!("`{other}` and `{one}` set the same filter"), "give one of them");
            }
        }
        for axis in [&self.x, &self.y] {
            if axis.values.len() < 2 {
                usage(
                    format!("`{}` has one value only: an axis has two or more", axis.parameter),
                    "to keep it the same everywhere, use --at",
                );
            }
        }
        if let Some(axis) = self.each.as_ref().filter(|axis| axis.values.len() > EACH) {
            usage(
                format!(
                    "`{}` has {} values: at most {EACH} maps are drawn",
                    axis.parameter,
                    axis.values.len()
                ),
                "give fewer, or make it an axis",
            );
        }
        if self.over == Some(self.method) {
            usage(
                format!("{} over itself is 1 everywhere", self.method.name()),
                "compare it with another rule",
            );
        }
        let letters = self.plant.names();
        for parameter in &used {
            match parameter {
                Parameter::Plant(name) if !letters.contains(&&**name) => {
                    let known = if letters.is_empty() { "no letters".to_owned() } else { letters.join(", ") };
                    let options = Setting::ALL.map(Setting::name).join(", ");
                    usage(
                        format!("the plant has no `{name}`; it has {known}"),
                        &format!("options of the rules are {options}"),
                    );
                }
                Parameter::Option(setting) if !self.looks_at(*setting) => usage(
                    format!("`{parameter}` means nothing to {}", self.method.name()),
                    &format!("it belongs to {}", Method::that_look_at(setting.option())),
                ),
                _ => {}
            }
        }
        for letter in letters {
            match Parameter::named(letter) {
                Ok(Parameter::Option(_)) => usage(
                    format!("`{letter}` in the plant is the name of an option"),
                    "call it otherwise in the plant",
                ),
                Ok(parameter) if !used.contains(&&parameter) => usage(
                    format!("`{letter}` in the plant has no value"),
                    &format!("give it an axis, or `--at {letter}=1`"),
                ),
                Err(message) => usage(message, "a letter is one to 40 letters, digits and `_`"),
                Ok(_) => {}
            }
        }
        if self.ts.is_some() && self.horizon.is_some() {
            usage(
                "a horizon is for continuous loops, and a sampling period was given".to_owned(),
                "leave out one of them",
            );
        }
        if faults.is_empty() {
            faults.extend(self.unreadable());
        }
        faults
    }

    /// The plant when it cannot be read at any corner of the grid.
    fn unreadable(&self) -> Option<MapFault> {
        let ends = |axis: Option<&Axis>| axis.map_or(vec![0], |axis| vec![0, axis.values.len() - 1]);
        let [x, y, each] = self.axes().map(ends);
        let mut first = None;
        for place in x.iter().flat_map(|&x| y.iter().map(move |&y| [x, y])) {
            for &each in &each {
                let text = self.expression([place[0], place[1], each]);
                match parse(&text) {
                    Ok(_) => return None,
                    Err(errors) => first = first.or(Some(MapFault::Plant(text, errors))),
                }
            }
        }
        first
    }

    /// Whether the rule looks at an option.
    fn looks_at(&self, setting: Setting) -> bool {
        self.method.options().contains(&setting.option())
    }

    fn parameters(&self) -> impl Iterator<Item = &Parameter> {
        let axes = self.axes().into_iter().flatten().map(|axis| &axis.parameter);
        axes.chain(self.at.iter().map(|(parameter, _)| parameter))
    }

    /// Number of points.
    #[must_use]
    pub fn points(&self) -> usize {
        self.axes().into_iter().flatten().map(|axis| axis.values.len()).product()
    }

    /// Number of rows: one for each rule at each point.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.points() * self.methods().len()
    }

    /// What its rows carry: a digest of all that they depend on, and their number.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{}/{}", digest(self), self.rows())
    }

    /// The axes from the outermost: those of the plant come first, so that rows of one plant stand together.
    fn order(&self) -> [usize; 3] {
        let mut order = [2, 1, 0];
        let is_of_plant = |i: &usize| self.axes()[*i].is_some_and(|axis| axis.parameter.is_of_plant());
        order.sort_by_key(|i| !is_of_plant(i));
        order
    }

    /// Points of one plant.
    fn inner(&self) -> usize {
        let own = self.axes().into_iter().flatten().filter(|axis| !axis.parameter.is_of_plant());
        own.map(|axis| axis.values.len()).product()
    }

    /// The place of a point and the rule of a row, from 0.
    pub(super) fn place(&self, row: usize) -> (Place, Method) {
        let methods = self.methods();
        let (mut rest, method) = (row / methods.len(), methods[row % methods.len()]);
        let mut place = [0; 3];
        for i in self.order().into_iter().rev() {
            let length = self.axes()[i].map_or(1, |axis| axis.values.len());
            place[i] = rest % length;
            rest /= length;
        }
        (place, method)
    }

    /// The values of all parameters at a place.
    fn values(&self, place: Place) -> Vec<(&Parameter, f64)> {
        let on_axes = self.axes().into_iter().zip(place);
        let on_axes = on_axes.filter_map(|(axis, i)| axis.map(|axis| (&axis.parameter, axis.values[i])));
        on_axes.chain(self.at.iter().map(|(parameter, value)| (parameter, *value))).collect()
    }

    /// The plant at a place.
    fn expression(&self, place: Place) -> String {
        let values = self.values(place);
        self.plant.with(|name| {
            let is_it = |(parameter, _): &&(&Parameter, f64)| {
                matches!(parameter, Parameter::Plant(own) if own == name)
            };
            values.iter().find(is_it).map_or(f64::NAN, |(_, value)| *value)
        })
    }

    /// Makes the rows in `range`, from 0, on `jobs` threads and gives them to `take` in their order; `done` counts them. What is
    /// computed depends neither on the threads nor on the range.
    ///
    /// # Errors
    /// [`Stopped`] by `control`, the rows up to then given; whatever `take` reports ends it as well.
    pub fn work<E: From<Stopped>>(
        &self,
        range: Range<usize>,
        jobs: usize,
        control: &Control,
        done: &AtomicU64,
        take: impl FnMut(Vec<Row>) -> Result<(), E>,
    ) -> Result<(), E> {
        if range.is_empty() {
            return Ok(());
        }
        let (name, methods, inner) = (self.name(), self.methods().len(), self.inner());
        let chunks = inner.div_ceil(TOGETHER);
        let group_of = |row: usize| {
            let point = row / methods;
            point / inner * chunks + point % inner / TOGETHER
        };
        let rows_of = |group: usize| {
            let first = group / chunks * inner + group % chunks * TOGETHER;
            let end = (first + TOGETHER).min((group / chunks + 1) * inner);
            let rows = (first * methods).max(range.start)..(end * methods).min(range.end);
            let text = self.expression(self.place(rows.start).0);
            let parsed = parse(&text);
            let mut plant = match &parsed {
                Ok(plant) => Ok(OnePlant::new(self, plant)),
                Err(errors) => Err(errors.first().map_or("it is no plant", |error| &*error.message)),
            };
            let mut made = Vec::with_capacity(rows.len());
            for number in rows {
                if control.is_stopped() {
                    break;
                }
                let mut row = self.row(&name, number, &text);
                match &mut plant {
                    Ok(plant) => plant.fill(&mut row, self.place(number)),
                    Err(why) => row.end(Status::Refused, &format!("the plant cannot be read: {why}")),
                }
                made.push(row);
                done.fetch_add(1, Ordering::Relaxed);
            }
            made
        };
        items_in_order(group_of(range.start)..=group_of(range.end - 1), jobs, control, take, rows_of)
    }

    /// A row with nothing but what is asked of it.
    fn row(&self, study: &str, number: usize, plant: &str) -> Row {
        let (place, method) = self.place(number);
        let values = self.values(place);
        let of = |setting: Setting| {
            let is_it = |(parameter, _): &&(&Parameter, f64)| **parameter == Parameter::Option(setting);
            let value = values.iter().find(is_it).map(|(_, value)| *value);
            value.filter(|_| method.options().contains(&setting.option()))
        };
        let point = Point { method, ms: of(Setting::Ms), noise_ratio: of(Setting::NoiseRatio) };
        let mut row = Row::new(study, number + 1, (plant, ""), point);
        let axes = self.axes();
        let named: [(&str, Option<f64>); 3] = core::array::from_fn(|i| {
            axes[i].map_or(("", None), |axis| (axis.parameter.name(), Some(axis.values[place[i]])))
        });
        row.put_point(named, self.horizon);
        row
    }
}

fn excludes(one: &Parameter, other: &Parameter) -> bool {
    match (one, other) {
        (Parameter::Option(one), Parameter::Option(other)) => one.excludes(*other),
        _ => false,
    }
}

/// Makes rows of one plant.
struct OnePlant<'a> {
    study: &'a MapStudy,
    plant: &'a TransferFunction,
    loops: Loops<'a>,
    ts: f64,
}

impl<'a> OnePlant<'a> {
    fn new(study: &'a MapStudy, plant: &'a TransferFunction) -> Self {
        let ts = study.ts.unwrap_or_else(|| NamedPlant::period(plant));
        Self { study, plant, loops: Loops::new(plant), ts }
    }

    fn fill(&mut self, row: &mut Row, (place, method): (Place, Method)) {
        let mut request = Request::new(method, self.ts);
        for (parameter, value) in self.study.values(place) {
            // The rule that is compared with takes what it looks at.
            let Parameter::Option(setting) = parameter else { continue };
            if method.options().contains(&setting.option())
                && let Err(why) = setting.apply(value, self.plant, &mut request)
            {
                return row.end(Status::Refused, &why);
            }
        }
        let view = match (self.study.ts, self.study.horizon) {
            (Some(_), _) => View::Sampled,
            (None, Some(end)) => View::Until(end),
            (None, None) => View::Continuous,
        };
        self.loops.fill(row, request, view);
    }
}

//! Which place of the text set which parameter of a controller.

use super::log::Log;
use controller_core::Param;
use std::ops::Range;

/// What a parameter is called in the text and where it was set last.
#[derive(Debug, Clone)]
pub(super) struct Setting {
    /// The key, for example `limits.lo`.
    pub(super) name: String,
    /// The place of its value.
    pub(super) span: Range<usize>,
}

/// The places of one controller's parameters.
#[derive(Debug, Clone)]
pub(super) struct Places {
    /// Where to point at for a parameter that was not written.
    pub(super) whole: Range<usize>,
    settings: Vec<(Param, Setting)>,
    silent: Vec<Param>,
    a2: Option<Setting>,
    /// Those of the controller inside of a cascade.
    pub(super) inner: Option<Box<Places>>,
}

impl Places {
    pub(super) fn new(whole: Range<usize>) -> Self {
        Self { whole, settings: Vec::new(), silent: Vec::new(), a2: None, inner: None }
    }

    /// `param` was set as `name` at `span`.
    pub(super) fn set(&mut self, param: Param, name: String, span: Range<usize>) {
        self.settings.retain(|(other, _)| *other != param);
        self.settings.push((param, Setting { name, span }));
    }

    /// The second coefficient of an estimator's model was set as `name` at `span`.
    pub(super) fn set_a2(&mut self, name: String, span: Range<usize>) {
        self.a2 = Some(Setting { name, span });
    }

    /// Where the second coefficient of an estimator's model was set.
    pub(super) fn a2(&self) -> Option<&Setting> {
        self.a2.as_ref()
    }

    /// What was reported of `params` already says all: nothing that follows from them is to be added.
    pub(super) fn silence(&mut self, params: &[Param]) {
        self.silent.extend(params);
    }

    /// Where `param` was set, if it was.
    pub(super) fn of(&self, param: Param) -> Option<&Setting> {
        self.settings.iter().find(|(other, _)| *other == param).map(|(_, setting)| setting)
    }

    /// Whether something was already reported of `param`.
    pub(super) fn is_reported(&self, param: Param, log: &Log<'_>) -> bool {
        self.silent.contains(&param) || self.of(param).is_some_and(|setting| log.is_faulty(&setting.span))
    }
}

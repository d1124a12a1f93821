//! The files that a text and all cases of it name, each read once.

use super::Recording;
use super::columns::{About, Problem};
use super::files::Files;
use super::recording::Wanted;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;
use std::rc::Rc;
use std::sync::Arc;

/// Most rows of all recordings together: they are held in memory.
const MOST_ROWS: usize = 50_000_000;

/// What was read so far.
pub(super) struct Library<'f> {
    files: &'f dyn Files,
    texts: RefCell<BTreeMap<String, Result<Rc<str>, String>>>,
    recordings: RefCell<BTreeMap<Wanted, Result<Arc<Recording>, Problem>>>,
}

impl<'f> Library<'f> {
    pub(super) fn new(files: &'f dyn Files) -> Self {
        Self { files, texts: RefCell::default(), recordings: RefCell::default() }
    }

    /// The text of a file.
    pub(super) fn text(&self, path: &str) -> Result<Rc<str>, String> {
        let mut texts = self.texts.borrow_mut();
        let text = texts.entry(path.to_owned()).or_insert_with(|| self.files.load(path).map(Rc::from));
        text.clone()
    }

    /// A recording in a file.
    pub(super) fn recording(&self, wanted: &Wanted) -> Result<Arc<Recording>, Problem> {
        if let Some(known) = self.recordings.borrow().get(wanted) {
            return known.clone();
        }
        let mut recording = wanted.load(self).map(Arc::new);
        let rows = |list: &Result<Arc<Recording>, Problem>| list.as_ref().map_or(0, |r| r.times.len());
        let total: usize = self.recordings.borrow().values().map(rows).sum();
        if total + rows(&recording) > MOST_ROWS {
            let message = format!("the recordings have more than {MOST_ROWS} rows together");
            recording = Err(Problem::new(About::File, message));
        }
        self.recordings.borrow_mut().insert(wanted.clone(), recording.clone());
        recording
    }
}

impl fmt::Debug for Library<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Library").finish_non_exhaustive()
    }
}

//! The files that a text and all cases of it name, each read once.

use super::files::Files;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;
use std::rc::Rc;

/// What was read so far.
pub(super) struct Library<'f> {
    files: &'f dyn Files,
    texts: RefCell<BTreeMap<String, Result<Rc<str>, String>>>,
}

impl<'f> Library<'f> {
    pub(super) fn new(files: &'f dyn Files) -> Self {
        Self { files, texts: RefCell::default() }
    }

    /// The text of a file.
    pub(super) fn text(&self, path: &str) -> Result<Rc<str>, String> {
        let mut texts = self.texts.borrow_mut();
        let text = texts.entry(path.to_owned()).or_insert_with(|| self.files.load(path).map(Rc::from));
        text.clone()
    }
}

impl fmt::Debug for Library<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Library").finish_non_exhaustive()
    }
}

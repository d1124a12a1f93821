//! The scenarios of a run: all of them are read before anything else happens.

use super::arguments::Options;
use super::input;
use super::quoting::quoted;
use crate::demo::BuiltIn;
use crate::output::{Problem, Source, Trouble};
use crate::scenario::{Case, Fault, Files, FolderFiles, NoFiles, SourceText, override_key, read_with};
use std::cell::RefCell;
use std::path::{Path, PathBuf};

/// A scenario that was read.
pub(super) struct Input {
    /// The file as it was given.
    pub(super) name: String,
    /// The text that was read, with the values of `--set`; its name says so.
    pub(super) source: SourceText,
    pub(super) warnings: Vec<Fault>,
    pub(super) cases: Vec<Case>,
}

impl Input {
    /// For messages about it.
    pub(super) fn source(&self) -> Source<'_> {
        Source::from(&self.source)
    }
}

/// What was read and what was not.
#[derive(Default)]
pub(super) struct Inputs {
    pub(super) list: Vec<Input>,
    /// Every file that was read; first those that were given.
    pub(super) files: Vec<PathBuf>,
    /// How many of them were given.
    pub(super) given: usize,
    /// What is wrong with any of them.
    pub(super) troubles: Vec<Trouble>,
}

/// Reads the files of the command line.
pub(super) fn read_files(paths: &[PathBuf], options: &Options) -> Inputs {
    let mut inputs = Inputs::default();
    let is_stdin = |path: &PathBuf| path.as_os_str() == "-";
    for path in paths {
        inputs.files.push(if is_stdin(path) { PathBuf::from("/dev/stdin") } else { path.clone() });
    }
    inputs.given = inputs.files.len();
    if paths.iter().filter(|path| is_stdin(path)).count() > 1 {
        let problem = Problem::new("usage", "`-` is given twice: the standard input can be read once");
        inputs.troubles.push(problem.into());
        return inputs;
    }
    for path in paths {
        match input::read(path) {
            Ok((name, text)) => {
                let files = Watched::beside(if is_stdin(path) { Path::new("") } else { path });
                inputs.read(name, text, options, &files);
                inputs.files.extend(files.seen.into_inner());
            }
            Err(problem) => inputs.troubles.push(problem.into()),
        }
    }
    inputs
}

/// Reads a text that stands in no file.
pub(super) fn read_text(name: &str, text: String, options: &Options) -> Inputs {
    let mut inputs = Inputs::default();
    inputs.read(name.to_owned(), text, options, &NoFiles);
    inputs
}

/// Reads scenarios that are built in.
pub(super) fn read_built_in(scenarios: &[BuiltIn], options: &Options) -> Inputs {
    let mut inputs = Inputs::default();
    for one in scenarios {
        inputs.read(one.name().to_owned(), one.text.to_owned(), options, &one.files());
    }
    inputs
}

impl Inputs {
    fn read(&mut self, name: String, text: String, options: &Options, files: &dyn Files) {
        let mut source = SourceText { name: name.clone(), text };
        let mut is_set = true;
        for (i, (key, value)) in options.set.iter().enumerate() {
            let with = if i == 0 { " with" } else { "" };
            let replaced = override_key(&source.text, key, value);
            source.name.push_str(&format!("{with} --set {}", quoted(&format!("{key}={value}"))));
            match replaced {
                Ok(text) => source.text = text,
                Err(fault) => {
                    is_set = false;
                    self.troubles.push(Trouble::Scenario(source.clone(), vec![fault]));
                }
            }
        }
        match read_with(&source.name, &source.text, options.precision.into(), files) {
            Ok(read) if is_set => {
                let (warnings, mut cases) = (read.warnings, read.cases);
                for case in &mut cases {
                    case.scenario.substeps = options.substeps.map_or(case.scenario.substeps, usize::from);
                }
                self.list.push(Input { name, source, warnings, cases });
            }
            Ok(_) => {}
            Err(faults) => self.troubles.push(Trouble::Scenario(source, faults)),
        }
    }
}

/// The files beside a scenario; remembers which of them were read, so that no output takes the place of one.
struct Watched {
    files: FolderFiles,
    folder: PathBuf,
    seen: RefCell<Vec<PathBuf>>,
}

impl Watched {
    fn beside(path: &Path) -> Self {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Self { files: FolderFiles::beside(path), folder, seen: RefCell::default() }
    }
}

impl Files for Watched {
    fn load(&self, path: &str) -> Result<String, String> {
        self.seen.borrow_mut().push(self.folder.join(path));
        self.files.load(path)
    }
}

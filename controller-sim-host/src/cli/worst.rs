//! The folder of the worst samples.

use super::Failure;
use super::scenarios::{Input, Inputs};
use crate::batch::sample::{SampleStudy, SampleSummary, replay, verify};
use crate::output::{FileTarget, Problem};
use crate::scenario::FolderFiles;
use crate::simulate::Precision;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Samples that are tried before the work, to find one that is a scenario.
const TRIED: usize = 100;

/// Where the worst samples go.
pub(super) struct Folder {
    path: PathBuf,
    text: String,
    name: String,
    force: bool,
    /// What the scenario reads: where it is, and its name there.
    read: Vec<(PathBuf, PathBuf)>,
}

impl Folder {
    /// Looks whether samples can be written there, before the work begins.
    pub(super) fn new(
        path: &Path,
        force: bool,
        study: &SampleStudy,
        input: &Input,
        inputs: &Inputs,
    ) -> Result<Self, Failure> {
        let name = path.display();
        let used = match fs::read_dir(path) {
            Ok(mut list) => list.next().is_some(),
            Err(_) if path.exists() => {
                let message = format!("`{name}` is no folder");
                return Err(Problem::new("file", message).help("give the name of a folder").into());
            }
            Err(_) => false,
        };
        if used && !force {
            let message = format!("the folder `{name}` is not empty");
            let help = "give another one, or `--force` to write into it";
            return Err(Problem::new("file-exists", message).help(help).into());
        }
        let beside = inputs.files.first().and_then(|file| file.parent()).unwrap_or(Path::new(""));
        let mut read: Vec<(PathBuf, PathBuf)> = Vec::new();
        for file in inputs.files.iter().skip(inputs.given) {
            let own = file.strip_prefix(beside).unwrap_or(file);
            if own.is_absolute() || read.iter().any(|(other, _)| other == file) {
                continue;
            }
            if own.components().any(|part| part == Component::ParentDir) {
                let message = format!("`--worst` cannot keep `{}` beside the samples", own.display());
                let help = "move the file below the folder of the scenario, or name it from the root";
                return Err(Problem::new("file", message).help(help).into());
            }
            read.push((file.clone(), own.to_owned()));
        }
        let text = input.source.text.clone();
        let folder = Self { path: path.to_owned(), text, name: input.name.clone(), force, read };
        let last = study.drawn.samples.min(TRIED);
        if let Some(first) = (1..=last).find(|number| study.sample(*number).scenario.is_ok()) {
            // What is read stands beside the scenario still.
            let files = FolderFiles::beside(inputs.files.first().map_or(Path::new(""), PathBuf::as_path));
            let made = replay(study, &folder.text, first, &[]);
            made.and_then(|text| verify(study, &text, first, &files))
                .map_err(|why| folder.impossible(&why))?;
        }
        Ok(folder)
    }

    fn impossible(&self, why: &str) -> Problem {
        let message = format!("samples of `{}` cannot be written as scenarios: {why}", self.name);
        let help = "`--worst` changes `plant.actual` and the keys that are drawn: they must be able to stand in the file itself";
        Problem::new("worst", message).help(help)
    }

    /// Writes the worst samples; gives their numbers and files.
    pub(super) fn write(
        &self,
        study: &SampleStudy,
        summary: &SampleSummary,
    ) -> Result<Vec<(usize, String)>, Failure> {
        let failed = |path: &Path, error: &dyn std::fmt::Display| {
            Failure::internal(Problem::new("file", format!("cannot write `{}`: {error}", path.display())))
        };
        fs::create_dir_all(&self.path).map_err(|error| failed(&self.path, &error))?;
        for (from, own) in &self.read {
            let to = self.path.join(own);
            let folder = to.parent().unwrap_or(&self.path);
            fs::create_dir_all(folder).map_err(|error| failed(folder, &error))?;
            fs::copy(from, &to).map_err(|error| failed(&to, &error))?;
        }
        let mut written = Vec::new();
        for (number, what) in summary.worst() {
            let path = self.path.join(format!("sample-{number}.toml"));
            let mut comments = vec![format!(
                "Sample {number} of {} from the seed {}, the worst in:",
                self.name, study.drawn.seed
            )];
            comments.extend(what.iter().map(|(controller, measure, value)| match *measure {
                "unstable" => format!("  {controller}: the unstable loop with the largest IAE, {value:?}"),
                measure => format!("  {controller}: {measure} = {value:?}"),
            }));
            if study.drawn.precision == Precision::F32 {
                comments
                    .push("The controllers ran in single precision: run it with --precision f32.".to_owned());
            }
            let made = replay(study, &self.text, number, &comments);
            let files = FolderFiles::beside(&path);
            let text = made.and_then(|text| verify(study, &text, number, &files).map(|()| text));
            let text = text.map_err(|why| Failure::internal(self.impossible(&why)))?;
            let target = FileTarget::new(&path, self.force)?;
            target.write(|file| file.write_all(text.as_bytes())).map_err(Failure::internal)?;
            written.push((number, path.display().to_string()));
        }
        Ok(written)
    }
}

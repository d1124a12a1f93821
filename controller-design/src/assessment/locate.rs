//! Where the operator stepped the output, and where the controller took over again.

use super::baseline::FEWEST;
use super::reason::Reason;
use super::record::{Record, mean};

/// A step is so many times larger than any jump among so many samples before it.
const JUMP: f64 = 3.0;
const BEFORE: usize = 20;
/// Samples around the one that was given in which the jump is looked for.
const AROUND: usize = 5;
/// Samples after a change of the set-point in which a jump of the output is its echo.
const ECHO: usize = 3;
/// The output has left the stepped value when it is this share of the step away from it.
const LEFT: f64 = 0.005;
/// A later jump of this share of the step is another experiment.
const ANOTHER: f64 = 0.5;

/// The parts of the record.
#[derive(Debug, Clone, Copy)]
pub(super) struct Parts {
    /// First sample with the stepped output.
    pub(super) step: usize,
    /// First sample in automatic after it.
    pub(super) auto: Option<usize>,
    /// First sample that does not belong to the experiment any more.
    pub(super) end: usize,
    /// What ended it, when it is not the record.
    pub(super) ended_by: Option<Reason>,
    /// First sample after the last change of the set-point before the step.
    pub(super) begin: usize,
}

impl Record {
    /// Divides the record.
    pub(super) fn parts(&self) -> Result<Parts, Reason> {
        let step = self.find_step()?;
        let begin = (1..=step).rev().find(|&k| self.sp[k] != self.sp[k - 1]).unwrap_or(0);
        if begin == step {
            return Err(Reason::SetpointMoved);
        }
        let auto = match self.auto_at {
            Some(auto) if auto > step && auto < self.len() => Some(auto),
            Some(_) => None,
            None => self.find_auto(step),
        };
        let (mut end, mut ended_by) = (self.len(), None);
        let size = (self.co[step] - self.co[step - 1]).abs();
        let after = auto.unwrap_or(self.len());
        for k in step + 1..self.len() {
            if self.sp[k] != self.sp[step] {
                (end, ended_by) = (k, Some(Reason::SetpointMoved));
                break;
            }
            // The controller itself may take back much of the step at once when it is sampled coarsely: only a jump
            // after which the output stands still is an operator's.
            let jumps = k > after
                && (self.co[k] - self.co[k - 1]).abs() > ANOTHER * size
                && self.co.get(k + 1).is_some_and(|next| *next == self.co[k]);
            if jumps {
                (end, ended_by) = (k, Some(Reason::SteppedAgain));
                break;
            }
        }
        Ok(Parts { step, auto, end, ended_by, begin })
    }

    fn jump(&self, k: usize) -> f64 {
        (self.co[k] - self.co[k - 1]).abs()
    }

    fn find_step(&self) -> Result<usize, Reason> {
        let quiet = |k: usize| self.sp[k.saturating_sub(ECHO)..=k].iter().all(|sp| *sp == self.sp[k]);
        // Of equal ones the first.
        let larger = |best: Option<usize>, k: usize| match best {
            Some(best) if self.jump(best) >= self.jump(k) => Some(best),
            _ => Some(k),
        };
        if let Some(at) = self.step_at {
            let range = at.saturating_sub(AROUND).max(1)..(at + AROUND + 1).min(self.len());
            let found = range.fold(None, larger).filter(|&k| self.jump(k) > 0.0);
            return found.ok_or(Reason::NoStep);
        }
        // A loop that swings more and more ends with larger jumps than the operator's, but comes to them gradually.
        let stands_out = |k: &usize| {
            let before = (k.saturating_sub(BEFORE).max(1)..*k).map(|k| self.jump(k)).fold(0.0, f64::max);
            let rounding = 1e-9 * self.co[*k].abs().max(self.co[k - 1].abs());
            quiet(*k) && self.jump(*k) > (JUMP * before).max(rounding)
        };
        let among = |mut range: core::ops::Range<usize>| {
            let first = range.find(stands_out)?;
            range.filter(stands_out).fold(Some(first), larger)
        };
        // Of the first samples too little is known to tell, unless it is clear.
        let later = || (FEWEST..self.len()).map(|k| self.jump(k)).fold(0.0, f64::max);
        match (among(1..FEWEST.min(self.len())), among(FEWEST..self.len())) {
            (Some(early), Some(late)) if self.jump(early) <= JUMP * self.jump(late) => Ok(late),
            // What later jumps come close to, noise mostly, is no step.
            (Some(early), None) if self.jump(early) <= JUMP * later() => Err(self.no_step()),
            (early, late) => early.or(late).ok_or_else(|| self.no_step()),
        }
    }

    /// What the record shows in place of a step.
    fn no_step(&self) -> Reason {
        let moves = |list: &[f64]| list.windows(2).any(|pair| pair[0] != pair[1]);
        if self.len() >= FEWEST && !moves(&self.co) {
            Reason::OutputConstant
        } else if moves(&self.sp) {
            Reason::SetpointChange
        } else {
            Reason::NoStep
        }
    }

    fn find_auto(&self, step: usize) -> Option<usize> {
        let from = step.saturating_sub(10);
        let tolerance = LEFT * (self.co[step] - mean(&self.co[from..step])).abs();
        (step + 1..self.len()).find(|&k| (self.co[k] - self.co[step]).abs() > tolerance)
    }
}

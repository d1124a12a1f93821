//! Where the numbers of contour lines stand.

use super::map::Line;

/// Half the height of a number, and the width of one of its characters \[px\].
const HALF: f64 = 7.0;
const CHARACTER: f64 = 6.2;
/// Distance between places that are tried along a line \[px\].
const STRIDE: f64 = 6.0;
/// Distance from the other numbers that is enough \[px\].
const FAR: f64 = 60.0;

/// A number on a line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Label {
    /// Its middle \[px\].
    pub(super) at: (f64, f64),
    pub(super) level: f64,
}

/// A number for each level, on its longest line, inside of the panel and on no other number; and the levels for which there
/// is no room. A second long line of a level has one, too. `taken` are places of something else.
pub(super) fn place_labels(
    lines: &[Line],
    levels: &[f64],
    size: (f64, f64),
    taken: &[(f64, f64)],
) -> (Vec<Label>, Vec<f64>) {
    let mut labels: Vec<Label> = Vec::new();
    let mut without = Vec::new();
    for &level in levels {
        let mut own: Vec<(f64, &Line)> = lines
            .iter()
            .filter(|line| line.level == level)
            .map(|line| (length(&line.points), line))
            .collect();
        own.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut found = false;
        for (length, line) in own {
            if found && length < 0.5 * size.0.min(size.1) {
                break;
            }
            if let Some(at) = best(&line.points, level, &labels, size, taken) {
                labels.push(Label { at, level });
                found = true;
            }
        }
        if !found && lines.iter().any(|line| line.level == level) {
            without.push(level);
        }
    }
    (labels, without)
}

/// Half the width that a number takes \[px\].
pub(super) fn half_width(level: f64) -> f64 {
    0.5 * CHARACTER * super::words::number(level).chars().count() as f64 + 3.0
}

/// The place farthest from other numbers, and of those that are far enough the one nearest to the middle of the line.
fn best(
    points: &[(f64, f64)],
    level: f64,
    labels: &[Label],
    size: (f64, f64),
    taken: &[(f64, f64)],
) -> Option<(f64, f64)> {
    let (half, whole) = (half_width(level), length(points));
    let mut chosen: Option<((f64, f64), (f64, f64))> = None;
    let mut travelled = 0.0;
    let mut next = 0.0;
    for pair in points.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let part = distance(from, to);
        while next <= travelled + part && part > 0.0 {
            let k = (next - travelled) / part;
            let at = (from.0 + k * (to.0 - from.0), from.1 + k * (to.1 - from.1));
            let inside = (half..=size.0 - half).contains(&at.0) && (HALF..=size.1 - HALF).contains(&at.1);
            let is_free = |other: &(f64, f64), width: f64| {
                (at.0 - other.0).abs() >= half + width || (at.1 - other.1).abs() >= 2.0 * HALF
            };
            let free = labels.iter().all(|label| is_free(&label.at, half_width(label.level)))
                && taken.iter().all(|place| is_free(place, 7.0));
            if inside && free {
                let nearest = labels.iter().map(|label| distance(at, label.at)).fold(FAR, f64::min);
                let score = (nearest, -(next - 0.5 * whole).abs());
                if chosen.is_none_or(|(_, best)| score > best) {
                    chosen = Some((at, score));
                }
            }
            next += STRIDE;
        }
        travelled += part;
    }
    chosen.map(|(at, _)| at)
}

fn distance(a: (f64, f64), b: (f64, f64)) -> f64 {
    libm::hypot(a.0 - b.0, a.1 - b.1)
}

fn length(points: &[(f64, f64)]) -> f64 {
    points.windows(2).map(|pair| distance(pair[0], pair[1])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (f64, f64) = (300.0, 200.0);

    fn line(level: f64, points: &[(f64, f64)]) -> Line {
        Line { level, points: points.to_vec() }
    }

    #[test]
    fn numbers_stand_on_their_lines_apart_from_each_other() {
        let levels: Vec<f64> = (1..=6).map(f64::from).collect();
        let lines: Vec<Line> =
            levels.iter().map(|k| line(*k, &[(0.0, 30.0 * k - 20.0), (300.0, 30.0 * k)])).collect();
        let (labels, without) = place_labels(&lines, &levels, SIZE, &[]);
        assert_eq!((labels.len(), without.len()), (6, 0));
        for (i, label) in labels.iter().enumerate() {
            let expected = 30.0 * label.level - 20.0 + label.at.0 / 15.0;
            assert!((label.at.1 - expected).abs() < 1e-9);
            assert!(labels[..i].iter().all(|other| distance(label.at, other.at) > 14.0));
        }
    }

    #[test]
    fn a_line_without_room_has_no_number() {
        let corner = line(1.0, &[(0.0, 3.0), (3.0, 0.0)]);
        assert_eq!(place_labels(&[corner], &[1.0, 2.0], SIZE, &[]), (vec![], vec![1.0]));
        let under = line(1.0, &[(100.0, 100.0), (104.0, 100.0)]);
        assert_eq!(place_labels(&[under], &[1.0], SIZE, &[(102.0, 100.0)]).1, [1.0]);
    }
}

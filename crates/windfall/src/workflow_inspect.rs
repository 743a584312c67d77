//! `windfall inspect FILE`: what a recording holds, and what looks wrong.

use crate::error::Error;
use crate::outcome::FindingOutcome;
use crate::read_csv::{read_header, read_loose_numbers};
use serde::Serialize;
use std::path::Path;
use windfall_numerics::unit::parse_unit;

/// Departure of a sampling interval from the median that counts as irregular.
const IRREGULAR: f64 = 0.01;

/// Successive samples at an extreme value that look like clipping.
const CLIPPED_RUN: usize = 4;

/// Distinct values below which a column is a logic level, never clipped.
const LOGIC_LEVELS: usize = 3;

/// Fewest samples among which a spike can be told.
const LEAST_FOR_SPIKES: usize = 50;

/// Part of the steps between samples that counts as usual.
const USUAL_STEPS: f64 = 0.99;

/// A spike stands out by this many times the usual step.
const SPIKE: f64 = 10.0;

/// What a recording holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Inspection {
    /// The file.
    pub file: String,
    /// Rows below the header.
    pub rows: usize,
    /// Columns in the order of the header.
    pub columns: Vec<ColumnInspection>,
    /// What looks wrong.
    pub findings: Vec<FindingOutcome>,
}

/// One column of a recording.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ColumnInspection {
    /// Name in the header.
    pub column: String,
    /// Unit guessed from the name.
    pub unit: Option<String>,
    /// What the column seems to be: "time", or the channel it could feed.
    pub role: Option<&'static str>,
    /// Cells that hold a number.
    pub samples: usize,
    /// Smallest value; unit of the column.
    pub smallest: Option<f64>,
    /// Largest value; unit of the column.
    pub largest: Option<f64>,
    /// Samples per unit of the time column, from the median interval, counting
    /// only rows in which this column has a sample.
    pub rate: Option<f64>,
    /// From the first to the last sample; unit of the time column.
    pub length: Option<f64>,
}

/// Looks through a recording.
///
/// # Errors
/// The file cannot be read, is empty or not UTF-8, or a row is ragged.
pub fn inspect_recording(path: &Path) -> Result<Inspection, Error> {
    let names = read_header(path)?;
    let cells = read_loose_numbers(path)?;
    let mut findings: Vec<FindingOutcome> = cells
        .faults
        .iter()
        .map(|fault| finding("cell", fault.to_string()))
        .collect();
    if cells.more_faults > 0 {
        let message = format!("{} more cells are no finite numbers", cells.more_faults);
        findings.push(finding("cell", message));
    }
    let mut columns = Vec::new();
    // A time column serves the columns to its right, up to the next one.
    let mut time: Option<usize> = None;
    for (index, name) in names.iter().enumerate() {
        let role = role_of(name);
        if role == Some("time") {
            time = Some(index);
            findings.extend(time_findings(name, &cells.columns[index]));
        } else {
            findings.extend(clipping(name, &cells.columns[index]));
            findings.extend(spikes(name, &cells.columns[index]));
        }
        let clock = time.map(|at| cells.columns[at].as_slice());
        columns.push(column_inspection(name, role, &cells.columns[index], clock));
    }
    if time.is_none() {
        let message = "no column looks like a time; give the sampling rate in campaign.toml: \
                       [files] rate = \"200 kHz\"";
        findings.push(finding("no-time", message.to_owned()));
    }
    let rows = cells.columns.first().map_or(0, Vec::len);
    Ok(Inspection {
        file: path.display().to_string(),
        rows,
        columns,
        findings,
    })
}

fn finding(code: &str, message: String) -> FindingOutcome {
    FindingOutcome {
        code: code.to_owned(),
        message,
    }
}

fn column_inspection(
    name: &str,
    role: Option<&'static str>,
    cells: &[Option<f64>],
    clock: Option<&[Option<f64>]>,
) -> ColumnInspection {
    let values: Vec<f64> = cells.iter().flatten().copied().collect();
    let extreme = |pick: fn(f64, f64) -> f64| values.iter().copied().reduce(pick);
    let times: Vec<f64> = clock.map_or_else(Vec::new, |clock| {
        cells
            .iter()
            .zip(clock)
            .filter(|(cell, _)| cell.is_some())
            .filter_map(|(_, t)| *t)
            .collect()
    });
    let interval = median_interval(&times);
    ColumnInspection {
        column: name.to_owned(),
        unit: unit_of(name),
        role,
        samples: values.len(),
        smallest: extreme(f64::min),
        largest: extreme(f64::max),
        rate: interval
            .filter(|interval| *interval > 0.0)
            .map(|interval| 1.0 / interval),
        length: times
            .first()
            .zip(times.last())
            .map(|(first, last)| last - first),
    }
}

fn median_interval(times: &[f64]) -> Option<f64> {
    let mut intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if intervals.is_empty() {
        return None;
    }
    let middle = intervals.len() / 2;
    Some(*intervals.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The unit in "Force (N)", "force_N", "Force [N]" or "Force in N".
fn unit_of(name: &str) -> Option<String> {
    let bracketed = [('(', ')'), ('[', ']')]
        .into_iter()
        .find_map(|(open, close)| {
            let (_, rest) = name.rsplit_once(open)?;
            rest.split_once(close)
                .map(|(unit, _)| unit.trim().to_owned())
        });
    let last = || {
        let (_, last) = name.rsplit_once(['_', ' '])?;
        Some(last.trim().to_owned())
    };
    bracketed
        .or_else(last)
        .filter(|unit| !unit.is_empty() && parse_unit(unit).is_ok())
}

/// Parts of names and what they usually stand for.
const ROLES: [(&str, &str); 16] = [
    ("time", "time"),
    ("phase_a", "phase_a"),
    ("phase a", "phase_a"),
    ("phase_b", "phase_b"),
    ("phase b", "phase_b"),
    ("force", "force"),
    ("load", "force"),
    ("velocity", "velocity"),
    ("speed", "velocity"),
    ("accel", "acceleration"),
    ("angle", "angle"),
    ("count", "count"),
    ("encoder", "count"),
    ("position", "position"),
    ("displacement", "position"),
    ("zeit", "time"),
];

fn role_of(name: &str) -> Option<&'static str> {
    let lower = name.to_lowercase();
    if matches!(lower.as_str(), "t" | "t_s" | "t (s)" | "t_ms" | "t [s]") {
        return Some("time");
    }
    // "Run 1: Time (s)": what follows the last colon counts.
    let part = lower.rsplit(':').next().unwrap_or(&lower);
    ROLES
        .iter()
        .find(|(word, _)| part.contains(word))
        .map(|(_, role)| *role)
}

fn time_findings(name: &str, cells: &[Option<f64>]) -> Vec<FindingOutcome> {
    let rows: Vec<(usize, f64)> = cells
        .iter()
        .enumerate()
        .filter_map(|(row, t)| Some((row, (*t)?)))
        .collect();
    let times: Vec<f64> = rows.iter().map(|(_, t)| *t).collect();
    if let Some(pair) = rows.windows(2).find(|pair| pair[1].1 <= pair[0].1) {
        let ((_, before), (row, time)) = (pair[0], pair[1]);
        let message = format!(
            "\"{name}\": time does not increase at sample {row}: {time} after {before}; \
             split the recording there, or give a sampling rate in place of the time column"
        );
        return vec![finding("time-backwards", message)];
    }
    let Some(median) = median_interval(&times) else {
        return Vec::new();
    };
    let off = |pair: &&[f64]| ((pair[1] - pair[0]) - median).abs();
    let worst = times.windows(2).max_by(|a, b| off(a).total_cmp(&off(b)));
    match worst {
        Some(pair) if off(&pair) > IRREGULAR * median => {
            let message = format!(
                "\"{name}\": sampling is irregular: the median interval is {median:.6}, \
                 but {:.6} after {:.6}",
                pair[1] - pair[0],
                pair[0]
            );
            vec![finding("irregular-sampling", message)]
        }
        _ => Vec::new(),
    }
}

fn clipping(name: &str, cells: &[Option<f64>]) -> Option<FindingOutcome> {
    let values: Vec<f64> = cells.iter().flatten().copied().collect();
    let mut sorted = values.clone();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    if sorted.len() <= LOGIC_LEVELS {
        return None;
    }
    [sorted[0], sorted[sorted.len() - 1]]
        .into_iter()
        .find_map(|limit| {
            let longest = values
                .chunk_by(|a, b| a == b)
                .filter(|run| run[0] == limit)
                .map(<[f64]>::len)
                .max()?;
            (longest >= CLIPPED_RUN).then(|| {
                let message = format!(
                    "\"{name}\": {longest} successive samples stand at the extreme value {limit}; \
                 the channel may be clipped"
                );
                finding("clipped", message)
            })
        })
}

/// Samples far from both neighbours, against what the channel usually does.
fn spikes(name: &str, cells: &[Option<f64>]) -> Option<FindingOutcome> {
    let values: Vec<f64> = cells.iter().flatten().copied().collect();
    if values.len() < LEAST_FOR_SPIKES {
        return None;
    }
    let mut steps: Vec<f64> = values
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .collect();
    // A spike has two large steps: those of two spikes are never usual.
    let rank = ((USUAL_STEPS * steps.len() as f64) as usize).min(steps.len() - 5);
    let usual = *steps.select_nth_unstable_by(rank, f64::total_cmp).1;
    // How far a sample stands out beyond the span of its neighbours.
    let out = |three: &[f64]| {
        let (low, high) = (three[0].min(three[2]), three[0].max(three[2]));
        (three[1] - high).max(low - three[1])
    };
    let spikes: Vec<usize> = (1..values.len() - 1)
        .filter(|&i| usual > 0.0 && out(&values[i - 1..=i + 1]) > SPIKE * usual)
        .collect();
    let first = *spikes.first()?;
    let message = format!(
        "\"{name}\": {} sample(s) far from both neighbours, the first is {} between {} \
         and {} (sample {first}); blank such cells or choose a range of time without them",
        spikes.len(),
        values[first],
        values[first - 1],
        values[first + 1]
    );
    Some(finding("spike", message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_units_and_roles_from_names() {
        for (name, unit, role) in [
            ("Run 1: Force (N)", Some("N"), Some("force")),
            ("Run 1: Time (s)", Some("s"), Some("time")),
            ("Acceleration (m/s²)", Some("m/s²"), Some("acceleration")),
            ("phase_a_V", Some("V"), Some("phase_a")),
            ("position_mm", Some("mm"), Some("position")),
            ("remarks", None, None),
        ] {
            assert_eq!(unit_of(name).as_deref(), unit, "{name}");
            assert_eq!(role_of(name), role, "{name}");
        }
    }

    #[test]
    fn recovers_a_glitch_put_into_a_sine() {
        let smooth: Vec<Option<f64>> = (0..200).map(|i| Some((0.1 * f64::from(i)).sin())).collect();
        assert_eq!(spikes("x", &smooth), None);
        let mut glitched = smooth;
        glitched[77] = Some(6.0);
        let found = spikes("x", &glitched).unwrap().message;
        assert!(
            found.starts_with("\"x\": 1 sample(s) far from both")
                && found.contains("the first is 6 between"),
            "{found}"
        );
    }

    #[test]
    fn closed_form_rate_length_and_faults_of_a_small_file() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("r.csv");
        std::fs::write(&path, "time_s,force_N,position_mm\n0,1,5\n0.5,9,\n1,9,6\n1.5,9,\n2,9,7\n2.5,x,\n3,3,8\n3.5,4,\n").unwrap();
        let found = inspect_recording(&path).unwrap();
        assert_eq!(
            (
                found.rows,
                found.columns[1].samples,
                found.columns[2].samples
            ),
            (8, 7, 4)
        );
        assert_eq!(
            (found.columns[1].rate, found.columns[2].rate),
            (Some(2.0), Some(1.0))
        );
        assert_eq!(
            (found.columns[1].length, found.columns[2].length),
            (Some(3.5), Some(3.0))
        );
        let codes: Vec<&str> = found.findings.iter().map(|f| f.code.as_str()).collect();
        assert_eq!(codes, ["cell", "clipped"]);
    }
}

//! Groups of a table as results show them.

use crate::regress::findings::{finding, lines_text};
use serde::Serialize;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_statistics::compare::group_summary::{Group, Groups, summarize};

/// What the values of one group look like; NaN (null in JSON) where there are
/// too few values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GroupOutcome {
    /// The levels in one text.
    pub group: String,
    /// Level of each grouping column.
    pub levels: Vec<String>,
    /// Number of values.
    pub n: usize,
    /// Rows whose value is missing.
    pub missing: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Standard deviation over |mean|; a fraction.
    pub cv: f64,
    /// Standard error of the mean.
    pub se: f64,
    /// Lower end of the mean's interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Smallest value.
    pub min: f64,
    /// First quartile.
    pub q1: f64,
    /// Median.
    pub median: f64,
    /// Third quartile.
    pub q3: f64,
    /// Largest value.
    pub max: f64,
}

/// A group's name: its levels.
#[must_use]
pub fn group_name(levels: &[String]) -> String {
    match levels {
        [] => "all".to_owned(),
        levels => levels.join(", "),
    }
}

/// Groups described.
pub(crate) fn group_outcomes(
    groups: &[Group],
    confidence: f64,
) -> Result<Vec<GroupOutcome>, Error> {
    let described = groups.iter().map(|group| {
        let found = summarize(group, confidence).map_err(statistics_error)?;
        Ok(GroupOutcome {
            group: group_name(&found.levels),
            levels: found.levels,
            n: found.n,
            missing: found.missing,
            mean: found.mean,
            sd: found.standard_deviation,
            cv: found.coefficient_of_variation,
            se: found.standard_error,
            low: found.low,
            high: found.high,
            min: found.smallest,
            q1: found.first_quartile,
            median: found.median,
            q3: found.third_quartile,
            max: found.largest,
        })
    });
    described.collect()
}

/// Errors of the statistics as errors of a request.
pub(crate) fn statistics_error(error: impl Into<windfall_statistics::error::Error>) -> Error {
    Error::Statistics(error.into())
}

/// Rows that are in no group or have no value.
pub(crate) fn missing_findings(
    groups: &Groups,
    value: &str,
    by: &[String],
    lines: &[usize],
) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    let missing: usize = groups.groups.iter().map(|group| group.missing).sum();
    if missing > 0 {
        let rows = if missing == 1 { "row" } else { "rows" };
        findings.push(finding(
            "missing",
            format!("{value:?} is missing in {missing} {rows}, left out"),
        ));
    }
    if !groups.ungrouped.is_empty() {
        let own: Vec<usize> = groups.ungrouped.iter().map(|row| lines[*row]).collect();
        findings.push(finding(
            "ungrouped",
            format!(
                "{} is missing in {}: these rows belong to no group",
                by.join(" or "),
                lines_text(&own)
            ),
        ));
    }
    findings
}

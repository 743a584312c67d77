//! Groups of a table, and rows outside of them.

use crate::regress::findings::finding;
use crate::rows::{GroupLoss, RowCount, lines_text};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_statistics::compare::group_summary::{Group, GroupSummary, Groups, summarize};
use windfall_statistics::runs::Runs;

/// Groups described.
pub(crate) fn summaries(groups: &[Group], confidence: f64) -> Result<Vec<GroupSummary>, Error> {
    let described = groups.iter().map(|group| summarize(group, confidence));
    described
        .collect::<Result<_, _>>()
        .map_err(statistics_error)
}

/// Rows with a value and a group, rows without, and these by groups.
pub(crate) fn row_count(groups: &Groups) -> RowCount {
    let lost = groups.groups.iter().filter(|group| group.missing > 0);
    let mut by: Vec<GroupLoss> = lost
        .map(|group| GroupLoss {
            group: group.levels.join(", "),
            left_out: group.missing,
            rows: group.missing + group.values.len(),
        })
        .collect();
    let outside = groups.ungrouped.len();
    by.extend((outside > 0).then(|| GroupLoss {
        group: String::new(),
        left_out: outside,
        rows: outside,
    }));
    RowCount {
        rows: groups.groups.iter().map(|group| group.values.len()).sum(),
        left_out: by.iter().map(|own| own.left_out).sum(),
        left_out_by: by,
    }
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
    lines: &Runs,
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
        let own: Vec<usize> = groups
            .ungrouped
            .iter()
            .filter_map(|row| lines.get(*row))
            .collect();
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

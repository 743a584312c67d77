//! What simulated studies say against a plan.

use crate::outcome::PlanRow;
use crate::question::{COVERAGE, Levels, Told};
use crate::text::{impacts_text, percent};
use windfall_files::found::FindingOutcome;

/// Simulated studies that failed.
pub(crate) fn failed_findings(rows: &[PlanRow]) -> Vec<FindingOutcome> {
    let failed = rows.iter().filter(|row| row.failed > 0);
    let finding = |row: &PlanRow| {
        let causes = row.failures.iter();
        let causes: Vec<String> = causes
            .map(|(why, count)| format!("{count}: {why}"))
            .collect();
        let so = match row.power {
            Some(_) => "and count as not having found the effect",
            None => "and are left out of the mean, which is not told where they are many",
        };
        FindingOutcome::new(
            "simulations-failed",
            format!(
                "{} fruit with {}: {} of {} simulated studies could not be evaluated {so} ({})",
                row.fruit,
                impacts_text(row.impacts),
                row.failed,
                row.simulations.unwrap_or_default(),
                causes.join("; ")
            ),
        )
    };
    failed.map(finding).collect()
}

/// Intervals that miss the truth far more often than they should, of the studies that are told
/// and of those that were looked at on the way; the largest such study for each number of impacts.
pub(crate) fn coverage_findings(
    rows: &[PlanRow],
    looked_at: &[PlanRow],
    levels: &Levels,
) -> Vec<FindingOutcome> {
    let missed = |row: &&PlanRow| {
        levels.is_missed(&Told {
            simulations: row.simulations,
            also: row.also.clone(),
            ..Told::default()
        })
    };
    let mut found: Vec<&PlanRow> = Vec::new();
    for row in rows.iter().chain(looked_at).filter(missed) {
        match found.iter_mut().find(|own| own.impacts == row.impacts) {
            Some(own) if own.fruit < row.fruit => *own = row,
            Some(_) => {}
            None => found.push(row),
        }
    }
    let finding = |row: &PlanRow| {
        let coverage = row.also.iter().find(|own| own.of == COVERAGE);
        FindingOutcome::new(
            "low-coverage",
            format!(
                "{} fruit with {}: simulated intervals of {} hold the truth in {} only; studies of \
                 this size promise more than they tell: take more fruit",
                row.fruit,
                impacts_text(row.impacts),
                percent(levels.confidence),
                percent(coverage.map_or(f64::NAN, |own| (1000.0 * own.value).round() / 1000.0))
            ),
        )
    };
    found.into_iter().map(finding).collect()
}

//! Repeated impacts as a measurement: impact after impact on one spot → critical energy.

use crate::kind::{FoundItems, MeasuredResults, Measurement};
use crate::measured::{MeasuredItem, MeasuredValue, ShownTables, ShownValue, plain_value, shown};
use crate::repeats::compare::{Compared, Comparison, FruitResult, compare_repeats};
use crate::repeats::evaluate::{RepeatImpact, evaluate_impact};
use crate::repeats::figure::figure_of_comparison;
use crate::repeats::methods::methods_of_repeats;
use crate::repeats::pairs::pairs_of;
use crate::repeats::read::{RepeatsCampaign, cell_of, energy_of, read_repeats};
use std::path::Path;
use windfall_campaign::settings::model::{Campaign, ImpactEntry};
use windfall_draw::files::{NamedFigure, file_name};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_repeat::align::CHANGES;
use windfall_repeat::criterion::Decision;
use windfall_repeat::equivalence::Verdict;
use windfall_repeat::interval::{EnergyInterval, energy_interval};
use windfall_repeat::threshold::{ProfiledValue, Threshold};
use windfall_repeat::turnbull::quantile_of;
use windfall_signal::recording::Recording;

/// What the table of impacts shows.
const SHOWN: [ShownValue; 4] = [
    shown("energy", "energy (J)", 1.0),
    shown("peak_force", "peak (N)", 1.0),
    shown("contact_duration", "duration (ms)", 1e3),
    shown("rise_slope", "rise (N/ms)", 1e-3),
];

/// What the tables of fruit and of the whole show.
const SHOWN_OF_SPECIMENS: [ShownValue; 4] = [
    shown("share", "share (%)", 100.0),
    shown("p", "p over fruit", 1.0),
    shown("critical_energy", "critical energy (J)", 1.0),
    shown("spread", "spread of ln energy", 1.0),
];

/// Shares of fruit below this are none; 1.
const LEAST_SHARE: f64 = 1e-6;

impl Measurement for RepeatsCampaign {
    type Found = RepeatImpact;

    const SHOWN: ShownTables = ShownTables {
        items: &SHOWN,
        parts: &[],
        specimens: &SHOWN_OF_SPECIMENS,
    };

    fn read(directory: &Path) -> Result<Self, Error> {
        read_repeats(directory)
    }

    fn shared(&self) -> &Campaign {
        &self.shared
    }

    fn shared_mut(&mut self) -> &mut Campaign {
        &mut self.shared
    }

    fn depends_on(&self, entry: &ImpactEntry) -> String {
        let (column, _) = &self.reference;
        let cells = [column, "spot", "repeat"].map(|c| cell_of(self, entry, c));
        let energy = energy_of(self, entry).ok();
        format!(
            "{:?} {:?} {:?} {cells:?} {energy:?}",
            self.align, self.conditioning, self.reference
        )
    }

    fn evaluate(&self, entry: &ImpactEntry, recording: &Recording) -> Result<RepeatImpact, Error> {
        evaluate_impact(self, entry, recording)
    }

    fn results(&self, found: &FoundItems<Self>) -> Result<MeasuredResults, Error> {
        let impacts: Vec<RepeatImpact> = found.iter().map(|(_, found)| found.clone()).collect();
        let pairs = pairs_of(&impacts, &self.align);
        let compared = compare_repeats(self, &pairs);
        let figures = compared.comparisons.iter().enumerate();
        let figures = figures.map(|(index, comparison)| {
            let name = name_of(comparison.energy, comparison.order);
            NamedFigure {
                caption: format!(
                    "{name}: mean curves of both impacts, their differences as parts of the first \
                     peak, and the test statistic with its critical level."
                ),
                figure: figure_of_comparison(&name, &pairs, &compared, index),
                name: file_name(&name),
            }
        });
        let figures: Vec<NamedFigure> = figures.collect();
        let items: Vec<MeasuredItem> = impacts.into_iter().map(|impact| impact.item).collect();
        let mut findings = compared.findings.clone();
        if !pairs.alone.is_empty() {
            let alone = pairs.alone.join(", ");
            let message = format!("no second impact on the same spot at the same energy: {alone}");
            findings.push(FindingOutcome::new("impact-alone", message));
        }
        let mut whole: Vec<MeasuredItem> = compared.comparisons.iter().map(over_fruit).collect();
        whole.extend(critical(self, &compared));
        Ok(MeasuredResults {
            failed: pairs.failed,
            specimens: compared.fruit.iter().map(on_fruit).collect(),
            whole,
            summary: Named::default(),
            findings,
            figures: Some(("Every energy, over all fruit.".to_owned(), figures)),
            ..MeasuredResults::of(items)
        })
    }

    fn methods(&self) -> Vec<String> {
        methods_of_repeats(self)
    }

    fn figure(
        &self,
        _: &ImpactEntry,
        _: Option<&RepeatImpact>,
        _: &MeasuredResults,
    ) -> Result<Option<NamedFigure>, Error> {
        Ok(None)
    }
}

/// "0.1200 J, impacts 1 and 2".
fn name_of(energy: f64, order: usize) -> String {
    format!("{energy:.4} J, impacts {} and {}", order + 1, order + 2)
}

fn percent(part: f64) -> String {
    format!("{:.2} %", 100.0 * part)
}

/// One comparison over all fruit.
fn over_fruit(comparison: &Comparison) -> MeasuredItem {
    let name = name_of(comparison.energy, comparison.order);
    let mut found = MeasuredItem::named(&name, "change from one impact to the next, over fruit");
    found.file = format!("{} fruit", comparison.curves.fruit);
    let curves = &comparison.curves;
    let largest = curves.statistic.get(curves.largest).copied().unwrap_or(0.0);
    let mut derived = Named::of([
        ("energy", plain_value(comparison.energy, "J")),
        ("p", plain_value(curves.p, "1")),
        ("p_alone", plain_value(curves.p_alone, "1")),
        ("least_p", plain_value(curves.least_p, "1")),
        ("largest_statistic", plain_value(largest, "1")),
    ]);
    let mut words = Named::of([("verdict", comparison.verdict.word().to_owned())]);
    for (name, change) in CHANGES.iter().zip(&comparison.changes) {
        for (end, value) in [
            ("", change.mean),
            ("_low_90", change.low),
            ("_high_90", change.high),
            ("_margin", change.margin),
            ("_p_equivalence", change.p_equivalence),
        ] {
            derived.push(format!("{name}_change{end}"), plain_value(value, "1"));
        }
        let word = match change.verdict {
            Verdict::Unchanged => format!("unchanged within ±{}", percent(change.margin)),
            Verdict::Changed => format!("changed by {}", percent(change.mean)),
            Verdict::Undecided => format!(
                "undecided: {} to {}",
                percent(change.low),
                percent(change.high)
            ),
        };
        words.push(name.replace('_', " "), word);
    }
    MeasuredItem {
        derived,
        words,
        ..found
    }
}

/// The ends of an interval of energies, as far as they are known; J.
fn push_ends(values: &mut Named<MeasuredValue>, ends: [(&str, f64); 2]) {
    let known = |energy: f64| energy > 0.0 && energy.is_finite();
    for (name, energy) in ends.into_iter().filter(|(_, energy)| known(*energy)) {
        values.push(name, plain_value(energy, "J"));
    }
}

fn between(low: f64, high: f64) -> String {
    match (low > 0.0, high.is_finite()) {
        (true, true) => format!("{low:.4} to {high:.4} J"),
        (true, false) => format!("above {low:.4} J"),
        (false, true) => format!("up to {high:.4} J"),
        (false, false) => "not known".to_owned(),
    }
}

/// One fruit by the reference.
fn on_fruit(result: &FruitResult) -> MeasuredItem {
    let law = "critical energy by the repeatability of the reference";
    let mut found = MeasuredItem::named(&result.specimen, law);
    found.file = format!("{} comparisons", result.decisions.len());
    let (low, high) = (result.interval.low, result.interval.high);
    push_ends(
        &mut found.derived,
        [("unchanged_up_to", low), ("changed_at", high)],
    );
    let energies = |verdict: Verdict| {
        let at = result
            .decisions
            .iter()
            .filter(|(_, _, d)| d.verdict == verdict);
        let at: Vec<String> = at.map(|(energy, _, _)| format!("{energy:.4}")).collect();
        at.join(" ")
    };
    let most = |of: fn(&Decision) -> f64| {
        let values = result.decisions.iter().map(|(_, _, decision)| of(decision));
        plain_value(values.fold(0.0, f64::max), "1")
    };
    found.derived.push("largest_ratio", most(|d| d.largest));
    found.derived.push("critical_ratio", most(|d| d.critical));
    found.words = Named::of([
        ("critical energy", between(low, high)),
        ("undecided at (J)", energies(Verdict::Undecided)),
    ]);
    found
}

/// Critical energy of the whole: by fruit, and by the tests over fruit.
fn critical(campaign: &RepeatsCampaign, compared: &Compared) -> Vec<MeasuredItem> {
    let law = "critical energy";
    let mut items = Vec::new();
    if let Some(threshold) = &compared.threshold {
        items.push(parametric(threshold, campaign.test.level, law));
    }
    if let Some(median) = quantile_of(&compared.masses, 0.5) {
        let mut found = MeasuredItem::named("Turnbull, of single fruit", law);
        let (low, high) = (median.low, median.high);
        push_ends(
            &mut found.derived,
            [("median_low", low), ("median_high", high)],
        );
        found.words = Named::of([("median", between(low, high))]);
        items.push(found);
    }
    let masses = compared.masses.iter();
    for mass in masses.filter(|mass| mass.share > LEAST_SHARE) {
        let (low, high) = (mass.low, mass.high);
        let law = "share of fruit by critical energy (Turnbull)";
        let mut found = MeasuredItem::named(&between(low, high), law);
        found.derived.push("share", plain_value(mass.share, "1"));
        push_ends(&mut found.derived, [("from", low), ("to", high)]);
        items.push(found);
    }
    let verdicts = compared.comparisons.iter().map(|c| (c.energy, c.verdict));
    let verdicts: Vec<(f64, Verdict)> = verdicts.collect();
    if !verdicts.is_empty() {
        let (EnergyInterval { low, high }, _) = energy_interval(&verdicts);
        let mut found = MeasuredItem::named("least energy with a change over fruit", law);
        push_ends(
            &mut found.derived,
            [("changed_at", high), ("unchanged_up_to", low)],
        );
        found.words = Named::of([("median", between(low, high))]);
        items.push(found);
    }
    items
}

fn parametric(threshold: &Threshold, level: f64, law: &str) -> MeasuredItem {
    let name = format!("{}, of single fruit", threshold.family.name());
    let mut found = MeasuredItem::named(&name, law);
    let value = |profiled: ProfiledValue, unit: &str| MeasuredValue {
        low: profiled.low,
        high: profiled.high,
        ..plain_value(profiled.value, unit)
    };
    let ends = |profiled: ProfiledValue| {
        between(
            profiled.low.unwrap_or(0.0),
            profiled.high.unwrap_or(f64::INFINITY),
        )
    };
    let (median, tenth) = (threshold.median, threshold.tenth);
    found.derived.push("critical_energy", value(median, "J"));
    found.derived.push("energy_of_a_tenth", value(tenth, "J"));
    if !threshold.spread_at_bound {
        found.derived.push("spread", value(threshold.spread, "1"));
    }
    let confidence = 100.0 * (1.0 - level);
    let shown = format!("{:.4} J ({confidence} %: {})", median.value, ends(median));
    found.words.push("median", shown);
    let shown = format!("{:.4} J ({})", tenth.value, ends(tenth));
    found.words.push("a tenth of the fruit", shown);
    found
}

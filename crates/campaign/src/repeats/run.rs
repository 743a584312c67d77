//! Repeated impacts as a measurement: impact after impact on one spot → critical energy.

use crate::measure::kind::{FoundItems, MeasuredResults, Measurement};
use crate::measure::measured::{
    MeasuredItem, MeasuredValue, ShownTables, ShownValue, plain_value, shown,
};
use crate::repeats::compare::{Compared, Comparison, FruitResult, compare_repeats};
use crate::repeats::evaluate::{RepeatImpact, evaluate_impact};
use crate::repeats::figure::figure_of_comparison;
use crate::repeats::methods::methods_of_repeats;
use crate::repeats::pairs::pairs_of;
use crate::repeats::read::{RepeatsCampaign, cell_of, energy_of, read_repeats};
use crate::settings::model::{Campaign, ImpactEntry};
use std::path::Path;
use windfall_draw::files::{NamedFigure, file_name};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_signal::recording::Recording;
use windfall_signal::repeat::align::CHANGES;
use windfall_signal::repeat::equivalence::Verdict;
use windfall_signal::repeat::threshold::{ProfiledValue, Threshold};
use windfall_signal::repeat::turnbull::quantile_of;

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
            findings.push(FindingOutcome {
                code: "impact-alone".to_owned(),
                message: format!(
                    "no second impact on the same spot at the same energy: {}",
                    pairs.alone.join(", ")
                ),
            });
        }
        let mut whole: Vec<MeasuredItem> = compared.comparisons.iter().map(over_fruit).collect();
        whole.extend(critical(self, &compared));
        Ok(MeasuredResults {
            failed: pairs.failed,
            specimens: compared.fruit.iter().map(on_fruit).collect(),
            whole,
            summary: Named(Vec::new()),
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

/// An item of no recording.
fn blank_item(id: String, law: &str) -> MeasuredItem {
    MeasuredItem {
        specimen: id.clone(),
        id,
        law: law.to_owned(),
        ..MeasuredItem::default()
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
    let mut found = blank_item(name, "change from one impact to the next, over fruit");
    found.file = format!("{} fruit", comparison.curves.fruit);
    let curves = &comparison.curves;
    let mut derived = vec![
        ("energy".to_owned(), plain_value(comparison.energy, "J")),
        ("p".to_owned(), plain_value(curves.p, "1")),
        ("p_alone".to_owned(), plain_value(curves.p_alone, "1")),
        ("least_p".to_owned(), plain_value(curves.least_p, "1")),
        (
            "largest_statistic".to_owned(),
            plain_value(
                curves.statistic.get(curves.largest).copied().unwrap_or(0.0),
                "1",
            ),
        ),
    ];
    let mut words = vec![("verdict".to_owned(), comparison.verdict.word().to_owned())];
    for (name, change) in CHANGES.iter().zip(&comparison.changes) {
        let put = |end: &str, value: f64| (format!("{name}_change{end}"), plain_value(value, "1"));
        derived.push(put("", change.mean));
        derived.push(put("_low_90", change.low));
        derived.push(put("_high_90", change.high));
        derived.push(put("_margin", change.margin));
        derived.push(put("_p_equivalence", change.p_equivalence));
        let word = match change.verdict {
            Verdict::Unchanged => format!("unchanged within ±{}", percent(change.margin)),
            Verdict::Changed => format!("changed by {}", percent(change.mean)),
            Verdict::Undecided => format!(
                "undecided: {} to {}",
                percent(change.low),
                percent(change.high)
            ),
        };
        words.push((name.replace('_', " "), word));
    }
    found.derived = Named(derived);
    found.words = Named(words);
    found
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
    let mut found = blank_item(
        result.specimen.clone(),
        "critical energy by the repeatability of the reference",
    );
    found.file = format!("{} comparisons", result.decisions.len());
    let (low, high) = (result.interval.low, result.interval.high);
    let mut derived = Vec::new();
    if low > 0.0 {
        derived.push(("unchanged_up_to".to_owned(), plain_value(low, "J")));
    }
    if high.is_finite() {
        derived.push(("changed_at".to_owned(), plain_value(high, "J")));
    }
    let energies = |verdict: Verdict| {
        let at = result
            .decisions
            .iter()
            .filter(|(_, _, d)| d.verdict == verdict);
        let at: Vec<String> = at.map(|(energy, _, _)| format!("{energy:.4}")).collect();
        at.join(" ")
    };
    let largest = result.decisions.iter().map(|(_, _, d)| d.largest);
    derived.push((
        "largest_ratio".to_owned(),
        plain_value(largest.fold(0.0, f64::max), "1"),
    ));
    let critical = result.decisions.iter().map(|(_, _, d)| d.critical);
    derived.push((
        "critical_ratio".to_owned(),
        plain_value(critical.fold(0.0, f64::max), "1"),
    ));
    found.derived = Named(derived);
    found.words = Named(vec![
        ("critical energy".to_owned(), between(low, high)),
        ("undecided at (J)".to_owned(), energies(Verdict::Undecided)),
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
        let mut found = blank_item("Turnbull, of single fruit".to_owned(), law);
        let mut derived = Vec::new();
        if median.low > 0.0 {
            derived.push(("median_low".to_owned(), plain_value(median.low, "J")));
        }
        if median.high.is_finite() {
            derived.push(("median_high".to_owned(), plain_value(median.high, "J")));
        }
        found.derived = Named(derived);
        found.words = Named(vec![(
            "median".to_owned(),
            between(median.low, median.high),
        )]);
        items.push(found);
    }
    for mass in compared
        .masses
        .iter()
        .filter(|mass| mass.share > LEAST_SHARE)
    {
        let mut found = blank_item(
            between(mass.low, mass.high),
            "share of fruit by critical energy (Turnbull)",
        );
        let mut derived = vec![("share".to_owned(), plain_value(mass.share, "1"))];
        derived.extend((mass.low > 0.0).then(|| ("from".to_owned(), plain_value(mass.low, "J"))));
        let finite = mass.high.is_finite();
        derived.extend(finite.then(|| ("to".to_owned(), plain_value(mass.high, "J"))));
        found.derived = Named(derived);
        items.push(found);
    }
    let verdicts: Vec<(f64, Verdict)> = compared
        .comparisons
        .iter()
        .map(|c| (c.energy, c.verdict))
        .collect();
    if !verdicts.is_empty() {
        let (interval, _) = windfall_signal::repeat::interval::energy_interval(&verdicts);
        let mut found = blank_item("least energy with a change over fruit".to_owned(), law);
        let text = between(interval.low, interval.high);
        let mut derived = Vec::new();
        if interval.high.is_finite() {
            derived.push(("changed_at".to_owned(), plain_value(interval.high, "J")));
        }
        if interval.low > 0.0 {
            derived.push(("unchanged_up_to".to_owned(), plain_value(interval.low, "J")));
        }
        found.derived = Named(derived);
        found.words = Named(vec![("median".to_owned(), text)]);
        items.push(found);
    }
    items
}

fn parametric(threshold: &Threshold, level: f64, law: &str) -> MeasuredItem {
    let mut found = blank_item(format!("{}, of single fruit", threshold.family.name()), law);
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
    let mut derived = vec![
        ("critical_energy".to_owned(), value(threshold.median, "J")),
        ("energy_of_a_tenth".to_owned(), value(threshold.tenth, "J")),
    ];
    if !threshold.spread_at_bound {
        derived.push(("spread".to_owned(), value(threshold.spread, "1")));
    }
    found.derived = Named(derived);
    let confidence = 100.0 * (1.0 - level);
    found.words = Named(vec![
        (
            "median".to_owned(),
            format!(
                "{:.4} J ({confidence} %: {})",
                threshold.median.value,
                ends(threshold.median)
            ),
        ),
        (
            "a tenth of the fruit".to_owned(),
            format!("{:.4} J ({})", threshold.tenth.value, ends(threshold.tenth)),
        ),
    ]);
    found
}

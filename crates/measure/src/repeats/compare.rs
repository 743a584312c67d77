//! Pairs of impacts → what changed, at which energy, and the critical energy.

use crate::repeats::pairs::{Pair, Pairs, difference_of};
use crate::repeats::read::{Margin, RepeatsCampaign};
use itertools::Itertools;
use windfall_files::found::FindingOutcome;
use windfall_repeat::align::CHANGES;
use windfall_repeat::criterion::{Decision, Difference, Repeatability, decide, repeatability};
use windfall_repeat::equivalence::{Equivalence, Verdict, equivalence};
use windfall_repeat::interval::{EnergyInterval, energy_interval};
use windfall_repeat::permutation::{ComparedCurves, Differences, SignFlipTest, sign_flip_test};
use windfall_repeat::threshold::{Threshold, fit_threshold};
use windfall_repeat::turnbull::{EnergyMass, turnbull};

/// References fewer than this are reported.
const FEW_REFERENCES: usize = 8;

/// One energy and two successive impacts, over all fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Energy; J.
    pub energy: f64,
    /// Position of the first of both impacts, from 0.
    pub order: usize,
    /// Fruit that have it, and their differences.
    pub fruit: Vec<Option<Difference>>,
    /// Curves over all fruit.
    pub curves: ComparedCurves,
    /// Changes of peak, duration and rise slope, where there is a margin.
    pub changes: Vec<Equivalence>,
    /// Over all fruit.
    pub verdict: Verdict,
}

/// What is found on one fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct FruitResult {
    /// The specimen.
    pub specimen: String,
    /// Energy (J), position of the first impact, and decision.
    pub decisions: Vec<(f64, usize, Decision)>,
    /// Where its critical energy lies; J.
    pub interval: EnergyInterval,
    /// Whether it was unchanged at an energy above its first change.
    pub contrary: bool,
}

/// Everything that the comparisons give.
#[derive(Clone, Debug, Default)]
pub struct Compared {
    /// Each energy and position.
    pub comparisons: Vec<Comparison>,
    /// The test over all of them.
    pub test: Option<SignFlipTest>,
    /// Scatter of the reference.
    pub reference: Option<Repeatability>,
    /// Margins of peak, duration and rise slope; 1.
    pub margins: Option<[f64; 3]>,
    /// Each fruit, where there is a reference.
    pub fruit: Vec<FruitResult>,
    /// Distribution of critical energies with a formula.
    pub threshold: Option<Threshold>,
    /// And without.
    pub masses: Vec<EnergyMass>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}

/// Compares all pairs.
pub fn compare_repeats(campaign: &RepeatsCampaign, pairs: &Pairs) -> Compared {
    let mut compared = Compared::default();
    reference(campaign, pairs, &mut compared);
    let fruit = fruit_of(pairs);
    comparisons(campaign, pairs, &fruit, &mut compared);
    decisions(campaign, pairs, &fruit, &mut compared);
    fruit_differ(&mut compared);
    thresholds(campaign, &mut compared);
    compared
}

fn finding(compared: &mut Compared, code: &str, message: String) {
    compared.findings.push(FindingOutcome::new(code, message));
}

/// Scatter of the reference, and the margins.
fn reference(campaign: &RepeatsCampaign, pairs: &Pairs, compared: &mut Compared) {
    let all = pairs.pairs.iter().filter(|pair| pair.reference);
    let differences: Vec<Difference> = all.filter_map(|pair| difference_of(&[pair])).collect();
    match repeatability(&differences) {
        Ok(found) => compared.reference = Some(found),
        Err(error) => finding(
            compared,
            "no-reference",
            format!(
                "the rig's own repeatability is not known ({error}); without it nothing is decided \
                 on single fruit. Repeat impacts on an elastic ball and mark them {} = {}",
                campaign.reference.0, campaign.reference.1
            ),
        ),
    }
    if let Some(found) = compared.reference.as_ref().filter(|r| r.n < FEW_REFERENCES) {
        let message = format!(
            "the repeatability comes from {} pairs on the reference; {FEW_REFERENCES} or more give \
             a criterion that is not much wider than the scatter itself",
            found.n
        );
        finding(compared, "few-references", message);
    }
    compared.margins = match (campaign.margin, &compared.reference) {
        (Margin::Given(margin), _) => Some([margin; 3]),
        (Margin::Deviations(k), Some(found)) => Some(found.changes.map(|sd| k * sd)),
        (Margin::Deviations(_), None) => None,
    };
    if compared.margins.is_none() {
        let message = "no margin is given and no reference tells one, so nothing can be called \
                       unchanged; give `margin` in [repeats]";
        finding(compared, "no-margin", message.to_owned());
    }
}

/// Specimens that can be damaged, in order of first appearance.
fn fruit_of(pairs: &Pairs) -> Vec<String> {
    let pairs = pairs.pairs.iter().filter(|pair| !pair.reference);
    pairs.map(|pair| pair.specimen.clone()).unique().collect()
}

/// Fruit and their differences, per energy and position.
type Keyed = (usize, usize, Vec<Option<Difference>>);

fn keyed(pairs: &Pairs, fruit: &[String]) -> Vec<Keyed> {
    let damageable = || pairs.pairs.iter().filter(|pair| !pair.reference);
    let mut keys: Vec<(usize, usize)> = damageable().map(|p| (p.level, p.order)).collect();
    keys.sort_unstable();
    keys.dedup();
    let differences = |(level, order): (usize, usize)| {
        let of = |name: &String| {
            let spots: Vec<&Pair> = damageable()
                .filter(|p| p.specimen == *name && (p.level, p.order) == (level, order))
                .collect();
            difference_of(&spots)
        };
        fruit.iter().map(of).collect::<Vec<_>>()
    };
    let with = |key: (usize, usize)| (key.0, key.1, differences(key));
    keys.into_iter().map(with).collect()
}

/// All fruit together: curves by the sign-flip test, values by equivalence.
fn comparisons(
    campaign: &RepeatsCampaign,
    pairs: &Pairs,
    fruit: &[String],
    compared: &mut Compared,
) {
    let mut all = keyed(pairs, fruit);
    let before = all.len();
    all.retain(|(_, _, each)| each.iter().flatten().count() >= 2);
    if all.len() < before {
        let message = format!(
            "{} of {before} comparisons have one fruit only and are not tested over fruit",
            before - all.len()
        );
        finding(compared, "fruit-alone", message);
    }
    if all.is_empty() {
        return;
    }
    let curve = |d: &Option<Difference>| d.as_ref().map(|d| d.curve.clone());
    let differences: Vec<Differences> = all
        .iter()
        .map(|(_, _, each)| each.iter().map(curve).collect())
        .collect();
    let test = match sign_flip_test(&differences, &campaign.test) {
        Ok(test) => test,
        Err(error) => return finding(compared, "not-tested", error.to_string()),
    };
    let level = campaign.test.level;
    if test.critical.is_none() {
        let most = test.comparisons.iter().map(|c| c.fruit).max().unwrap_or(0);
        let message = format!(
            "with {most} fruit the least two-sided p is {}, so no change can be significant at \
             {level} over fruit; {} fruit can",
            0.5_f64.powi(most as i32 - 1),
            (1.0 - level.log2()).ceil()
        );
        finding(compared, "few-fruit", message);
    }
    for ((energy_level, order, fruit), curves) in all.into_iter().zip(test.comparisons.clone()) {
        let change = |i: usize, margin: f64| {
            let values: Vec<f64> = fruit.iter().flatten().map(|d| d.changes[i]).collect();
            equivalence(&values, margin, level).ok()
        };
        let changes: Vec<Equivalence> = match compared.margins {
            Some(margins) => (0..3).filter_map(|i| change(i, margins[i])).collect(),
            None => Vec::new(),
        };
        let within = changes.len() == 3 && changes.iter().all(|c| c.verdict == Verdict::Unchanged);
        let energy = pairs.energies[energy_level];
        let verdict = match (curves.p <= level, within) {
            (true, _) => Verdict::Changed,
            (false, true) => Verdict::Unchanged,
            (false, false) => Verdict::Undecided,
        };
        if verdict == Verdict::Changed && within {
            let message = format!(
                "at {energy:.4} J the curves change (p = {:.4}), but {} stay within their margins",
                curves.p,
                CHANGES.join(", ").replace('_', " ")
            );
            finding(compared, "change-within-margin", message);
        }
        compared.comparisons.push(Comparison {
            energy,
            order,
            fruit,
            curves,
            changes,
            verdict,
        });
    }
    compared.test = Some(test);
}

/// Each fruit by the reference.
fn decisions(campaign: &RepeatsCampaign, pairs: &Pairs, fruit: &[String], compared: &mut Compared) {
    let Some(reference) = compared.reference.clone() else {
        return;
    };
    // Without a margin nothing is called unchanged.
    let margins = compared.margins.unwrap_or([0.0; 3]);
    let all = keyed(pairs, fruit);
    for (index, specimen) in fruit.iter().enumerate() {
        let of_fruit: Vec<(f64, usize, &Difference)> = all
            .iter()
            .filter_map(|(at, order, each)| {
                Some((pairs.energies[*at], *order, each[index].as_ref()?))
            })
            .collect();
        let count = of_fruit.len();
        let level = campaign.test.level;
        let decisions: Vec<(f64, usize, Decision)> = of_fruit
            .into_iter()
            .filter_map(|(energy, order, difference)| {
                let decision = decide(difference, &reference, margins, count, level).ok()?;
                Some((energy, order, decision))
            })
            .collect();
        let verdicts: Vec<(f64, Verdict)> =
            decisions.iter().map(|(e, _, d)| (*e, d.verdict)).collect();
        let (interval, contrary) = energy_interval(&verdicts);
        compared.fruit.push(FruitResult {
            specimen: specimen.clone(),
            decisions,
            interval,
            contrary,
        });
    }
}

/// Energies at which single fruit change and their mean does not.
fn fruit_differ(compared: &mut Compared) {
    let counts = compared.comparisons.iter().filter_map(|comparison| {
        let of = |fruit: &FruitResult| {
            let here = |(energy, order, decision): &(f64, usize, Decision)| {
                *energy == comparison.energy
                    && *order == comparison.order
                    && decision.verdict == Verdict::Changed
            };
            fruit.decisions.iter().any(here)
        };
        let changed = compared.fruit.iter().filter(|fruit| of(fruit)).count();
        (changed > 0 && comparison.verdict != Verdict::Changed).then(|| {
            format!(
                "{changed} of {} at {:.4} J",
                comparison.curves.fruit, comparison.energy
            )
        })
    });
    let counts: Vec<String> = counts.collect();
    if !counts.is_empty() {
        let message = format!(
            "single fruit changed by the repeatability of the reference ({}) where the test over \
             fruit sees no change: it asks for the mean over fruit and is weak where only some \
             change. The intervals of single fruit are the better answer there",
            counts.join(", ")
        );
        finding(compared, "fruit-differ", message);
    }
}

/// Critical energies of the fruit.
fn thresholds(campaign: &RepeatsCampaign, compared: &mut Compared) {
    if compared.fruit.is_empty() {
        return;
    }
    let intervals: Vec<EnergyInterval> = compared.fruit.iter().map(|f| f.interval).collect();
    match fit_threshold(&intervals, campaign.family, campaign.test.level) {
        Ok(threshold) => {
            if threshold.spread_at_bound {
                let message = "the intervals do not tell how much fruit differ: all may have one \
                               critical energy, or nothing bounds their spread. Use smaller steps \
                               of energy or more fruit";
                finding(compared, "spread-unknown", message.to_owned());
            }
            compared.threshold = Some(threshold);
        }
        Err(error) => finding(compared, "no-threshold", error.to_string()),
    }
    compared.masses = turnbull(&intervals).unwrap_or_default();
    let contrary: Vec<&str> = compared
        .fruit
        .iter()
        .filter(|f| f.contrary)
        .map(|f| f.specimen.as_str())
        .collect();
    if !contrary.is_empty() {
        let message = format!(
            "unchanged at an energy above the first change: {}. A spot that has changed is not fresh \
             and may stand more; the first change is taken",
            contrary.join(", ")
        );
        finding(compared, "change-then-none", message);
    }
}

//! What the user gave (priors, bounds, noise) beside what all impacts together say.

use crate::result::outcome::ImpactOutcome;
use crate::settings::model::FitPlan;
use windfall_contact::laws::kind::LawKind;
use windfall_files::found::{FindingOutcome, robust_spread};
use windfall_files::text::number::plain;
use windfall_identify::finding::in_a_sentence;
use windfall_identify::fit::known::NOTICEABLE;
use windfall_identify::fit::problem::{Known, Prior};
use windfall_identify::samples::Quantity;

/// Fewest impacts that say something together.
const FEWEST: usize = 3;
/// Part of the impacts that end on a bound above which their mean is one of a selection; 1.
const MANY_AT_BOUND: f64 = 0.1;
/// Ratio of residuals to the noise that the user gave, or its inverse, that contradicts it; 1.
const OTHER_NOISE: f64 = 1.5;

/// What priors, bounds and noise that were given have to do with the results.
pub fn given_findings(plan: &FitPlan, impacts: &[ImpactOutcome]) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    for (kind, known) in &plan.known {
        let own = impacts.iter().filter(|impact| impact.law == kind.name());
        let own: Vec<&ImpactOutcome> = own.collect();
        if let Some(prior) = known.prior {
            findings.extend(prior_finding(*kind, known, prior, &own));
        }
        findings.extend(bounds_finding(*kind, known, &own));
    }
    let quantities = Quantity::ALL.into_iter().zip(plan.options.noise_sd);
    let given = quantities.filter_map(|(quantity, sd)| Some((quantity, sd?)));
    findings.extend(given.filter_map(|(quantity, sd)| noise_finding(quantity, sd, impacts)));
    findings
}

/// Parameters of which a prior is a noticeable part of what is known, in half of the impacts:
/// estimates lie closer together than fruit do.
pub fn held_together(plan: &FitPlan, kind: LawKind, impacts: &[&ImpactOutcome]) -> Vec<String> {
    let known = plan.known.iter().filter(|(own, _)| *own == kind);
    let held = known.filter(|(_, known)| {
        let prior = known
            .prior
            .and_then(|prior| median_share(known, prior, impacts));
        prior.is_some_and(|share| share > NOTICEABLE)
    });
    held.map(|(_, known)| known.name.clone()).collect()
}

/// Median part of what is known of a parameter that is its prior, C/σ²; 1.
fn median_share(known: &Known, prior: Prior, impacts: &[&ImpactOutcome]) -> Option<f64> {
    let name = known.name.as_str();
    let shares = impacts.iter().filter_map(|impact| {
        let moved = impact.common.get(&format!("prior.{name}"))?.get(name)?;
        Some((moved / prior.sd).clamp(0.0, 1.0))
    });
    let shares: Vec<f64> = shares.collect();
    robust_spread(&shares).map(|(median, _)| median)
}

/// Impacts with a finding of one of some codes on a parameter.
fn count_of(impacts: &[&ImpactOutcome], codes: &[&str], about: &str) -> usize {
    let told =
        |own: &FindingOutcome| codes.contains(&own.code.as_str()) && own.message.starts_with(about);
    let impacts = impacts.iter();
    impacts
        .filter(|impact| impact.findings.iter().any(told))
        .count()
}

fn prior_finding(
    kind: LawKind,
    known: &Known,
    prior: Prior,
    impacts: &[&ImpactOutcome],
) -> Option<FindingOutcome> {
    let (name, law) = (in_a_sentence(&known.name), kind.name());
    let codes = ["prior-contradicted", "prior-outweighed"];
    let apart = count_of(impacts, &codes, &format!("the prior of {name},"));
    if impacts.len() >= FEWEST && 2 * apart > impacts.len() {
        let told = format!(
            "{law}: {apart} of {} impacts contradict the prior of {name}, {} ± {}; their findings \
             say what the data alone tell. Correct the prior, or leave it out",
            impacts.len(),
            plain(prior.mean),
            plain(prior.sd),
        );
        return Some(FindingOutcome::new("prior-excludes-data", told));
    }
    let share = median_share(known, prior, impacts)?;
    (share > NOTICEABLE).then(|| {
        let told = format!(
            "{law}: {:.0} % of what a typical impact tells of {name} is its prior. All impacts \
             share its error, which their mean keeps undivided (common_sd), and {name} spreads \
             less between impacts than between fruit",
            100.0 * share
        );
        FindingOutcome::new("prior-in-means", told)
    })
}

fn bounds_finding(
    kind: LawKind,
    known: &Known,
    impacts: &[&ImpactOutcome],
) -> Option<FindingOutcome> {
    if known.range.0.is_infinite() && known.range.1.is_infinite() {
        return None;
    }
    let name = in_a_sentence(&known.name);
    let ended = count_of(impacts, &["at-bound"], &format!("{name} ended"));
    let many = ended >= 2 && ended as f64 > MANY_AT_BOUND * impacts.len() as f64;
    many.then(|| {
        let told = format!(
            "{}: {name} ends on a bound that was given in {ended} of {} impacts, which do not \
             count: the mean of the others is one of a selection",
            kind.name(),
            impacts.len()
        );
        FindingOutcome::new("bounds-hold", told)
    })
}

fn noise_finding(quantity: Quantity, sd: f64, impacts: &[ImpactOutcome]) -> Option<FindingOutcome> {
    let name = quantity.name();
    let ratios = impacts.iter().filter_map(|impact| {
        let own = impact.residuals.get(name)?;
        Some(own.rms / own.noise)
    });
    let ratios: Vec<f64> = ratios.filter(|ratio| ratio.is_finite()).collect();
    let (median, _) = robust_spread(&ratios)?;
    let other = !(1.0 / OTHER_NOISE..=OTHER_NOISE).contains(&median);
    other.then(|| {
        let side = match median > 1.0 {
            true => "intervals are too narrow, or the law does not describe the signal",
            false => "intervals are too wide",
        };
        let told = format!(
            "the noise of {name} is given as {} {}, and residuals are {median:.2} times that in \
             the median of {} fits: {side}",
            plain(sd),
            quantity.unit(),
            ratios.len()
        );
        FindingOutcome::new("noise-contradicted", told)
    })
}

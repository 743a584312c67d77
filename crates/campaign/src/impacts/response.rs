//! What of the instruments explains what the fits of all impacts leave.

use crate::error::CampaignError;
use crate::impacts::fit::law_problem;
use crate::recording::extract::extract_recording;
use crate::result::bench::says_of_bench;
use crate::result::counted::excluded;
use crate::result::outcome::ImpactOutcome;
use crate::settings::bench::is_of_response;
use crate::settings::model::{BenchFound, ImpactCampaign, ImpactEntry};
use rayon::prelude::*;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::text::number::value_and_sd;
use windfall_identify::bench::cause::{Cause, CauseFound, likeliest_causes};
use windfall_identify::bench::residuals::{BenchResiduals, bench_residuals};
use windfall_identify::fit::interval::IntervalOptions;
use windfall_identify::fit::problem::FitOptions;
use windfall_identify::rig::bench::{BenchQuantity, BenchSd};
use windfall_identify::rig::kind::Rig;
use windfall_signal::uncertain::Uncertain;

/// Rounds of fits and estimates: each begins where the one before has come. A fourth moves nothing.
const ROUNDS: usize = 3;
/// Impacts at most whose residuals are asked for a cause.
const ASKED: usize = 24;
/// Difference of AICc from which a cause is said to explain residuals better.
const BETTER: f64 = 10.0;

/// What each impact leaves of a campaign's first law, where it can be fitted.
fn residuals(
    campaign: &ImpactCampaign,
    rig: &Rig,
    entries: &[&ImpactEntry],
) -> Vec<BenchResiduals> {
    let Some(law) = campaign.fit.laws.first() else {
        return Vec::new();
    };
    // By the impacts alone: a prior of the law would count once in each of them.
    let mut plan = campaign.fit.clone();
    plan.without_priors();
    let problem = law_problem(law, &plan);
    let options = FitOptions {
        bench: BenchSd::default(),
        intervals: IntervalOptions::default(),
        ..campaign.fit.options
    };
    let mass = Some(rig.effective_mass());
    let of = |entry: &&ImpactEntry| {
        let (impact, _) = extract_recording(campaign, entry, mass).ok()?;
        bench_residuals(&impact, rig, &problem, &options).ok()
    };
    entries.par_iter().filter_map(of).collect()
}

/// Estimates a filter, the sensor or the arm over all impacts of a campaign, together with the
/// gain and the delay that are to be estimated, and puts it in the place of what campaign.toml
/// says.
///
/// # Errors
/// Fewer than five impacts can be fitted, or their residuals do not show it.
pub(crate) fn estimate_response(
    campaign: &mut ImpactCampaign,
    rig: &Rig,
    asked: &[BenchQuantity],
) -> Result<(), Error> {
    let Some(quantity) = asked.iter().copied().find(|own| is_of_response(*own)) else {
        return Ok(());
    };
    let cause = Cause {
        gain: asked
            .iter()
            .any(|own| *own != BenchQuantity::ForceDelay && !is_of_response(*own)),
        delay: asked.contains(&BenchQuantity::ForceDelay),
        pole: quantity == BenchQuantity::ForceFilter,
        sensor: quantity == BenchQuantity::SensorFrequency,
        arm: quantity == BenchQuantity::ArmFrequency,
    };
    let told = campaign.fit.options.response;
    let mut found: Option<CauseFound> = None;
    let without = Cause {
        pole: false,
        sensor: false,
        arm: false,
        ..cause
    };
    for round in 0..ROUNDS {
        let entries = campaign.shared.entries.iter();
        let entries: Vec<&ImpactEntry> = entries.filter(|own| excluded(own).is_none()).collect();
        let residuals = residuals(campaign, rig, &entries);
        let fitted = residuals.len();
        let both = likeliest_causes(&residuals, &[cause, without]);
        let of = |cause: Cause| both.iter().find(|own| own.cause == cause);
        // In the second round it is taken off already.
        let shown = of(cause)
            .zip(of(without))
            .filter(|(with, without)| round > 0 || without.aic - with.aic >= BETTER);
        let Some((own, _)) = shown else {
            return Err(Error::from(CampaignError::ResponseUntold {
                path: campaign.shared.directory.clone(),
                quantity: quantity.name(),
                fitted,
            }));
        };
        let mut response = told;
        if cause.pole {
            response.pole = own.fault.response.pole;
        }
        if cause.sensor {
            response.sensor = own.fault.response.sensor;
        }
        if cause.arm {
            response.arm = own.fault.response.arm;
        }
        campaign.fit.options.response = response;
        campaign.contact.response = response;
        found = Some(*own);
    }
    if let Some(found) = found {
        keep(campaign, quantity, &found);
    }
    Ok(())
}

/// Keeps what has been estimated with its uncertainties.
fn keep(campaign: &mut ImpactCampaign, quantity: BenchQuantity, found: &CauseFound) {
    let all: &[(BenchQuantity, Uncertain)] = match quantity {
        BenchQuantity::ForceFilter => &[(quantity, found.frequency)],
        BenchQuantity::SensorFrequency => &[
            (quantity, found.frequency),
            (BenchQuantity::SensorDamping, found.damping),
        ],
        _ => &[
            (quantity, found.frequency),
            (BenchQuantity::ArmDamping, found.damping),
            (BenchQuantity::ArmCompliance, found.compliance),
        ],
    };
    for (quantity, value) in all {
        campaign.bench.sd = campaign.bench.sd.with(*quantity, value.sd);
        campaign.bench.found.push(BenchFound {
            quantity: *quantity,
            value: value.value,
            sd: value.sd,
            told: None,
            impacts: found.impacts,
        });
    }
}

/// Which fault of the bench explains best what the fits leave; asked where force and
/// displacement contradict each other, since a fault may imitate another law.
pub(crate) fn name_cause(
    campaign: &ImpactCampaign,
    rig: &Rig,
    impacts: &[ImpactOutcome],
) -> Option<FindingOutcome> {
    let law = &impacts.first()?.law;
    let counted = impacts
        .iter()
        .filter(|own| own.law == *law && says_of_bench(own));
    let counted: Vec<&str> = counted.map(|own| own.id.as_str()).collect();
    let entries = campaign.shared.entries.iter();
    let entries: Vec<&ImpactEntry> = entries
        .filter(|entry| counted.contains(&entry.id.as_str()))
        .collect();
    let most = ASKED.min(entries.len());
    let spread = (0..most).map(|part| entries[part * entries.len() / most]);
    let residuals = residuals(campaign, rig, &spread.collect::<Vec<_>>());
    let none = Cause::default();
    let one = [
        none,
        Cause { gain: true, ..none },
        Cause {
            delay: true,
            ..none
        },
        Cause {
            gain: true,
            delay: true,
            ..none
        },
        Cause { pole: true, ..none },
        Cause {
            sensor: true,
            ..none
        },
        Cause { arm: true, ..none },
    ];
    let found = likeliest_causes(&residuals, &one);
    let best = found.first().filter(|own| own.cause != none)?;
    let nothing = found.iter().find(|own| own.cause == none)?;
    let gained = nothing.aic - best.aic;
    if gained < BETTER {
        return None;
    }
    // A cause that has the best one's parameters and more explains what it explains.
    let mut others = found[1..]
        .iter()
        .filter(|own| !includes(own.cause, best.cause));
    let beside = others.next().map(|next| {
        let apart = next.aic - best.aic;
        match apart < BETTER {
            true => format!(
                "; they do not tell it from {} (ΔAICc {apart:.1})",
                words(rig, next)
            ),
            false => format!(", next {} (ΔAICc {apart:.0})", words(rig, next)),
        }
    });
    let told = format!(
        "of single faults of the bench, what the fits of {} impacts leave is best explained by {} \
         (ΔAICc {gained:.0} to none){}{}",
        best.impacts,
        words(rig, best),
        beside.unwrap_or_default(),
        estimate(rig, best),
    );
    Some(FindingOutcome::new("bench-cause", told))
}

/// Whether a cause has all that another one has.
fn includes(all: Cause, part: Cause) -> bool {
    let has = |own: Cause| [own.gain, own.delay, own.pole, own.sensor, own.arm];
    has(all)
        .iter()
        .zip(has(part))
        .all(|(all, part)| *all || !part)
}

/// "a force sensor that swings at 2000 ± 2 Hz with a damping of 0.050 ± 0.001".
fn words(rig: &Rig, found: &CauseFound) -> String {
    let shown = |own: Uncertain, scale: f64| value_and_sd(scale * own.value, Some(scale * own.sd));
    let frequency = shown(found.frequency, 1.0);
    let damping = shown(found.damping, 1.0);
    let gain = || {
        let mass = match rig {
            Rig::Pendulum(_) => "effective mass",
            Rig::Carriage(_) => "mass",
        };
        format!(
            "a force that reads {} % too much (or {mass} wrong)",
            shown(found.gain, 100.0)
        )
    };
    let delay = || format!("a force that is {} µs late", shown(found.delay, 1e6));
    let cause = found.cause;
    match (cause.gain, cause.delay) {
        (true, true) => return format!("{}, and {}", gain(), delay()),
        (true, false) => return gain(),
        (false, true) => return delay(),
        (false, false) => (),
    }
    if cause.pole {
        return format!("a filter of first order at {frequency} Hz before the force");
    }
    if cause.sensor {
        return format!("a force sensor that swings at {frequency} Hz with a damping of {damping}");
    }
    if cause.arm {
        return format!(
            "an arm that bends by {} nm/N and swings at {frequency} Hz with a damping of {damping}",
            shown(found.compliance, 1e9)
        );
    }
    "nothing".to_owned()
}

/// How to estimate a cause.
fn estimate(rig: &Rig, found: &CauseFound) -> String {
    let cause = found.cause;
    let mass = match rig {
        Rig::Pendulum(_) => BenchQuantity::Inertia,
        Rig::Carriage(_) => BenchQuantity::Mass,
    };
    let all = [
        (cause.gain, mass),
        (cause.delay, BenchQuantity::ForceDelay),
        (cause.pole, BenchQuantity::ForceFilter),
        (cause.sensor, BenchQuantity::SensorFrequency),
        (cause.arm, BenchQuantity::ArmFrequency),
    ];
    let asked = all.iter().filter(|(has, _)| *has);
    let asked: Vec<String> = asked
        .map(|(_, own)| format!("\"{}\"", own.name()))
        .collect();
    format!(
        ". `[fit] estimate = [{}]` takes it into account",
        asked.join(", ")
    )
}

//! What the impacts of a campaign together say of the bench that they were made on.

use crate::result::counted::SHIFT_OF_DELAY;
use crate::result::outcome::{ImpactOutcome, PooledOutcome};
use std::f64::consts::TAU;
use windfall_files::found::{FindingOutcome, robust_spread};
use windfall_files::named::Named;
use windfall_files::text::number::value_and_sd;
use windfall_identify::rig::kind::Rig;
use windfall_signal::uncertain::{Uncertain, weighted_mean};

/// Reasons that leave an impact out and are what is asked here.
const ASKED: [&str; 2] = ["impulse-contradicts-momentum", "late-channel"];
/// Fewest impacts that say something of their bench.
const FEWEST: usize = 5;
/// Robust deviations from the median beyond which an impact has a fault of its own.
const OWN_FAULT: f64 = 6.0;
/// Deviations by which a value must differ from that of a perfect bench.
const CLEAR: f64 = 4.0;

/// Gain and delay of the force by Newton's law, over all impacts: no law of the fruit enters.
///
/// Each is the weighted mean over the impacts, without those far from the others, and its
/// deviation the larger of what theirs and their scatter give. Nothing with fewer than five.
pub fn pooled_bench(impacts: &[ImpactOutcome]) -> Named<PooledOutcome> {
    let law = impacts.first().map(|impact| &impact.law);
    let asked = |impact: &&ImpactOutcome| {
        let mut reasons = impact.left_out.iter();
        Some(&impact.law) == law && reasons.all(|own| ASKED.contains(&own.code.as_str()))
    };
    let own: Vec<&ImpactOutcome> = impacts.iter().filter(asked).collect();
    let pooled = ["force_gain", "force_delay"]
        .into_iter()
        .filter_map(|name| {
            let of = |impact: &&ImpactOutcome| {
                let (value, sd) = (impact.derived(name)?, *impact.derived_sd.get(name)?);
                (sd > 0.0).then(|| Uncertain::new(value, sd))
            };
            let values: Vec<Uncertain> = own.iter().filter_map(of).collect();
            let found = match name {
                "force_gain" => pooled_gain(values),
                _ => pooled(values),
            };
            Some((name.into(), found?))
        });
    Named(pooled.collect())
}

/// [`pooled`] of gains, by way of their inverse. That is what is estimated without bias, with a
/// deviation that does not depend on it: small gains would weigh more than large ones.
pub(crate) fn pooled_gain(gains: Vec<Uncertain>) -> Option<PooledOutcome> {
    let inverse = |value: f64, sd: f64| (1.0 / value, sd / (value * value));
    let inverted = gains.into_iter().map(|own| {
        let (value, sd) = inverse(own.value, own.sd);
        Uncertain::new(value, sd)
    });
    let mean = pooled(inverted.collect())?;
    let (value, sd) = inverse(mean.value, mean.sd);
    Some(PooledOutcome { value, sd, ..mean })
}

/// A weighted mean without those that are far from the others; `None` of fewer than five.
pub(crate) fn pooled(mut values: Vec<Uncertain>) -> Option<PooledOutcome> {
    let plain: Vec<f64> = values.iter().map(|own| own.value).collect();
    let (median, spread) = robust_spread(&plain)?;
    values.retain(|own| (own.value - median).abs() <= OWN_FAULT * spread.hypot(own.sd));
    let mean = weighted_mean(&values).filter(|_| values.len() >= FEWEST)?;
    let apart = values.iter().map(|own| (own.value - mean.value) / own.sd);
    Some(PooledOutcome {
        value: mean.value,
        sd: mean.sd,
        impacts: values.len(),
        chi_square: apart.map(|z| z * z).sum(),
    })
}

/// What differs from a perfect bench, and the likeliest causes.
pub fn bench_findings(
    rig: &Rig,
    bench: &Named<PooledOutcome>,
    impacts: &[ImpactOutcome],
) -> Vec<FindingOutcome> {
    let clear = |name: &str, perfect: f64| {
        let own = bench.get(name)?;
        ((own.value - perfect).abs() > CLEAR * own.sd).then_some(own)
    };
    let durations = impacts
        .iter()
        .filter_map(|own| own.derived("contact_duration"));
    let durations: Vec<f64> = durations.collect();
    let duration = robust_spread(&durations).map(|(median, _)| median);
    let gain = clear("force_gain", 1.0);
    let gain = gain.map(|own| FindingOutcome::new("bench-gain", gain_text(rig, own)));
    let delay = clear("force_delay", 0.0);
    let delay = delay.map(|own| FindingOutcome::new("bench-delay", delay_text(own, duration)));
    gain.into_iter().chain(delay).collect()
}

fn gain_text(rig: &Rig, gain: &PooledOutcome) -> String {
    let (mass, weigh) = match rig {
        Rig::Pendulum(_) => (
            "the effective mass (inertia, or the arm or the counts per turn)",
            "swing the arm with and without a known mass to measure its inertia",
        ),
        Rig::Carriage(_) => (
            "the mass (or the scale of the displacement)",
            "weigh the moving body",
        ),
    };
    let percent = |part: f64| {
        let word = if part < 0.0 { "small" } else { "large" };
        format!("{:.1} % too {word}", 100.0 * part.abs())
    };
    format!(
        "over {} impacts the force is {} times mass × acceleration of the displacement: {mass} is \
         {}, or the force reads {}; force and displacement cannot tell which, and every stiffness is \
         off by as much. Hang known weights on the force sensor, or {weigh}",
        gain.impacts,
        value_and_sd(gain.value, Some(gain.sd)),
        percent(1.0 / gain.value - 1.0),
        percent(gain.value - 1.0),
    )
}

fn delay_text(delay: &PooledOutcome, duration: Option<f64>) -> String {
    let shown = value_and_sd(1e6 * delay.value.abs(), Some(1e6 * delay.sd));
    let shift = duration.map_or_else(String::new, |duration| {
        let shift = (SHIFT_OF_DELAY * delay.value.abs() / duration).exp_m1();
        format!("; a stiffness may be {:.1} % off", 100.0 * shift)
    });
    if delay.value < 0.0 {
        return format!(
            "over {} impacts the displacement comes {shown} µs after the force: it was sampled \
             later, or passes a filter{shift}",
            delay.impacts
        );
    }
    let corner = 1.0 / (TAU * delay.value);
    format!(
        "over {} impacts the force comes {shown} µs after the displacement: it was sampled later, \
         or passes a filter or amplifier of {} Hz (of first order; {} Hz of second), or the \
         sensor itself swings{shift}",
        delay.impacts,
        rounded(corner),
        rounded(std::f64::consts::SQRT_2 * corner),
    )
}

/// Two digits.
fn rounded(value: f64) -> String {
    let step = 10f64.powf(value.log10().floor() - 1.0);
    format!("{:.0}", (value / step).round() * step)
}

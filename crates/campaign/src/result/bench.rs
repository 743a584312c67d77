//! What the impacts of a campaign together say of the bench that they were made on.

use crate::result::counted::DEVIATIONS;
use crate::result::outcome::{BenchOutcome, ImpactOutcome, PooledOutcome};
use std::f64::consts::{PI, TAU};
use windfall_files::found::{FindingOutcome, robust_spread};
use windfall_files::named::Named;
use windfall_files::text::number::value_and_sd;
use windfall_identify::rig::bench::{BenchQuantity, BenchSd};
use windfall_identify::rig::kind::Rig;
use windfall_signal::uncertain::{Uncertain, variance_between, weighted_mean};

/// Reasons that leave an impact out and are what is asked here.
const ASKED: [&str; 2] = ["impulse-contradicts-momentum", "late-channel"];
/// Fewest impacts that say something of their bench.
const FEWEST: usize = 5;
/// Robust deviations from the median beyond which an impact has a fault of its own.
const OWN_FAULT: f64 = 6.0;
/// Part of its value, or of the contact, by which an estimate is far from what is told; 1.
const FAR: f64 = 0.1;
/// What a resolution of r may shift: the gain by a r² + b r⁴, the delay by that times T. Of
/// simulated impacts on a perfect bench, 5 to 200 kHz, 11,000 to 360,000 counts a turn: the time
/// between samples shifts by less than 0.3 r², counts by nothing that is seen up to r = 0.05.
const GAIN_BY_BLUR: [f64; 2] = [0.3, 50.0];
const DELAY_BY_BLUR: [f64; 2] = [0.1, 25.0];
/// The coarsest resolution at which force and displacement say anything of each other; 1.
pub(crate) const COARSEST: f64 = 0.3;
/// ∫ a² dt over (Δv)²/T, of a half sine; 1.
const HALF_SINE: f64 = PI * PI / 8.0;
/// Deviations by which a value must differ from that of a perfect bench.
const CLEAR: f64 = 4.0;

/// Gain and delay of the force by Newton's law, over all impacts: no law of the fruit enters.
///
/// Each is the weighted mean over the impacts, without those far from the others, and its
/// deviation the larger of what theirs and their scatter give. Nothing with fewer than five.
pub fn pooled_bench(impacts: &[ImpactOutcome]) -> Named<PooledOutcome> {
    let law = impacts.first().map(|impact| &impact.law);
    let asked = |impact: &&ImpactOutcome| Some(&impact.law) == law && says_of_bench(impact);
    let own: Vec<&ImpactOutcome> = impacts.iter().filter(asked).collect();
    let pooled = ["force_gain", "force_delay"]
        .into_iter()
        .filter_map(|name| {
            let of = |impact: &&ImpactOutcome| {
                let (value, sd) = (impact.derived(name)?, *impact.derived_sd.get(name)?);
                let sharpness = (
                    impact.derived("resolution")?,
                    impact.derived("contact_duration")?,
                );
                (sd > 0.0).then(|| (Uncertain::new(value, sd), sharpness))
            };
            let values = own.iter().filter_map(of).collect();
            Some((name.into(), pooled(name, values)?))
        });
    Named(pooled.collect())
}

/// Common value of gains or delays of the force.
///
/// Gains are averaged by way of their inverse, which is what is estimated without bias and with
/// a deviation that does not depend on it: small gains would weigh more than large ones. What
/// the time between samples or counts may shift in all impacts alike is added undivided.
///
/// * `name`: "force_gain" or "force_delay"
/// * `values`: with resolution and duration of each contact; 1, s
///
/// Contacts coarser than [`COARSEST`] are not asked.
pub(crate) fn pooled(
    name: &str,
    mut values: Vec<(Uncertain, (f64, f64))>,
) -> Option<PooledOutcome> {
    values.retain(|(_, (resolution, _))| *resolution <= COARSEST);
    let middle = |of: fn(&(f64, f64)) -> f64| {
        let own: Vec<f64> = values.iter().map(|(_, own)| of(own)).collect();
        robust_spread(&own).map(|(median, _)| median)
    };
    let (resolution, duration) = (middle(|own| own.0)?, middle(|own| own.1)?);
    let blur =
        |[square, fourth]: [f64; 2]| resolution.powi(2) * (square + fourth * resolution.powi(2));
    let own = values.into_iter().map(|(own, _)| own);
    if name == "force_delay" {
        let mean = averaged(own.collect())?;
        let sd = mean.sd.hypot(blur(DELAY_BY_BLUR) * duration);
        return Some(PooledOutcome { sd, ..mean });
    }
    let inverse = |value: f64, sd: f64| (1.0 / value, sd / (value * value));
    let inverted = own.map(|own| {
        let (value, sd) = inverse(own.value, own.sd);
        Uncertain::new(value, sd)
    });
    let mean = averaged(inverted.collect())?;
    let (value, sd) = inverse(mean.value, mean.sd.hypot(blur(GAIN_BY_BLUR)));
    Some(PooledOutcome { value, sd, ..mean })
}

/// Whether an impact counts, or would if its bench were as told.
pub fn says_of_bench(impact: &ImpactOutcome) -> bool {
    let mut reasons = impact.left_out.iter();
    reasons.all(|own| ASKED.contains(&own.code.as_str()))
}

/// A weighted mean without those that are far from the others; `None` of fewer than five.
///
/// # Source
/// MacKinnon and White (1985), J. Econometrics 29:305, HC3, for the deviation by scatter.
fn averaged(mut values: Vec<Uncertain>) -> Option<PooledOutcome> {
    let plain: Vec<f64> = values.iter().map(|own| own.value).collect();
    let (median, spread) = robust_spread(&plain)?;
    values.retain(|own| (own.value - median).abs() <= OWN_FAULT * spread.hypot(own.sd));
    // Deviations that are too small must not choose the impacts that count: of an encoder whose
    // counts keep step with the samples they are smallest where its shift is largest.
    let own: Vec<f64> = values.iter().map(|own| own.sd).collect();
    let between = variance_between(&values).sqrt();
    for value in &mut values {
        value.sd = value.sd.hypot(between);
    }
    let mean = weighted_mean(&values).filter(|_| values.len() >= FEWEST)?;
    let apart = values.iter().zip(&own);
    let apart = apart.map(|(value, sd)| (value.value - mean.value) / sd);
    // The scatter at the weights that were given: they may be wrong, as where noise is coloured,
    // and a few impacts then decide the mean.
    let total: f64 = values.iter().map(|own| own.sd.powi(-2)).sum();
    let scatter = values.iter().map(|own| {
        let share = own.sd.powi(-2) / total;
        (share * (own.value - mean.value) / (1.0 - share).max(f64::MIN_POSITIVE)).powi(2)
    });
    Some(PooledOutcome {
        value: mean.value,
        sd: mean.sd.max(scatter.sum::<f64>().sqrt()),
        impacts: values.len(),
        chi_square: apart.map(|z| z * z).sum(),
    })
}

/// What differs from a perfect bench, and the likeliest causes.
///
/// * `known`: what campaign.toml says of its uncertainties
pub fn bench_findings(
    rig: &Rig,
    known: &BenchSd,
    bench: &Named<PooledOutcome>,
    impacts: &[ImpactOutcome],
) -> Vec<FindingOutcome> {
    let clear = |name: &str, perfect: f64| {
        let own = bench.get(name)?;
        let told = match name {
            "force_gain" => known.relative_push(rig),
            _ => known.of(BenchQuantity::ForceDelay),
        };
        let room = (CLEAR * own.sd).max(DEVIATIONS * told);
        ((own.value - perfect).abs() > room).then_some(own)
    };
    let gain = clear("force_gain", 1.0);
    let gain = gain.map(|own| FindingOutcome::new("bench-gain", gain_text(rig, own)));
    let delay = clear("force_delay", 0.0);
    let delay = delay.map(|own| {
        let energy = energy_text(rig, own, impacts).unwrap_or_default();
        FindingOutcome::new("bench-delay", delay_text(own) + &energy)
    });
    gain.into_iter().chain(delay).collect()
}

/// Estimates that are so far from what campaign.toml says that something else is likelier.
pub fn far_estimates(
    estimated: &Named<BenchOutcome>,
    impacts: &[ImpactOutcome],
) -> Vec<FindingOutcome> {
    let durations = impacts
        .iter()
        .filter_map(|own| own.derived("contact_duration"));
    let durations: Vec<f64> = durations.collect();
    let duration = robust_spread(&durations).map_or(f64::INFINITY, |(median, _)| median);
    let far = estimated.0.iter().filter_map(|(name, own)| {
        let (scale, likelier) = match name == BenchQuantity::ForceDelay.name() {
            true => (duration, "rows that are missing, or a clock of its own"),
            false => (
                own.told?,
                "the arm, the counts per turn, a unit or a factor",
            ),
        };
        let away = (own.value - own.told?).abs() / scale;
        (away > FAR).then(|| {
            let told = format!(
                "{name} is estimated {:.0} % away from what campaign.toml says{}: \
                 something else is more likely to be wrong ({likelier}), and that error then goes \
                 into stiffness and damping",
                100.0 * away,
                if scale == duration {
                    " (of the contact)"
                } else {
                    ""
                },
            );
            FindingOutcome::new("bench-far", told)
        })
    });
    far.collect()
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
         {}, or the force reads {}; force and displacement cannot tell which. Stiffness and damping \
         may be off by as much. Hang known weights on the force sensor, or {weigh}",
        gain.impacts,
        value_and_sd(gain.value, Some(gain.sd)),
        percent(1.0 / gain.value - 1.0),
        percent(gain.value - 1.0),
    )
}

fn delay_text(delay: &PooledOutcome) -> String {
    let shown = value_and_sd(1e6 * delay.value.abs(), Some(1e6 * delay.sd));
    if delay.value < 0.0 {
        return format!(
            "over {} impacts the displacement comes {shown} µs after the force: it was sampled \
             later, or passes a filter",
            delay.impacts
        );
    }
    let corner = 1.0 / (TAU * delay.value);
    format!(
        "over {} impacts the force comes {shown} µs after the displacement: it was sampled later, \
         or passes a filter or amplifier of {} Hz (of first order; {} Hz of second), or the \
         sensor itself swings",
        delay.impacts,
        rounded(corner),
        rounded(std::f64::consts::SQRT_2 * corner),
    )
}

/// What a delay τ does to the balance of energy: it takes τ m ∫ a² dt from the area of the loop
/// of force over displacement, which is what the fruit absorbs.
fn energy_text(rig: &Rig, delay: &PooledOutcome, impacts: &[ImpactOutcome]) -> Option<String> {
    let shares = impacts.iter().filter(|own| says_of_bench(own));
    let shares = shares.filter_map(|own| {
        let (impulse, duration) = (own.derived("impulse")?, own.derived("contact_duration")?);
        let absorbed = own.derived("absorbed_energy").filter(|own| *own > 0.0)?;
        let lost = HALF_SINE * impulse.powi(2) / (rig.effective_mass() * duration);
        Some(delay.value * lost / absorbed)
    });
    let (share, _) = robust_spread(&shares.collect::<Vec<_>>())?;
    Some(format!(
        ". The loop of force over displacement is about {:.1} % of the absorbed energy too {}",
        100.0 * share.abs(),
        if share > 0.0 { "small" } else { "large" }
    ))
}

/// Two digits.
fn rounded(value: f64) -> String {
    let step = 10f64.powf(value.log10().floor() - 1.0);
    format!("{:.0}", (value / step).round() * step)
}

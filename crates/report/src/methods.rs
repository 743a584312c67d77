//! What was done to the recordings, in the words of a methods section.

use windfall_campaign::result::outcome::CampaignOutcome;
use windfall_campaign::settings::model::{ImpactCampaign, KnownKind, MassPlan, RigPlan};
use windfall_contact::law::EndRule;
use windfall_files::text::number::{plain, unit_text, value_and_sd};
use windfall_identify::fit::interval::IntervalMethod;
use windfall_identify::fit::problem::{FitOptions, NoiseModel, Weighting};
use windfall_identify::samples::Quantity;
use windfall_measure::words::{filters_text, laws_text, listed, threshold_text};
use windfall_signal::options::RateMethod;
use windfall_signal::trigger::{Baseline, Orientation};

/// Paragraphs that say exactly how the results came about.
pub fn methods(campaign: &ImpactCampaign, outcome: &CampaignOutcome) -> Vec<String> {
    let mut paragraphs = vec![rig(campaign, outcome)];
    paragraphs.extend(estimated(outcome));
    paragraphs.push(signals(campaign));
    paragraphs.extend(laws_text(&campaign.fit.laws, &campaign.fit.free));
    paragraphs.push(cost(&campaign.fit.options));
    paragraphs.extend(given(campaign));
    paragraphs.push(nuisances(&campaign.fit.options, outcome));
    paragraphs.push(intervals(&campaign.fit.options));
    paragraphs
}

fn rig(campaign: &ImpactCampaign, outcome: &CampaignOutcome) -> String {
    let mass = plain(outcome.effective_mass.value);
    match campaign.rig {
        RigPlan::Pendulum(rig) => format!(
            "Specimens were struck by a pendulum with a moment of inertia of {} kg m² about its \
             pivot, {} m from pivot to contact, a mass of {} kg and its centre of mass {} m from \
             the pivot (effective mass at the contact {mass} kg; acceleration of gravity {} m/s²).",
            match outcome.estimated.get("inertia") {
                Some(own) => plain(own.value),
                None => rig.inertia.to_string(),
            },
            rig.arm,
            rig.mass,
            rig.centre_of_mass,
            rig.gravity
        ),
        RigPlan::Carriage {
            mass: plan,
            driving_acceleration,
            ..
        } => {
            let known = match plan {
                MassPlan::Given { .. } if outcome.estimated.get("mass").is_some() => {
                    "estimated, see below".to_owned()
                }
                MassPlan::Given { .. } => "as given".to_owned(),
                MassPlan::FromImpulse => format!(
                    "found from impulse and change of velocity of {} impacts, standard \
                     uncertainty {} kg",
                    outcome.effective_mass.impacts,
                    plain(outcome.effective_mass.sd)
                ),
            };
            format!(
                "Specimens were struck by a body on a line with a mass of {mass} kg ({known}) and \
                 an acceleration of {} m/s² towards the specimen without contact.",
                driving_acceleration
            )
        }
    }
}

/// What of the bench was estimated, and how.
fn estimated(outcome: &CampaignOutcome) -> Option<String> {
    let parts = outcome.estimated.0.iter().map(|(name, own)| {
        let unit = if own.unit == "1" { "" } else { &own.unit };
        let value = value_and_sd(own.value, Some(own.sd));
        let text = format!("{name} = {value} {}", unit_text(unit));
        format!("{} ({} impacts)", text.trim_end(), own.impacts)
    });
    let parts: Vec<String> = parts.collect();
    (!parts.is_empty()).then(|| {
        format!(
            "These quantities of the bench were estimated from all impacts together, by Newton's \
             law for force and displacement: {}. Their uncertainty is part of every interval.",
            parts.join("; ")
        )
    })
}

fn signals(campaign: &ImpactCampaign) -> String {
    let contact = &campaign.contact;
    let trigger = &contact.trigger;
    let threshold = threshold_text(&trigger.threshold);
    let baseline = match trigger.baseline {
        Baseline::Remove => {
            "The mean force before contact was subtracted, and a drift or a hum of its zero where \
             the findings say so."
        }
        Baseline::Drift => {
            "A straight line through the force before and after contact was subtracted."
        }
        Baseline::Keep => "The force was taken as recorded, without a correction of its zero.",
    };
    let sign = match contact.orientation {
        Orientation::Correct => {
            " Channels recorded with the opposite sign were turned (the findings say which)."
        }
        Orientation::AsRecorded => "",
    };
    let rate = match contact.rate {
        RateMethod::Automatic => {
            "measured where there was a channel for it, else the central difference of the displacement where that was sampled evenly"
        }
        RateMethod::Measured => "measured",
        RateMethod::CentralDifference => "the central difference of the displacement",
        RateMethod::SmoothingSpline => {
            "the derivative of a smoothing spline of the displacement, its penalty by cross-validation"
        }
        RateMethod::EdgeTimes => "the length of a count over the time between its edges",
        RateMethod::LocalPolynomial { .. } => {
            "the derivative of local polynomials (Savitzky-Golay) of the displacement"
        }
    };
    let filters = filters_text(&contact.conditioning);
    let tip = contact
        .conditioning
        .tip_mass
        .map_or_else(String::new, |mass| {
            format!(" The inertia of {mass} kg ahead of the force sensor was added to the force.",)
        });
    let flight = if contact.free_flight > contact.margin_before.max(contact.margin_after) {
        format!(
            ", and of the motion up to {} durations as far as it was free",
            contact.free_flight
        )
    } else {
        String::new()
    };
    format!(
        "Contact was taken to last while the force {threshold}; {} and {} of its duration were \
         kept before and after it{flight}. {baseline}{sign} The displacement rate was {rate}. {filters}{tip}",
        contact.margin_before, contact.margin_after
    )
}

fn cost(options: &FitOptions) -> String {
    let quantities = listed(&options.quantities.names());
    let weights = match options.weighting {
        Weighting::InverseVariance => "weighted by the inverse of the variance of its noise",
        Weighting::InverseMean => {
            "weighted by the inverse of its mean absolute value, as in the 2003 pendulum study"
        }
    };
    let noise = match options.noise {
        NoiseModel::Automatic => {
            "The noise of each channel (its variance, the correlation of successive samples, the \
             steps of an encoder, the uncertainty of the zero) was taken from the recording."
        }
        NoiseModel::White => "Samples were taken as independent of each other.",
    };
    let end = match options.end {
        EndRule::ForceZero => "when the force returned to zero",
        EndRule::GapZero => "when the displacement returned to zero",
    };
    format!(
        "Parameters were estimated by least squares (Levenberg-Marquardt with exact derivatives) \
         over {quantities}, each {weights}. {noise} The motion under the law was integrated by an \
         explicit Runge-Kutta pair of order 8 (Dormand and Prince) to a relative accuracy of {:e}; \
         contact ended {end}.",
        options.accuracy
    )
}

/// Priors, bounds and noise that the user gave.
fn given(campaign: &ImpactCampaign) -> Option<String> {
    let texts = campaign.fit.known_texts.iter();
    let mut told: Vec<String> = texts
        .map(|own| match own.kind {
            KnownKind::Prior => format!("a normal prior of {}, {}", own.name, own.text),
            KnownKind::Bounds => format!("bounds of {}, {}", own.name, own.text),
        })
        .collect();
    let noise = Quantity::ALL.into_iter().zip(campaign.fit.options.noise_sd);
    told.extend(noise.filter_map(|(quantity, sd)| {
        let sd = plain(sd?);
        Some(format!(
            "noise of {}, {sd} {}",
            quantity.name(),
            unit_text(quantity.unit())
        ))
    }));
    (!told.is_empty()).then(|| format!("Given beside the recordings: {}.", told.join("; ")))
}

fn nuisances(options: &FitOptions, outcome: &CampaignOutcome) -> String {
    let all = outcome.impacts.len();
    let estimated = |name: &str| {
        let found = outcome.impacts.iter().filter_map(|i| i.nuisances.get(name));
        match found.filter(|estimate| !estimate.held).count() {
            0 => "held as read off the signals".to_owned(),
            n if n == all => "estimated too".to_owned(),
            n => format!("estimated too in {n} of {all} fits, where the data can tell it"),
        }
    };
    let velocity = match options.known_velocity {
        Some(velocity) => format!("held at {velocity} m/s"),
        None => estimated("initial_velocity"),
    };
    format!(
        "The velocity at first touch was {velocity}; the time of first touch was {}; the zero of \
         the displacement was {}.",
        estimated("onset"),
        estimated("displacement_offset")
    )
}

fn intervals(options: &FitOptions) -> String {
    let percent = 100.0 * options.confidence;
    let asked = &options.intervals;
    let how = match asked.method {
        IntervalMethod::Asymptotic => {
            "the estimate ± Student's t times its standard deviation, from the curvature of the cost at its minimum".to_owned()
        }
        IntervalMethod::Profile => "by profile likelihood".to_owned(),
        IntervalMethod::Bootstrap => format!(
            "by a bootstrap of residual blocks (bias-corrected percentiles of {} replicates of \
             each impact, seed {})",
            asked.replicates, asked.seed
        ),
        IntervalMethod::Posterior => format!(
            "quantiles of the posterior (no-U-turn sampler, {} chains of {} draws, flat priors on \
             the logarithms of what has no other, seed {})",
            asked.chains, asked.draws, asked.seed
        ),
    };
    format!(
        "Intervals of {percent} % are {how}. Means are given ± the standard deviation between impacts (n − 1)."
    )
}

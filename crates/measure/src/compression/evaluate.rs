//! One slow compression: loading curve, yield, laws, modulus.

use crate::compression::read::{CompressionCampaign, specimen_radii};
use crate::measured::{MeasuredItem, MeasuredItems, MeasuredValue, plain_value, value_with_sd};
use windfall_campaign::recording::channel::channel_samples;
use windfall_campaign::recording::read::recording_path;
use windfall_campaign::settings::model::ImpactEntry;
use windfall_compression::fit::{
    CompressionEstimate, CompressionFit, LoadingCurve, fit_compression,
};
use windfall_contact::apparent_modulus::{PressedContact, PrincipalRadii, stiffness_per_modulus};
use windfall_contact::expression::LawExpression;
use windfall_contact::parameter::Elastic;
use windfall_files::error::{Error, Place};
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_files::text::number::plain;
use windfall_signal::compression::{
    CompressionCurve, FitRange, LoadingEnd, compression_curve, fitted_range,
};
use windfall_signal::kinematics::value_at;
use windfall_signal::polynomial::local_polynomial;
use windfall_signal::recording::{Quantity, Recording};

/// Points of a curve at most that a law is fitted to; more are averaged.
const MOST_POINTS: usize = 2000;

/// A law misses a curve when the residuals are this many times the noise.
const MISSES: f64 = 5.0;

/// A rate is uneven when it varies by more than this part; 1.
const UNEVEN: f64 = 0.1;

/// The loading curve of an entry.
///
/// # Errors
/// A channel is not there, or the recording shows no compression.
pub fn loading_curve(
    campaign: &CompressionCampaign,
    entry: &ImpactEntry,
    recording: &Recording,
) -> Result<CompressionCurve, Error> {
    let force = channel_samples(recording, Quantity::Force, entry)?;
    let position = channel_samples(recording, Quantity::Displacement, entry)?;
    let at_force = |time: &f64| value_at(&position.times, &position.values, *time);
    let positions: Vec<f64> = force.times.iter().map(at_force).collect();
    compression_curve(&force.times, &positions, &force.values, &campaign.options)
        .map_err(|source| failed(campaign, entry, source))
}

fn failed(
    campaign: &CompressionCampaign,
    entry: &ImpactEntry,
    source: impl std::error::Error + Send + Sync + 'static,
) -> Error {
    let path = recording_path(&campaign.shared.files, entry);
    let source = Box::new(source);
    Error::Evaluation { path, source }
}

/// The part of a curve that a law is fitted to, with its rate, averaged to at most a
/// few thousand points.
///
/// Where the campaign does not say otherwise, a law without damping is fitted up
/// to the largest stiffness; a damped one, whose force rises steepest at touch,
/// up to half of the yield force.
pub fn fitted_part(
    campaign: &CompressionCampaign,
    curve: &CompressionCurve,
    law: &LawExpression,
) -> LoadingCurve {
    let damping = law.kind.describe().index_of("c");
    let undamped = damping.is_none_or(|index| law.values[index] == Some(0.0));
    let range = campaign.fit_to.unwrap_or(match undamped {
        true => FitRange::LargestStiffness,
        false => FitRange::PartOfYield(0.5),
    });
    let (first, last) = fitted_range(curve, range);
    let range = first..=last;
    let (times, deformation) = (
        &curve.times[range.clone()],
        &curve.deformation[range.clone()],
    );
    let force = &curve.force[range];
    let n = times.len();
    let window = ((n / 10) | 1).max(5);
    let overall = (deformation[n - 1] - deformation[0]) / (times[n - 1] - times[0]);
    let rate = local_polynomial(times, deformation, window, 1, 1);
    let rate = rate.unwrap_or_else(|| vec![overall; n]);
    let block = n.div_ceil(MOST_POINTS);
    let mean = |values: &[f64]| -> Vec<f64> {
        let blocks = values.chunks(block);
        blocks
            .map(|b| b.iter().sum::<f64>() / b.len() as f64)
            .collect()
    };
    LoadingCurve {
        deformation: mean(deformation),
        rate: mean(&rate),
        force: mean(force),
    }
}

/// Everything about one entry: one item for each law.
///
/// # Errors
/// The recording shows no compression, or a law cannot be fitted.
pub fn evaluate_compression(
    campaign: &CompressionCampaign,
    entry: &ImpactEntry,
    recording: &Recording,
) -> Result<MeasuredItems, Error> {
    let curve = loading_curve(campaign, entry, recording)?;
    let radii = radii_of_entry(campaign, entry)?;
    let items = campaign.laws.iter().map(|law| {
        let part = fitted_part(campaign, &curve, law);
        let fit = fit_compression(std::slice::from_ref(&part), law, &campaign.free);
        let fit = fit.map_err(|source| failed(campaign, entry, source))?;
        Ok(item(campaign, entry, (&curve, &part, &fit), radii))
    });
    Ok(MeasuredItems {
        items: items.collect::<Result<Vec<_>, Error>>()?,
    })
}

/// Radii of the specimen of an entry, or in the entry's own row.
///
/// # Errors
/// A cell is no positive number.
pub fn radii_of_entry(
    campaign: &CompressionCampaign,
    entry: &ImpactEntry,
) -> Result<Option<PrincipalRadii>, Error> {
    let directory = &campaign.shared.directory;
    let place = |file, line| Place::at(&directory.join(file), line);
    let own = specimen_radii(&entry.cells, &place("impacts.csv", entry.line))?;
    match (own, campaign.shared.specimen_of(entry)) {
        (None, Some(specimen)) => {
            specimen_radii(&specimen.cells, &place("specimens.csv", specimen.line))
        }
        (own, _) => Ok(own),
    }
}

fn item(
    campaign: &CompressionCampaign,
    entry: &ImpactEntry,
    (curve, part, fit): (&CompressionCurve, &LoadingCurve, &CompressionFit),
    radii: Option<PrincipalRadii>,
) -> MeasuredItem {
    let ended = match curve.ended_by {
        LoadingEnd::Bioyield => "bioyield",
        LoadingEnd::Rupture => "rupture",
        LoadingEnd::Reversal => "reversal",
        LoadingEnd::Hold => "hold",
        LoadingEnd::RecordingEnd => "end of recording",
    };
    let mut derived = curve_values(curve, fit, part);
    if let Some(radii) = radii {
        push_modulus(&mut derived, campaign, fit, radii);
    }
    MeasuredItem {
        words: Named::of([("loading_ended_by", ended.to_owned())]),
        parameters: parameters_of(fit),
        derived,
        findings: findings(curve, part, fit, radii),
        ..MeasuredItem::of(&campaign.shared, entry, fit.law.kind().name())
    }
}

/// Parameters of a fitted law with their uncertainties; held ones too.
pub fn parameters_of(fit: &CompressionFit) -> Named<MeasuredValue> {
    let values = fit.law.parameters();
    let parameters = fit.law.kind().describe().parameters.iter().enumerate();
    let value = |i: usize| match &fit.parameters[i] {
        Some(estimate) => measured(estimate, &fit.law.unit_of(i)),
        None => plain_value(values[i], &fit.law.unit_of(i)),
    };
    parameters
        .map(|(i, parameter)| (parameter.name, value(i)))
        .collect()
}

fn measured(estimate: &CompressionEstimate, unit: &str) -> MeasuredValue {
    let finite = |value: f64| value.is_finite().then_some(value);
    MeasuredValue {
        value: estimate.value,
        sd: finite(estimate.sd),
        low: finite(estimate.low),
        high: finite(estimate.high),
        unit: unit.to_owned(),
    }
}

fn curve_values(
    curve: &CompressionCurve,
    fit: &CompressionFit,
    part: &LoadingCurve,
) -> Named<MeasuredValue> {
    let touch = fit.touches[0].value;
    let mut values = Named::default();
    for (name, point) in [
        ("bioyield", &curve.bioyield),
        ("softening", &curve.softening),
        ("rupture", &curve.rupture),
    ] {
        if let Some(point) = point {
            let deformation = plain_value(point.deformation - touch, "m");
            values.push(format!("{name}_force"), plain_value(point.force, "N"));
            values.push(format!("{name}_deformation"), deformation);
        }
    }
    let end = &curve.loading_end;
    let deformed = end.deformation - touch;
    let mut push = |name: &str, value, unit| values.push(name, plain_value(value, unit));
    push("loading_force", end.force, "N");
    push("loading_deformation", deformed, "m");
    push("loading_energy", curve.energy, "J");
    if curve.bioyield.is_some() {
        push("energy_to_yield", curve.energy, "J");
    }
    let (stiffness, sd) = (curve.stiffness.value, curve.stiffness.sd);
    values.push("stiffness", value_with_sd(stiffness, sd, "N/m"));
    let mut push = |name: &str, value, unit| values.push(name, plain_value(value, unit));
    push("secant_stiffness", end.force / deformed, "N/m");
    let (rate, variation) = mean_and_variation(&part.rate);
    push("deformation_rate", rate, "m/s");
    push("rate_variation", variation, "1");
    push("fitted_force", part.force[part.force.len() - 1], "N");
    let fitted = part.deformation[part.deformation.len() - 1] - touch;
    push("fitted_deformation", fitted, "m");
    values.push("touch", measured(&fit.touches[0], "m"));
    values.push("residual_rms", plain_value(fit.rms, "N"));
    values.push("force_noise", plain_value(curve.force_noise, "N"));
    values
}

fn mean_and_variation(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    (mean, (squares / n).sqrt() / mean.abs())
}

/// Adds the apparent modulus and the radii it rests on, for laws of Hertz's contact.
fn push_modulus(
    values: &mut Named<MeasuredValue>,
    campaign: &CompressionCampaign,
    fit: &CompressionFit,
    radii: PrincipalRadii,
) {
    if fit.law.kind().describe().elastic != Elastic::Hertzian {
        return;
    }
    let contact = PressedContact {
        fruit: radii,
        indenter: campaign.indenter,
    };
    let per_modulus = stiffness_per_modulus(&vec![contact; campaign.plates]);
    let k = fit.law.parameters()[0];
    let sd = fit.parameters[0].map_or(0.0, |estimate| estimate.sd);
    let factor = (1.0 - campaign.poisson_ratio.powi(2)) / per_modulus;
    values.push(
        "apparent_modulus",
        value_with_sd(k * factor, sd * factor, "Pa"),
    );
    values.push("radius", plain_value(radii.first, "m"));
    values.push("radius_2", plain_value(radii.second, "m"));
}

fn findings(
    curve: &CompressionCurve,
    part: &LoadingCurve,
    fit: &CompressionFit,
    radii: Option<PrincipalRadii>,
) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    let mut tell = |code: &str, message: String| {
        findings.push(FindingOutcome::new(code, message));
    };
    if curve.began_in_contact {
        let touch = plain(1e3 * fit.touches[0].value);
        tell(
            "began_in_contact",
            format!(
                "force was there from the first sample on: the first touch is extrapolated by the law, to {touch} mm on the axis of deformation"
            ),
        );
    }
    match curve.ended_by {
        LoadingEnd::Reversal => tell("loading_reversed", format!(
            "the deformation decreased {} s after the first touch or sample, before any yield: unloading, or a controller that oscillates; what follows is not used",
            plain(curve.loading_end.time - curve.times[0])
        )),
        LoadingEnd::Hold => tell("loading_held", format!(
            "the position is held from {} s on and the force falls: loading ends there, before any yield; kind = \"relaxation\" in [rig] evaluates the hold",
            plain(curve.loading_end.time)
        )),
        LoadingEnd::RecordingEnd => tell("no_yield", "the recording ends before the force ceases to increase: there is no bioyield point in it".to_owned()),
        LoadingEnd::Rupture | LoadingEnd::Bioyield => {}
    }
    let noise = curve.force_noise.max(f64::MIN_POSITIVE);
    let part_of_force = fit.rms / part.force[part.force.len() - 1];
    if fit.rms > MISSES * noise && part_of_force > 0.002 {
        tell(
            "law_misses_curve",
            format!(
                "{} describes the curve to {} % of the force at the end of the fitted range, {} times the noise: its parameters are a compromise",
                fit.law.kind().name(),
                plain(100.0 * part_of_force),
                plain(fit.rms / noise)
            ),
        );
    }
    if !fit.converged {
        tell(
            "fit_not_converged",
            "the fit did not converge; its parameters are not to be used".to_owned(),
        );
    }
    let damping = fit.law.kind().describe().index_of("c");
    if let Some(c) = damping.and_then(|index| fit.parameters[index])
        && (c.low <= 0.0 || !c.sd.is_finite())
    {
        tell("damping_not_told", "the interval of the damping c holds zero: one rate of deformation does not tell it; compress the same fruit at several rates, or hold c".to_owned());
    }
    let (_, variation) = mean_and_variation(&part.rate);
    if variation > UNEVEN {
        tell(
            "rate_uneven",
            format!(
                "the rate of deformation varies by {} % over the fitted range; stiffness and modulus belong to no single rate",
                plain(100.0 * variation)
            ),
        );
    }
    if radii.is_none() {
        tell("radius_unknown", "no apparent modulus: specimens.csv has none of radius_mm, diameter_1_mm to diameter_3_mm, or chord_mm and sagitta_mm".to_owned());
    }
    findings
}

//! Calibration of a law on the recorded waveforms of the drops of a campaign.

use crate::calibrate::features::correlations;
use crate::calibrate::waveform_outcome::{
    WaveformDropOutcome, WaveformOutcome, WaveformParameter, WeakOutcome,
};
use crate::read::{DropCampaign, PlatePlan};
use windfall_contact::expression::LawExpression;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_drop_rig::rig::DropRig;
use windfall_drop_rig::waveform::{
    DropRecord, Estimate, Knowledge, RecordFit, WaveformFit, WaveformPlate, WaveformProblem,
    WaveformRig,
};
use windfall_drop_rig::waveform_fit::calibrate_waveform;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_measure::measured::MeasuredValue;
use windfall_signal::bounce::train::BounceTrain;
use windfall_signal::uncertain::Uncertain;
use windfall_tables::regress::findings::finding;

/// Samples before the first visible force that are used, for the plate delays it; s.
const LEAD: f64 = 2e-3;
/// Ringing is followed down to this part of the noise; 1.
const SILENCE: f64 = 0.3;
/// Without ringing: this many contact durations after the end; 1.
const AFTER: f64 = 0.5;
/// A misfit from here on is said; 1.
const MISFIT: f64 = 1.2;
/// A parameter less certain than this is said; 1.
const WEAK: f64 = 0.2;
/// Measured mass and velocity contradict the waveform at this many deviations; 1.
const DISAGREE: f64 = 4.0;

/// A drop with its recording.
#[derive(Clone, Debug)]
pub struct RecordedDrop {
    /// Id in impacts.csv.
    pub id: String,
    /// The fruit.
    pub specimen: String,
    /// Mass of the fruit; kg.
    pub mass: Uncertain,
    /// Drop height; m.
    pub height: Uncertain,
    /// Force and bounces.
    pub train: BounceTrain,
}

/// Calibrates a law on the waveforms of drops.
///
/// * `law`: at its start values, with the positions of its free parameters
/// * `rig`: where the search starts; what campaign.toml gives of the plate is
///   held, or known with its uncertainty, the rest is estimated
///
/// # Errors
/// No drop can be used, or the fit fails.
pub fn waveform_outcome(
    campaign: &DropCampaign,
    (law, free): (&Law, &[usize]),
    end: EndRule,
    rig: &DropRig,
    drops: &[RecordedDrop],
) -> Result<(WaveformOutcome, Vec<FindingOutcome>), Error> {
    let mut findings = Vec::new();
    let mut used = Vec::new();
    let mut records = Vec::new();
    for drop in drops {
        match record_of(campaign, drop) {
            Ok(record) => {
                used.push(drop);
                records.push(record);
            }
            Err(reason) => {
                let message = format!("{} is left out: {reason}", drop.id);
                findings.push(finding("waveform-left-out", message));
            }
        }
    }
    if records.is_empty() {
        let missing = "no drop has a waveform that can be fitted";
        let advice = "`windfall fit` says what is wrong with each recording";
        return Err(Error::not_known(&campaign.shared.title, missing, advice));
    }
    let problem = WaveformProblem {
        law: *law,
        free: free.to_vec(),
        end,
        rig: WaveformRig {
            gravity: campaign.rig.gravity,
            effective_mass_factor: Knowledge::Fixed(campaign.rig.effective_mass_factor),
            plate: rig.plate.map(|plate| plate_of(&campaign.rig.plate, plate)),
        },
        records,
    };
    let fit = calibrate_waveform(&problem).map_err(|source| {
        let subject = format!("waveforms of {} drops", used.len());
        Error::identify(subject, source)
    })?;
    findings.extend(said(&fit));
    let impacts = problem.records.iter().map(|r| r.windows.len());
    let drops = used.iter().zip(&fit.records);
    let outcome = WaveformOutcome {
        law: LawExpression::from(fit.law).to_string(),
        parameters: parameters(&fit),
        covariance: fit.covariance.clone(),
        logarithmic: fit.logarithmic.clone(),
        correlations: correlations(fit.covariance.len(), |i, j| fit.covariance[i][j]),
        weakest: fit.weakest.as_ref().map(|weak| {
            let shares = fit.names.iter().cloned().zip(weak.shares.iter().copied());
            WeakOutcome {
                sd: weak.sd,
                shares: shares.collect(),
            }
        }),
        by_scatter: fit.by_records,
        misfit: fit.misfit,
        samples: fit.samples,
        impacts: impacts.sum(),
        drops: drops
            .map(|(drop, record)| drop_outcome(drop, record))
            .collect(),
        converged: fit.converged,
        evaluations: fit.evaluations,
    };
    findings.extend(of_drops(campaign, &used, &fit));
    Ok((outcome, findings))
}

/// What campaign.toml knows of the plate; the start of the rest.
fn plate_of(plan: &PlatePlan, start: windfall_drop_rig::rig::Plate) -> WaveformPlate {
    let known = |value: Option<Uncertain>, start: f64| {
        value.map_or(Knowledge::Free(start), Knowledge::measured)
    };
    match *plan {
        PlatePlan::Sprung {
            mass,
            stiffness,
            damping,
        } => WaveformPlate {
            mass: Knowledge::measured(mass),
            stiffness: known(stiffness, start.stiffness),
            damping: known(damping, start.damping),
        },
        PlatePlan::Rigid => WaveformPlate {
            mass: Knowledge::Fixed(start.mass),
            stiffness: Knowledge::Fixed(start.stiffness),
            damping: Knowledge::Fixed(start.damping),
        },
    }
}

/// A drop as the fit takes it, or why it cannot be taken.
fn record_of(campaign: &DropCampaign, drop: &RecordedDrop) -> Result<DropRecord, String> {
    let train = &drop.train;
    let bounces = train.bounces.iter();
    let usable = bounces.take_while(|bounce| bounce.complete && !bounce.clipped);
    let used = usable.count().min(campaign.calibrate.bounces);
    if used == 0 {
        return Err(match train.bounces.first() {
            None => "it has no bounce".to_owned(),
            Some(first) if first.clipped => "its first peak is clipped".to_owned(),
            Some(_) => "its first contact is not recorded whole".to_owned(),
        });
    }
    let decay = train.ringing.as_ref().map(|ringing| {
        let ratio = ringing.damping_ratio.value;
        let damped = std::f64::consts::TAU / ringing.period.value;
        damped * ratio / (1.0 - ratio * ratio).max(f64::MIN_POSITIVE).sqrt()
    });
    let windows = (0..used).map(|i| {
        let bounce = &train.bounces[i];
        let heard = match decay {
            Some(decay) => (bounce.peak.abs() / (SILENCE * train.noise)).ln().max(0.0) / decay,
            None => AFTER * (bounce.end.value - bounce.onset.value),
        };
        let next = train.bounces.get(i + 1);
        let last = next.map_or(f64::INFINITY, |next| next.onset.value - LEAD);
        let from = bounce.onset.value - LEAD;
        (from, (bounce.end.value + heard).min(last))
    });
    let onsets = train.bounces[..used].iter().map(|b| b.onset.value);
    Ok(DropRecord {
        windows: windows.collect(),
        onsets: onsets.collect(),
        times: train.times.clone(),
        force: train.force.clone(),
        noise: train.noise,
        velocity: Knowledge::measured(touch_velocity(campaign, drop)),
        mass: Knowledge::measured(drop.mass),
    })
}

/// Velocity at first touch by the drop height, v = √(2 g h); m/s.
fn touch_velocity(campaign: &DropCampaign, drop: &RecordedDrop) -> Uncertain {
    let value = (2.0 * campaign.rig.gravity * drop.height.value).sqrt();
    let sd = 0.5 * value * drop.height.sd / drop.height.value;
    Uncertain { value, sd }
}

fn parameters(fit: &WaveformFit) -> Vec<WaveformParameter> {
    let units = |name: &str, place: usize| match name {
        "plate_stiffness" => "N/m".to_owned(),
        "plate_damping" => "N s/m".to_owned(),
        "plate_mass" => "kg".to_owned(),
        "effective_mass_factor" => "1".to_owned(),
        _ => fit.law.unit_of(place),
    };
    let description = fit.law.kind().describe();
    let rows = fit.names.iter().zip(&fit.estimates).enumerate();
    rows.map(|(i, (name, estimate))| {
        let place = description.index_of(name).unwrap_or(0);
        WaveformParameter {
            name: name.clone(),
            value: measured(estimate, &units(name, place)),
            sd_of_noise: match fit.logarithmic[i] {
                true => fit.sd_of_noise[i] * estimate.value,
                false => fit.sd_of_noise[i],
            },
            per_millimetre: per_millimetre(fit, i),
        }
    })
    .collect()
}

/// A stiffness "N/m^e" with its exponent e in "N/mm^e", which is less tied to it.
fn per_millimetre(fit: &WaveformFit, index: usize) -> Option<MeasuredValue> {
    let description = fit.law.kind().describe();
    let place = description.index_of(&fit.names[index])?;
    let unit = description.parameters[place].unit;
    let exponent = description
        .parameters
        .iter()
        .position(|parameter| unit == format!("N/m^{}", parameter.name))?;
    let name = description.parameters[exponent].name;
    let value = fit.law.parameters()[exponent];
    let scale = 1e-3f64.ln();
    let mut variance = fit.covariance[index][index];
    if let Some(free) = fit.names.iter().position(|known| known == name) {
        let (both, own) = (fit.covariance[index][free], fit.covariance[free][free]);
        variance += 2.0 * scale * both + scale * scale * own;
    }
    let number = fit.estimates[index].value * (scale * value).exp();
    let sd = variance.max(0.0).sqrt();
    let estimate = &fit.estimates[index];
    // The quantile that the interval was made with.
    let own = fit.covariance[index][index].sqrt();
    let quantile = (estimate.high / estimate.value).ln() / own;
    Some(MeasuredValue {
        value: number,
        sd: Some(number * sd),
        low: Some(number * (-quantile * sd).exp()),
        high: Some(number * (quantile * sd).exp()),
        unit: format!("N/mm^{name}"),
    })
}

fn measured(estimate: &Estimate, unit: &str) -> MeasuredValue {
    MeasuredValue {
        value: estimate.value,
        sd: Some(estimate.sd),
        low: Some(estimate.low),
        high: Some(estimate.high),
        unit: unit.to_owned(),
    }
}

fn drop_outcome(drop: &RecordedDrop, record: &RecordFit) -> WaveformDropOutcome {
    WaveformDropOutcome {
        id: drop.id.clone(),
        specimen: drop.specimen.clone(),
        height: drop.height.value,
        onset: measured(&record.onset, "s"),
        velocity: measured(&record.velocity, "m/s"),
        mass: measured(&record.mass, "kg"),
        level: measured(&record.level, "N"),
        misfit: record.misfit,
        samples: record.samples,
    }
}

/// What a reader of the estimates must know.
fn said(fit: &WaveformFit) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    if !fit.converged {
        let message =
            "the search gave up before the minimum: give [calibrate] start, or hold a parameter";
        findings.push(finding("waveform-not-converged", message.to_owned()));
    }
    if fit.misfit > MISFIT {
        let message = format!(
            "chi-square is {:.1} times the number of samples: beyond the noise, law and rig do not \
             follow the waveforms; uncertainties are widened by {:.1}, which is no more than a \
             stopgap. Look at the residuals: another law, an effective mass factor, or fruit that \
             differ",
            fit.misfit,
            fit.misfit.sqrt()
        );
        findings.push(finding("waveform-misfit", message));
    }
    if fit.by_records {
        let message = "the drops differ by more than noise: uncertainties are those of the scatter \
                       from drop to drop, and the law is that of their mean";
        findings.push(finding("waveform-drops-differ", message.to_owned()));
    }
    if let Some(weak) = fit.weakest.as_ref().filter(|weak| weak.sd > WEAK) {
        let shares = fit.names.iter().zip(&weak.shares);
        let large = shares.filter(|(_, share)| share.abs() > 0.1);
        let parts: Vec<_> = large
            .map(|(name, share)| format!("{share:+.2} {name}"))
            .collect();
        let message = format!(
            "these drops hardly tell the combination {} (standard uncertainty {:.2}): drops from \
             another height, a heavier fruit or a prior tell more",
            parts.join(" "),
            weak.sd
        );
        findings.push(finding("waveform-weak", message));
    }
    findings
}

/// Drops whose waveform contradicts what was measured of them.
fn of_drops(
    campaign: &DropCampaign,
    drops: &[&RecordedDrop],
    fit: &WaveformFit,
) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    for (drop, record) in drops.iter().zip(&fit.records) {
        let touch = touch_velocity(campaign, drop);
        for (what, given, unit, known, estimate) in [
            (
                "velocity at first touch",
                "the height",
                "m/s",
                touch,
                &record.velocity,
            ),
            ("mass", "the mass", "kg", drop.mass, &record.mass),
        ] {
            let (value, sd, found) = (known.value, known.sd, estimate.value);
            if sd > 0.0 && (found - value).abs() > DISAGREE * sd {
                let message = format!(
                    "{}: its {what} is {value:.4} {unit} ± {sd:.4} as measured, but {found:.4} \
                     {unit} by its waveform: volts per newton, {given} or the law is wrong",
                    drop.id
                );
                findings.push(finding("waveform-contradicts", message));
            }
        }
    }
    findings
}

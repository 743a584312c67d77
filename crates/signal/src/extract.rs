//! Recording → Impact.

use crate::choose::choose;
use crate::clipping::clipped_channels;
use crate::compare::compare;
use crate::conditioning::add_tip_force;
use crate::error::Error;
use crate::finding::Finding;
use crate::flight::margins;
use crate::found::{Found, found};
use crate::impact::{Impact, Measured, Series};
use crate::jump::jump;
use crate::kinematics::{Motion, smoothing_window};
use crate::measure::{
    Side, Surroundings, Velocity, free_velocity, impulse, largest_displacement,
    largest_displacement_sd, with_energies,
};
use crate::noise_track::{baseline_persistence, force_noise, noise_of};
use crate::options::{ExtractOptions, RateMethod};
use crate::orient::{
    leave_out_glitches, mean_between, offset_sd, orient, oriented_displacement, oriented_force,
};
use crate::polynomial::{PolynomialFit, fit_polynomial, local_polynomial};
use crate::rate::derived_rate;
use crate::recording::Recording;
use crate::touch::Touch;
use crate::track::{Signals, Track, Tracks, mean_interval};
use crate::trigger::scale::{index_of_largest, moving_mean};
use crate::trigger::{Baseline, ContactChoice, Contacts, Threshold};
use crate::uncertain::{Uncertain, sd_of_largest};

/// Fewer samples in contact than this are reported.
const FEW_SAMPLES: usize = 8;
/// A threshold above this part of the largest force is told; 1.
const HIGH_THRESHOLD: f64 = 0.2;
/// Noise below this part of the largest force leaves its peak alone; 1.
const CLEAN_PEAK: f64 = 0.01;
/// Order of the local polynomial that a noisy peak is read from.
const PEAK_ORDER: usize = 2;

/// Cuts one impact out of a recording.
///
/// The contact window comes from the force ([`crate::trigger::find_contacts`]); without a force
/// channel from the deceleration, measured or by differences of block means of
/// displacement or rate. The displacement is zeroed at onset, by interpolation
/// between samples, and positive into the fruit; the force is repulsive, less
/// its mean before contact. Each channel keeps its own sampling times.
///
/// # Errors
/// [`Error::MissingChannel`] without anything to find a contact in,
/// [`Error::NoContact`], [`Error::NotFinite`], [`Error::TimeNotIncreasing`] and
/// the others of [`Error`].
pub fn extract_impact(
    recording: &Recording,
    options: &ExtractOptions,
) -> Result<(Impact, Vec<Finding>), Error> {
    let mut findings = Vec::new();
    let Found {
        tracks,
        contacts,
        turns,
        from_motion,
    } = found(recording, options, &mut findings)?;

    // The contact, and the free motion around it.
    let place = choose(&contacts, &turns, options, from_motion, &mut findings)?;
    missing_samples(recording, &place, &mut findings)?;
    findings.extend(clipped_channels(recording, (place.onset, place.end)));

    // Signs, zeros and noise; then what they say, and the rate to be fitted.
    let mut signals = oriented(tracks, &contacts, &place, options, &mut findings);
    if let (Some(force), Some(tip)) = (&mut signals.force, options.conditioning.tip_mass) {
        let masses = (tip, options.effective_mass);
        let acceleration = signals.acceleration.as_ref();
        add_tip_force(force, acceleration, &place, masses, &mut findings)?;
    }
    findings.extend(high_threshold(&signals, &contacts, &place, options));
    let measured = measure(&signals, &contacts, &place, options);
    let measured = compare(measured, &signals, &place, options, &mut findings);
    let measured_rate = signals.rate.is_some();
    signals.rate = rate(&mut signals, options, &place, &mut findings);

    let margins = margins(&signals, &measured, &place, options, &mut findings);
    let short = [options.margin_before, options.margin_after].map(|own| own * place.duration());
    let used = (place.onset - margins[0], place.end + margins[1]);
    let lost = |own| jump(own, used, place.duration());
    findings.extend(signals.displacement.iter().find_map(lost));
    let cut = |track: Option<Track>, kept: [f64; 2]| {
        track.and_then(|track| series(&track, &place, kept, options))
    };
    let removed = options.trigger.baseline != Baseline::Keep;
    let force = cut(signals.force, short).map(|series| Series {
        zero_sd: if removed {
            offset_sd(&contacts, series.persistence)
        } else {
            0.0
        },
        ..series
    });
    let impact = Impact {
        displacement: cut(signals.displacement, margins),
        rate: cut(signals.rate, margins).map(|series| Series {
            derived: !keeps_measured(options, measured_rate),
            ..series
        }),
        force,
        acceleration: cut(signals.acceleration, short),
        onset: place.onset,
        end: place.end,
        measured,
    };
    Ok((impact, findings))
}

/// Reports samples that are missing outside of the contact, and what was assumed of others.
///
/// # Errors
/// [`Error::MissingInContact`]: also next to it, where the first or last sample of the
/// contact would be.
fn missing_samples(
    recording: &Recording,
    place: &Surroundings,
    findings: &mut Vec<Finding>,
) -> Result<(), Error> {
    for missing in &recording.missing {
        let channel = recording
            .channels
            .iter()
            .find(|c| c.name == missing.channel);
        let times = || {
            channel
                .iter()
                .flat_map(|c| (0..c.samples.len()).map(|i| c.times.at(i)))
        };
        let before = times().take_while(|time| *time < place.onset).last();
        let after = times().find(|time| *time > place.end);
        let from = before.unwrap_or(f64::NEG_INFINITY);
        let until = after.unwrap_or(f64::INFINITY);
        let mut inside = missing
            .times
            .iter()
            .filter(|&&time| from < time && time < until);
        if let Some(&at) = inside.next() {
            return Err(Error::MissingInContact {
                channel: missing.channel.clone(),
                samples: 1 + inside.count(),
                onset: place.onset,
                end: place.end,
                at,
                first: missing.first.clone(),
            });
        }
        findings.extend(missing.times.first().map(|&at| Finding::MissingSamples {
            channel: missing.channel.clone(),
            samples: missing.times.len(),
            at,
            first: missing.first.clone(),
        }));
    }
    let doubts = recording.doubts.iter().cloned();
    findings.extend(doubts.map(|doubt| Finding::DecimalOrThousands { doubt }));
    Ok(())
}

fn oriented(
    tracks: Tracks,
    contacts: &Contacts,
    place: &Surroundings,
    options: &ExtractOptions,
    findings: &mut Vec<Finding>,
) -> Signals {
    let force = tracks.force.map(|track| {
        let mut track = oriented_force(track, contacts, options, findings);
        track.noise = force_noise(&track, contacts, place, findings);
        track.persistence = baseline_persistence(&track, contacts);
        track
    });
    let displacement = tracks.position.map(|position| {
        let mut track = oriented_displacement(position, place, options, findings);
        leave_out_glitches(&mut track, Motion::Displacement, place, options, findings);
        track.noise = noise_of(&track, place, findings);
        track
    });
    let rate = tracks.rate.map(|mut track| {
        // Just before contact it moves towards the fruit.
        let wrong = mean_between(&track, place.onset - 0.2 * place.duration(), place.onset) < 0.0;
        orient(&mut track, wrong, options, findings);
        leave_out_glitches(&mut track, Motion::Rate, place, options, findings);
        track.noise = noise_of(&track, place, findings);
        track
    });
    let acceleration = tracks.acceleration.map(|mut track| {
        // In contact it is pushed away from the fruit.
        let wrong = mean_between(&track, place.onset, place.end) > 0.0;
        orient(&mut track, wrong, options, findings);
        track.noise = noise_of(&track, place, findings);
        track
    });
    for track in [&displacement, &rate, &force, &acceleration]
        .into_iter()
        .flatten()
    {
        findings.extend(few_samples(track, place));
    }
    Signals {
        displacement,
        rate,
        force,
        acceleration,
    }
}

/// The rate to be fitted: measured, or derived from the displacement.
fn rate(
    signals: &mut Signals,
    options: &ExtractOptions,
    place: &Surroundings,
    findings: &mut Vec<Finding>,
) -> Option<Track> {
    let measured = signals.rate.take();
    if keeps_measured(options, measured.is_some()) {
        return measured;
    }
    let mut track = derived_rate(signals.displacement.as_ref()?, options, place)?;
    track.noise = noise_of(&track, place, findings);
    Some(track)
}

/// Whether the rate to be fitted is the measured one.
fn keeps_measured(options: &ExtractOptions, measured: bool) -> bool {
    match options.rate {
        RateMethod::Measured => true,
        RateMethod::Automatic => measured,
        RateMethod::CentralDifference
        | RateMethod::SmoothingSpline
        | RateMethod::EdgeTimes
        | RateMethod::LocalPolynomial { .. } => false,
    }
}

fn measure(
    signals: &Signals,
    contacts: &Contacts,
    place: &Surroundings,
    options: &ExtractOptions,
) -> Measured {
    let window = contacts.windows.iter().find(|w| w.onset == place.onset);
    let onset_seen = window.is_some_and(|w| w.onset_seen);
    let end_seen = window.is_some_and(|w| w.end_seen);
    let whole = onset_seen && end_seen;

    let before = velocity(signals, place, Side::Before, options).filter(|_| onset_seen);
    let after = velocity(signals, place, Side::After, options).filter(|_| end_seen);
    let rebound = after.map(|v| -v.value);
    let touch = window.map(|w| Touch::new(contacts.threshold, w.peak, place));
    let change = before.zip(rebound).map(|(v, r)| v.value + r);
    let impulse = signals.force.as_ref().filter(|_| whole).and_then(|track| {
        let zero_sd = offset_sd(contacts, track.persistence);
        impulse(&track.times, &track.values, track.noise, zero_sd, place)
    });
    let force = signals.force.as_ref();
    let peak = force.and_then(|track| {
        let zero_sd = offset_sd(contacts, track.persistence);
        peak_force(track, place, zero_sd)
    });
    let crossings = force.map(|track| crossings_sd(track, contacts, place));
    let measured = Measured {
        impact_velocity: before.map(|v| v.value),
        rebound_velocity: rebound,
        restitution: before.zip(rebound).map(|(v, r)| r / v.value),
        contact_duration: whole.then(|| place.duration()),
        peak_force: peak.map(|own| own.value),
        peak_force_sd: peak.map(|own| own.sd),
        contact_duration_sd: crossings.filter(|_| whole).map(|[on, off]| on.hypot(off)),
        max_displacement_sd: signals.displacement.as_ref().and_then(|track| {
            let onset = before.map_or(0.0, |v| v.value.abs()) * crossings?[0];
            let samples = (&track.times[..], &track.values[..]);
            largest_displacement_sd(samples, track.noise, onset, place)
        }),
        max_displacement: signals
            .displacement
            .as_ref()
            .and_then(|track| largest_displacement(&track.times, &track.values, place)),
        impulse: impulse.map(|j| j.0),
        resolution: resolution(signals, place, before.map(|v| v.value)),
        impact_velocity_sd: before.map(|v| v.sd),
        rebound_velocity_sd: after.map(|v| v.sd),
        touch_velocity_sd: touch
            .zip(change)
            .map(|(touch, change)| touch.velocity_sd(change, options.driving_acceleration)),
        impulse_sd: impulse.map(|j| j.1),
        ..Measured::default()
    };
    match options.effective_mass {
        Some(mass) => with_energies(measured, mass),
        None => measured,
    }
}

/// Longest time between samples or counts, over the contact's duration.
fn resolution(signals: &Signals, place: &Surroundings, velocity: Option<f64>) -> Option<f64> {
    let tracks = [
        &signals.force,
        &signals.displacement,
        &signals.rate,
        &signals.acceleration,
    ];
    let between = tracks
        .into_iter()
        .flatten()
        .map(|track| mean_interval(&track.times));
    let counted = signals
        .displacement
        .as_ref()
        .and_then(|track| track.quantum);
    let count = counted
        .zip(velocity)
        .map(|(quantum, velocity)| quantum / velocity.abs());
    let longest = between.chain(count).reduce(f64::max)?;
    Some(longest / place.duration())
}

/// Velocity next to the contact, from displacement or else from a measured rate.
fn velocity(
    signals: &Signals,
    place: &Surroundings,
    side: Side,
    options: &ExtractOptions,
) -> Option<Velocity> {
    let from = |track: &Option<Track>, motion| {
        let track = track.as_ref()?;
        let samples = (&track.times[..], &track.values[..], motion);
        free_velocity(
            samples,
            track.noise,
            place,
            side,
            options.driving_acceleration,
        )
    };
    from(&signals.displacement, Motion::Displacement).or_else(|| from(&signals.rate, Motion::Rate))
}

/// Largest force of the contact; with much noise, that of a local quadratic over a
/// tenth of the contact.
///
/// * `zero_sd`: standard uncertainty of the zero; N
fn peak_force(track: &Track, place: &Surroundings, zero_sd: f64) -> Option<Uncertain> {
    let first = track.times.partition_point(|&t| t < place.onset);
    let last = track.times.partition_point(|&t| t <= place.end);
    let (times, values) = (&track.times[first..last], &track.values[first..last]);
    let top = index_of_largest(values, |v| v);
    let largest = *values.get(top)?;
    // The top of the signal without its noise.
    let window = smoothing_window(place.duration(), mean_interval(times));
    let from = top.saturating_sub(window / 2);
    let to = (top + window / 2 + 1).min(times.len());
    let fit = fit_polynomial(&times[from..to], &values[from..to], times[top], PEAK_ORDER);
    let level = |fit: &PolynomialFit| {
        let d = &fit.derivatives;
        let at = |t: &f64| d[0] + (t - times[top]) * (d[1] + 0.5 * d[2] * (t - times[top]));
        times[from..to].iter().map(at).collect::<Vec<_>>()
    };
    let single = || {
        let of_noise = fit.as_ref();
        let of_noise = of_noise.map_or(track.noise, |fit| sd_of_largest(&level(fit), track.noise));
        Uncertain::new(largest, of_noise.hypot(zero_sd))
    };
    if track.noise <= CLEAN_PEAK * largest {
        return Some(single());
    }
    let smooth = local_polynomial(times, values, window, PEAK_ORDER, 0);
    let smooth = smooth.and_then(|values| values.into_iter().reduce(f64::max));
    // Quadratics half a window apart hardly share their noise, and compete likewise.
    let of_smooth = fit.as_ref().map_or(track.noise, |fit| {
        let all = level(fit);
        let apart: Vec<f64> = [0, all.len() / 2, all.len() - 1].map(|i| all[i]).to_vec();
        sd_of_largest(&apart, fit.noise_gains[0] * track.noise)
    });
    let smooth = smooth.map(|value| Uncertain::new(value, of_smooth.hypot(zero_sd)));
    Some(smooth.unwrap_or_else(single))
}

/// Standard uncertainties of onset and end: what noise of the averaged force does to the
/// crossings of the threshold; s.
fn crossings_sd(track: &Track, contacts: &Contacts, place: &Surroundings) -> [f64; 2] {
    let averaged = moving_mean(&track.values, contacts.smoothing);
    let noise = track.noise / (contacts.smoothing as f64).sqrt();
    let reach = contacts.smoothing / 2;
    [place.onset, place.end].map(|crossing| {
        let after = track.times.partition_point(|&t| t < crossing);
        let last = (after + reach).min(averaged.len() - 1);
        let first = after.saturating_sub(reach + 1);
        let rise = (averaged[last] - averaged[first]).abs();
        let time = track.times[last] - track.times[first];
        match rise > noise {
            true => noise * time / rise,
            // The force hardly rises there: anywhere in between.
            false => time,
        }
    })
}

/// A threshold that leaves much of the contact out.
fn high_threshold(
    signals: &Signals,
    contacts: &Contacts,
    place: &Surroundings,
    options: &ExtractOptions,
) -> Option<Finding> {
    let window = contacts.windows.iter().find(|w| w.onset == place.onset)?;
    let share = contacts.threshold / window.peak;
    let channel = &signals.force.as_ref()?.name;
    (share > HIGH_THRESHOLD).then(|| Finding::HighThreshold {
        channel: channel.clone(),
        threshold: contacts.threshold,
        share,
        cure: match options.trigger.threshold {
            Threshold::Fixed(_) => "Lower `threshold` in [contact], or leave it to the noise",
            Threshold::Automatic { .. } => "The noise requires it: check cable and amplifier",
        },
    })
}

fn few_samples(track: &Track, place: &Surroundings) -> Option<Finding> {
    let onset = track.times.partition_point(|&t| t < place.onset);
    let end = track.times.partition_point(|&t| t <= place.end);
    (end - onset < FEW_SAMPLES).then(|| Finding::FewSamples {
        channel: track.name.clone(),
        samples: end - onset,
    })
}

/// The samples around the contact; `None` if there is none.
///
/// * `kept`: before and after it; s
fn series(
    track: &Track,
    place: &Surroundings,
    [before, after]: [f64; 2],
    options: &ExtractOptions,
) -> Option<Series> {
    let times = &track.times;
    let from = place.onset - before.max(options.pre_trigger);
    let until = place.end + after.max(options.post_trigger);
    let onset = times.partition_point(|&t| t < place.onset);
    let end = times.partition_point(|&t| t <= place.end);
    let first = times
        .partition_point(|&t| t < from)
        .min(onset.saturating_sub(options.margin_samples))
        .max(times.partition_point(|&t| t <= place.from));
    let last = times
        .partition_point(|&t| t <= until)
        .max(end + options.margin_samples)
        .min(times.partition_point(|&t| t < place.until));
    let (first, last) = match options.trigger.choice {
        ContactChoice::Within { from, to } => (
            first.max(times.partition_point(|&t| t < from)),
            last.min(times.partition_point(|&t| t <= to)),
        ),
        ContactChoice::First | ContactChoice::Strongest => (first, last),
    };
    (first < last).then(|| Series {
        times: times[first..last].to_vec(),
        values: track.values[first..last].to_vec(),
        noise: track.noise,
        zero_sd: 0.0,
        persistence: track.persistence,
        quantum: track.quantum,
        derived: false,
    })
}

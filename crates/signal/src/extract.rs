//! Recording → Impact.

use crate::clipping::clipping;
use crate::deceleration::deceleration;
use crate::error::{Error, Times};
use crate::finding::Finding;
use crate::impact::{Impact, Measured, Series};
use crate::kinematics::{
    Encoder, Motion, central_difference, displacement_from_angles, rate_quantum, smoothing_window,
    value_at,
};
use crate::measure::{
    Side, Surroundings, free_velocity, impulse, largest_displacement, with_energies,
};
use crate::noise::{Noise, NoiseSource, RELATIVE_FLOOR, combined_noise, scatter_about_polynomial};
use crate::polynomial::{evenly_spaced, local_polynomial};
use crate::quadrature::IllegalTransition;
use crate::recording::Recording;
use crate::track::{Geometry, Position, Track, Tracks, missing, tracks};
use crate::trigger::{
    Baseline, Contacts, Orientation, Signal, Threshold, TriggerOptions, find_contacts,
};

/// Fewer samples in contact than this are reported.
const FEW_SAMPLES: usize = 8;

/// Fewer samples before contact than this are reported.
const SHORT_BASELINE: usize = 5;

/// An offset is reported if it exceeds this part of the peak force; 1.
const OFFSET_SHARE: f64 = 0.01;

/// Samples of a block within which a signal is taken as a parabola plus noise.
const NOISE_BLOCK: usize = 8;

/// Blocks that a contact must hold to find the noise within it.
const NOISE_BLOCKS: usize = 10;

/// How the series of the displacement rate is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RateMethod {
    /// The measured channel if there is one, else the central difference of the
    /// displacement if that is sampled evenly, else none.
    #[default]
    Automatic,
    /// The measured channel or none.
    Measured,
    /// The central difference of the displacement, even if a channel was measured.
    CentralDifference,
    /// The derivative of local polynomials (Savitzky-Golay) of the displacement.
    /// Smooth, for display; neighbouring samples share their noise.
    LocalPolynomial {
        /// Order of the polynomial, 1 to 4; 2 or 3 are usual.
        order: usize,
        /// Odd number of samples; `None`: about a tenth of the contact.
        window: Option<usize>,
    },
}

/// How an impact is cut out of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtractOptions {
    /// Contact window.
    pub trigger: TriggerOptions,
    /// What is done about a channel of the wrong sign.
    pub orientation: Orientation,
    /// What is kept before onset, as a part of the contact's duration; 1.
    pub margin_before: f64,
    /// What is kept after the end, as a part of the contact's duration; 1.
    pub margin_after: f64,
    /// Samples kept at least on either side, where the recording has them.
    pub margin_samples: usize,
    /// The encoder, if there are phases or counts.
    pub encoder: Option<Encoder>,
    /// What an illegal transition of the encoder adds.
    pub illegal: IllegalTransition,
    /// Length of the arm, if an angle is measured; m.
    pub arm: Option<f64>,
    /// How the series of the displacement rate is made.
    pub rate: RateMethod,
    /// Mass that the contact feels, for the energies; kg.
    pub effective_mass: Option<f64>,
    /// Acceleration of the free impactor, positive into the fruit; m/s².
    pub driving_acceleration: f64,
}

impl Default for ExtractOptions {
    fn default() -> Self {
        Self {
            trigger: TriggerOptions::default(),
            orientation: Orientation::default(),
            margin_before: 0.2,
            margin_after: 0.2,
            margin_samples: 3,
            encoder: None,
            illegal: IllegalTransition::default(),
            arm: None,
            rate: RateMethod::default(),
            effective_mass: None,
            driving_acceleration: 0.0,
        }
    }
}

/// Cuts one impact out of a recording.
///
/// The contact window comes from the force ([`find_contacts`]); without a force
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
    check_options(options)?;
    let mut findings = Vec::new();
    let geometry = Geometry {
        encoder: options.encoder,
        arm: options.arm,
        illegal: options.illegal,
    };
    let mut tracks = tracks(recording, &geometry, &mut findings)?;

    // The contact, and the free motion around it.
    let (contacts, resolution) = contacts(recording, &tracks, options)?;
    let place = choose(&contacts, options, resolution, &mut findings)?;

    // Signs and zeros of the convention.
    let force = tracks.force.take().map(|track| {
        let window = (place.onset, place.end);
        findings.extend(clipping(
            &track.name,
            &track.times,
            &track.values,
            window,
            contacts.reversed,
        ));
        oriented_force(track, &contacts, options, &mut findings)
    });
    let displacement = tracks
        .position
        .take()
        .map(|position| oriented_displacement(position, &place, options, &mut findings));
    let measured_rate = tracks.rate.take().map(|mut track| {
        let wrong = mean_between(&track, place.onset - 0.2 * place.duration(), place.onset) < 0.0;
        orient(&mut track, wrong, options, &mut findings);
        track
    });
    let acceleration = tracks.acceleration.take().map(|mut track| {
        let wrong = mean_between(&track, place.onset, place.end) > 0.0;
        orient(&mut track, wrong, options, &mut findings);
        track
    });
    for track in [&displacement, &measured_rate, &force, &acceleration]
        .into_iter()
        .flatten()
    {
        findings.extend(few_samples(track, &place));
    }
    let noises = Noises {
        displacement: displacement
            .as_ref()
            .map(|t| noise_of(t, &place, &mut findings)),
        rate: measured_rate
            .as_ref()
            .map(|t| noise_of(t, &place, &mut findings)),
        force: force
            .as_ref()
            .map(|t| force_noise(t, &contacts, &place, &mut findings)),
    };

    let measured = measure(
        displacement.as_ref(),
        measured_rate.as_ref(),
        force.as_ref(),
        &noises,
        &contacts,
        &place,
        options,
    );

    let (rate, rate_noise) = rate(
        displacement.as_ref(),
        measured_rate,
        &noises,
        &place,
        options,
        &mut findings,
    );
    let acceleration_noise = acceleration
        .as_ref()
        .map(|t| noise_of(t, &place, &mut findings));
    let cut = |track: Option<Track>, noise: Option<f64>| {
        track.and_then(|track| series(&track, noise?, &place, options))
    };
    let impact = Impact {
        displacement: cut(displacement, noises.displacement),
        rate: cut(rate, rate_noise),
        force: cut(force, noises.force),
        acceleration: cut(acceleration, acceleration_noise),
        onset: place.onset,
        end: place.end,
        measured,
    };
    Ok((impact, findings))
}

struct Noises {
    displacement: Option<f64>,
    rate: Option<f64>,
    force: Option<f64>,
}

fn check_options(options: &ExtractOptions) -> Result<(), Error> {
    let bad = |option, value, expected| {
        Err(Error::BadOption {
            option,
            value,
            expected,
        })
    };
    for (option, margin) in [
        ("margin before contact", options.margin_before),
        ("margin after contact", options.margin_after),
    ] {
        if !(margin >= 0.0 && margin.is_finite()) {
            return bad(
                option,
                margin,
                "a part of the contact's duration, 0 or more",
            );
        }
    }
    if let Some(mass) = options.effective_mass
        && !(mass > 0.0 && mass.is_finite())
    {
        return bad("effective mass", mass, "a positive mass");
    }
    if !options.driving_acceleration.is_finite() {
        return bad(
            "driving acceleration",
            options.driving_acceleration,
            "a finite number",
        );
    }
    if let RateMethod::LocalPolynomial { order, window } = options.rate {
        if !(1..=4).contains(&order) {
            return bad("order of the rate's polynomial", order as f64, "1 to 4");
        }
        if let Some(window) = window
            && (window % 2 == 0 || window <= order)
        {
            return bad(
                "window of the rate's polynomial",
                window as f64,
                "an odd number above the order",
            );
        }
    }
    Ok(())
}

/// Contacts from the force, else from the deceleration, with its resolution.
fn contacts(
    recording: &Recording,
    tracks: &Tracks,
    options: &ExtractOptions,
) -> Result<(Contacts, Option<Finding>), Error> {
    if let Some(force) = &tracks.force {
        let signal = signal(force, "N", &force.times, &force.values);
        return Ok((find_contacts(&signal, &options.trigger)?, None));
    }
    // A threshold in newtons means nothing to a deceleration; a tenth of the
    // largest stays above what the differences smear before the onset.
    let trigger = TriggerOptions {
        threshold: Threshold::Automatic {
            deviations: 5.0,
            least: 0.0,
            share: 0.1,
        },
        baseline: Baseline::Remove,
        ..options.trigger
    };
    if let Some(track) = &tracks.acceleration {
        let values: Vec<f64> = track.values.iter().map(|a| -a).collect();
        let found = find_contacts(&signal(track, "m/s²", &track.times, &values), &trigger)?;
        let interval = mean_interval(&track.times);
        return Ok((found, Some(window_finding(track, interval))));
    }
    let (track, motion) = match (&tracks.position, &tracks.rate) {
        (Some(position), _) => (&position.track, Motion::Displacement),
        (None, Some(rate)) => (rate, Motion::Rate),
        (None, None) => {
            return Err(missing(
                recording,
                "force, acceleration, displacement or displacement rate",
            ));
        }
    };
    let scale = tracks.position.as_ref().and_then(|p| p.arm).unwrap_or(1.0);
    let values: Vec<f64> = track.values.iter().map(|v| v * scale).collect();
    let found =
        deceleration(&track.times, &values, motion).ok_or_else(|| Error::TooFewSamples {
            channel: track.name.clone(),
            samples: track.values.len(),
            least: 3,
        })?;
    let contacts = find_contacts(
        &signal(track, "m/s²", &found.times, &found.values),
        &trigger,
    )?;
    Ok((contacts, Some(window_finding(track, found.resolution))))
}

fn signal<'a>(
    track: &'a Track,
    unit: &'static str,
    times: &'a [f64],
    values: &'a [f64],
) -> Signal<'a> {
    Signal {
        name: &track.name,
        unit,
        times,
        values,
    }
}

fn window_finding(track: &Track, resolution: f64) -> Finding {
    Finding::WindowFromMotion {
        channel: track.name.clone(),
        resolution,
    }
}

fn mean_interval(times: &[f64]) -> f64 {
    let n = times.len();
    if n < 2 {
        0.0
    } else {
        (times[n - 1] - times[0]) / (n - 1) as f64
    }
}

/// The contact that is used, up to its neighbours.
fn choose(
    contacts: &Contacts,
    options: &ExtractOptions,
    from_motion: Option<Finding>,
    findings: &mut Vec<Finding>,
) -> Result<Surroundings, Error> {
    findings.extend(from_motion);
    let windows = &contacts.windows;
    let chosen = contacts.choose(options.trigger.choice)?;
    let window = windows[chosen];
    if windows.len() > 1 {
        findings.push(Finding::SeveralContacts {
            onsets: Times(windows.iter().map(|w| w.onset).collect()),
            used: window.onset,
        });
    }
    if !window.onset_seen {
        findings.push(Finding::ContactAtStart { time: window.onset });
    }
    if !window.end_seen {
        findings.push(Finding::ContactAtEnd { time: window.end });
    }
    let before = chosen.checked_sub(1).map(|i| windows[i].end);
    let after = windows.get(chosen + 1).map(|w| w.onset);
    Ok(Surroundings {
        onset: window.onset,
        end: window.end,
        from: before.unwrap_or(f64::NEG_INFINITY),
        until: after.unwrap_or(f64::INFINITY),
    })
}

fn oriented_force(
    mut track: Track,
    contacts: &Contacts,
    options: &ExtractOptions,
    findings: &mut Vec<Finding>,
) -> Track {
    for value in &mut track.values {
        *value -= contacts.offset;
    }
    if contacts.baseline_samples < SHORT_BASELINE {
        findings.push(Finding::ShortBaseline {
            channel: track.name.clone(),
            samples: contacts.baseline_samples,
        });
    }
    let peak = contacts.windows.iter().map(|w| w.peak).fold(0.0, f64::max);
    if contacts.offset.abs() > OFFSET_SHARE * peak {
        findings.push(Finding::OffsetRemoved {
            channel: track.name.clone(),
            offset: contacts.offset,
            offset_sd: offset_sd(contacts),
        });
    }
    orient(&mut track, contacts.reversed, options, findings);
    track
}

fn offset_sd(contacts: &Contacts) -> f64 {
    contacts.deviation / (contacts.baseline_samples.max(1) as f64).sqrt()
}

fn orient(track: &mut Track, wrong: bool, options: &ExtractOptions, findings: &mut Vec<Finding>) {
    if !wrong {
        return;
    }
    let corrected = options.orientation == Orientation::Correct;
    if corrected {
        for value in &mut track.values {
            *value = -*value;
        }
    }
    findings.push(Finding::Reversed {
        channel: track.name.clone(),
        corrected,
    });
}

fn oriented_displacement(
    position: Position,
    place: &Surroundings,
    options: &ExtractOptions,
    findings: &mut Vec<Finding>,
) -> Track {
    let Position { mut track, arm } = position;
    // During contact the impactor is, on average, where it loads the fruit.
    let zero = value_at(&track.times, &track.values, place.onset);
    for value in &mut track.values {
        *value -= zero;
    }
    let within = mean_between(&track, place.onset, place.end);
    orient(&mut track, within < 0.0, options, findings);
    if let Some(arm) = arm {
        track.values = displacement_from_angles(&track.values, 0.0, arm);
        track.quantum = track.quantum.map(|q| q * arm);
    }
    track
}

/// Mean of the samples in a span of time, or the interpolated value in its
/// middle if there is none.
fn mean_between(track: &Track, from: f64, to: f64) -> f64 {
    let first = track.times.partition_point(|&t| t < from);
    let last = track.times.partition_point(|&t| t <= to);
    if last <= first {
        return value_at(&track.times, &track.values, 0.5 * (from + to));
    }
    track.values[first..last].iter().sum::<f64>() / (last - first) as f64
}

/// Scatter about parabolas through blocks of samples, within the contact if it
/// has enough of them, else before it; at least the rounding of a quantum.
fn noise_of(track: &Track, place: &Surroundings, findings: &mut Vec<Finding>) -> f64 {
    let first = track.times.partition_point(|&t| t < place.onset);
    let last = track.times.partition_point(|&t| t <= place.end);
    let span = if last - first >= NOISE_BLOCKS * NOISE_BLOCK {
        first..last
    } else {
        let length = (2 * (last - first)).max(3 * NOISE_BLOCK);
        first.saturating_sub(length)..first
    };
    let block = (span.len() / 20).clamp(NOISE_BLOCK, 5 * NOISE_BLOCK);
    let scatter =
        scatter_about_polynomial(&track.times[span.clone()], &track.values[span], block, 2);
    stated(track, scatter, &(first..last), findings)
}

fn force_noise(
    track: &Track,
    contacts: &Contacts,
    place: &Surroundings,
    findings: &mut Vec<Finding>,
) -> f64 {
    if contacts.baseline_samples < SHORT_BASELINE {
        return noise_of(track, place, findings);
    }
    let first = track.times.partition_point(|&t| t < place.onset);
    let last = track.times.partition_point(|&t| t <= place.end);
    stated(track, Some(contacts.deviation), &(first..last), findings)
}

fn stated(
    track: &Track,
    scatter: Option<f64>,
    within: &std::ops::Range<usize>,
    findings: &mut Vec<Finding>,
) -> f64 {
    let largest = track.values[within.clone()]
        .iter()
        .map(|v| v.abs())
        .fold(0.0, f64::max);
    let Noise { deviation, source } = combined_noise(scatter, track.quantum, largest);
    if source == NoiseSource::Floor {
        findings.push(Finding::NoiseAtFloor {
            channel: track.name.clone(),
            floor: deviation,
            reason: FLOOR_REASON,
        });
    }
    deviation
}

const FLOOR_REASON: &str = "a millionth of the largest sample: neither scatter nor steps are seen";
const _: () = assert!(RELATIVE_FLOOR == 1e-6);

/// The series of the rate and its noise.
fn rate(
    displacement: Option<&Track>,
    measured: Option<Track>,
    noises: &Noises,
    place: &Surroundings,
    options: &ExtractOptions,
    findings: &mut Vec<Finding>,
) -> (Option<Track>, Option<f64>) {
    let derived = match options.rate {
        RateMethod::Measured => return (measured, noises.rate),
        RateMethod::Automatic if measured.is_some() => return (measured, noises.rate),
        RateMethod::Automatic => displacement
            .filter(|track| evenly_spaced(&track.times))
            .and_then(central_rate),
        RateMethod::CentralDifference => displacement.and_then(central_rate),
        RateMethod::LocalPolynomial { order, window } => {
            displacement.and_then(|track| polynomial_rate(track, order, window, place))
        }
    };
    let noise = derived
        .as_ref()
        .map(|track| noise_of(track, place, findings));
    (derived, noise)
}

fn central_rate(track: &Track) -> Option<Track> {
    let n = track.values.len();
    (n >= 3).then(|| Track {
        name: format!("rate of {}", track.name),
        times: track.times[1..n - 1].to_vec(),
        values: central_difference(&track.times, &track.values),
        quantum: track
            .quantum
            .map(|q| rate_quantum(q, mean_interval(&track.times))),
    })
}

fn polynomial_rate(
    track: &Track,
    order: usize,
    window: Option<usize>,
    place: &Surroundings,
) -> Option<Track> {
    let window =
        window.unwrap_or_else(|| smoothing_window(place.duration(), mean_interval(&track.times)));
    Some(Track {
        name: format!("rate of {}", track.name),
        times: track.times.clone(),
        values: local_polynomial(&track.times, &track.values, window, order, 1)?,
        quantum: None,
    })
}

fn measure(
    displacement: Option<&Track>,
    rate: Option<&Track>,
    force: Option<&Track>,
    noises: &Noises,
    contacts: &Contacts,
    place: &Surroundings,
    options: &ExtractOptions,
) -> Measured {
    let window = contacts.windows.iter().find(|w| w.onset == place.onset);
    let velocity = |side| {
        let from = |track: Option<&Track>, noise: Option<f64>, motion| {
            let track = track?;
            let samples = (&track.times[..], &track.values[..], motion);
            free_velocity(samples, noise?, place, side, options.driving_acceleration)
        };
        from(displacement, noises.displacement, Motion::Displacement)
            .or_else(|| from(rate, noises.rate, Motion::Rate))
    };
    let before = window
        .filter(|w| w.onset_seen)
        .and_then(|_| velocity(Side::Before));
    let after = window
        .filter(|w| w.end_seen)
        .and_then(|_| velocity(Side::After));
    let rebound = after.map(|v| -v.value);
    let impulse = force.zip(noises.force).and_then(|(track, noise)| {
        impulse(
            &track.times,
            &track.values,
            noise,
            offset_sd(contacts),
            place,
        )
    });
    let whole = window.is_some_and(|w| w.onset_seen && w.end_seen);
    let measured = Measured {
        impact_velocity: before.map(|v| v.value),
        rebound_velocity: rebound,
        restitution: before.zip(rebound).map(|(v, r)| r / v.value),
        contact_duration: whole.then(|| place.duration()),
        peak_force: force.and_then(|track| largest_within(track, place)),
        max_displacement: displacement
            .and_then(|track| largest_displacement(&track.times, &track.values, place)),
        impulse: impulse.filter(|_| whole).map(|j| j.0),
        impact_velocity_sd: before.map(|v| v.sd),
        rebound_velocity_sd: after.map(|v| v.sd),
        impulse_sd: impulse.filter(|_| whole).map(|j| j.1),
        ..Measured::default()
    };
    match options.effective_mass {
        Some(mass) => with_energies(measured, mass),
        None => measured,
    }
}

fn largest_within(track: &Track, place: &Surroundings) -> Option<f64> {
    let first = track.times.partition_point(|&t| t < place.onset);
    let last = track.times.partition_point(|&t| t <= place.end);
    track.values[first..last].iter().copied().reduce(f64::max)
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
fn series(
    track: &Track,
    noise: f64,
    place: &Surroundings,
    options: &ExtractOptions,
) -> Option<Series> {
    let times = &track.times;
    let from = place.onset - options.margin_before * place.duration();
    let until = place.end + options.margin_after * place.duration();
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
    (first < last).then(|| Series {
        times: times[first..last].to_vec(),
        values: track.values[first..last].to_vec(),
        noise,
    })
}

//! Channels of a recording, checked and turned into what an impact consists of.

use crate::encoder::quadrature::{ILLEGAL_SHARE, IllegalTransition, Tally, decode_quadrature};
use crate::error::{Error, positive};
use crate::finding::Finding;
use crate::kinematics::{Encoder, count_length};
use crate::noise::estimate::quantum;
use crate::recording::{Channel, Quantity, Recording};
use crate::validate::checked_times;

/// One signal with its sampling times.
pub(crate) struct Track {
    pub name: String,
    pub times: Vec<f64>,
    pub values: Vec<f64>,
    /// Step of the values, if they are quantised.
    pub quantum: Option<f64>,
    /// Standard deviation of the noise of one sample; 0 until it is found.
    pub noise: f64,
    /// Correlation of the noise of successive samples, where it is known; 1.
    pub persistence: Option<f64>,
}

/// Position of the impactor: its values are a length, or the angle of an arm.
pub(crate) struct Position {
    pub track: Track,
    /// Length of the arm if the values are angles; m.
    pub arm: Option<f64>,
}

/// Everything in a recording that an impact is made of.
pub(crate) struct Tracks {
    pub position: Option<Position>,
    pub rate: Option<Track>,
    pub force: Option<Track>,
    pub acceleration: Option<Track>,
}

impl Tracks {
    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut Track> {
        let position = self.position.as_mut().map(|own| &mut own.track);
        let others = [&mut self.rate, &mut self.force, &mut self.acceleration];
        position.into_iter().chain(others.into_iter().flatten())
    }
}

/// Channels in the convention of an impact, with their noise.
pub(crate) struct Signals {
    pub displacement: Option<Track>,
    pub rate: Option<Track>,
    pub force: Option<Track>,
    pub acceleration: Option<Track>,
}

/// How positions are made of encoder and angle channels.
pub(crate) struct Geometry {
    pub encoder: Option<Encoder>,
    pub arm: Option<f64>,
    pub illegal: IllegalTransition,
}

pub(crate) fn tracks(
    recording: &Recording,
    geometry: &Geometry,
    findings: &mut Vec<Finding>,
) -> Result<Tracks, Error> {
    for (i, channel) in recording.channels.iter().enumerate() {
        let twin = recording.channels[..i]
            .iter()
            .find(|c| c.quantity == channel.quantity);
        if let Some(twin) = twin {
            return Err(Error::RepeatedChannel {
                quantity: channel.quantity,
                first: twin.name.clone(),
                second: channel.name.clone(),
            });
        }
    }
    let mut plain = |quantity| {
        find(recording, quantity)
            .map(|channel| plain_track(channel, findings))
            .transpose()
    };
    let rate = plain(Quantity::Rate)?;
    let force = plain(Quantity::Force)?;
    let acceleration = plain(Quantity::Acceleration)?;
    Ok(Tracks {
        position: position(recording, geometry, findings)?,
        rate,
        force,
        acceleration,
    })
}

fn find(recording: &Recording, quantity: Quantity) -> Option<&Channel> {
    recording
        .channels
        .iter()
        .find(|channel| channel.quantity == quantity)
}

fn plain_track(channel: &Channel, findings: &mut Vec<Finding>) -> Result<Track, Error> {
    let (times, finding) = checked_times(channel)?;
    findings.extend(finding);
    Ok(Track {
        name: channel.name.clone(),
        times,
        values: channel.samples.clone(),
        quantum: quantum(&channel.samples),
        noise: 0.0,
        persistence: None,
    })
}

/// Position from a displacement, else phases, else a count, else an angle.
fn position(
    recording: &Recording,
    geometry: &Geometry,
    findings: &mut Vec<Finding>,
) -> Result<Option<Position>, Error> {
    if let Some(channel) = find(recording, Quantity::Displacement) {
        let track = plain_track(channel, findings)?;
        return Ok(Some(Position { track, arm: None }));
    }
    let phases = (
        find(recording, Quantity::PhaseA),
        find(recording, Quantity::PhaseB),
    );
    match phases {
        (Some(a), Some(b)) => {
            let track = decoded_track(a, b, geometry.illegal, findings)?;
            return from_counts(track, Quantity::PhaseA, geometry).map(Some);
        }
        (Some(_), None) => {
            return Err(missing(recording, "phase B of the encoder, beside phase A"));
        }
        (None, Some(_)) => {
            return Err(missing(recording, "phase A of the encoder, beside phase B"));
        }
        (None, None) => {}
    }
    if let Some(channel) = find(recording, Quantity::EncoderCount) {
        let track = plain_track(channel, findings)?;
        return from_counts(track, Quantity::EncoderCount, geometry).map(Some);
    }
    if let Some(channel) = find(recording, Quantity::Angle) {
        let track = plain_track(channel, findings)?;
        let arm = positive_arm(&track.name, Quantity::Angle, geometry)?;
        return Ok(Some(Position {
            track,
            arm: Some(arm),
        }));
    }
    Ok(None)
}

pub(crate) fn missing(recording: &Recording, needed: &'static str) -> Error {
    let names: Vec<String> = recording
        .channels
        .iter()
        .map(|channel| format!("'{}' ({})", channel.name, channel.quantity))
        .collect();
    Error::MissingChannel {
        needed,
        found: if names.is_empty() {
            "no channel at all".to_owned()
        } else {
            names.join(", ")
        },
    }
}

fn decoded_track(
    a: &Channel,
    b: &Channel,
    illegal: IllegalTransition,
    findings: &mut Vec<Finding>,
) -> Result<Track, Error> {
    let (times, finding) = checked_times(a)?;
    let (times_b, _) = checked_times(b)?;
    if times != times_b {
        return Err(Error::PhasesNotTogether {
            a: a.name.clone(),
            b: b.name.clone(),
        });
    }
    findings.extend(finding);
    let decoded = decode_quadrature((&a.name, &a.samples), (&b.name, &b.samples), illegal)?;
    let name = format!("{} and {}", a.name, b.name);
    findings.extend(illegal_finding(&name, &times, &decoded.tally));
    Ok(Track {
        name,
        times,
        values: decoded.counts.iter().map(|&count| count as f64).collect(),
        quantum: Some(1.0),
        noise: 0.0,
        persistence: None,
    })
}

fn illegal_finding(name: &str, times: &[f64], tally: &Tally) -> Option<Finding> {
    let first = tally.first_illegal?;
    let n = times.len();
    (tally.illegal_share() > ILLEGAL_SHARE).then(|| Finding::IllegalTransitions {
        channels: name.to_owned(),
        illegal: tally.illegal,
        transitions: tally.transitions,
        first: times[first],
        sampling_rate: (n - 1) as f64 / (times[n - 1] - times[0]),
        added: tally.added,
    })
}

fn from_counts(
    mut track: Track,
    quantity: Quantity,
    geometry: &Geometry,
) -> Result<Position, Error> {
    let (unit, arm) = match geometry.encoder {
        Some(Encoder::Linear { count_length }) => (positive("count length", count_length)?, None),
        Some(Encoder::Rotary {
            counts_per_revolution,
        }) => {
            let counts = positive("counts per revolution", counts_per_revolution)?;
            let arm = positive_arm(&track.name, quantity, geometry)?;
            // An angle: the count length at unit arm.
            (count_length(counts, 1.0), Some(arm))
        }
        None => {
            return Err(Error::MissingGeometry {
                channel: track.name,
                quantity,
                needed: "the encoder, for example counts_per_revolution = 360000",
            });
        }
    };
    for value in &mut track.values {
        *value *= unit;
    }
    track.quantum = Some(unit);
    Ok(Position { track, arm })
}

fn positive_arm(channel: &str, quantity: Quantity, geometry: &Geometry) -> Result<f64, Error> {
    match geometry.arm {
        Some(arm) => positive("arm", arm),
        None => Err(Error::MissingGeometry {
            channel: channel.to_owned(),
            quantity,
            needed: "the length of the arm, for example arm = \"0.505 m\"",
        }),
    }
}

/// Mean time between samples; 0 of one sample; s.
pub(crate) fn mean_interval(times: &[f64]) -> f64 {
    let n = times.len();
    if n < 2 {
        0.0
    } else {
        (times[n - 1] - times[0]) / (n - 1) as f64
    }
}

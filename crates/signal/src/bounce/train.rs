//! A train of bounces: what is looked for, and what was found.

use crate::bounce::finding::BounceFinding;
use crate::ringing::model::Ringing;
use crate::trigger::{Orientation, Threshold};
use crate::uncertain::Uncertain;

/// What the force of bounces is measured from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum StaticLevel {
    /// The mean before the first contact.
    #[default]
    BeforeFirst,
    /// A level that is known, in the channel's own sign; N.
    Given(f64),
    /// A line from quiet stretch to quiet stretch: before, between and after
    /// the bounces. For levels that drift; what rests on the plate at the end
    /// becomes part of the level.
    Follow,
}

/// How bounces are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BounceOptions {
    /// What the force is measured from.
    pub static_level: StaticLevel,
    /// What is done about a force that is negative in contact.
    pub orientation: Orientation,
    /// Above what contact force a contact begins.
    pub threshold: Threshold,
    /// It is over below this part of the threshold; 1.
    pub release: f64,
    /// Contacts closer than this are one; s. `None`: a tenth of the longest.
    pub smallest_gap: Option<f64>,
    /// Least impulse of a bounce; N s. `None`: 6 of its standard deviations, and 1/50 of the largest.
    pub smallest_impulse: Option<f64>,
    /// Ringing of the plate is looked for and taken out.
    pub plate: PlateRinging,
}

/// What is known about the ringing of the plate below the impacts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PlateRinging {
    /// Found from what the force does after the contacts, if it rings.
    #[default]
    Find,
    /// Damped period and damping ratio are known.
    Known {
        /// Damped period; s.
        period: f64,
        /// Damping ratio; 1.
        damping_ratio: f64,
    },
    /// The support does not ring: its force is the contact force.
    Rigid,
}

impl Default for BounceOptions {
    fn default() -> Self {
        Self {
            static_level: StaticLevel::default(),
            orientation: Orientation::default(),
            threshold: Threshold::Automatic {
                deviations: 6.0,
                least: 0.0,
                share: 0.005,
            },
            release: 0.5,
            smallest_gap: None,
            smallest_impulse: None,
            plate: PlateRinging::default(),
        }
    }
}

/// One impact of a train; support forces are positive in compression, from the static level.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounce {
    /// First touch, between samples; s. `sd` is that by noise and sampling.
    pub onset: Uncertain,
    /// Uncertainty of `onset` from the unknown shape of the rise, common to a train; s.
    pub onset_shape: f64,
    /// End of the contact; s.
    pub end: Uncertain,
    /// Largest support force until the next bounce; N.
    pub peak: f64,
    /// Its time; s.
    pub peak_time: f64,
    /// First maximum of the support force without the ringing of the bounce before; N.
    pub first_peak: f64,
    /// Standard deviation of a peak by noise; N.
    pub peak_sd: f64,
    /// Impulse of the contact force; N s.
    pub impulse: Uncertain,
    /// Ringing of the plate after the contact.
    pub ringing: Option<Ringing>,
    /// Whether the ringing had decayed into the noise by the next bounce or the end.
    pub decayed: bool,
    /// Whether the force stands at the limit of the instrument.
    pub clipped: bool,
    /// Whether the contact was recorded from before its onset to after its end.
    pub complete: bool,
    /// First sample and the one behind the last in contact.
    pub samples: (usize, usize),
}

/// Bounces of one recording.
#[derive(Clone, Debug, PartialEq)]
pub struct BounceTrain {
    /// Name of the channel.
    pub channel: String,
    /// Times of the samples; s.
    pub times: Vec<f64>,
    /// Support force from the static level, positive in compression; N.
    pub force: Vec<f64>,
    /// Contact force, smoothed over `smoothing`; the support force where nothing rings; N.
    pub contact_force: Vec<f64>,
    /// Length of the moving mean, taken twice, in `contact_force`; s.
    pub smoothing: f64,
    /// `contact_force` above which a contact begins, and below which it is over; N.
    pub thresholds: (f64, f64),
    /// Static level before the first contact, in the channel's own sign; N.
    pub static_level: Uncertain,
    /// Standard deviation of the noise of a sample of `force`; N.
    pub noise: f64,
    /// Ringing of the plate from all bounces: damped period and damping ratio.
    pub ringing: Option<PooledRinging>,
    /// The bounces, in their order.
    pub bounces: Vec<Bounce>,
    /// Times from onset to onset, one fewer than bounces; s.
    pub intervals: Vec<Uncertain>,
    /// What a reader must know.
    pub findings: Vec<BounceFinding>,
}

/// Ringing of the plate over all bounces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PooledRinging {
    /// Damped period; s.
    pub period: Uncertain,
    /// Damping ratio; 1.
    pub damping_ratio: Uncertain,
    /// Bounces it comes from; 0 where it was given.
    pub bounces: usize,
}

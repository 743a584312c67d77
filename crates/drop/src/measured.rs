//! What is kept of a drop.

use serde::{Deserialize, Deserializer, Serialize};
use windfall_campaign::pipeline::evaluate::Document;
use windfall_campaign::store::documents::StoredValue;
use windfall_measure::measured::{MeasuredItem, MeasuredItems, MeasuredValue, value_with_sd};
use windfall_signal::uncertain::Uncertain;

/// A value with its standard uncertainty, as it is kept; SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Known {
    /// Value; not a number where there is none.
    #[serde(deserialize_with = "number_or_none")]
    pub value: f64,
    /// Standard uncertainty; not a number where it is not known.
    #[serde(deserialize_with = "number_or_none")]
    pub sd: f64,
}

impl Known {
    /// The value as results show it.
    pub fn shown(self, unit: &str) -> MeasuredValue {
        value_with_sd(self.value, self.sd, unit)
    }
}

impl From<Uncertain> for Known {
    fn from(from: Uncertain) -> Self {
        let finite = |value: f64| if value.is_finite() { value } else { f64::NAN };
        Self {
            value: finite(from.value),
            sd: finite(from.sd),
        }
    }
}

/// JSON has no "not a number": it is written as null.
fn number_or_none<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

/// One bounce of a drop; SI.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredBounce {
    /// First touch; s.
    pub onset: Known,
    /// How far all onsets of the drop may be off together; s.
    pub onset_shape: f64,
    /// End of the contact; s.
    pub end: Known,
    /// Largest support force until the next bounce; N.
    pub peak: Known,
    /// When; s.
    pub peak_time: f64,
    /// First local maximum of the support force; N.
    pub first_peak: f64,
    /// Impulse of the contact; N s.
    pub impulse: Known,
    /// Whether the force stands at the limit of the instrument.
    pub clipped: bool,
    /// Whether the contact was recorded from before its onset to after its end.
    pub complete: bool,
    /// Speed of approach, where it is known; m/s.
    pub impact_velocity: Option<Known>,
    /// Restitution by every method that applies.
    pub restitutions: Vec<MeasuredRestitution>,
}

/// Restitution of a bounce by one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredRestitution {
    /// Name of the method: "drop_height", "flights", "impulse", "velocities".
    pub method: String,
    /// Speed of approach; m/s.
    pub impact_velocity: Known,
    /// Coefficient of restitution; 1.
    pub restitution: Known,
}

/// Logarithmic decrement after the first bounce.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredDecrement {
    /// Per cycle; 1.
    pub decrement: Known,
    /// Cycles between the two peaks.
    pub cycles: usize,
    /// Damping ratio; 1.
    pub damping_ratio: Known,
    /// Damped period; s.
    pub period: Known,
}

/// Ringing of the plate after the bounces of one drop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredRinging {
    /// Damped period; s.
    pub period: Known,
    /// Damping ratio; 1.
    pub damping_ratio: Known,
    /// Bounces that it comes from.
    pub bounces: usize,
}

/// What one recording gives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredDrop {
    /// Values of the drop, for tables.
    pub item: MeasuredItem,
    /// Values of each bounce, for tables.
    pub parts: Vec<MeasuredItem>,
    /// Mass of the fruit; kg.
    pub mass: Known,
    /// Drop height; m.
    pub height: Known,
    /// Its bounces.
    pub bounces: Vec<MeasuredBounce>,
    /// From onset to onset; s.
    pub intervals: Vec<Known>,
    /// Ringing of the plate, where it was heard.
    pub ringing: Option<MeasuredRinging>,
    /// Its logarithmic decrement after the first bounce.
    pub decrement: Option<MeasuredDecrement>,
    /// Static level before the first contact; N.
    pub static_level: Known,
    /// Standard deviation of the noise of a sample; N.
    pub noise: f64,
}

impl Document for MeasuredDrop {
    fn values(&self) -> Vec<StoredValue> {
        let items = vec![self.item.clone()];
        MeasuredItems { items }.values()
    }
}

//! How an impact is cut out of a recording.

use crate::conditioning::Conditioning;
use crate::encoder::edge_rate::CountTimes;
use crate::encoder::quadrature::IllegalTransition;
use crate::error::Error;
use crate::kinematics::Encoder;
use crate::response::Response;
use crate::trigger::{Orientation, TriggerOptions};
use serde::Serialize;

/// How the series of the displacement rate is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RateMethod {
    /// The measured channel, else the central difference of an evenly sampled displacement.
    #[default]
    Automatic,
    /// The measured channel or none.
    Measured,
    /// The central difference of the displacement, even if a channel was measured.
    CentralDifference,
    /// The derivative of a cross-validated smoothing spline, through the edges of counts.
    SmoothingSpline,
    /// Length of a count over the time between edges ([`ExtractOptions::edge_window`]).
    EdgeTimes,
    /// Local polynomials (Savitzky-Golay): smooth, but neighbouring samples share noise.
    LocalPolynomial {
        /// Order of the polynomial, 1 to 4; 2 or 3 are usual.
        order: usize,
        /// Odd number of samples; `None`: about a tenth of the contact.
        window: Option<usize>,
    },
}

/// How an impact is cut out of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ExtractOptions {
    /// Contact window.
    pub trigger: TriggerOptions,
    /// What is done about a channel of the wrong sign.
    pub orientation: Orientation,
    /// What is kept before onset, as a part of the contact's duration; 1.
    pub margin_before: f64,
    /// What is kept after the end, as a part of the contact's duration; 1.
    pub margin_after: f64,
    /// Free motion of displacement and rate that is kept on either side where it is seen to
    /// be free, as a part of the contact's duration; 1. It says how fast and from where the
    /// impactor came and went, and so sharpens stiffness and damping. 0: the margins.
    pub free_flight: f64,
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
    /// Least time between the edges of a rate for [`RateMethod::EdgeTimes`]; s. 0: neighbours.
    pub edge_window: f64,
    /// What the times beside counts mean.
    pub count_times: CountTimes,
    /// Kept before onset at least, where the recording has it; s.
    pub pre_trigger: f64,
    /// Kept after the end at least, likewise; s.
    pub post_trigger: f64,
    /// Filters, and the tip ahead of the force sensor.
    pub conditioning: Conditioning,
    /// Mass that the contact feels, for the energies; kg.
    pub effective_mass: Option<f64>,
    /// Acceleration of the free impactor, positive into the fruit; m/s².
    pub driving_acceleration: f64,
    /// What the instruments make of force and displacement.
    pub response: Response,
}

impl Default for ExtractOptions {
    fn default() -> Self {
        Self {
            trigger: TriggerOptions::default(),
            orientation: Orientation::default(),
            margin_before: 0.2,
            margin_after: 0.2,
            free_flight: 2.0,
            margin_samples: 3,
            encoder: None,
            illegal: IllegalTransition::default(),
            arm: None,
            rate: RateMethod::default(),
            edge_window: 0.0,
            count_times: CountTimes::default(),
            pre_trigger: 0.0,
            post_trigger: 0.0,
            conditioning: Conditioning::default(),
            effective_mass: None,
            driving_acceleration: 0.0,
            response: Response::default(),
        }
    }
}

pub(crate) fn check_options(options: &ExtractOptions) -> Result<(), Error> {
    let bad = |option, value, expected| Err(Error::bad_option(option, value, expected));
    for (option, margin) in [
        ("margin before contact", options.margin_before),
        ("margin after contact", options.margin_after),
        ("free flight", options.free_flight),
    ] {
        if !(margin >= 0.0 && margin.is_finite()) {
            return bad(
                option,
                margin,
                "a part of the contact's duration, 0 or more",
            );
        }
    }
    for (option, time) in [
        ("window of the rate's edges", options.edge_window),
        ("pre-trigger", options.pre_trigger),
        ("post-trigger", options.post_trigger),
    ] {
        if !(time >= 0.0 && time.is_finite()) {
            return bad(option, time, "a time of 0 s or more");
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

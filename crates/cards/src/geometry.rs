//! `windfall radius`: radii of curvature.

use serde::Serialize;
use windfall_contact::apparent_modulus::PrincipalRadii;
use windfall_contact::curvature::{mean_radius, radii_of_ellipsoid, radius_from_chord};
use windfall_files::error::Error;
use windfall_files::option_value::{positive, unusable};
use windfall_files::text::number::plain;

/// What `windfall radius` is asked; texts with units.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct RadiusRequest {
    /// Distance between the feet of a chord gauge
    #[cfg_attr(feature = "clap", arg(long, value_name = "LENGTH"))]
    pub chord: Option<String>,
    /// Height of the surface above the chord
    #[cfg_attr(feature = "clap", arg(long, value_name = "LENGTH"))]
    pub sagitta: Option<String>,
    /// Three diameters; the first along the axis that is struck or pressed
    #[cfg_attr(feature = "clap", arg(long, value_name = "A, B, C"))]
    pub diameters: Option<String>,
    /// Radius of the other body, or "plane": gives R*
    #[cfg_attr(feature = "clap", arg(long, value_name = "LENGTH"))]
    pub against: Option<String>,
}

/// Radii of curvature; m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct RadiusOutcome {
    /// One principal radius; m.
    pub radius: f64,
    /// The other; m.
    pub radius_2: f64,
    /// Radius of a sphere of the same mean curvature; m.
    pub mean_radius: f64,
    /// R* with the other body, from the mean radius; m.
    pub effective_radius: Option<f64>,
}

/// Radii of curvature from what was measured.
///
/// # Errors
/// Values are missing or cannot be used.
pub fn radius(request: &RadiusRequest) -> Result<RadiusOutcome, Error> {
    let radii = match (&request.chord, &request.sagitta, &request.diameters) {
        (Some(chord), Some(sagitta), None) => {
            let chord = positive("--chord", chord, "m")?;
            let sagitta = positive("--sagitta", sagitta, "m")?;
            if sagitta > 0.5 * chord {
                let problem = "the sagitta is more than half of the chord: the feet of the gauge \
                               would stand beyond the widest part; are the two exchanged?";
                return Err(unusable("--sagitta", problem));
            }
            PrincipalRadii::sphere(radius_from_chord(chord, sagitta))
        }
        (None, None, Some(text)) => {
            let parts: Vec<&str> = text.split(',').map(str::trim).collect();
            let [first, second, third] = parts[..] else {
                let problem = "expected three diameters, such as \"72 mm, 70 mm, 65 mm\"";
                return Err(unusable(format!("--diameters {text}"), problem));
            };
            let diameter = |text| positive("--diameters", text, "m");
            radii_of_ellipsoid(diameter(first)?, diameter(second)?, diameter(third)?)
        }
        _ => {
            let problem = "give --chord and --sagitta, or --diameters";
            return Err(unusable("windfall radius", problem));
        }
    };
    let mean = mean_radius(radii);
    let effective = match request.against.as_deref() {
        None => None,
        Some("plane") => Some(mean),
        Some(text) => {
            let other = positive("--against", text, "m")?;
            Some(1.0 / (1.0 / mean + 1.0 / other))
        }
    };
    Ok(RadiusOutcome {
        radius: radii.first,
        radius_2: radii.second,
        mean_radius: mean,
        effective_radius: effective,
    })
}

/// Radii for people.
pub fn text_of_radius(outcome: &RadiusOutcome) -> String {
    let mm = |value: f64| format!("{} mm", plain(1e3 * value));
    let mut text = match outcome.radius == outcome.radius_2 {
        true => format!("radius of curvature  {}\n", mm(outcome.radius)),
        false => format!(
            "principal radii      {} and {}\nmean radius          {}\n",
            mm(outcome.radius),
            mm(outcome.radius_2),
            mm(outcome.mean_radius)
        ),
    };
    if let Some(effective) = outcome.effective_radius {
        text += &format!("R*                   {}\n", mm(effective));
    }
    text
}

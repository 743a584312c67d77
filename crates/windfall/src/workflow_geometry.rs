//! `windfall radius` and `windfall card transfer`: radii of curvature, and laws
//! taken from one geometry to another.

use crate::error::Error;
use crate::option_value::{positive, unusable};
use crate::text_number::plain;
use serde::Serialize;
use windfall_contact::apparent_modulus::{PressedContact, PrincipalRadii};
use windfall_contact::curvature::{mean_radius, radii_of_ellipsoid, radius_from_chord};
use windfall_contact::expression::parse_law;
use windfall_contact::transfer::{Geometry, transfer};

/// What `windfall radius` is asked; texts with units.
#[derive(Clone, Debug, Default)]
pub struct RadiusRequest {
    /// Chord of a gauge.
    pub chord: Option<String>,
    /// Height of the surface above the chord.
    pub sagitta: Option<String>,
    /// Three diameters, the first along the axis that is struck or pressed.
    pub diameters: Option<String>,
    /// Radius of the other body, or "plane".
    pub against: Option<String>,
}

/// Radii of curvature; m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
#[must_use]
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

/// What `windfall card transfer` is asked; texts with units.
#[derive(Clone, Debug)]
pub struct TransferRequest {
    /// The law with its parameters.
    pub law: String,
    /// Radii in the geometry where it was found: "41.5 mm, plane".
    pub from: String,
    /// Plates that deformed the fruit there.
    pub from_plates: usize,
    /// Radii in the geometry where it is wanted: "41.5 mm, 25 mm".
    pub to: String,
    /// Plates that deform the fruit there.
    pub to_plates: usize,
    /// Whether both bodies are fruit where it is wanted.
    pub to_fruit: bool,
}

/// A law in another geometry.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TransferOutcome {
    /// The law there, as an expression.
    pub law: String,
    /// k there over k here.
    pub stiffness_ratio: f64,
    /// What is assumed.
    pub assumptions: Vec<String>,
}

/// A law in another geometry.
///
/// # Errors
/// A text cannot be used, or the law cannot be transferred.
pub fn transfer_law(request: &TransferRequest) -> Result<TransferOutcome, Error> {
    let law = parse_law(&request.law)
        .and_then(|law| law.complete())
        .map_err(|error| unusable(format!("--law {}", request.law), error.to_string()))?;
    let from = geometry("--from", &request.from, request.from_plates, 1.0)?;
    let relative = if request.to_fruit { 0.5 } else { 1.0 };
    let to = geometry("--to", &request.to, request.to_plates, relative)?;
    let there = transfer(law, &from, &to)
        .map_err(|error| unusable(format!("--law {}", request.law), error.to_string()))?;
    let values = there.law.parameters();
    let named = there.law.kind().describe().parameters.iter().zip(&values);
    let named: Vec<String> = named
        .map(|(p, value)| format!("{}={value}", p.name))
        .collect();
    let mut assumptions = vec![
        "Hertz's contact: k goes as E*√R*, and deformations of contacts in series add".to_owned(),
        "plates and impactor are rigid beside the fruit".to_owned(),
        "the damping of the material, c/k, is the same; rates of deformation are not".to_owned(),
    ];
    if request.to_fruit {
        assumptions
            .push("both bodies are fruit of one modulus: E* is half of a fruit's".to_owned());
    }
    Ok(TransferOutcome {
        law: format!("{}({})", there.law.kind().name(), named.join(", ")),
        stiffness_ratio: there.stiffness_ratio,
        assumptions,
    })
}

/// "41.5 mm, plane" with one or two contacts of that kind.
fn geometry(option: &str, text: &str, plates: usize, relative: f64) -> Result<Geometry, Error> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let [fruit, other] = parts[..] else {
        let problem = "expected the radius of the fruit and that of the other body, such as \
                       \"41.5 mm, 25 mm\" or \"41.5 mm, plane\"";
        return Err(unusable(format!("{option} {text}"), problem));
    };
    if !(1..=2).contains(&plates) {
        return Err(unusable(format!("{option}-plates"), "expected 1 or 2"));
    }
    let fruit = PrincipalRadii::sphere(positive(option, fruit, "m")?);
    let indenter = match other {
        "plane" => PrincipalRadii::PLANE,
        other => PrincipalRadii::sphere(positive(option, other, "m")?),
    };
    Ok(Geometry {
        contacts: vec![PressedContact { fruit, indenter }; plates],
        relative_modulus: relative,
    })
}

/// A transferred law for people.
#[must_use]
pub fn text_of_transfer(outcome: &TransferOutcome) -> String {
    let mut text = format!(
        "{}\n\n{} times the stiffness of the geometry it was found in, assuming that\n",
        outcome.law,
        plain(outcome.stiffness_ratio)
    );
    for assumption in &outcome.assumptions {
        text += &format!("  - {assumption}\n");
    }
    text
}

//! `windfall card transfer`: a law, or a law card, taken from one geometry to
//! another by R* and E*.

use crate::law_card::{CARD_FORMAT, CardContact, LawCard};
use crate::law_use::complete_law_among;
use crate::read_card::{law_of_card, read_card, write_card};
use serde::Serialize;
use std::path::PathBuf;
use windfall_contact::apparent_modulus::{PressedContact, PrincipalRadii, stiffness_per_modulus};
use windfall_contact::effective::{Elastic, effective_radius};
use windfall_contact::expression::LawExpression;
use windfall_contact::laws::kind::Law;
use windfall_contact::transfer::{Geometry, Transferred, transfer};
use windfall_files::error::Error;
use windfall_files::option_value::{positive, quantity, unusable};
use windfall_files::text::number::plain;

/// Inputs of `windfall card transfer`; texts with units.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct TransferRequest {
    /// The law with its parameters, as it was found
    #[cfg_attr(
        feature = "clap",
        arg(long, required_unless_present = "file", conflicts_with = "file")
    )]
    pub law: Option<String>,
    /// The law card of the law as it was found
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath))]
    pub file: Option<PathBuf>,
    /// Where it was found: radius of the fruit, radius of the other body or "plane"
    #[cfg_attr(feature = "clap", arg(long, value_name = "RADIUS, RADIUS"))]
    pub from: String,
    /// Plates that deformed the fruit where it was found: 1 or 2
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 1, value_name = "N"))]
    pub from_plates: usize,
    /// The other body where it was found: rigid, fruit, or its modulus and Poisson's ratio
    #[cfg_attr(feature = "clap", arg(long, value_name = "BODY"))]
    pub from_other: Option<String>,
    /// Where it is wanted: radius of the fruit, radius of the other body or "plane"
    #[cfg_attr(feature = "clap", arg(long, value_name = "RADIUS, RADIUS"))]
    pub to: String,
    /// Plates that deform the fruit where it is wanted: 1 or 2
    #[cfg_attr(feature = "clap", arg(long, default_value_t = 1, value_name = "N"))]
    pub to_plates: usize,
    /// The other body where it is wanted: rigid, fruit, or its modulus and Poisson's ratio
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "BODY", conflicts_with = "to_fruit")
    )]
    pub to_other: Option<String>,
    /// Where it is wanted, the other body is a fruit of the same modulus
    #[cfg_attr(feature = "clap", arg(long))]
    pub to_fruit: bool,
    /// Write the law card of the law where it is wanted
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, requires = "file"))]
    pub card: Option<PathBuf>,
}

/// A law in another geometry; SI.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct TransferOutcome {
    /// The law there, as an expression.
    pub law: String,
    /// k there over k here.
    pub stiffness_ratio: f64,
    /// The contact that it was found in.
    pub from: CardContact,
    /// The contact that it is wanted for.
    pub to: CardContact,
    /// What is assumed.
    pub assumptions: Vec<String>,
}

/// A law in another geometry, and its card if requested.
///
/// # Errors
/// A text or file cannot be used, or the law cannot be transferred.
pub fn transfer_law(request: &TransferRequest) -> Result<TransferOutcome, Error> {
    let (law, option, card) = found_law(request)?;
    let (from_plates, from_other) = (request.from_plates, &request.from_other);
    let here = side("--from", &request.from, from_plates, from_other)?;
    let to_other = match request.to_fruit {
        true => &Some("fruit".to_owned()),
        false => &request.to_other,
    };
    let there = side("--to", &request.to, request.to_plates, to_other)?;
    // Only laws of Hertz's contact have a k that gives the modulus.
    let plain = transfer(law, &here.geometry, &there.geometry)
        .map_err(|error| unusable(option.clone(), error.to_string()))?;
    let (from, to) = relative_moduli(&law, &here, &there)?;
    let relative = |side: &Side, relative_modulus| Geometry {
        relative_modulus,
        ..side.geometry.clone()
    };
    let found = transfer(law, &relative(&here, from), &relative(&there, to)).unwrap_or(plain);
    let outcome = TransferOutcome {
        law: LawExpression::from(found.law).to_string(),
        stiffness_ratio: found.stiffness_ratio,
        from: here.outcome(&law),
        to: there.outcome(&found.law),
        assumptions: assumptions(&here, &there),
    };
    if let Some(path) = &request.card {
        let Some(card) = card else {
            let problem = "a card is written from a card: give --file FILE in place of --law";
            return Err(unusable("--card", problem));
        };
        write_card(path, &card_there(card, &found, &outcome))?;
    }
    Ok(outcome)
}

/// The requested law, its text and its card.
fn found_law(request: &TransferRequest) -> Result<(Law, String, Option<LawCard>), Error> {
    match (&request.law, &request.file) {
        (Some(text), None) => Ok((
            complete_law_among(text, &[])?,
            format!("--law {text}"),
            None,
        )),
        (None, Some(path)) => {
            let card = read_card(path)?;
            let law = law_of_card(&card, path)?;
            Ok((law, format!("--file {}", path.display()), Some(card)))
        }
        _ => {
            let problem = "give one of --law LAW and --file FILE";
            Err(unusable("windfall card transfer", problem))
        }
    }
}

/// The body that the fruit touches.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Other {
    Rigid,
    Fruit,
    Elastic(Elastic),
}

/// The requested geometry.
#[derive(Clone, Debug)]
struct Side {
    geometry: Geometry,
    other: Other,
    radius: f64,
    text: String,
}

impl Side {
    /// E* from the stiffness of a law of Hertz's contact there.
    fn modulus(&self, law: &Law) -> f64 {
        law.parameters()[0] / stiffness_per_modulus(&self.geometry.contacts)
    }

    fn outcome(&self, law: &Law) -> CardContact {
        CardContact {
            effective_radius: self.radius,
            effective_modulus: self.modulus(law),
            bodies: self.text.clone(),
        }
    }
}

/// "41.5 mm, plane" with one or two contacts of that kind.
fn side(option: &str, text: &str, plates: usize, other: &Option<String>) -> Result<Side, Error> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let [fruit, body] = parts[..] else {
        let problem = "expected the radius of the fruit and that of the other body, such as \
                       \"41.5 mm, 25 mm\" or \"41.5 mm, plane\"";
        return Err(unusable(format!("{option} {text}"), problem));
    };
    if !(1..=2).contains(&plates) {
        return Err(unusable(format!("{option}-plates"), "expected 1 or 2"));
    }
    let radius = positive(option, fruit, "m")?;
    let (indenter, other_radius) = match body {
        "plane" => (PrincipalRadii::PLANE, f64::INFINITY),
        body => {
            let radius = positive(option, body, "m")?;
            (PrincipalRadii::sphere(radius), radius)
        }
    };
    let contact = PressedContact {
        fruit: PrincipalRadii::sphere(radius),
        indenter,
    };
    let other = other_body(&format!("{option}-other"), other.as_deref())?;
    let name = match other {
        Other::Rigid => "rigid body".to_owned(),
        Other::Fruit => "fruit of the same modulus".to_owned(),
        Other::Elastic(body) => format!("body of {} Pa, ν = {}", plain(body.modulus), body.poisson),
    };
    let contacts = if plates == 2 { "between two: " } else { "" };
    Ok(Side {
        geometry: Geometry {
            contacts: vec![contact; plates],
            relative_modulus: 1.0,
        },
        other,
        radius: effective_radius(radius, other_radius),
        text: format!("{contacts}fruit of {fruit} on {name}, {body}"),
    })
}

fn other_body(option: &str, text: Option<&str>) -> Result<Other, Error> {
    match text.map(str::trim) {
        None | Some("rigid") => Ok(Other::Rigid),
        Some("fruit") => Ok(Other::Fruit),
        Some(text) => {
            let Some((modulus, poisson)) = text.split_once(',') else {
                let problem = "expected \"rigid\", \"fruit\", or a modulus and Poisson's ratio such \
                               as \"3 GPa, 0.4\"";
                return Err(unusable(format!("{option} {text}"), problem));
            };
            let poisson = quantity(option, poisson.trim(), "1")?;
            if !(0.0..=0.5).contains(&poisson) {
                let problem = "Poisson's ratio is from 0 to 0.5";
                return Err(unusable(format!("{option} {text}"), problem));
            }
            Ok(Other::Elastic(Elastic {
                modulus: positive(option, modulus.trim(), "Pa")?,
                poisson,
            }))
        }
    }
}

/// E* of both contacts over that of the fruit on a rigid body.
///
/// The stiffness where the law was found gives E* there; the compliance of the other
/// body there is subtracted, that of the new one added: 1/E* = A_fruit + A_other with
/// A = (1 − ν²)/E.
fn relative_moduli(law: &Law, here: &Side, there: &Side) -> Result<(f64, f64), Error> {
    let whole = 1.0 / here.modulus(law);
    let compliance = |body: Elastic| (1.0 - body.poisson * body.poisson) / body.modulus;
    let fruit = match here.other {
        Other::Rigid => whole,
        Other::Fruit => 0.5 * whole,
        Other::Elastic(body) => whole - compliance(body),
    };
    if fruit <= 0.0 {
        let problem = format!(
            "the other body alone would give way more than the contact does (E* is {} Pa): its \
             modulus is too low",
            plain(1.0 / whole)
        );
        return Err(unusable("--from-other", problem));
    }
    let relative = |other: Other| match other {
        Other::Rigid => 1.0,
        Other::Fruit => 0.5,
        Other::Elastic(body) => fruit / (fruit + compliance(body)),
    };
    Ok((relative(here.other), relative(there.other)))
}

fn assumptions(here: &Side, there: &Side) -> Vec<String> {
    let mut assumptions = vec![
        "Hertz's contact: k goes as E*√R*, and deformations of contacts in series add".to_owned(),
    ];
    if [here.other, there.other].contains(&Other::Rigid) {
        assumptions.push("plates and impactor are rigid beside the fruit".to_owned());
    }
    assumptions.push(
        "the damping of the material, c/k, is the same; rates of deformation are not".to_owned(),
    );
    if there.other == Other::Fruit {
        assumptions
            .push("both bodies are fruit of one modulus: E* is half of a fruit's".to_owned());
    }
    let elastic = |other: &Other| matches!(other, Other::Elastic(_));
    if [here.other, there.other].iter().any(elastic) {
        assumptions.push("a body that is no fruit gives way without damping of its own".to_owned());
    }
    assumptions
}

/// The card of the law in its new geometry.
fn card_there(mut card: LawCard, found: &Transferred, outcome: &TransferOutcome) -> LawCard {
    let ratio = found.stiffness_ratio;
    for parameter in card.parameters.values_mut() {
        parameter.value *= ratio;
        parameter.sd = parameter.sd.map(|sd| ratio * sd);
        parameter.interval = parameter.interval.map(|ends| ends.map(|end| ratio * end));
    }
    // Covariances of logarithms stay; those of values go with their squares.
    if let Some(covariance) = &mut card.covariance {
        scale(&mut covariance.matrix, &covariance.of, ratio);
    }
    if let Some(population) = &mut card.population {
        population
            .median
            .iter_mut()
            .for_each(|value| *value *= ratio);
        scale(&mut population.between_fruit, &population.of, ratio);
        if let Some(within) = &mut population.within_fruit {
            scale(within, &population.of, ratio);
        }
    }
    // Equal strain in the contact, √(d/R*), bounds what was seen.
    let size = outcome.to.effective_radius / outcome.from.effective_radius;
    let moduli = outcome.to.effective_modulus / outcome.from.effective_modulus;
    card.range.displacement = card.range.displacement.map(|d| d * size);
    card.range.peak_force = card
        .range
        .peak_force
        .map(|force| force * moduli * size * size);
    card.format = CARD_FORMAT;
    card.expression.clone_from(&outcome.law);
    card.bodies.impactor = outcome.to.bodies.clone();
    card.cautions.push(format!(
        "transferred from {} (R* = {} m, E* = {} Pa) to {} (R* = {} m, E* = {} Pa): {} times the \
         stiffness",
        outcome.from.bodies,
        plain(outcome.from.effective_radius),
        plain(outcome.from.effective_modulus),
        outcome.to.bodies,
        plain(outcome.to.effective_radius),
        plain(outcome.to.effective_modulus),
        plain(ratio)
    ));
    card.cautions
        .extend(outcome.assumptions.iter().map(|a| format!("assumed: {a}")));
    card.cautions.push(
        "its ranges of displacement and force are those of equal strain in the contact; velocities \
         and masses are as they were seen"
            .to_owned(),
    );
    card.contact = Some(outcome.to.clone());
    card
}

/// Scales rows and columns of values that are not logarithms.
fn scale(matrix: &mut [Vec<f64>], of: &[String], ratio: f64) {
    let factor = |name: &String| if name.starts_with("ln ") { 1.0 } else { ratio };
    for (row, first) in matrix.iter_mut().zip(of) {
        for (cell, second) in row.iter_mut().zip(of) {
            *cell *= factor(first) * factor(second);
        }
    }
}

/// A transferred law for people.
pub fn text_of_transfer(outcome: &TransferOutcome) -> String {
    let contact = |contact: &CardContact| {
        format!(
            "{}: R* = {} mm, E* = {} MPa",
            contact.bodies,
            plain(1e3 * contact.effective_radius),
            plain(1e-6 * contact.effective_modulus)
        )
    };
    let mut text = format!(
        "{}\n\nfrom {}\nto   {}\n\n{} times the stiffness of the geometry it was found in, assuming that\n",
        outcome.law,
        contact(&outcome.from),
        contact(&outcome.to),
        plain(outcome.stiffness_ratio)
    );
    for assumption in &outcome.assumptions {
        text += &format!("  - {assumption}\n");
    }
    text
}

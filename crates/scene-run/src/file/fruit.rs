//! `[[fruit]]` of scene.toml.

use crate::file::key::Section;
use crate::file::scene::FruitFile;
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::TomlSource;
use windfall_scene::population::{FruitKind, Ovate, Source};

/// Most fruit of a kind: about 40 GB of memory.
const MOST_FRUIT: usize = 10_000_000;

/// A kind of fruit, and its name.
pub fn fruit_of(
    source: &TomlSource,
    fruit: &Spanned<FruitFile>,
    materials: &[String],
) -> Result<(String, FruitKind), Error> {
    let file = fruit.get_ref();
    let table = Section {
        source,
        name: "[[fruit]]",
        at: fruit.span(),
    };
    let name = file.material.as_ref();
    let name =
        name.ok_or_else(|| table.lacks("material", "its material", "material = \"apple\""))?;
    let own = table.material(&name.span(), "material", name.get_ref(), materials)?;
    let count = file.count.as_ref();
    let count = count.ok_or_else(|| table.lacks("count", "how many there are", "count = 100"))?;
    if *count.get_ref() > MOST_FRUIT {
        let problem = format!("a scene has at most {MOST_FRUIT} fruit of a kind");
        return Err(table.refused(&count.span(), "count", count.get_ref(), problem));
    }
    let example = "diameter = \"75 mm\"";
    let diameter = table.above_zero(&file.diameter, "diameter", "m")?;
    let diameter = diameter.ok_or_else(|| table.lacks("diameter", "mean diameter", example))?;
    let sd = table.at_least_zero(&file.diameter_sd, "diameter_sd", "m")?;
    let sd = sd.unwrap_or(0.0);
    if let (Some(given), true) = (&file.diameter_sd, diameter <= 3.0 * sd) {
        let problem = format!("it must be less than a third of the diameter, {diameter} m");
        return Err(table.refused(&given.span(), "diameter_sd", given.get_ref(), problem));
    }
    let example = "density = \"840 kg/m^3\"";
    let density = table.above_zero(&file.density, "density", "kg/m^3")?;
    let density = density.ok_or_else(|| table.lacks("density", "density", example))?;
    if let (Some(given), false) = (&file.density, DENSITIES.contains(&density)) {
        let problem = "it must lie between 10 and 25,000 kg/m^3: an apple has about 840, water 1000; \
                       1 g/cm^3 is 1000 kg/m^3";
        return Err(table.refused(&given.span(), "density", given.get_ref(), problem));
    }
    let kind = FruitKind {
        material: own,
        count: *count.get_ref(),
        radius: 0.5 * diameter,
        radius_sd: 0.5 * sd,
        ovate: ovate_of(&table, file, diameter)?,
        density,
        source: source_of(&table, file)?,
    };
    let name = file.name.as_ref().map(Spanned::get_ref);
    Ok((name.unwrap_or(&materials[own]).clone(), kind))
}

/// Densities between foam and the heaviest metal; kg/m³.
const DENSITIES: std::ops::RangeInclusive<f64> = 10.0..=25_000.0;

/// Spheres that make up an ovate fruit, where the file does not say how many: a fruit of
/// 100 mm by 60 mm then lacks 0.9 mm of its spheroid at most.
const SPHERES: usize = 9;

/// How fruit of a kind are longer than thick, if they are.
fn ovate_of(table: &Section, file: &FruitFile, diameter: f64) -> Result<Option<Ovate>, Error> {
    let refused = |spheres: &Spanned<usize>, problem: &str| {
        Err(table.refused(&spheres.span(), "spheres", spheres.get_ref(), problem))
    };
    let Some(given) = &file.length else {
        let problem = "it says of how many spheres an ovate fruit is: give its length too";
        return file
            .spheres
            .as_ref()
            .map_or(Ok(None), |own| refused(own, problem));
    };
    let length = table.given(given, "length", "m")?;
    let ratio = length / diameter;
    let long = ratio > 1.0 && ratio <= LONGEST;
    if !long {
        let problem = format!(
            "an ovate fruit is longer than thick ({diameter} m), and at most {LONGEST} times; \
             for a round one leave the length out (flat ones cannot be made of spheres along an \
             axis)"
        );
        return Err(table.refused(&given.span(), "length", format!("{length} m"), problem));
    }
    let count = file.spheres.as_ref().map_or(SPHERES, |own| *own.get_ref());
    match &file.spheres {
        Some(own) if !(2..=MOST_SPHERES).contains(&count) => refused(
            own,
            &format!("an ovate fruit is of 2 to {MOST_SPHERES} spheres"),
        ),
        _ => Ok(Some(Ovate {
            ratio,
            spheres: count,
        })),
    }
}

/// Length over diameter at most.
const LONGEST: f64 = 10.0;

/// Spheres of a fruit at most.
const MOST_SPHERES: usize = 99;

/// How fruit of a kind come.
fn source_of(table: &Section, file: &FruitFile) -> Result<Source, Error> {
    let seconds =
        |value, key| Ok::<f64, Error>(table.at_least_zero(value, key, "s")?.unwrap_or(0.0));
    Ok(match (&file.lattice, &file.pour, &file.drop, &file.tree) {
        (Some(own), None, None, None) => Source::Lattice {
            low: own.get_ref().low,
            high: own.get_ref().high,
            velocity: own.get_ref().velocity,
        },
        (None, Some(pour), None, None) => {
            let own = pour.get_ref();
            let rate = table.given(&own.rate, "pour rate", "1/s")?;
            if !(rate > 0.0 && rate.is_finite()) {
                let problem = "a rate must be above zero";
                return Err(table.refused(&pour.span(), "pour rate", rate, problem));
            }
            Source::Pour {
                low: own.low,
                high: own.high,
                velocity: own.velocity,
                rate,
                from: seconds(&own.from, "pour from")?,
            }
        }
        (None, None, Some(own), None) => {
            let own = own.get_ref();
            Source::Drop {
                place: own.place,
                velocity: own.velocity,
                interval: seconds(&own.interval, "drop interval")?,
                from: seconds(&own.from, "drop from")?,
            }
        }
        (None, None, None, Some(own)) => Source::Tree {
            low: own.get_ref().low,
            high: own.get_ref().high,
            over: seconds(&own.get_ref().over, "tree over")?,
        },
        _ => {
            let example = "drop = { place = [0, 0, 1], interval = \"0.5 s\" }";
            let meaning = "how they come: one of lattice, pour, drop, tree";
            return Err(table.lacks("lattice, pour, drop or tree", meaning, example));
        }
    })
}

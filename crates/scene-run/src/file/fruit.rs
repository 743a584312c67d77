//! `[[fruit]]` of scene.toml.

use crate::file::key::{material, needed};
use crate::file::scene::FruitFile;
use std::ops::Range;
use toml::Spanned;
use windfall_files::error::Error;
use windfall_files::text::toml_source::{
    TomlSource, invalid, missing, needed_quantity, optional_quantity,
};
use windfall_scene::population::{FruitKind, Ovate, Source};

/// A kind of fruit, and its name.
///
/// # Errors
/// Something is missing or cannot be.
pub fn fruit_of(
    source: &TomlSource,
    fruit: &Spanned<FruitFile>,
    materials: &[String],
) -> Result<(String, FruitKind), Error> {
    const TABLE: &str = "[[fruit]]";
    let (file, at) = (fruit.get_ref(), fruit.span());
    let lacks = |key, meaning, example| {
        let key = needed(TABLE, key, meaning, "", example);
        missing(source, &at, &key, TABLE.to_owned())
    };
    let name = file.material.as_ref();
    let name = name.ok_or_else(|| lacks("material", "its material", "material = \"apple\""))?;
    let own = material(
        source,
        &name.span(),
        (TABLE, "material"),
        name.get_ref(),
        materials,
    )?;
    let count = file.count.as_ref();
    let count = count.ok_or_else(|| lacks("count", "how many there are", "count = 100"))?;
    let diameter = needed(
        TABLE,
        "diameter",
        "mean diameter",
        "m",
        "diameter = \"75 mm\"",
    );
    let diameter = needed_quantity(source, &at, file.diameter.as_ref(), &diameter)?;
    let sd = needed(
        TABLE,
        "diameter_sd",
        "standard deviation",
        "m",
        "diameter_sd = \"2 mm\"",
    );
    let sd = optional_quantity(source, file.diameter_sd.as_ref(), &sd)?.unwrap_or(0.0);
    let density = needed(
        TABLE,
        "density",
        "density",
        "kg/m^3",
        "density = \"840 kg/m^3\"",
    );
    let density = needed_quantity(source, &at, file.density.as_ref(), &density)?;
    if !(diameter > 3.0 * sd && sd >= 0.0 && density > 0.0) {
        let problem = "diameter and density must be above zero, and diameter_sd less than a third \
                       of the diameter"
            .to_owned();
        let text = format!("{diameter} m, {sd} m, {density} kg/m^3");
        return Err(invalid(source, &at, (TABLE, "diameter"), &text, problem));
    }
    let ovate = ovate_of(source, file, diameter)?;
    let way = source_of(source, file, &at)?;
    let kind = FruitKind {
        material: own,
        count: *count.get_ref(),
        radius: 0.5 * diameter,
        radius_sd: 0.5 * sd,
        ovate,
        density,
        source: way,
    };
    let name = file
        .name
        .as_ref()
        .map_or(&materials[own], |name| name.get_ref());
    Ok((name.clone(), kind))
}

/// Spheres that make up an ovate fruit, where the file does not say how many: a fruit of
/// 100 mm by 60 mm then lacks 0.9 mm of its spheroid at most.
const SPHERES: usize = 9;

/// How fruit of a kind are longer than thick, if they are.
fn ovate_of(source: &TomlSource, file: &FruitFile, diameter: f64) -> Result<Option<Ovate>, Error> {
    const TABLE: &str = "[[fruit]]";
    let Some(given) = file.length.as_ref() else {
        if let Some(spheres) = &file.spheres {
            let problem = "it says of how many spheres an ovate fruit is: give its length too";
            let text = spheres.get_ref().to_string();
            let key = (TABLE, "spheres");
            return Err(invalid(
                source,
                &spheres.span(),
                key,
                &text,
                problem.to_owned(),
            ));
        }
        return Ok(None);
    };
    let key = needed(TABLE, "length", "mean length", "m", "length = \"90 mm\"");
    let length = optional_quantity(source, Some(given), &key)?.unwrap_or(diameter);
    let ratio = length / diameter;
    let long = ratio > 1.0 && ratio <= LONGEST;
    if !long {
        let problem = format!(
            "an ovate fruit is longer than thick ({diameter} m), and at most {LONGEST} times; \
             for a round one leave the length out (flat ones cannot be made of spheres along an \
             axis)"
        );
        let text = format!("{length} m");
        return Err(invalid(
            source,
            &given.span(),
            (TABLE, "length"),
            &text,
            problem,
        ));
    }
    let spheres = file.spheres.as_ref();
    let count = spheres.map_or(SPHERES, |own| *own.get_ref());
    if let Some(spheres) = spheres.filter(|_| !(2..=MOST_SPHERES).contains(&count)) {
        let problem = format!("an ovate fruit is of 2 to {MOST_SPHERES} spheres");
        let (at, key) = (spheres.span(), (TABLE, "spheres"));
        return Err(invalid(source, &at, key, &count.to_string(), problem));
    }
    Ok(Some(Ovate {
        ratio,
        spheres: count,
    }))
}

/// Length over diameter at most.
const LONGEST: f64 = 10.0;

/// Spheres of a fruit at most.
const MOST_SPHERES: usize = 99;

/// How fruit of a kind come.
fn source_of(source: &TomlSource, file: &FruitFile, at: &Range<usize>) -> Result<Source, Error> {
    const TABLE: &str = "[[fruit]]";
    let seconds = |value, key| {
        let key = needed(TABLE, key, "a time", "s", "from = \"0 s\"");
        Ok::<f64, Error>(optional_quantity(source, value, &key)?.unwrap_or(0.0))
    };
    let way = match (&file.lattice, &file.pour, &file.drop, &file.tree) {
        (Some(own), None, None, None) => Source::Lattice {
            low: own.get_ref().low,
            high: own.get_ref().high,
            velocity: own.get_ref().velocity,
        },
        (None, Some(own), None, None) => {
            let (own, at) = (own.get_ref(), own.span());
            let rate = needed(
                TABLE,
                "pour rate",
                "fruit per second",
                "1/s",
                "rate = \"50 Hz\"",
            );
            let rate = needed_quantity(source, &at, Some(&own.rate), &rate)?;
            if !(rate > 0.0 && rate.is_finite()) {
                let problem = "a rate must be above zero".to_owned();
                return Err(invalid(
                    source,
                    &at,
                    (TABLE, "pour rate"),
                    &rate.to_string(),
                    problem,
                ));
            }
            Source::Pour {
                low: own.low,
                high: own.high,
                velocity: own.velocity,
                rate,
                from: seconds(own.from.as_ref(), "pour from")?,
            }
        }
        (None, None, Some(own), None) => {
            let own = own.get_ref();
            Source::Drop {
                place: own.place,
                velocity: own.velocity,
                interval: seconds(own.interval.as_ref(), "drop interval")?,
                from: seconds(own.from.as_ref(), "drop from")?,
            }
        }
        (None, None, None, Some(own)) => Source::Tree {
            low: own.get_ref().low,
            high: own.get_ref().high,
            over: seconds(own.get_ref().over.as_ref(), "tree over")?,
        },
        _ => {
            let example = "drop = { place = [0, 0, 1], interval = \"0.5 s\" }";
            let meaning = "how they come: one of lattice, pour, drop, tree";
            let key = needed(TABLE, "lattice, pour, drop or tree", meaning, "", example);
            return Err(missing(source, at, &key, TABLE.to_owned()));
        }
    };
    Ok(way)
}

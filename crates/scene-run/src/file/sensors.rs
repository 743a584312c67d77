//! `[[sensors]]` of scene.toml.

use crate::file::key::{Section, short};
use crate::file::walls::{PlaneFile, PlateFile, normal_of, plate_of};
use schemars::JsonSchema;
use serde::Deserialize;
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_files::error::{Error, Place};
use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{TomlSource, place_at, suggestion};
use windfall_scene::scene::Fruit;
use windfall_scene::shape::surface::Plate;
use windfall_scene::vector::Vector;

/// `[[sensors]]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SensorFile {
    /// Name.
    pub name: Option<Spanned<String>>,
    /// An endless plane through which fruit pass.
    pub plane: Option<Spanned<PlaneFile>>,
    /// A parallelogram through which fruit pass.
    pub plate: Option<Spanned<PlateFile>>,
    /// A box in which fruit are.
    #[serde(rename = "box")]
    pub space: Option<Spanned<SpaceFile>>,
    /// A kind of fruit that feels its acceleration.
    pub probe: Option<Spanned<String>>,
    /// The kind of fruit that counts, if not all do.
    pub fruit: Option<Spanned<String>>,
    /// Time from sample to sample, or over which a flow is counted.
    pub interval: Option<Spanned<QuantityText>>,
    /// Threshold of an impact on a probe.
    pub least_acceleration: Option<Spanned<QuantityText>>,
}

/// `box`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpaceFile {
    /// Lowest corner; m.
    pub low: [f64; 3],
    /// Highest corner; m.
    pub high: [f64; 3],
}

/// What a sensor is.
#[derive(Clone, Debug, PartialEq)]
pub enum SensorKind {
    /// An endless plane; its normal has the length 1.
    Plane {
        /// A point of it; m.
        point: Vector,
        /// The direction of a pass forward.
        normal: Vector,
    },
    /// A parallelogram; a pass forward is in the direction of the first edge times the second.
    Plate(Plate),
    /// A box of space.
    Space {
        /// Lowest corner; m.
        low: Vector,
        /// Highest corner; m.
        high: Vector,
    },
    /// Fruit that feel their acceleration.
    Probe {
        /// Threshold of an impact; m/s².
        least: f64,
    },
}

/// A sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorPlan {
    /// Name.
    pub name: String,
    /// What it is.
    pub kind: SensorKind,
    /// The kinds of fruit that count, by number, if not all do; those that are probes.
    pub only: Option<Vec<usize>>,
    /// Time from sample to sample, or over which a flow is counted; s.
    pub interval: f64,
}

/// All sensors of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorsPlan {
    /// Each of them.
    pub all: Vec<SensorPlan>,
    /// The kind of each fruit, in the order of the scene; empty without sensors.
    pub kind_of: Vec<usize>,
    /// Where the interval of each stands, and how.
    intervals: Vec<(Place, String)>,
}

impl SensorsPlan {
    /// Whether a fruit is a probe.
    pub fn is_probe(&self, fruit: u32) -> bool {
        let probes = self.all.iter();
        let mut probes = probes.filter(|own| matches!(own.kind, SensorKind::Probe { .. }));
        probes.any(|own| self.counts(own, fruit))
    }

    /// Whether a fruit counts for a sensor.
    pub fn counts(&self, sensor: &SensorPlan, fruit: u32) -> bool {
        let of = |kinds: &Vec<usize>| {
            let kind = self.kind_of.get(fruit as usize);
            kind.is_some_and(|kind| kinds.contains(kind))
        };
        sensor.only.as_ref().is_none_or(of)
    }

    /// The first sensor that is a probe.
    pub fn probe(&self) -> Option<&SensorPlan> {
        let mut all = self.all.iter();
        all.find(|own| matches!(own.kind, SensorKind::Probe { .. }))
    }

    /// Refuses samples that are closer than time steps.
    ///
    /// * `step`: time step, or time between the frames of another engine; s
    ///
    /// # Errors
    /// The interval of a sensor is shorter.
    pub fn check_step(&self, step: f64) -> Result<(), Error> {
        let sampled = |own: &SensorPlan| {
            let counts = matches!(own.kind, SensorKind::Plane { .. } | SensorKind::Plate(_));
            !counts && own.interval < step * (1.0 - 1e-9)
        };
        let mut pairs = self.all.iter().zip(&self.intervals);
        let Some((own, (place, text))) = pairs.find(|(own, _)| sampled(own)) else {
            return Ok(());
        };
        Err(Error::Refused {
            place: place.clone(),
            problem: format!(
                "[[sensors]]: the interval of \"{}\", {text}, is shorter than the time step of the scene, \
                 {} s: nothing happens in between. Give a longer interval, or a shorter time_step",
                own.name,
                short(step)
            ),
        })
    }
}

/// Fruit and their kinds.
pub struct Kinds<'a> {
    /// Name and number of fruit of each.
    pub names: &'a [(String, usize)],
    /// That of each fruit, in the order of the scene.
    pub kind_of: &'a [usize],
    /// All fruit.
    pub fruit: &'a [Fruit],
}

/// What `[[sensors]]` say.
///
/// * `end`: of the scene; s
///
/// # Errors
/// A sensor is none, or several; two have one name; its kind of fruit is not there; a value that
/// cannot be.
pub fn sensors_of(
    source: &TomlSource,
    sensors: &[Spanned<SensorFile>],
    kinds: &Kinds,
    end: f64,
) -> Result<SensorsPlan, Error> {
    let mut plan = SensorsPlan::default();
    for sensor in sensors {
        let table = Section {
            source,
            name: "[[sensors]]",
            at: sensor.span(),
        };
        let own = sensor_of(&table, sensor.get_ref(), kinds, end)?;
        if plan.all.iter().any(|other| other.name == own.name) {
            let at = sensor.get_ref().name.as_ref().map(Spanned::span);
            let problem = "another sensor has this name: tables and results are told apart by it";
            return Err(table.refused(&at.unwrap_or(sensor.span()), "name", &own.name, problem));
        }
        let interval = sensor.get_ref().interval.as_ref();
        let (at, text) = interval.map_or((sensor.span(), String::new()), |own| {
            (own.span(), own.get_ref().0.clone())
        });
        plan.intervals.push((place_at(source, &at), text));
        plan.all.push(own);
    }
    if !plan.all.is_empty() {
        plan.kind_of = kinds.kind_of.to_vec();
    }
    Ok(plan)
}

/// Time over which a flow is counted where the file does not say; s.
const WINDOW: f64 = 1.0;

/// Threshold of an impact where the file does not say; m/s².
const LEAST: f64 = 15.0 * STANDARD_GRAVITY;

fn sensor_of(
    table: &Section,
    file: &SensorFile,
    kinds: &Kinds,
    end: f64,
) -> Result<SensorPlan, Error> {
    let name = file.name.as_ref().map(Spanned::get_ref);
    let name = name.ok_or_else(|| table.lacks("name", "its name", "name = \"end of the belt\""))?;
    let kinds_given = [
        ("plane", file.plane.as_ref().map(Spanned::span)),
        ("plate", file.plate.as_ref().map(Spanned::span)),
        ("box", file.space.as_ref().map(Spanned::span)),
        ("probe", file.probe.as_ref().map(Spanned::span)),
    ];
    table.alone(&kinds_given, "write a [[sensors]] for each")?;
    let (kind, sampled) = match (&file.plane, &file.plate, &file.space, &file.probe) {
        (Some(own), None, None, None) => {
            let normal = normal_of(table, own)?;
            let point = own.get_ref().point;
            (SensorKind::Plane { point, normal }, false)
        }
        (None, Some(own), None, None) => (SensorKind::Plate(plate_of(table, own)?), false),
        (None, None, Some(own), None) => (space_of(table, own)?, true),
        (None, None, None, Some(_)) => {
            let least = &file.least_acceleration;
            let least = table.above_zero(least, "least_acceleration", "m/s^2")?;
            let least = least.unwrap_or(LEAST);
            (SensorKind::Probe { least }, true)
        }
        _ => {
            let key = "plane, plate, box or probe";
            let meaning = "what it is: one of plane, plate, box, probe";
            let example = "plane = { point = [0.6, 0, 0], normal = [1, 0, 0] }";
            return Err(table.lacks(key, meaning, example));
        }
    };
    let is_probe = matches!(kind, SensorKind::Probe { .. });
    if let (Some(own), false) = (&file.least_acceleration, is_probe) {
        let problem = "only a probe has impacts: leave it out";
        return Err(table.refused(&own.span(), "least_acceleration", own.get_ref(), problem));
    }
    if let (Some(own), true) = (&file.fruit, is_probe) {
        let problem = "a probe names its kind itself: leave it out";
        return Err(table.refused(&own.span(), "fruit", own.get_ref(), problem));
    }
    let (of, key) = match is_probe {
        true => (&file.probe, "probe"),
        false => (&file.fruit, "fruit"),
    };
    let only = of.as_ref().map(|own| kinds_called(table, key, own, kinds));
    let only = only.transpose()?;
    let interval = interval_of(table, file, sampled, end)?;
    if let (Some(own), Some(of)) = (&file.probe, &only) {
        check_comes(table, own, kinds, (of, end))?;
    }
    Ok(SensorPlan {
        name: name.clone(),
        kind,
        only,
        interval,
    })
}

fn interval_of(table: &Section, file: &SensorFile, sampled: bool, end: f64) -> Result<f64, Error> {
    let found = table.above_zero(&file.interval, "interval", "s")?;
    let Some((given, interval)) = file.interval.as_ref().zip(found) else {
        return match sampled {
            true => Err(table.lacks(
                "interval",
                "time from sample to sample",
                "interval = \"20 ms\"",
            )),
            false => Ok(WINDOW),
        };
    };
    if !interval.is_finite() || (sampled && interval > end) {
        let problem = format!("it must be shorter than the scene, which ends at {end} s");
        return Err(table.refused(&given.span(), "interval", given.get_ref(), problem));
    }
    Ok(interval)
}

fn space_of(table: &Section, space: &Spanned<SpaceFile>) -> Result<SensorKind, Error> {
    let SpaceFile { low, high } = *space.get_ref();
    if (0..3).any(|axis| low[axis] >= high[axis]) {
        let problem = "`low` must be below `high` in x, y and z";
        let text = format!("{low:?}, {high:?}");
        return Err(table.refused(&space.span(), "box", text, problem));
    }
    Ok(SensorKind::Space { low, high })
}

/// The kinds of fruit of a name, by number.
fn kinds_called(
    table: &Section,
    key: &str,
    name: &Spanned<String>,
    kinds: &Kinds,
) -> Result<Vec<usize>, Error> {
    let of_name = |own: &(usize, &(String, usize))| own.1.0 == *name.get_ref();
    let all = kinds.names.iter().enumerate().filter(of_name);
    let all: Vec<usize> = all.map(|(number, _)| number).collect();
    if all.is_empty() {
        let known: Vec<&str> = kinds.names.iter().map(|own| own.0.as_str()).collect();
        let near = suggestion(name.get_ref(), known.iter().copied());
        let problem = format!(
            "no [[fruit]] has this name{near}; there are {}",
            known.join(", ")
        );
        return Err(table.refused(&name.span(), key, name.get_ref(), problem));
    }
    Ok(all)
}

/// Refuses a probe that never comes.
fn check_comes(
    table: &Section,
    name: &Spanned<String>,
    kinds: &Kinds,
    (of, end): (&[usize], f64),
) -> Result<(), Error> {
    let probes = kinds.fruit.iter().zip(kinds.kind_of);
    let probes = probes.filter(|(_, kind)| of.contains(kind));
    let first = probes.map(|(own, _)| own.time).reduce(f64::min);
    let problem = match first {
        Some(first) if first < end => return Ok(()),
        Some(first) => format!(
            "the first of these fruit comes at {} s, and the scene ends at {end} s: let it come \
             earlier (`from`), or the scene end later",
            short(first)
        ),
        None => "there is no fruit of this kind: its count is 0".to_owned(),
    };
    Err(table.refused(&name.span(), "probe", name.get_ref(), problem))
}

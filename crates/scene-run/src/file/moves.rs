//! `[[moves]]` of scene.toml: what walls do, and when.

use crate::file::columns::quantities;
use crate::file::key::{Section, short};
use crate::file::walls::{RotationFile, VibrationFile, axis_of, vibration_of};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::Path as FilePath;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::table::data::{Data, read_data};
use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{TomlSource, suggestion};
use windfall_numerics::monotone_cubic::MonotoneCubic;
use windfall_scene::shape::motion::{Axis, How, Move, Path, When};
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::{Vector, length, scaled, subtract, unit};

/// `[[moves]]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MoveFile {
    /// Name, for studies.
    #[serde(rename = "name")]
    pub _name: Option<String>,
    /// Which walls.
    pub walls: Option<Spanned<Vec<Spanned<String>>>>,
    /// How far they go in all; m.
    pub shift: Option<Spanned<[f64; 3]>>,
    /// At which velocity they go; m/s.
    pub velocity: Option<Spanned<[f64; 3]>>,
    pub rotation: Option<Spanned<RotationFile>>,
    pub vibration: Option<Spanned<VibrationFile>>,
    /// Velocity of a belt's surface; m/s.
    pub belt: Option<Spanned<[f64; 3]>>,
    /// A table of positions.
    pub path: Option<Spanned<PathFile>>,
    /// When it begins.
    pub from: Option<Spanned<QuantityText>>,
    /// When it has ended.
    pub until: Option<Spanned<QuantityText>>,
    /// How long it takes to its full speed, and from there to rest.
    pub ramp: Option<Spanned<QuantityText>>,
}

/// `path`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathFile {
    /// A table with the column time, and x, y, z or angle.
    pub file: Spanned<String>,
    /// A point of the axis that angles are about; m.
    pub point: Option<[f64; 3]>,
    /// Its direction.
    pub axis: Option<[f64; 3]>,
}

/// Longest ramp where the file does not say one; s.
const RAMP: f64 = 0.1;
/// Part of its time that such a ramp takes at most; 1.
const RAMP_SHARE: f64 = 0.25;
/// Faster walls, between two rows of a table or by a shift or an angle, jump; m/s and rad/s.
const LARGEST_SPEED: f64 = 100.0;

/// Adds the moves of the file to the walls that they name.
///
/// * `end`: of the scene; s
///
/// # Errors
/// A move of no wall, or of none that there is; none or several kinds in one; times that cannot be;
/// a table that cannot be read or jumps; moves that cannot be together.
pub fn add_moves(
    source: &TomlSource,
    moves: &[Spanned<MoveFile>],
    walls: &mut [Wall],
    end: f64,
) -> Result<(), Error> {
    for own in moves {
        let table = Section {
            source,
            name: "[[moves]]",
            at: own.span(),
        };
        let numbers = walls_of(&table, own.get_ref(), walls)?;
        let found = move_of(&table, own.get_ref(), end)?;
        for number in numbers {
            let wall = &mut walls[number];
            wall.motion.moves.push(found.clone());
            if let Some(problem) = wall.motion.problem() {
                let name = wall.name.clone();
                return Err(table.refused(&own.span(), "walls", name, problem));
            }
        }
    }
    Ok(())
}

/// The numbers of the walls that a move names.
fn walls_of(table: &Section, file: &MoveFile, walls: &[Wall]) -> Result<Vec<usize>, Error> {
    let example = "walls = [\"bin\", \"pad\"]";
    let names = file.walls.as_ref().filter(|own| !own.get_ref().is_empty());
    let names = names.ok_or_else(|| table.lacks("walls", "which walls move", example))?;
    let mut found = Vec::new();
    for name in names.get_ref() {
        let text = name.get_ref();
        let number = walls.iter().position(|own| own.name == *text);
        let number = number.ok_or_else(|| {
            let near = suggestion(text, walls.iter().map(|own| own.name.as_str()));
            let problem = format!("the scene has no wall of that name{near}");
            table.refused(&name.span(), "walls", text, problem)
        })?;
        if found.contains(&number) {
            let problem = "it is named twice";
            return Err(table.refused(&name.span(), "walls", text, problem));
        }
        found.push(number);
    }
    Ok(found)
}

fn move_of(table: &Section, file: &MoveFile, end: f64) -> Result<Move, Error> {
    let kinds = [
        ("shift", file.shift.as_ref().map(Spanned::span)),
        ("velocity", file.velocity.as_ref().map(Spanned::span)),
        ("rotation", file.rotation.as_ref().map(Spanned::span)),
        ("vibration", file.vibration.as_ref().map(Spanned::span)),
        ("belt", file.belt.as_ref().map(Spanned::span)),
        ("path", file.path.as_ref().map(Spanned::span)),
    ];
    table.alone(&kinds, "write a [[moves]] for each")?;
    if kinds.iter().all(|(_, at)| at.is_none()) {
        let meaning = "one of shift, velocity, rotation, vibration, belt, path";
        let example = "shift = [0, 0, 0.3]";
        return Err(table.lacks("shift", meaning, example));
    }
    if let Some(path) = &file.path {
        for (key, value) in [
            ("from", &file.from),
            ("until", &file.until),
            ("ramp", &file.ramp),
        ] {
            if let Some(value) = value {
                let problem = "the times of a path are those of its table: leave it out";
                return Err(table.refused(&value.span(), key, value.get_ref(), problem));
            }
        }
        let found = path_of(table, path)?;
        return match found.when.from < end {
            true => Ok(found),
            false => Err(never_begins(table, "path file", &path.get_ref().file, end)),
        };
    }
    let when = when_of(table, file, end)?;
    let how = how_of(table, file, &when)?;
    Ok(Move { when, how })
}

/// The error of a move that begins after the end of the scene.
fn never_begins(table: &Section, key: &str, at: &Spanned<impl ToString>, end: f64) -> Error {
    let problem = format!("the scene ends at {} s: it would never begin", short(end));
    table.refused(&at.span(), key, at.get_ref().to_string(), problem)
}

/// Refuses walls that would have to jump.
///
/// * `speed`: m/s or rad/s
fn check_speed(
    table: &Section,
    at: &std::ops::Range<usize>,
    key: &str,
    speed: f64,
) -> Result<(), Error> {
    if speed <= LARGEST_SPEED {
        return Ok(());
    }
    let problem = format!(
        "the wall would have to move at {} m/s or rad/s to get there by `until`: give it more time",
        short(speed)
    );
    Err(table.refused(at, key, table.written(at), problem))
}

fn when_of(table: &Section, file: &MoveFile, end: f64) -> Result<When, Error> {
    let from = table.at_least_zero(&file.from, "from", "s")?.unwrap_or(0.0);
    if let Some(own) = file.from.as_ref().filter(|_| from >= end) {
        return Err(never_begins(table, "from", own, end));
    }
    let until = table.optional(&file.until, "until", "s")?;
    if let (Some(own), Some(until)) = (&file.until, until)
        && until <= from
    {
        let problem = format!("it must be after {} s, when the move begins", short(from));
        return Err(table.refused(&own.span(), "until", own.get_ref(), problem));
    }
    let until = until.unwrap_or(f64::INFINITY);
    let ramp = table.at_least_zero(&file.ramp, "ramp", "s")?;
    if let (Some(own), Some(ramp)) = (&file.ramp, ramp)
        // Half of it to the last digit is half of it.
        && 2.0 * ramp > (until - from) * (1.0 + 1e-9)
    {
        let problem = format!(
            "the move lasts {} s, and is to speed up and to slow down in that: give at most half of \
             it",
            short(until - from)
        );
        return Err(table.refused(&own.span(), "ramp", own.get_ref(), problem));
    }
    let ramp = ramp.unwrap_or_else(|| RAMP.min(RAMP_SHARE * (until - from)));
    let ramp = ramp.min(0.5 * (until - from));
    Ok(When { from, until, ramp })
}

fn how_of(table: &Section, file: &MoveFile, when: &When) -> Result<How, Error> {
    let needs_end = |at: &std::ops::Range<usize>, key: &str| match when.until.is_finite() {
        true => Ok(()),
        false => {
            let problem = "how far it goes in all needs an end: give `until` as well";
            Err(table.refused(at, key, table.written(at), problem))
        }
    };
    if let Some(own) = &file.shift {
        needs_end(&own.span(), "shift")?;
        let velocity = scaled(*own.get_ref(), 1.0 / when.whole());
        check_speed(table, &own.span(), "shift", length(velocity))?;
        return Ok(How::Velocity(velocity));
    }
    if let Some(own) = &file.velocity {
        return Ok(How::Velocity(*own.get_ref()));
    }
    if let Some(own) = &file.vibration {
        return vibration_of(table, own);
    }
    if let Some(own) = &file.belt {
        return Ok(How::Belt(*own.get_ref()));
    }
    let Some(turn) = &file.rotation else {
        return Err(table.lacks("shift", "what the walls do", "shift = [0, 0, 0.3]"));
    };
    let about = axis_of(table, turn)?;
    let own = turn.get_ref();
    let angular_velocity = match (&own.angular_velocity, &own.angle) {
        (Some(own), None) => table.given(own, "rotation angular_velocity", "rad/s")?,
        (None, Some(own)) => {
            needs_end(&own.span(), "rotation angle")?;
            let speed = table.given(own, "rotation angle", "rad")? / when.whole();
            check_speed(table, &own.span(), "rotation angle", speed.abs())?;
            speed
        }
        _ => {
            let problem = "give either angle = \"90 deg\" or angular_velocity = \"1 rad/s\"";
            return Err(table.refused(
                &turn.span(),
                "rotation",
                table.written(&turn.span()),
                problem,
            ));
        }
    };
    Ok(How::Rotation {
        about,
        angular_velocity,
    })
}

/// A move by a table of positions.
fn path_of(table: &Section, path: &Spanned<PathFile>) -> Result<Move, Error> {
    let file = path.get_ref();
    let name = table.named_file("path file", &file.file)?;
    let data = read_data(&name)?;
    let rows = Rows::of(&name, &data)?;
    let axis = match (&rows.angle, file.point, file.axis) {
        (None, None, None) => None,
        (Some(_), Some(point), Some(axis)) => {
            let direction = unit(axis).ok_or_else(|| {
                let problem = "an axis must have a length";
                table.refused(&path.span(), "path axis", "[0, 0, 0]", problem)
            })?;
            Some(Axis { point, direction })
        }
        (Some(_), ..) => {
            let problem =
                "its table has angles: give the `point` and the `axis` that they are about";
            return Err(table.refused(&path.span(), "path", file.file.get_ref(), problem));
        }
        (None, ..) => {
            let problem = "its table has no column of angles (angle_deg): leave out `point` and \
                           `axis`, or add it";
            return Err(table.refused(&path.span(), "path", file.file.get_ref(), problem));
        }
    };
    let curve = |values: &Vec<f64>| MonotoneCubic::new(&rows.time, values);
    Ok(Move {
        when: When {
            from: rows.time[0],
            until: rows.time[rows.time.len() - 1],
            ramp: 0.0,
        },
        how: How::Path(Box::new(Path {
            shift: rows.shift.each_ref().map(curve),
            turn: axis.zip(rows.angle.as_ref().map(curve)),
        })),
    })
}

/// Rows of a table of positions; SI.
struct Rows {
    time: Vec<f64>,
    shift: [Vec<f64>; 3],
    angle: Option<Vec<f64>>,
}

impl Rows {
    fn of(path: &FilePath, data: &Data) -> Result<Self, Error> {
        let column = |name: &str, unit: &str| {
            quantities(&data.table, name, unit).map_err(|error| data.told(error))
        };
        let wrong = |row: usize, problem: String| {
            let line = data.line(row);
            Err(unusable(format!("{} line {line}", path.display()), problem))
        };
        let of_file = |problem: &str| unusable(path.display().to_string(), problem);
        let time = column("time", "s")?;
        let time = time.ok_or_else(|| {
            of_file("a table of positions needs the column time_s (or another unit of time)")
        })?;
        let shifts = [column("x", "m")?, column("y", "m")?, column("z", "m")?];
        let angle = column("angle", "rad")?;
        if angle.is_none() && shifts.iter().all(Option::is_none) {
            let problem = "a table of positions needs some of the columns x_m, y_m, z_m (or other \
                           units of length) and angle_deg (or angle_rad)";
            return Err(of_file(problem));
        }
        if time.len() < 2 {
            return Err(of_file("a table of positions needs at least two rows"));
        }
        let shift = shifts.map(|own| own.unwrap_or_else(|| vec![0.0; time.len()]));
        let rows = Self { time, shift, angle };
        for row in 0..rows.time.len() {
            let (place, angle) = rows.at(row);
            if !(rows.time[row].is_finite()
                && place.iter().all(|own| own.is_finite())
                && angle.is_finite())
            {
                return wrong(row, "a cell is blank or no finite number".to_owned());
            }
            let Some(before) = row.checked_sub(1) else {
                continue;
            };
            let lasts = rows.time[row] - rows.time[before];
            if lasts <= 0.0 {
                let problem = "its time is not after that of the row before: sort the rows by time, \
                               each time once";
                return wrong(row, problem.to_owned());
            }
            let (place_before, angle_before) = rows.at(before);
            let speed = length(subtract(place, place_before)) / lasts;
            let turns = (angle - angle_before).abs() / lasts;
            let jump = match () {
                () if speed > LARGEST_SPEED => format!("{} m/s", short(speed)),
                () if turns > LARGEST_SPEED => format!("{} rad/s", short(turns)),
                () => continue,
            };
            return wrong(
                row,
                format!(
                    "the wall would get here from the row before within {} s, at {jump}: are its \
                     units right, or is a row missing?",
                    short(lasts)
                ),
            );
        }
        Ok(rows)
    }

    /// Displacement and angle of a row.
    fn at(&self, row: usize) -> (Vector, f64) {
        let angle = self.angle.as_ref().map_or(0.0, |own| own[row]);
        (self.shift.each_ref().map(|own| own[row]), angle)
    }
}

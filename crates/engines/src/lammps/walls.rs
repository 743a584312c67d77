//! Walls of a scene as regions of LAMMPS, with `fix wall/gran/region`.

use crate::deck::{Task, triple};
use crate::lammps::terms::terms;
use crate::law::PairNumbers;
use crate::walls::{Region, Tilt, region_of};
use std::fmt::Write;
use windfall_files::text::quote::comment_text;
use windfall_scene::shape::wall::{Motion, Wall};
use windfall_scene::vector::{Vector, add, dot, plus_scaled};

/// Regions and fixes of all walls.
///
/// # Errors
/// Walls that it cannot represent, each with its reason.
pub(crate) fn walls(task: &Task) -> Result<String, Vec<String>> {
    let mut text = String::new();
    task.each_wall(|number, wall| {
        text += &one(task, number, wall)?;
        Ok(())
    })?;
    Ok(text)
}

fn one(task: &Task, number: usize, wall: &Wall) -> Result<String, String> {
    let region = region_of(wall)?;
    let (variables, moves) = motion(number, wall, &region)?;
    let region = region.words();
    let mut text = format!("# {}\n{variables}", comment_text(&wall.name));
    let classes = &task.classes.classes;
    let mut done = Vec::new();
    for (class, own) in classes.iter().enumerate() {
        let interaction = task.interaction(own.material, wall.material)?;
        // One for all where size makes no difference.
        let one_for_all = !PairNumbers::by_size(interaction)
            && classes.iter().all(|a| a.material == own.material);
        if one_for_all && class > 0 {
            continue;
        }
        let group = match one_for_all || classes.len() == 1 {
            true => "all".to_owned(),
            false => format!("t{}", class + 1),
        };
        // A moving region reports its velocity once per step, so each fix needs its own.
        let shared = moves.is_empty();
        let id = match shared {
            true => format!("w{number}"),
            false => format!("w{number}_{class}"),
        };
        if !done.contains(&id) {
            let _ = writeln!(text, "region {id} {region}{moves} units box");
            done.push(id.clone());
        }
        let terms = terms(task, interaction, own.radius, own.mass)?;
        let _ = writeln!(
            text,
            "fix w{number}_{class} {group} wall/gran/region granular {terms} region {id}"
        );
    }
    Ok(text)
}

/// Variables of a wall's motion, and the words of its region that use them.
fn motion(number: usize, wall: &Wall, region: &Region) -> Result<(String, String), String> {
    let motion = &wall.motion;
    let (mut text, mut words) = (String::new(), String::new());
    let shift = shift(motion, region)?;
    if shift.iter().any(|own| !own.is_empty()) {
        words += " move";
        for (axis, formula) in ["x", "y", "z"].iter().zip(&shift) {
            if formula.is_empty() {
                words += " NULL";
                continue;
            }
            let _ = writeln!(text, "variable w{number}{axis} equal {formula}");
            let _ = write!(words, " v_w{number}{axis}");
        }
    }
    let turn = match (region.tilt(), motion.rotation) {
        (None, None) => return Ok((text, words)),
        (Some(Tilt { point, axis, angle }), None) => (point, axis, angle.to_string()),
        (None, Some(own)) => (
            own.point,
            own.axis,
            format!("{}*time", own.angular_velocity),
        ),
        (Some(_), Some(_)) => {
            return Err("it turns and does not stand along the axes".to_owned());
        }
    };
    let (point, axis, angle) = turn;
    let _ = writeln!(text, "variable w{number}turn equal {angle}");
    let _ = write!(
        words,
        " rotate v_w{number}turn {} {}",
        triple(point),
        triple(axis)
    );
    Ok((text, words))
}

/// Where a wall is along each axis, as a formula of the time; empty where it stays.
fn shift(motion: &Motion, region: &Region) -> Result<[String; 3], String> {
    let mut velocity = motion.velocity;
    if motion.surface_velocity != [0.0; 3] {
        // An endless plane that moves along itself is a belt.
        let Region::Plane { normal, .. } = region else {
            return Err(
                "a belt: of surfaces that run and stay it has endless planes alone (LIGGGHTS has \
                 others)"
                    .to_owned(),
            );
        };
        if motion.rotation.is_some() {
            return Err("a belt that turns".to_owned());
        }
        velocity = add(velocity, along(motion.surface_velocity, *normal));
    }
    Ok([0, 1, 2].map(|axis| {
        let mut parts = Vec::new();
        if velocity[axis] != 0.0 {
            parts.push(format!("{}*time", velocity[axis]));
        }
        if let Some(own) = motion.vibration
            && own.amplitude[axis] != 0.0
        {
            let rate = 2.0 * std::f64::consts::PI * own.frequency;
            parts.push(format!("{}*sin({rate}*time)", own.amplitude[axis]));
        }
        parts.join("+")
    }))
}

/// The part of a velocity along a plane.
fn along(velocity: Vector, normal: Vector) -> Vector {
    plus_scaled(velocity, normal, -dot(velocity, normal))
}

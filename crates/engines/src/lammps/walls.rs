//! Walls of a scene as regions of LAMMPS, with `fix wall/gran/region`.

use crate::deck::{Task, triple};
use crate::lammps::terms::terms;
use crate::law::PairNumbers;
use crate::walls::{Region, Tilt, region_of};
use std::fmt::Write;
use windfall_files::text::quote::comment_text;
use windfall_scene::shape::motion::{Axis, How, Motion, When};
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::{Vector, dot, plus_scaled};

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
    let turn = match (region.tilt(), turn(motion)) {
        (None, None) => return Ok((text, words)),
        (Some(Tilt { point, axis, angle }), None) => (point, axis, angle.to_string()),
        (None, Some((about, angle))) => (about.point, about.direction, angle),
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

/// The axis that a wall turns about, and its angle as a formula of the time.
fn turn(motion: &Motion) -> Option<(Axis, String)> {
    let (mut axis, mut angles) = (None, Vec::new());
    for own in &motion.moves {
        if let How::Rotation {
            about,
            angular_velocity,
        } = own.how
        {
            axis = Some(about);
            angles.push(format!("{angular_velocity}*{}", elapsed(&own.when)));
        }
    }
    axis.map(|axis| (axis, angles.join("+")))
}

/// Where a wall is along each axis, as a formula of the time; empty where it stays.
fn shift(motion: &Motion, region: &Region) -> Result<[String; 3], String> {
    let mut parts = [const { Vec::new() }; 3];
    let mut push = |vector: Vector, formula: &str| {
        for (parts, own) in parts.iter_mut().zip(vector) {
            if own != 0.0 {
                parts.push(format!("{own}*{formula}"));
            }
        }
    };
    for own in &motion.moves {
        match &own.how {
            How::Velocity(velocity) => push(*velocity, &elapsed(&own.when)),
            How::Belt(velocity) => {
                // An endless plane that moves along itself is a belt.
                let Region::Plane { normal, .. } = region else {
                    return Err(
                        "a belt: of surfaces that run and stay it has endless planes alone \
                         (LIGGGHTS has others)"
                            .to_owned(),
                    );
                };
                push(along(*velocity, *normal), &elapsed(&own.when));
            }
            How::Vibration {
                amplitude,
                frequency,
            } => {
                let rate = 2.0 * std::f64::consts::PI * frequency;
                push(*amplitude, &oscillation(&own.when, rate));
            }
            How::Rotation { .. } => {}
            How::Path(_) => {
                return Err(
                    "it follows a table of positions (windfall's own engine has it)".to_owned(),
                );
            }
        }
    }
    if motion.runs()
        && motion
            .moves
            .iter()
            .any(|own| matches!(own.how, How::Rotation { .. }))
    {
        return Err("a belt that turns".to_owned());
    }
    Ok(parts.map(|own| own.join("+")))
}

/// [`When::elapsed`] as a formula of the time.
fn elapsed(when: &When) -> String {
    let When { from, until, ramp } = *when;
    if *when == When::ALWAYS {
        return "v_time".to_owned();
    }
    // The part of a time above zero, or half the square of it over the ramp.
    let grows = |corner: f64| match ramp > 0.0 {
        true => format!("(v_time>{corner})*(v_time-{corner})^2/{}", 2.0 * ramp),
        false => format!("(v_time>{corner})*(v_time-{corner})"),
    };
    let mut corners = vec![(from, '+')];
    if ramp > 0.0 {
        corners.push((from + ramp, '-'));
    }
    if until.is_finite() && ramp > 0.0 {
        corners.push((until - ramp, '-'));
    }
    if until.is_finite() {
        corners.push((until, if ramp > 0.0 { '+' } else { '-' }));
    }
    let terms = corners
        .iter()
        .map(|(corner, sign)| format!("{sign}{}", grows(*corner)));
    let terms: String = terms.collect();
    format!("({})", terms.trim_start_matches('+'))
}

/// A vibration of amplitude 1 as a formula of the time.
///
/// * `rate`: rad/s
fn oscillation(when: &When, rate: f64) -> String {
    let When { from, until, ramp } = *when;
    if *when == When::ALWAYS {
        return format!("sin({rate}*v_time)");
    }
    let wave = format!("sin({rate}*(v_time-{from}))");
    let rises = match ramp > 0.0 {
        true => format!(
            "((v_time>{from})*(v_time-{from})-(v_time>{top})*(v_time-{top}))/{ramp}",
            top = from + ramp
        ),
        false => format!("(v_time>{from})"),
    };
    let falls = match (until.is_finite(), ramp > 0.0) {
        (true, true) => format!(
            "(1-((v_time>{top})*(v_time-{top})-(v_time>{until})*(v_time-{until}))/{ramp})",
            top = until - ramp
        ),
        (true, false) => format!("(v_time<{until})"),
        (false, _) => "1".to_owned(),
    };
    format!("{wave}*{rises}*{falls}")
}

/// The part of a velocity along a plane.
fn along(velocity: Vector, normal: Vector) -> Vector {
    plus_scaled(velocity, normal, -dot(velocity, normal))
}

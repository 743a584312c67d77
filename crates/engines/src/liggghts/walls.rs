//! Walls of a scene for LIGGGHTS: meshes of triangles, and endless planes along the axes.

use crate::deck::{Task, triple};
use crate::liggghts::model::{Model, Types, model_of, words};
use crate::walls::triangles_of;
use std::fmt::Write;
use windfall_files::text::quote::comment_text;
use windfall_scene::shape::motion::How;
use windfall_scene::shape::surface::Shape;
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::{Vector, cross, length, scaled, subtract};

/// Walls of a deck.
pub(crate) struct Walls {
    /// Their lines.
    pub text: String,
    /// Files of their meshes.
    pub meshes: Vec<(String, String)>,
}

/// All walls.
///
/// # Errors
/// Those that it cannot represent, each with its reason.
pub(crate) fn walls(task: &Task, types: &Types) -> Result<Walls, Vec<String>> {
    let mut found = Walls {
        text: String::new(),
        meshes: Vec::new(),
    };
    let (mut names, mut form) = (Vec::new(), None);
    task.each_wall(|number, wall| {
        let model = model(task, wall)?;
        if let Shape::Plane { point, normal } = wall.shape {
            found.text += &plane(task, types, (number, wall), (point, normal), model)?;
            return Ok(());
        }
        if *form.get_or_insert(model) != model {
            return Err(
                "all walls but endless planes need one form of law, k d or k d^1.5".to_owned(),
            );
        }
        let (text, stl) = mesh(types, number, wall)?;
        found.text += &text;
        found.meshes.push((format!("wall{number}.stl"), stl));
        names.push(format!("wall{number}"));
        Ok(())
    })?;
    if let Some(model) = form {
        let (form, options) = words(model, task.rolls());
        let _ = writeln!(
            found.text,
            "fix meshes all wall/gran {form} mesh n_meshes {} meshes {} {options}",
            names.len(),
            names.join(" ")
        );
    }
    Ok(found)
}

/// The form of the law that all fruit have with a wall.
fn model(task: &Task, wall: &Wall) -> Result<Model, String> {
    let mut found = None;
    for class in &task.classes.classes {
        let model = model_of(task.interaction(class.material, wall.material)?)?;
        if *found.get_or_insert(model) != model {
            return Err("its contacts with all fruit need one form of law".to_owned());
        }
    }
    found.ok_or_else(|| "there are no fruit".to_owned())
}

fn plane(
    task: &Task,
    types: &Types,
    (number, wall): (usize, &Wall),
    (point, normal): (Vector, Vector),
    model: Model,
) -> Result<String, String> {
    if !wall.motion.moves.is_empty() {
        return Err("an endless plane that moves: a plate can".to_owned());
    }
    let across = (0..3).find(|&axis| normal[axis].abs() == 1.0);
    let axis = across.ok_or("an endless plane that is not across an axis: a plate can")?;
    let (form, options) = words(model, task.rolls());
    Ok(format!(
        "# {}\nfix plane{number} all wall/gran {form} primitive type {} {}plane {} {options}\n",
        comment_text(&wall.name),
        types.of_wall(wall.material),
        ["x", "y", "z"][axis],
        point[axis]
    ))
}

fn mesh(types: &Types, number: usize, wall: &Wall) -> Result<(String, String), String> {
    let triangles = triangles_of(&wall.shape)?;
    if !wall.motion.is_steady() {
        return Err("its moves begin or end, or follow a table".to_owned());
    }
    let (mut belt, mut moves) = (String::new(), Vec::new());
    for own in &wall.motion.moves {
        match &own.how {
            How::Belt(velocity) => belt = format!(" surface_vel {}", triple(*velocity)),
            How::Velocity(velocity) => moves.push(format!("linear {}", triple(*velocity))),
            How::Vibration {
                amplitude,
                frequency,
            } => {
                let (amplitude, period) = (triple(*amplitude), 1.0 / frequency);
                moves.push(format!("wiggle amplitude {amplitude} period {period}"));
            }
            How::Rotation {
                about,
                angular_velocity,
            } => {
                let direction = triple(scaled(about.direction, angular_velocity.signum()));
                let period = 2.0 * std::f64::consts::PI / angular_velocity.abs();
                let point = triple(about.point);
                moves.push(format!(
                    "rotate origin {point} axis {direction} period {period}"
                ));
            }
            How::Path(_) => return Err("it follows a table".to_owned()),
        }
    }
    let mut text = format!(
        "# {}\nfix wall{number} all mesh/surface file wall{number}.stl type {}{belt}\n",
        comment_text(&wall.name),
        types.of_wall(wall.material)
    );
    for (place, own) in moves.iter().enumerate() {
        let _ = writeln!(
            text,
            "fix move{number}_{place} all move/mesh mesh wall{number} {own}"
        );
    }
    Ok((text, stl(&triangles)))
}

/// Triangles as STL text.
fn stl(triangles: &[[Vector; 3]]) -> String {
    let mut text = "solid wall\n".to_owned();
    for [a, b, c] in triangles {
        let across = cross(subtract(*b, *a), subtract(*c, *a));
        let normal = scaled(across, 1.0 / length(across));
        let _ = writeln!(text, "facet normal {}\nouter loop", triple(normal));
        for corner in [a, b, c] {
            let _ = writeln!(text, "vertex {}", triple(*corner));
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid wall\n"
}

//! Contacts and types in the words of LIGGGHTS.

use crate::law::PairNumbers;
use windfall_contact::granular_law::Damping;
use windfall_scene::interaction::Interaction;

/// A form of the normal force that LIGGGHTS has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Model {
    /// `hertz/stiffness`.
    Hertz,
    /// `hooke/stiffness absolute_damping on`.
    Hooke,
}

/// Types of atoms: materials of walls first, then classes of fruit.
pub(crate) struct Types {
    /// Materials of walls.
    pub walls: Vec<usize>,
}

impl Types {
    /// The type of a wall's material.
    pub(crate) fn of_wall(&self, material: usize) -> usize {
        let place = self.walls.iter().position(|own| *own == material);
        place.map_or(0, |place| place + 1)
    }
}

/// The form of a law.
///
/// # Errors
/// Why it has none.
pub(crate) fn model_of(interaction: &Interaction) -> Result<Model, String> {
    // The form depends on neither radius nor mass.
    let law = PairNumbers::of(interaction, 1.0, 1.0)?.law;
    match (law.hertzian, law.damping) {
        (true, Damping::None | Damping::Root(_)) => Ok(Model::Hertz),
        (false, Damping::None | Damping::Constant(_)) => Ok(Model::Hooke),
        _ => Err(
            "of Hertz's contact it has damping that grows as the root of the displacement \
                  alone"
                .to_owned(),
        ),
    }
}

/// The words of a form in a pair style or a wall.
pub(crate) fn words(model: Model, rolls: bool) -> (String, &'static str) {
    let name = match model {
        Model::Hertz => "hertz/stiffness",
        Model::Hooke => "hooke/stiffness",
    };
    let rolling = if rolls { " rolling_friction epsd2" } else { "" };
    let options = match model {
        Model::Hertz => "limitForce on",
        Model::Hooke => "limitForce on absolute_damping on",
    };
    (format!("model {name} tangential history{rolling}"), options)
}

//! What the decks of both engines have in common.

use crate::classes::{Classes, classes_of};
use crate::law::PairNumbers;
use std::collections::BTreeSet;
use windfall_files::found::FindingOutcome;
use windfall_files::text::quote::comment_text;
use windfall_scene::interaction::Interaction;
use windfall_scene::scene::{Fruit, Scene};
use windfall_scene::shape::mesh::bounds;
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::{Vector, length, scaled};

/// A deck: files in one directory, and findings.
#[derive(Clone, Debug)]
pub struct Deck {
    /// Names and contents; the first is the one that the engine is given.
    pub files: Vec<(String, String)>,
    /// Steps to the end.
    pub steps: u64,
    /// What the engine does otherwise than windfall.
    pub findings: Vec<FindingOutcome>,
}

/// What decks are made of.
pub struct Task<'a> {
    /// The scene, its fruit in the order in which they come.
    pub scene: &'a Scene,
    pub title: &'a str,
    /// Classes of fruit.
    pub classes: Classes,
    /// Steps to the end.
    pub steps: u64,
    /// Steps between frames.
    pub frame_steps: u64,
    /// Fastest fruit that is expected; m/s.
    pub speed: f64,
}

/// Name of the file of frames.
pub const FRAMES: &str = "frames.bin";

/// Its log, in the same place.
pub const LOG: &str = "log.txt";

/// Skin of the list of neighbours over the mean radius; 1.
const SKIN: f64 = 0.16;
/// Part of the skin that a fruit may go between looks at the list; 1.
const LOOK: f64 = 0.1;
/// How long a fruit waits whose place is taken; s.
const WAIT: f64 = 5e-3;
/// Load over the weight of a fruit at which the stiffness against rolling is right, where an
/// engine takes only one; 1.
const LOADED: f64 = 5.0;

impl<'a> Task<'a> {
    /// * `most`: classes of one material at most
    pub fn new(
        scene: &'a Scene,
        title: &'a str,
        most: usize,
        steps: u64,
        frame_steps: u64,
        speed: f64,
    ) -> Self {
        let classes = classes_of(scene, most);
        Self {
            scene,
            title,
            classes,
            steps,
            frame_steps,
            speed,
        }
    }

    /// Fruit that are there from the beginning; those behind them come later.
    pub fn first(&self) -> usize {
        self.scene
            .fruit
            .iter()
            .take_while(|own| own.time <= 0.0)
            .count()
    }

    /// The first step at which a fruit may come.
    pub fn step_of(&self, time: f64) -> u64 {
        (time / self.scene.time_step).ceil() as u64
    }

    /// Steps that a fruit waits.
    pub fn wait(&self) -> u64 {
        (WAIT / self.scene.time_step).round().max(1.0) as u64
    }

    /// Largest radius; m.
    pub fn largest(&self) -> f64 {
        self.scene
            .fruit
            .iter()
            .map(|own| own.radius)
            .fold(0.0, f64::max)
    }

    /// Skin of the list of neighbours; m.
    pub fn skin(&self) -> f64 {
        let sum = self.scene.fruit.iter().map(|own| own.radius).sum::<f64>();
        SKIN * sum / self.scene.fruit.len().max(1) as f64
    }

    /// Steps between looks at the list of neighbours.
    pub fn looks(&self) -> u64 {
        let way = self.speed * self.scene.time_step;
        ((LOOK * self.skin() / way) as u64).clamp(1, 20)
    }

    /// Elastic force at which the stiffness against rolling is right; N.
    pub fn load(&self, mass: f64) -> f64 {
        LOADED * mass * length(self.scene.gravity).max(1.0)
    }

    /// A box around all that is there from the beginning, and where fruit come; m.
    pub fn bounds(&self) -> [Vector; 2] {
        let fruit = self.scene.fruit.iter();
        let places = fruit.flat_map(|own| own.elsewhere.into_iter().flatten().chain([own.place]));
        let walls = self.scene.walls.iter();
        let walls = walls.flat_map(|wall| wall.shape.corners());
        let (low, high) = bounds(places.chain(walls));
        let margin = 2.0 * self.largest();
        [low.map(|own| own - margin), high.map(|own| own + margin)]
    }

    /// Laws of possible contacts that no engine has, each with its reason.
    pub fn lawless(&self) -> Vec<String> {
        let scene = self.scene;
        let kinds: BTreeSet<usize> = scene.fruit.iter().map(|own| own.material).collect();
        let with = kinds.iter().copied();
        let with: BTreeSet<usize> = with
            .chain(scene.walls.iter().map(|own| own.material))
            .collect();
        let mut reasons = Vec::new();
        for (&(a, b), interaction) in &scene.interactions {
            let touches =
                kinds.contains(&a) && with.contains(&b) || kinds.contains(&b) && with.contains(&a);
            if let (true, Err(reason)) = (touches, interaction.law.granular()) {
                let (a, b) = (&scene.materials[a], &scene.materials[b]);
                reasons.push(format!("the law of {a} and {b}, {reason}"));
            }
        }
        for wall in &scene.walls {
            let Some(curved) = wall.shape.curved() else {
                continue;
            };
            for &kind in &kinds {
                let Ok(interaction) = scene.interaction(kind, wall.material) else {
                    continue;
                };
                if PairNumbers::by_size(interaction) && !interaction.follows_radii() {
                    reasons.push(format!(
                        "the {curved} \"{}\" under a law that does not follow the radii: give its \
                         effective_radius",
                        wall.name
                    ));
                }
            }
        }
        reasons
    }

    /// What classes do to the coefficients.
    pub fn finding_of_classes(&self) -> Option<FindingOutcome> {
        let classes = &self.classes;
        (classes.damping_error > 0.0 || classes.stiffness_error > 0.0).then(|| {
            let message = format!(
                "the engine has coefficients for {} classes of size: damping coefficients of single \
                 fruit are off by up to {:.1} %, stiffnesses by up to {:.1} %; --classes makes more",
                classes.classes.len(),
                100.0 * classes.damping_error,
                100.0 * classes.stiffness_error
            );
            FindingOutcome::new("engine-classes", message)
        })
    }

    /// Commands for gravity and air drag, the same in both engines.
    pub fn fields(&self) -> String {
        let mut text = String::new();
        let size = length(self.scene.gravity);
        if size > 0.0 {
            let down = triple(scaled(self.scene.gravity, 1.0 / size));
            text += &format!("fix gravity all gravity {size} vector {down}\n");
        }
        if let Some(air) = self.scene.air {
            let drag = 0.5 * air.density * air.drag_coefficient;
            text += "compute radius all property/atom radius\n";
            for axis in ["x", "y", "z"] {
                text += &format!(
                    "variable drag{axis} atom -{drag}*PI*c_radius^2*sqrt(vx^2+vy^2+vz^2)*v{axis}\n"
                );
            }
            text += "fix air all addforce v_dragx v_dragy v_dragz\n";
        }
        text
    }

    /// The box of the scene, or where the fruit are read from that are in it.
    pub(crate) fn space(&self, [low, high]: [Vector; 2], types: usize) -> String {
        match self.first() > 0 {
            true => "read_data fruit.data".to_owned(),
            false => format!(
                "region scene block {} units box\ncreate_box {types} scene",
                sides(low, high)
            ),
        }
    }

    /// The region of a sink.
    pub(crate) fn sink(&self, number: usize) -> String {
        let sink = &self.scene.sinks[number];
        format!(
            "# sink: {}\nregion sink{number} block {} units box\n",
            comment_text(&sink.name),
            sides(sink.low, sink.high)
        )
    }

    /// Neighbours, the time step, and what is printed.
    pub(crate) fn stepping(&self) -> String {
        format!(
            "neighbor {} bin\nneigh_modify delay 0 every {} check yes\ntimestep {}\n\
             thermo_style custom step atoms\nthermo {}\nthermo_modify lost error\n",
            self.skin(),
            self.looks(),
            self.scene.time_step,
            (self.steps / 20).max(1),
        )
    }

    /// Fruit that come before the end, with their numbers.
    pub(crate) fn coming(&self) -> impl Iterator<Item = (usize, &Fruit)> {
        let coming = self.scene.fruit.iter().enumerate().skip(self.first());
        coming.filter(|(_, own)| self.step_of(own.time) < self.steps)
    }

    /// fruit.data: those that are there from the beginning.
    ///
    /// * `walls`: types of atoms before those of fruit
    /// * `atoms`: the title of their table
    pub(crate) fn data(&self, [low, high]: [Vector; 2], walls: usize, atoms: &str) -> String {
        let first = self.first();
        let mut text = format!(
            "fruit of a scene of windfall\n\n{first} atoms\n{} atom types\n\n",
            walls + self.classes.classes.len()
        );
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            text += &format!("{} {} {name}lo {name}hi\n", low[axis], high[axis]);
        }
        text += &format!("\n{atoms}\n\n");
        for (number, fruit) in self.scene.fruit[..first].iter().enumerate() {
            text += &format!(
                "{} {} {} {} {}\n",
                number + 1,
                walls + self.classes.of_fruit[number] + 1,
                2.0 * fruit.radius,
                density(fruit),
                triple(fruit.place)
            );
        }
        text += "\nVelocities\n\n";
        for (number, fruit) in self.scene.fruit[..first].iter().enumerate() {
            let (velocity, spin) = (triple(fruit.velocity), triple(fruit.spin));
            text += &format!("{} {velocity} {spin}\n", number + 1);
        }
        text
    }

    /// How two materials interact.
    pub(crate) fn interaction(&self, a: usize, b: usize) -> Result<&Interaction, String> {
        let found = self.scene.interaction(a, b);
        found.map_err(|problem| problem.to_string())
    }

    /// What every wall makes of a deck.
    ///
    /// # Errors
    /// Walls that the engine cannot represent, each with its reason.
    pub(crate) fn each_wall(
        &self,
        mut one: impl FnMut(usize, &Wall) -> Result<(), String>,
    ) -> Result<(), Vec<String>> {
        let walls = self.scene.walls.iter().enumerate();
        let reasons = walls.filter_map(|(number, wall)| {
            let reason = one(number, wall).err()?;
            Some(format!("the wall \"{}\": {reason}", wall.name))
        });
        let reasons: Vec<String> = reasons.collect();
        match reasons.is_empty() {
            true => Ok(()),
            false => Err(reasons),
        }
    }

    /// Whether some contact resists rolling.
    pub fn rolls(&self) -> bool {
        let mut all = self.scene.interactions.values();
        all.any(|own| own.rolling > 0.0 && own.friction > 0.0)
    }
}

/// Density of a fruit as a sphere; kg/m³.
pub fn density(fruit: &Fruit) -> f64 {
    fruit.mass / (4.0 / 3.0 * std::f64::consts::PI * fruit.radius.powi(3))
}

/// Vectors as variables of a deck, by their names.
pub(crate) fn variables(vectors: &[(&str, Vector)]) -> String {
    let axes = ["x", "y", "z"];
    let each = vectors.iter().flat_map(|(name, vector)| {
        let parts = axes.iter().zip(vector);
        parts.map(move |(axis, value)| format!("variable {name}{axis} string {value}\n"))
    });
    each.collect()
}

/// Opposite corners as a block of a deck.
pub(crate) fn sides(low: Vector, high: Vector) -> String {
    let ends = low.iter().zip(high);
    let ends: Vec<String> = ends.map(|(low, high)| format!("{low} {high}")).collect();
    ends.join(" ")
}

/// Three numbers of a deck.
pub fn triple([x, y, z]: Vector) -> String {
    format!("{x} {y} {z}")
}

//! What the decks of both engines have in common.

use crate::classes::{Classes, classes_of};
use crate::law::PairNumbers;
use std::collections::BTreeSet;
use windfall_files::found::FindingOutcome;
use windfall_scene::scene::{Fruit, Scene};
use windfall_scene::shape::wall::Shape;
use windfall_scene::vector::{Vector, length, scaled};

/// A deck: files in one directory, and what is to be known of them.
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
    /// Its title.
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
    #[must_use]
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
    #[must_use]
    pub fn first(&self) -> usize {
        self.scene
            .fruit
            .iter()
            .take_while(|own| own.time <= 0.0)
            .count()
    }

    /// The first step at which a fruit may come.
    #[must_use]
    pub fn step_of(&self, time: f64) -> u64 {
        (time / self.scene.time_step).ceil() as u64
    }

    /// Steps that a fruit waits.
    #[must_use]
    pub fn wait(&self) -> u64 {
        (WAIT / self.scene.time_step).round().max(1.0) as u64
    }

    /// Largest radius; m.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.scene
            .fruit
            .iter()
            .map(|own| own.radius)
            .fold(0.0, f64::max)
    }

    /// Skin of the list of neighbours; m.
    #[must_use]
    pub fn skin(&self) -> f64 {
        let sum = self.scene.fruit.iter().map(|own| own.radius).sum::<f64>();
        SKIN * sum / self.scene.fruit.len().max(1) as f64
    }

    /// Steps between looks at the list of neighbours.
    #[must_use]
    pub fn looks(&self) -> u64 {
        let way = self.speed * self.scene.time_step;
        ((LOOK * self.skin() / way) as u64).clamp(1, 20)
    }

    /// Elastic force at which the stiffness against rolling is right; N.
    #[must_use]
    pub fn load(&self, mass: f64) -> f64 {
        LOADED * mass * length(self.scene.gravity).max(1.0)
    }

    /// A box around all that is there from the beginning, and where fruit come; m.
    #[must_use]
    pub fn bounds(&self) -> [Vector; 2] {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        let mut take = |place: Vector| {
            for axis in 0..3 {
                low[axis] = low[axis].min(place[axis]);
                high[axis] = high[axis].max(place[axis]);
            }
        };
        for fruit in &self.scene.fruit {
            take(fruit.place);
            fruit.elsewhere.iter().flatten().for_each(|own| take(*own));
        }
        for wall in &self.scene.walls {
            match &wall.shape {
                Shape::Plane { .. } => {}
                Shape::Plates(plates) => {
                    plates
                        .iter()
                        .flat_map(|own| own.corners())
                        .for_each(&mut take);
                }
                Shape::Cylinder { start, end, radius } => {
                    for own in [start, end] {
                        take(own.map(|own| own - radius));
                        take(own.map(|own| own + radius));
                    }
                }
                Shape::Mesh { triangles } => {
                    triangles.iter().flatten().for_each(|own| take(*own));
                }
            }
        }
        let margin = 2.0 * self.largest();
        [low.map(|own| own - margin), high.map(|own| own + margin)]
    }

    /// Why laws of contacts that can be cannot be put into an engine's terms.
    #[must_use]
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
            let tube = matches!(wall.shape, Shape::Cylinder { .. });
            for &kind in &kinds {
                let Ok(interaction) = scene.interaction(kind, wall.material) else {
                    continue;
                };
                if tube && PairNumbers::by_size(interaction) && !interaction.follows_radii() {
                    reasons.push(format!(
                        "the cylinder \"{}\" under a law that does not follow the radii: give its \
                         effective_radius",
                        wall.name
                    ));
                }
            }
        }
        reasons
    }

    /// What classes do to the coefficients.
    #[must_use]
    pub fn finding_of_classes(&self) -> Option<FindingOutcome> {
        let classes = &self.classes;
        (classes.damping_error > 0.0 || classes.stiffness_error > 0.0).then(|| FindingOutcome {
            code: "engine-classes".to_owned(),
            message: format!(
                "the engine has coefficients for {} classes of size: damping coefficients of single \
                 fruit are off by up to {:.1} %, stiffnesses by up to {:.1} %; --classes makes more",
                classes.classes.len(),
                100.0 * classes.damping_error,
                100.0 * classes.stiffness_error
            ),
        })
    }

    /// Gravity and the drag of the air, in words that both engines have.
    #[must_use]
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

    /// Whether some contact resists rolling.
    #[must_use]
    pub fn rolls(&self) -> bool {
        let mut all = self.scene.interactions.values();
        all.any(|own| own.rolling > 0.0 && own.friction > 0.0)
    }
}

/// Text as a comment of a deck: nothing that an engine would act on.
#[must_use]
pub fn comment(text: &str) -> String {
    let plain = |own: char| match own {
        '&' | '"' | '\'' | '$' => '_',
        own if own.is_control() => ' ',
        own => own,
    };
    text.chars().map(plain).collect()
}

/// Density of a fruit as a sphere; kg/m³.
#[must_use]
pub fn density(fruit: &Fruit) -> f64 {
    fruit.mass / (4.0 / 3.0 * std::f64::consts::PI * fruit.radius.powi(3))
}

/// Three numbers of a deck.
#[must_use]
pub fn triple([x, y, z]: Vector) -> String {
    format!("{x} {y} {z}")
}

//! Which time step a scene needs, and what error it makes.

use crate::error::Error;
use crate::interaction::Interaction;
use crate::motion::simulation::Simulation;
use crate::scene::{Fruit, Scene};
use crate::shape::motion::Motion;
use crate::shape::surface::Shape;
use crate::shape::wall::Wall;
use std::collections::BTreeMap;

/// What a time step does to one impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepError {
    /// Contact duration; s.
    pub duration: f64,
    /// Relative error of the peak force; 1.
    pub peak: f64,
    /// Error of the absorbed energy, over the impact energy; 1.
    pub energy: f64,
}

/// One impact of a fruit on a wall, of half the mass where two fruit meet.
#[derive(Clone, Copy, Debug)]
pub struct Impact<'a> {
    /// What happens where they touch.
    pub interaction: &'a Interaction,
    /// R*; m.
    pub radius: f64,
    /// Effective mass; kg.
    pub mass: f64,
    /// Impact speed; m/s.
    pub speed: f64,
}

/// Contact duration (s), peak force (N) and absorbed energy (J) of an impact.
struct Measured {
    duration: f64,
    peak: f64,
    energy: f64,
}

/// The finest step that stands for no error, over the contact duration; 1.
const FINE: f64 = 1.0 / 4000.0;
/// Longest step over the contact duration; 1. Stiffer contacts in a dense bed need room.
const LONGEST: f64 = 1.0 / 20.0;
/// Where in a step first touch is looked at; of the step.
const PHASES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 0.95];
/// Steps looked at, each this part of the one before.
pub const SHORTER: f64 = 0.8;
/// Shortest step over the contact duration; 1.
pub const SHORTEST: f64 = 1.0 / 1000.0;

impl Impact<'_> {
    /// What a step does to this impact, by the very code of scenes.
    pub fn error_of(&self, step: f64) -> Result<StepError, Error> {
        self.error_beside(&self.measured(FINE * self.duration()?, 0.5)?, step)
    }

    /// What a step does to this impact, where first touch comes at the worst.
    ///
    /// * `fine`: the impact without error
    fn error_beside(&self, fine: &Measured, step: f64) -> Result<StepError, Error> {
        let impact_energy = 0.5 * self.mass * self.speed * self.speed;
        let (mut peak, mut energy) = (0.0_f64, 0.0_f64);
        for phase in PHASES {
            let own = self.measured(step, phase)?;
            peak = peak.max((own.peak / fine.peak - 1.0).abs());
            energy = energy.max((own.energy - fine.energy).abs() / impact_energy);
        }
        Ok(StepError {
            duration: fine.duration,
            peak,
            energy,
        })
    }

    /// The longest step that errs by no more than `error` in peak force and energy, with
    /// what it does.
    pub fn step_for(&self, error: f64) -> Result<(f64, StepError), Error> {
        let duration = self.duration()?;
        let fine = self.measured(FINE * duration, 0.5)?;
        let mut step = LONGEST * duration;
        loop {
            let found = self.error_beside(&fine, step)?;
            if found.peak.max(found.energy) <= error || step < SHORTEST * duration {
                return Ok((step, found));
            }
            step *= SHORTER;
        }
    }

    /// Whether the bodies do not come so close that their law means nothing.
    pub fn is_shallow(&self) -> bool {
        !matches!(self.duration(), Err(Error::Overlap { .. }))
    }

    /// Contact duration; s.
    fn duration(&self) -> Result<f64, Error> {
        // From a guess that is far too short to one that is fine.
        let mut step = 1e-7;
        for _ in 0..3 {
            step = 0.002 * self.measured(step, 0.5)?.duration;
        }
        Ok(step / 0.002)
    }

    /// The impact with a time step.
    ///
    /// * `phase`: of the step at first touch; 1
    fn measured(&self, step: f64, phase: f64) -> Result<Measured, Error> {
        let wall = Wall {
            name: "wall".to_owned(),
            material: 1,
            shape: Shape::Plane {
                point: [0.0; 3],
                normal: [0.0, 0.0, 1.0],
            },
            motion: Motion::default(),
        };
        let height = self.radius + phase * self.speed * step;
        let mut fruit = Fruit::sphere(0, self.radius, 1.0, [0.0, 0.0, height]);
        fruit.mass = self.mass;
        fruit.velocity = [0.0, 0.0, -self.speed];
        let scene = Scene {
            materials: vec!["fruit".to_owned(), "wall".to_owned()],
            interactions: BTreeMap::from([
                ((0, 0), self.interaction.clone()),
                ((0, 1), self.interaction.clone()),
            ]),
            walls: vec![wall],
            fruit: vec![fruit],
            time_step: step,
            ..Scene::default()
        };
        let mut simulation = Simulation::new(scene)?;
        for _ in 0..MOST_STEPS {
            simulation.step()?;
            if let Some(event) = simulation.take_events().first() {
                return Ok(Measured {
                    duration: event.duration,
                    peak: event.peak_force,
                    energy: event.absorbed_energy,
                });
            }
        }
        Err(Error::Value {
            what: "the duration of a contact",
            value: MOST_STEPS as f64 * step,
            problem: "it does not end",
        })
    }
}

/// Steps after which a contact counts as one that does not end.
const MOST_STEPS: usize = 2_000_000;

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_contact::expression::parse_law;

    #[test]
    fn a_step_is_as_long_as_its_error_allows() {
        let law = parse_law("kuwabara-kono(k=753599, c=1524)").unwrap();
        let interaction = Interaction::frictionless(law.complete().unwrap());
        let impact = Impact {
            interaction: &interaction,
            radius: 0.04,
            mass: 0.2,
            speed: 0.5,
        };
        let (step, found) = impact.step_for(1e-3).unwrap();
        assert!(found.peak <= 1e-3 && found.energy <= 1e-3, "{found:?}");
        // Ended at zero force after 7.65 ms.
        assert!((found.duration / 7.6501e-3 - 1.0).abs() < 1e-4, "{found:?}");
        assert!(step > 2e-5 && step < 4e-4, "{step}");
        let (finer, _) = impact.step_for(1e-5).unwrap();
        // Second order: a hundredth of the error for a tenth of the step, roughly.
        assert!(finer < 0.25 * step && finer > 0.02 * step, "{finer} {step}");
    }
}

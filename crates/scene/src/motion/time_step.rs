//! Which time step a scene needs, and what error it makes.

use crate::error::Error;
use crate::interaction::Interaction;
use crate::motion::simulation::Simulation;
use crate::scene::{Fruit, Scene};
use crate::shape::motion::{How, Motion, Move, When};
use crate::shape::surface::Shape;
use crate::shape::wall::Wall;
use std::collections::BTreeMap;
use std::f64::consts::PI;

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
    /// How the wall shakes that it may be on.
    pub shaking: Option<Shaking>,
}

/// A vibration along the normal of a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaking {
    /// Amplitude; m.
    pub amplitude: f64,
    /// Frequency; Hz.
    pub frequency: f64,
}

impl Shaking {
    /// Largest acceleration; m/s².
    pub fn acceleration(&self) -> f64 {
        self.amplitude * (2.0 * PI * self.frequency).powi(2)
    }
}

/// When an impact begins.
#[derive(Clone, Copy, Debug)]
struct Begin {
    /// First touch, in a step; of the step.
    in_step: f64,
    /// First touch, in a vibration of a wall that shakes; of the period.
    in_period: Option<f64>,
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
/// The same on a wall that shakes, where errors change faster with it; of the step.
const SHAKEN_PHASES: [f64; 8] = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875];
/// Where in a vibration first touch is looked at; of the period.
const SHAKEN: [f64; 8] = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875];
/// Steps looked at, each this part of the one before.
pub const SHORTER: f64 = 0.8;
/// Shortest step over the contact duration; 1.
pub const SHORTEST: f64 = 1.0 / 1000.0;

impl Impact<'_> {
    /// What a step does to this impact, by the very code of scenes.
    pub fn error_of(&self, step: f64) -> Result<StepError, Error> {
        self.error_beside(&self.without_error()?, step)
    }

    /// The impact at rest and at each phase of a vibration, without error.
    fn without_error(&self) -> Result<Vec<(Option<f64>, Measured)>, Error> {
        let step = FINE * self.duration()?;
        let shaken = SHAKEN.map(Some);
        let shaken = self.shaking.map_or(&[][..], |_| &shaken[..]);
        let phases = [None].into_iter().chain(shaken.iter().copied());
        let measured = |in_period| {
            let begin = Begin {
                in_step: 0.5,
                in_period,
            };
            Ok((in_period, self.measured(step, begin)?))
        };
        phases.map(measured).collect()
    }

    /// What a step does to this impact, where first touch comes at the worst.
    ///
    /// * `fine`: the impact without error
    fn error_beside(
        &self,
        fine: &[(Option<f64>, Measured)],
        step: f64,
    ) -> Result<StepError, Error> {
        let impact_energy = 0.5 * self.mass * self.speed * self.speed;
        let (mut peak, mut energy) = (0.0_f64, 0.0_f64);
        for (in_period, fine) in fine {
            let phases = match in_period {
                Some(_) => &SHAKEN_PHASES[..],
                None => &PHASES,
            };
            for &in_step in phases {
                let begin = Begin {
                    in_step,
                    in_period: *in_period,
                };
                let own = self.measured(step, begin)?;
                peak = peak.max((own.peak / fine.peak - 1.0).abs());
                energy = energy.max((own.energy - fine.energy).abs() / impact_energy);
            }
        }
        Ok(StepError {
            duration: fine[0].1.duration,
            peak,
            energy,
        })
    }

    /// The longest step that errs by no more than `error` in peak force and energy, with
    /// what it does.
    pub fn step_for(&self, error: f64) -> Result<(f64, StepError), Error> {
        let fine = self.without_error()?;
        let duration = self.duration()?;
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
        // From steps of which a stiff contact may take few to one that is fine.
        let mut step = (COARSE * self.radius / self.speed).min(LONGEST_GUESS);
        let mut duration = loop {
            match self.measured(step, AT_REST) {
                Ok(own) if own.duration > 100.0 * step => break own.duration,
                // A contact that does not end, and one that fails with any step.
                Err(error @ Error::Value { .. }) => return Err(error),
                Err(error) if step < SHORTEST_GUESS => return Err(error),
                _ => step *= 0.1,
            }
        };
        for _ in 0..2 {
            duration = self.measured(0.002 * duration, AT_REST)?.duration;
        }
        Ok(duration)
    }

    /// The impact with a time step.
    fn measured(&self, step: f64, begin: Begin) -> Result<Measured, Error> {
        let touch = begin.in_step * step;
        let shaken = self.shaking.zip(begin.in_period);
        let shaken = shaken.map(|(own, phase)| Move {
            when: When {
                // A period earlier, so that it shakes before they touch.
                from: touch - (1.0 + phase) / own.frequency,
                ..When::ALWAYS
            },
            how: How::Vibration {
                amplitude: [0.0, 0.0, own.amplitude],
                frequency: own.frequency,
            },
        });
        let wall = Wall {
            name: "wall".to_owned(),
            material: 1,
            shape: Shape::Plane {
                point: [0.0; 3],
                normal: [0.0, 0.0, 1.0],
            },
            motion: Motion {
                moves: shaken.into_iter().collect(),
            },
        };
        let placed = wall.motion.at(touch);
        let velocity = placed.velocity[2] - self.speed;
        let height = placed.shift[2] + self.radius - velocity * begin.in_step * step;
        let mut fruit = Fruit::sphere(0, self.radius, 1.0, [0.0, 0.0, height]);
        fruit.mass = self.mass;
        fruit.velocity = [0.0, 0.0, velocity];
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

/// Way in the first step by which a contact duration is looked for, over the radius; 1.
const COARSE: f64 = 1e-3;
/// The longest such step; s.
const LONGEST_GUESS: f64 = 1e-3;
/// Impacts that fail even with a shorter step fail with any; s.
const SHORTEST_GUESS: f64 = 1e-7;
/// Steps after which a contact counts as one that does not end.
const MOST_STEPS: usize = 2_000_000;
/// On a wall that does not shake.
const AT_REST: Begin = Begin {
    in_step: 0.5,
    in_period: None,
};

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_contact::expression::parse_law;

    fn apple() -> Interaction {
        let law = parse_law("kuwabara-kono(k=753599, c=1524)").unwrap();
        Interaction::frictionless(law.complete().unwrap())
    }

    fn impact(interaction: &Interaction, speed: f64, shaking: Option<Shaking>) -> Impact<'_> {
        Impact {
            interaction,
            radius: 0.04,
            mass: 0.2,
            speed,
            shaking,
        }
    }

    #[test]
    fn a_step_is_as_long_as_its_error_allows() {
        let apple = apple();
        let impact = impact(&apple, 0.5, None);
        let (step, found) = impact.step_for(1e-3).unwrap();
        assert!(found.peak <= 1e-3 && found.energy <= 1e-3, "{found:?}");
        // Ended at zero force after 7.65 ms.
        assert!((found.duration / 7.6501e-3 - 1.0).abs() < 1e-4, "{found:?}");
        assert!(step > 2e-5 && step < 4e-4, "{step}");
        let (finer, _) = impact.step_for(1e-5).unwrap();
        // Second order: a hundredth of the error for a tenth of the step, roughly.
        assert!(finer < 0.25 * step && finer > 0.02 * step, "{finer} {step}");
    }

    #[test]
    fn a_stated_error_holds_on_a_floor_that_shakes() {
        let apple = apple();
        let shaking = Shaking {
            amplitude: 2e-3,
            frequency: 100.0,
        };
        let (longer, _) = impact(&apple, 2.0, None).step_for(1e-3).unwrap();
        let impact = impact(&apple, 2.0, Some(shaking));
        let (step, stated) = impact.step_for(1e-3).unwrap();
        assert!(step < 0.8 * longer, "{step} {longer}");
        let fine = FINE * stated.duration;
        let at = |in_step, period| Begin {
            in_step,
            in_period: Some(period),
        };
        // SciPy's DOP853 at 1e-11: phase, peak force, absorbed energy.
        for (period, peak, energy) in [
            (0.0, 135.886_719_58, 0.231_278_577),
            (0.375, 184.592_828_33, 0.371_935_194),
            (0.625, 326.407_304_75, 0.935_890_363),
            (0.875, 209.632_713_51, 0.467_943_534),
        ] {
            let own = impact.measured(fine, at(0.5, period)).unwrap();
            assert!(
                (own.peak / peak - 1.0).abs() < 1e-5,
                "{period}: {}",
                own.peak
            );
            assert!(
                (own.energy / energy - 1.0).abs() < 1e-5,
                "{period}: {}",
                own.energy
            );
        }
        // Errors over the stated ones, the worst of each phase of the vibration.
        let over = |period: f64| {
            let exact = impact.measured(fine, at(0.5, period)).unwrap();
            let of_share = |share: u32| {
                let begin = at(f64::from(share) / 16.0, period);
                let own = impact.measured(step, begin).unwrap();
                let energy = (own.energy - exact.energy).abs() / (0.5 * 0.2 * 4.0);
                let peak = (own.peak / exact.peak - 1.0).abs();
                (peak / stated.peak).max(energy / stated.energy)
            };
            (0..16).map(of_share).fold(0.0, f64::max)
        };
        let mut worst: Vec<f64> = (0..24).map(|own| over(f64::from(own) / 24.0)).collect();
        worst.sort_by(f64::total_cmp);
        // Between the phases that were looked at, a little more; no step is short enough for the
        // one at which the floor just catches the fruit again.
        assert!(worst[22] < 1.1 && worst[23] < 4.0, "{worst:?} {stated:?}");
    }
}

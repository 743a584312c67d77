//! Which loads of a scene are static rather than impacts.

use std::collections::BTreeMap;
use windfall_contact::law::EndRule;
use windfall_identify::rig::simulate::simulate_impact;
use windfall_scene::event::Event;
use windfall_scene::interaction::{Draws, Interaction};
use windfall_scene::scene::Scene;

/// A load that has not fallen below half of its peak for so many times the duration of a single
/// impact of its speed is static.
const LONGER: f64 = 10.0;
/// Speeds at which the duration of a single impact is known: from, times, how often. m/s.
const SPEEDS: (f64, f64, usize) = (1e-3, 2.0, 14);

/// Durations of single impacts, by the pair of materials and the speed.
#[derive(Clone, Debug)]
pub struct StaticLoads {
    /// At the speeds of [`SPEEDS`]; s. Endless where the bodies stay together.
    durations: BTreeMap<(usize, usize), Vec<f64>>,
}

impl StaticLoads {
    /// For the mean fruit of each material.
    pub fn of(scene: &Scene) -> Self {
        let durations = scene.interactions.iter();
        let durations = durations.map(|(&pair, own)| (pair, durations_of(scene, pair, own)));
        Self {
            durations: durations.collect(),
        }
    }

    /// Whether a load is static: it is a rest of its contact, or took more than ten times as long
    /// as a single impact of its speed to fall below half of its peak.
    pub fn is_static(&self, scene: &Scene, event: &Event) -> bool {
        if event.resting {
            return true;
        }
        let durations = self.durations.get(&scene.materials_of(event));
        let (first, factor, _) = SPEEDS;
        // Between two speeds the slower one, which lasts longer.
        let place = (event.normal_speed.max(first) / first).log2() / factor.log2();
        durations
            .and_then(|all| all.get(place as usize).or(all.last()))
            .is_some_and(|single| event.width > LONGER * single)
    }
}

fn durations_of(scene: &Scene, pair: (usize, usize), own: &Interaction) -> Vec<f64> {
    let Some((radius, mass)) = scene.mean_contact(pair) else {
        return Vec::new();
    };
    let law = own
        .law_of(radius, &Draws::default(), None)
        .unwrap_or(own.law);
    let (first, factor, count) = SPEEDS;
    let duration = |place: i32| {
        let speed = first * factor.powi(place);
        let impact = simulate_impact(&law, mass, speed, 0.0, EndRule::ForceZero);
        impact.map_or(f64::INFINITY, |own| own.contact_duration)
    };
    (0..count as i32).map(duration).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_contact::laws::kind::LawKind;
    use windfall_scene::event::Partner;
    use windfall_scene::scene::Fruit;
    use windfall_scene::shape::motion::Motion;
    use windfall_scene::shape::surface::Shape;
    use windfall_scene::shape::wall::Wall;

    /// A spring and a mass: half a period, π √(m/k), at any speed.
    #[test]
    fn closed_form_durations_of_a_linear_spring() {
        let law = LawKind::KelvinVoigt.with_parameters(&[1e4, 0.0]).unwrap();
        let mut fruit = Fruit::sphere(0, 0.04, 1.0, [0.0; 3]);
        fruit.mass = 0.2;
        let wall = Wall {
            name: "wall".to_owned(),
            material: 1,
            shape: Shape::Plane {
                point: [0.0; 3],
                normal: [0.0, 0.0, 1.0],
            },
            motion: Motion::default(),
        };
        let scene = Scene {
            materials: vec!["apple".to_owned(), "steel".to_owned()],
            interactions: [((0, 1), Interaction::frictionless(law))].into(),
            fruit: vec![fruit],
            walls: vec![wall],
            ..Scene::default()
        };
        let loads = StaticLoads::of(&scene);
        let single = std::f64::consts::PI * (0.2_f64 / 1e4).sqrt();
        let event = |normal_speed: f64, duration: f64, resting: bool| Event {
            fruit: 0,
            partner: Partner::Wall(0),
            time: 0.0,
            duration,
            lasting: false,
            number: 1,
            resting,
            width: duration,
            place: [0.0; 3],
            spot: [0.0; 3],
            other_spot: [0.0; 3],
            normal_speed,
            tangential_speed: 0.0,
            peak_force: 1.0,
            largest_displacement: 0.0,
            absorbed_energy: 0.0,
            friction_energy: 0.0,
        };
        for speed in [0.0, 1e-3, 0.3, 50.0] {
            assert!(
                !loads.is_static(&scene, &event(speed, 9.99 * single, false)),
                "{speed}"
            );
            assert!(
                loads.is_static(&scene, &event(speed, 10.01 * single, false)),
                "{speed}"
            );
        }
        assert!(loads.is_static(&scene, &event(1.0, 0.0, true)));
    }
}

//! The eight impacts of Chung and Ooi (2011), Granul. Matter 13, 643, "Benchmark tests for
//! verifying discrete element modelling codes at particle impact level", against their
//! analytic results. Materials of tests 1 to 5 as there; tests 6 to 8, whose results depend
//! on friction, restitution, sizes and velocities alone while the contact slides, with an
//! aluminium alloy.
#![allow(clippy::unwrap_used)]

use crate::annuli;
use crate::common;

use annuli::slip_after;
use common::{ball, floor, law, scene};
use std::f64::consts::PI;
use windfall_scene::event::Event;
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::{FruitState, Simulation};
use windfall_scene::scene::Fruit;

/// Density (kg/m³), Young's modulus (Pa), Poisson's ratio.
#[derive(Clone, Copy)]
struct Material {
    density: f64,
    young: f64,
    poisson: f64,
}

const GLASS: Material = of(2800.0, 4.8e10, 0.20);
const LIMESTONE: Material = of(2500.0, 2.0e10, 0.25);
const ALUMINIUM_ALLOY: Material = of(2699.0, 7.0e10, 0.30);
const MAGNESIUM_ALLOY: Material = of(1800.0, 4.0e10, 0.35);
const ALUMINIUM_OXIDE: Material = of(4000.0, 3.8e11, 0.23);
const CAST_IRON: Material = of(7000.0, 1.0e11, 0.25);
const STEEL: Material = of(7850.0, 2.08e11, 0.30);
const POLYETHYLENE: Material = of(1400.0, 1.0e9, 0.40);

const fn of(density: f64, young: f64, poisson: f64) -> Material {
    Material {
        density,
        young,
        poisson,
    }
}

impl Material {
    fn mass(&self, radius: f64) -> f64 {
        self.density * 4.0 / 3.0 * PI * radius.powi(3)
    }

    /// k of Hertz's F = k d^1.5, with something rigid or with its like.
    fn stiffness(&self, radius: f64, rigid: bool) -> f64 {
        let own = self.young / (1.0 - self.poisson.powi(2));
        4.0 / 3.0 * if rigid { own } else { 0.5 * own } * radius.sqrt()
    }
}

/// Greatest depth of an elastic impact, k d^2.5/2.5 = m v²/2.
fn deepest(mass: f64, stiffness: f64, speed: f64) -> f64 {
    (1.25 * mass * speed * speed / stiffness).powf(0.4)
}

/// β of the damping √5 β √(m k) d^¼ v, for a restitution ended where the force returns to
/// zero: with q = √(4k/5m) d^(5/4), dv/dq = −q/v − 2β is a damped oscillator, and e is
/// Kelvin and Voigt's (Schwager and Pöschel 2007, Granul. Matter 9, 465).
fn damping_for(restitution: f64) -> f64 {
    let of = |beta: f64| {
        let turned = (1.0 - beta * beta).sqrt();
        let end = PI - (2.0 * beta * turned).atan2(1.0 - 2.0 * beta * beta);
        (-beta * end / turned).exp()
    };
    let (mut low, mut high) = (0.0, 0.999);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if of(middle) > restitution {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// A contact of a stiffness and of a restitution at a mass.
fn contact(stiffness: f64, restitution: f64, mass: f64) -> Interaction {
    if restitution >= 1.0 {
        return Interaction::frictionless(law(&format!("hertz(k={stiffness:e})")));
    }
    let beta = damping_for(restitution);
    let nominal = (-PI * beta / (1.0 - beta * beta).sqrt()).exp();
    Interaction::frictionless(law(&format!(
        "tsuji(k={stiffness:e}, restitution={nominal}, mass={mass:e})"
    )))
}

fn with_friction(mut own: Interaction, friction: f64, poisson: f64) -> Interaction {
    own.friction = friction;
    own.tangential_ratio = mindlin_ratio(poisson);
    // The damped normal force rises at once, as d^¼; a tangential spring alone lags behind
    // μ F there, by 1.6 % of the impulse.
    own.tangential_damping = 1.0;
    own
}

/// Runs until they part; the balls and the event.
fn impact(
    interaction: Interaction,
    step: f64,
    fruit: Vec<Fruit>,
    wall: bool,
) -> (Vec<FruitState>, Event) {
    let mut scene = scene(interaction, step);
    if wall {
        scene.walls.push(floor());
    }
    scene.fruit = fruit;
    let mut simulation = Simulation::new(scene).unwrap();
    for _ in 0..100_000 {
        simulation.step().unwrap();
        if let Some(event) = simulation.take_events().first() {
            return (simulation.fruit(), *event);
        }
    }
    panic!("they do not part");
}

fn close(found: f64, wanted: f64, tolerance: f64) {
    let off = (found - wanted).abs();
    assert!(off <= tolerance * wanted.abs(), "{found} for {wanted}");
}

/// Peak, depth and duration of an elastic impact, and depth against time within it.
fn check_hertz(event: &Event, mass: f64, stiffness: f64, speed: f64) {
    let depth = deepest(mass, stiffness, speed);
    close(event.normal_speed, speed, 1e-9);
    close(event.largest_displacement, depth, 1e-5);
    close(event.peak_force, stiffness * depth.powf(1.5), 1e-5);
    // T = 2.868 (m²/(R E*² v))^(1/5), to more digits.
    close(event.duration, 2.943_275_5 * depth / speed, 2e-5);
    assert!(event.absorbed_energy.abs() < 1e-5 * 0.5 * mass * speed * speed);
}

#[test]
fn closed_form_1_two_spheres_of_a_kind() {
    let radius = 0.01;
    for material in [GLASS, LIMESTONE] {
        let mass = material.mass(radius);
        let stiffness = material.stiffness(0.5 * radius, false);
        let depth = deepest(0.5 * mass, stiffness, 20.0);
        let step = 2.943 * depth / 20.0 / 1500.0;
        let gap = 0.3 * 20.0 * step;
        let at = radius + 0.5 * gap;
        let balls = vec![
            ball(radius, mass, [-at, 0.0, 0.0], [10.0, 0.0, 0.0]),
            ball(radius, mass, [at, 0.0, 0.0], [-10.0, 0.0, 0.0]),
        ];
        let own = contact(stiffness, 1.0, mass);
        let (after, event) = impact(own.clone(), step, balls.clone(), false);
        check_hertz(&event, 0.5 * mass, stiffness, 20.0);
        close(after[0].velocity[0], -10.0, 1e-5);
        close(after[1].velocity[0], 10.0, 1e-5);
        // The curve: t(d) = (d_m/v) ∫ dx/√(1 − x^2.5), by the midpoint rule.
        let mut scene = scene(own, step);
        scene.fruit = balls;
        let mut simulation = Simulation::new(scene).unwrap();
        let mut looked = 0;
        while simulation.fruit()[0].velocity[0] > 0.5 {
            simulation.step().unwrap();
            let own = simulation.fruit();
            let overlap = 2.0 * radius - (own[1].place[0] - own[0].place[0]);
            if overlap > 0.05 * depth && overlap < 0.95 * depth {
                let share = overlap / depth;
                let time: f64 = (0..2000)
                    .map(|number| (f64::from(number) + 0.5) / 2000.0 * share)
                    .map(|x| share / 2000.0 / (1.0 - x.powf(2.5)).sqrt())
                    .sum();
                close(simulation.time() - gap / 20.0, time * depth / 20.0, 2e-4);
                looked += 1;
            }
        }
        assert!(looked > 200, "{looked}");
    }
}

#[test]
fn closed_form_2_a_sphere_and_a_rigid_plane() {
    let radius = 0.1;
    for material in [ALUMINIUM_ALLOY, MAGNESIUM_ALLOY] {
        let mass = material.mass(radius);
        let stiffness = material.stiffness(radius, true);
        let step = 2.943 * deepest(mass, stiffness, 0.2) / 0.2 / 1500.0;
        let start = [0.0, 0.0, radius + 0.3 * 0.2 * step];
        let balls = vec![ball(radius, mass, start, [0.0, 0.0, -0.2])];
        let (after, event) = impact(contact(stiffness, 1.0, mass), step, balls, true);
        check_hertz(&event, mass, stiffness, 0.2);
        close(after[0].velocity[2], 0.2, 1e-5);
    }
}

#[test]
fn closed_form_3_restitution_as_given() {
    let radius = 0.0025;
    for material in [ALUMINIUM_OXIDE, CAST_IRON] {
        let mass = material.mass(radius);
        let stiffness = material.stiffness(radius, true);
        let step = 2.943 * deepest(mass, stiffness, 3.9) / 3.9 / 3000.0;
        let start = [0.0, 0.0, radius + 0.3 * 3.9 * step];
        for restitution in [0.2, 0.4, 0.6, 0.8, 1.0] {
            let balls = vec![ball(radius, mass, start, [0.0, 0.0, -3.9])];
            let own = contact(stiffness, restitution, mass);
            let (after, _) = impact(own, step, balls, true);
            println!("e = {restitution}: {}", after[0].velocity[2] / 3.9);
            close(after[0].velocity[2] / 3.9, restitution, 5e-4);
        }
    }
}

/// A sphere of a material that strikes a rigid plane, with the velocity along it and the
/// spin that it has: its state, and its depth over its radius.
fn strike(
    (material, radius): (Material, f64),
    (restitution, friction): (f64, f64),
    [along, down, spin]: [f64; 3],
) -> (FruitState, f64) {
    let mass = material.mass(radius);
    let stiffness = material.stiffness(radius, true);
    let depth = deepest(mass, stiffness, down);
    let step = 2.943 * depth / down / 3000.0;
    let start = [0.0, 0.0, radius + 0.3 * down * step];
    let mut own = ball(radius, mass, start, [along, 0.0, -down]);
    own.spin = [0.0, spin, 0.0];
    let interaction = contact(stiffness, restitution, mass);
    let interaction = with_friction(interaction, friction, material.poisson);
    let (after, _) = impact(interaction, step, vec![own], true);
    (after[0], depth / radius)
}

#[test]
fn closed_form_4_constant_speed_at_many_angles() {
    for (material, restitution) in [(ALUMINIUM_OXIDE, 0.98), (ALUMINIUM_ALLOY, 0.98)] {
        let (radius, friction, speed) = (0.0025, 0.092, 3.9);
        for degrees in [2.0, 5.0, 10.0, 20.0, 25.0, 30.0, 45.0, 60.0, 70.0, 80.0] {
            let angle = f64::to_radians(degrees);
            let (along, down) = (speed * angle.sin(), speed * angle.cos());
            let (after, soft) = strike(
                (material, radius),
                (restitution, friction),
                [along, down, 0.0],
            );
            close(after.velocity[2] / down, restitution, 5e-4);
            let impulse = friction * (1.0 + restitution);
            let kept = after.velocity[0] / along;
            let back = (after.velocity[0] - radius * after.spin[1]) / after.velocity[2];
            println!(
                "{degrees}°: e_t {kept:.4}, ω {:.1} rad/s, {back:.4}",
                after.spin[1]
            );
            if angle.tan() > 1.02 * 3.5 * impulse {
                // e_t = 1 − μ(1 + e)/tan θ; ω = 5 μ(1 + e) V cos θ/(2R); of the surface
                // tan φ = tan θ/e − 7 μ(1 + e)/(2e).
                close(kept, 1.0 - impulse / angle.tan(), 1e-3);
                let spin = 2.5 * impulse * down / radius;
                close(after.spin[1], spin, 1e-3 + soft);
                let wanted = (angle.tan() - 3.5 * impulse) / restitution;
                assert!(
                    (back - wanted).abs() < 3e-3 + 3.0 * soft,
                    "{degrees}: {back} {wanted}"
                );
            } else {
                // It sticks for a while: never more than in sliding, and within what one
                // spring for the whole area errs by, half of μ v_n/ratio.
                let scale = mindlin_ratio(material.poisson) / friction;
                let wanted = slip_after(angle.tan(), friction, mindlin_ratio(material.poisson));
                assert!(
                    kept > 1.0 - impulse / angle.tan() - 1e-3,
                    "{degrees}: {kept}"
                );
                assert!(
                    scale * (back * restitution - wanted).abs() < 0.55,
                    "{degrees}: {back} {wanted}"
                );
            }
        }
    }
}

#[test]
fn closed_form_5_constant_normal_speed_at_many_tangential_speeds() {
    for material in [STEEL, POLYETHYLENE] {
        let (radius, friction, down) = (1e-5, 0.3, 5.0);
        for along in [0.5, 1.0, 5.0, 10.0, 15.0, 20.0, 30.0, 50.0, 70.0] {
            let (after, soft) = strike((material, radius), (1.0, friction), [along, down, 0.0]);
            close(after.velocity[2], down, 1e-4);
            let ratio = mindlin_ratio(material.poisson);
            // In their scale, over μ v_n.
            let size = friction * down;
            let slip = (after.velocity[0] - radius * after.spin[1]) / size;
            let spin = radius * after.spin[1] / size;
            println!("{:.3}: surface {slip:.4}, spin {spin:.4}", along / size);
            if along / size > 7.0 {
                close(along / size - after.velocity[0] / size, 2.0, 1e-3);
                close(spin, 5.0, 1e-3 + soft);
            } else {
                let wanted = slip_after(along / down, friction, ratio) / friction;
                assert!(
                    (slip - wanted).abs() * ratio < 0.5 + 5.0 * soft,
                    "{along}: {slip} {wanted}"
                );
            }
        }
    }
}

#[test]
fn closed_form_6_constant_normal_speed_at_many_spins() {
    let (radius, friction, down) = (0.1, 0.4, 0.2);
    for (restitution, spins) in [
        (0.5, [6.0, 10.0, 20.0, 40.0]),
        (1.0, [8.0, 12.0, 20.0, 40.0]),
    ] {
        for spin in spins {
            let (after, soft) = strike(
                (ALUMINIUM_ALLOY, radius),
                (restitution, friction),
                [0.0, down, -spin],
            );
            // v' = μ(1 + e) v_n and ω' = ω − 5 μ(1 + e) v_n/(2R) while it slides.
            close(after.velocity[2] / down, restitution, 5e-4);
            let gained = friction * (1.0 + restitution) * down;
            close(-after.velocity[0], gained, 1e-3);
            close(after.spin[1] + spin, 2.5 * gained / radius, 1e-3 + soft);
        }
    }
}

#[test]
fn closed_form_7_two_spheres_of_a_kind_that_spin() {
    let (radius, friction, speed, restitution) = (0.1, 0.4, 0.2, 0.5);
    let material = ALUMINIUM_ALLOY;
    let mass = material.mass(radius);
    let stiffness = material.stiffness(0.5 * radius, false);
    let depth = deepest(0.5 * mass, stiffness, 2.0 * speed);
    let step = 2.943 * depth / (2.0 * speed) / 3000.0;
    for spin in [6.0, 12.0, 40.0] {
        let at = radius + 0.3 * speed * step;
        let mut balls = vec![
            ball(radius, mass, [-at, 0.0, 0.0], [speed, 0.0, 0.0]),
            ball(radius, mass, [at, 0.0, 0.0], [-speed, 0.0, 0.0]),
        ];
        balls.iter_mut().for_each(|own| own.spin = [0.0, 0.0, spin]);
        let own = contact(stiffness, restitution, 0.5 * mass);
        let own = with_friction(own, friction, material.poisson);
        let (after, _) = impact(own, step, balls, false);
        let soft = depth / radius;
        // Each as if it struck a rigid plane at its own speed.
        let gained = friction * (1.0 + restitution) * speed;
        close(after[1].velocity[0], restitution * speed, 5e-4);
        close(after[0].velocity[1], -gained, 1e-3);
        close(after[1].velocity[1], gained, 1e-3);
        for own in &after {
            close(spin - own.spin[2], 2.5 * gained / radius, 1e-3 + soft);
        }
    }
}

#[test]
fn closed_form_8_two_spheres_of_different_size() {
    let (friction, speed, restitution) = (0.4, 0.2, 0.5);
    let material = ALUMINIUM_ALLOY;
    let (small, large) = (0.1, 0.5);
    let [light, heavy] = [small, large].map(|radius| material.mass(radius));
    let mass = light * heavy / (light + heavy);
    let radius = small * large / (small + large);
    let stiffness = material.stiffness(radius, false);
    let depth = deepest(mass, stiffness, speed);
    let step = 2.943 * depth / speed / 3000.0;
    for spin in [8.0, 15.0, 40.0] {
        let gap = 0.3 * speed * step;
        let mut first = ball(small, light, [-small - gap, 0.0, 0.0], [speed, 0.0, 0.0]);
        first.spin = [0.0, 0.0, spin];
        let second = ball(large, heavy, [large, 0.0, 0.0], [0.0; 3]);
        let own = contact(stiffness, restitution, mass);
        let own = with_friction(own, friction, material.poisson);
        let (after, _) = impact(own, step, vec![first, second], false);
        let soft = depth / small;
        // The impulse is J = m* (1 + e) v along the normal, μ J across.
        let impulse = mass * (1.0 + restitution) * speed;
        close(speed - after[0].velocity[0], impulse / light, 5e-4);
        close(after[1].velocity[0], impulse / heavy, 5e-4);
        close(after[0].velocity[1], -friction * impulse / light, 1e-3);
        close(after[1].velocity[1], friction * impulse / heavy, 1e-3);
        let turned = |radius: f64, mass: f64| 2.5 * friction * impulse / (mass * radius);
        close(spin - after[0].spin[2], turned(small, light), 1e-3 + soft);
        close(-after[1].spin[2], turned(large, heavy), 1e-3 + soft);
    }
}

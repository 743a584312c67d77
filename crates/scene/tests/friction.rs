//! Friction: oblique impacts, inclines, stacks.
#![allow(clippy::unwrap_used)]

use crate::common;

use common::{ball, floor, law, plane, scene};
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::motion::simulation::{FruitState, Simulation};

const POISSON: f64 = 0.3;

fn elastic(friction: f64) -> Interaction {
    Interaction {
        friction,
        tangential_ratio: mindlin_ratio(POISSON),
        ..Interaction::frictionless(law("hertz(k=1e12)"))
    }
}

/// A ball of 10 mm, so hard that it stays round, strikes a plane; its state afterwards.
fn bounce(interaction: Interaction, step: f64, tangential: f64, spin: f64) -> FruitState {
    let mut scene = scene(interaction, step);
    scene.walls.push(floor());
    let mut own = ball(
        0.01,
        0.01,
        [0.0, 0.0, 0.010_000_001],
        [tangential, 0.0, -1.0],
    );
    own.spin = [0.0, spin, 0.0];
    scene.fruit.push(own);
    let mut simulation = Simulation::new(scene).unwrap();
    while simulation.take_events().is_empty() {
        simulation.step().unwrap();
    }
    simulation.fruit()[0]
}

#[test]
fn closed_form_gross_sliding() {
    // An impulse of friction μ m v_n (1 + e) against the slip, as long as it slides
    // throughout: Chung and Ooi (2011), Granul. Matter 13, 643, tests 4 to 6; e = 1 here.
    for (friction, tangential, spin) in [(0.092, 1.5, 0.0), (0.3, 4.0, 0.0), (0.1, 0.0, 200.0)] {
        let after = bounce(elastic(friction), 4e-9, tangential, spin);
        let slip: f64 = tangential - 0.01 * spin;
        let change = -2.0 * friction * slip.signum();
        assert!((after.velocity[2] - 1.0).abs() < 1e-5, "{after:?}");
        assert!(
            (after.velocity[0] - tangential - change).abs() < 1e-5,
            "{after:?}"
        );
        // Moment of the impulse: Δω = −(5/2) Δv/R about y, for a force along x below.
        let turned = -2.5 * change / 0.01;
        assert!(
            (after.spin[1] - spin - turned).abs() < 2e-3 * turned.abs(),
            "{after:?} {turned}"
        );
    }
}

/// Maw, Barber and Fawcett's elastic impact of a sphere: tangential velocity of its surface
/// after over before, both over the normal velocity and scaled, ψ₂ of ψ₁.
fn scaled_after(scaled_before: f64, friction: f64) -> f64 {
    let factor = 2.0 * (1.0 - POISSON) / (friction * (2.0 - POISSON));
    let after = bounce(elastic(friction), 4e-9, scaled_before / factor, 0.0);
    (after.velocity[0] - 0.01 * after.spin[1]) * factor
}

#[test]
fn closed_form_oblique_impacts_that_slide_throughout() {
    // ψ₂ = ψ₁ − 4χ from ψ₁ = 4χ − 1 on: Maw, Barber and Fawcett (1976), Wear 38, 101. Close
    // to that end the increments of one spring stick a little earlier than their annuli do.
    let chi = (1.0 - POISSON) * (1.0 + 2.5) / (2.0 - POISSON);
    for before in [4.0 * chi + 0.5, 4.0 * chi + 2.0] {
        let after = scaled_after(before, 0.3);
        assert!(
            (after - (before - 4.0 * chi)).abs() < 1e-2,
            "{before}: {after}"
        );
    }
    // With half of that slip it sticks in between, and the surface comes back.
    let after = scaled_after(3.0, 0.3);
    assert!((-1.2..0.0).contains(&after), "{after}");
}

#[test]
fn closed_form_oblique_impacts_that_stick_throughout() {
    // Two springs side by side: the normal one turns by π, the slip, of effective mass
    // 2/7 m, by π √(7/2 k_t/k_n), so that its velocity is multiplied by the cosine.
    for ratio in [0.4, mindlin_ratio(POISSON), 1.2] {
        let interaction = Interaction {
            friction: 1e3,
            tangential_ratio: ratio,
            ..Interaction::frictionless(law("kelvin-voigt(k=1e10, c=0)"))
        };
        let after = bounce(interaction, 1e-9, 0.5, 0.0);
        let slip = after.velocity[0] - 0.01 * after.spin[1];
        let turned = (std::f64::consts::PI * (3.5_f64 * ratio).sqrt()).cos();
        assert!(
            (slip / 0.5 - turned).abs() < 2e-3,
            "{ratio}: {slip} {turned}"
        );
    }
}

/// Acceleration along an incline of the angle over g, from rest.
fn down(angle: f64, friction: f64) -> (f64, f64) {
    let interaction = Interaction {
        friction,
        tangential_ratio: mindlin_ratio(POISSON),
        tangential_damping: 1.0,
        annuli: 4,
        ..Interaction::frictionless(law("kuwabara-kono(k=753599, c=1524)"))
    };
    let mut scene = scene(interaction, 2e-5);
    scene.walls.push(floor());
    let (s, c) = angle.sin_cos();
    scene.gravity = [9.81 * s, 0.0, -9.81 * c];
    // At the depth where it rests.
    let depth = (0.2 * 9.81 * c / 753_599.0_f64).powf(2.0 / 3.0);
    scene
        .fruit
        .push(ball(0.04, 0.2, [0.0, 0.0, 0.04 - depth], [0.0; 3]));
    let mut simulation = Simulation::new(scene).unwrap();
    let at = |simulation: &mut Simulation, time: f64| {
        while simulation.time() < time {
            simulation.step().unwrap();
        }
        let own = simulation.fruit()[0];
        (own.velocity[0], own.spin[1])
    };
    let (v, w) = at(&mut simulation, 0.2);
    let (later, faster) = at(&mut simulation, 0.4);
    ((later - v) / (0.2 * 9.81), (faster - w) / 0.2)
}

#[test]
fn closed_form_a_ball_rolls_or_slides_down_an_incline() {
    // Rolling: 5/7 g sin α while tan α < 7/2 μ; sliding: g (sin α − μ cos α).
    let angle = 0.3_f64;
    let (along, spin) = down(angle, 0.3);
    // It rolls on the radius less the depth: 5/7 becomes 1/(1 + 2/5 (R/arm)²).
    let arm = 0.04 - (0.2 * 9.81 * angle.cos() / 753_599.0_f64).powf(2.0 / 3.0);
    let rolling = angle.sin() / (1.0 + 0.4 * (0.04 / arm).powi(2));
    assert!((along / rolling - 1.0).abs() < 1e-5, "{along} {rolling}");
    assert!((spin * arm / (along * 9.81) - 1.0).abs() < 1e-5, "{spin}");
    let angle = 0.9_f64;
    let (along, _) = down(angle, 0.2);
    assert!(
        (along - (angle.sin() - 0.2 * angle.cos())).abs() < 1e-4,
        "{along}"
    );
}

#[test]
fn closed_form_rolling_friction_slows_a_ball() {
    // On a level plane the moment μ_r R F turns against it: v' = −(5/7) μ_r g.
    let interaction = Interaction {
        friction: 0.5,
        tangential_ratio: mindlin_ratio(POISSON),
        tangential_damping: 1.0,
        annuli: 4,
        rolling: 0.02,
        ..Interaction::frictionless(law("kuwabara-kono(k=753599, c=1524)"))
    };
    let mut scene = scene(interaction, 2e-5);
    scene.walls.push(floor());
    scene.gravity = [0.0, 0.0, -9.81];
    let depth = (0.2 * 9.81 / 753_599.0_f64).powf(2.0 / 3.0);
    let mut own = ball(0.04, 0.2, [0.0, 0.0, 0.04 - depth], [0.5, 0.0, 0.0]);
    own.spin = [0.0, 0.5 / (0.04 - depth), 0.0];
    scene.fruit.push(own);
    let mut simulation = Simulation::new(scene).unwrap();
    let mut speeds = Vec::new();
    for time in [0.5, 1.5] {
        while simulation.time() < time {
            simulation.step().unwrap();
        }
        speeds.push(simulation.fruit()[0].velocity[0]);
    }
    let slowed = speeds[0] - speeds[1];
    assert!(
        (slowed / (5.0 / 7.0 * 0.02 * 9.81) - 1.0).abs() < 1e-2,
        "{slowed}"
    );
    // It comes to rest, and stays.
    while simulation.time() < 8.0 {
        simulation.step().unwrap();
    }
    let own = simulation.fruit()[0];
    assert!(own.velocity[0].abs() < 1e-6, "{own:?}");
}

#[test]
fn a_stack_in_a_groove_rests_without_creep() {
    let interaction = Interaction {
        friction: 0.5,
        tangential_ratio: mindlin_ratio(POISSON),
        tangential_damping: 1.0,
        annuli: 4,
        rolling: 0.01,
        ..Interaction::frictionless(law("kuwabara-kono(k=753599, c=1524)"))
    };
    let mut scene = scene(interaction, 5e-5);
    scene.gravity = [0.0, 0.0, -9.81];
    scene.walls.push(floor());
    for (name, axis, sign) in [("a", 0, 1.0), ("b", 0, -1.0), ("c", 1, 1.0), ("d", 1, -1.0)] {
        let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
        point[axis] = -0.0805 * sign;
        normal[axis] = sign;
        scene.walls.push(plane(name, point, normal));
    }
    // Four below, one in the hollow above them.
    for (x, y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        scene
            .fruit
            .push(ball(0.04, 0.2, [0.0402 * x, 0.0402 * y, 0.0402], [0.0; 3]));
    }
    scene
        .fruit
        .push(ball(0.04, 0.2, [0.001, 0.0, 0.11], [0.0; 3]));
    let mut simulation = Simulation::new(scene).unwrap();
    let places = |simulation: &mut Simulation, time: f64| {
        while simulation.time() < time {
            simulation.step().unwrap();
        }
        simulation.fruit()
    };
    let settled = places(&mut simulation, 5.0);
    let after = places(&mut simulation, 65.0);
    for (a, b) in settled.iter().zip(&after) {
        for axis in 0..3 {
            let way = (b.place[axis] - a.place[axis]).abs();
            assert!(way < 1e-7, "fruit {} went {way:e} m in a minute", a.fruit);
        }
    }
}

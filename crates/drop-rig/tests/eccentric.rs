//! Planar bodies on the plate: against closed forms, the central model and
//! balances.

#![allow(clippy::unwrap_used)]

use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_drop_rig::eccentric::body::EccentricBody;
use windfall_drop_rig::eccentric::impact::{EccentricImpact, EccentricSummary};
use windfall_drop_rig::eccentric::shape::Shape;
use windfall_drop_rig::eccentric::simulate::{eccentric_trajectory, simulate_eccentric_drop};
use windfall_drop_rig::rig::Plate;
use windfall_identify::error::Error;
use windfall_identify::rig::simulate::simulate_impact;

const GRAVITY: f64 = 9.80665;
const MASS: f64 = 0.0048;
const RADIUS: f64 = 0.01;
/// The study's plate.
const PLATE: Plate = Plate {
    mass: 0.2,
    stiffness: 645_800.0,
    damping: 52.47,
};

fn law(expression: &str) -> Law {
    parse_law(expression).unwrap().complete().unwrap()
}

fn disc(offset: f64, degrees: f64) -> Shape {
    Shape::OffsetDisc {
        radius: RADIUS,
        offset,
        angle: degrees.to_radians(),
    }
}

fn ellipse(degrees: f64) -> Shape {
    Shape::Ellipse {
        semi_axes: [0.012, 0.009],
        tilt: degrees.to_radians(),
    }
}

fn body(shape: Shape, friction: f64) -> EccentricBody {
    EccentricBody {
        friction,
        ..EccentricBody::at_rest(shape, MASS)
    }
}

fn drop(law: &Law, body: &EccentricBody, plate: Option<Plate>, impacts: usize) -> EccentricSummary {
    simulate_eccentric_drop(law, body, plate, GRAVITY, 0.5, impacts, EndRule::ForceZero).unwrap()
}

/// ADAMS IMPACT in the study's units: N, mm, s.
fn adams(k: f64, e: f64, c: f64, d: f64) -> Law {
    let si = [k * 1000f64.powf(e), e, c * 1000.0, d / 1000.0];
    windfall_contact::laws::kind::LawKind::AdamsImpact
        .with_parameters(&si)
        .unwrap()
}

fn close(found: f64, expected: f64, relative: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(
        error <= relative * expected.abs(),
        "{what}: {found} instead of {expected}, off by {:e}",
        error / expected.abs()
    );
}

/// Without offset, and as an ellipse of equal axes, the central sphere of the
/// drop study: contact and support peaks, interval and separation computed
/// with two independent integrators for the reference tables (run 1 of the
/// study's Table 3, its optimum, and Table 2 with the coarsest depth).
#[test]
fn reference_central_sphere() {
    let cases = [
        (
            adams(1.0, 2.25, 3.5e-4, 0.001),
            [
                18.080344768036845,
                26.943519781130316,
                0.5525408385021561,
                2.692291677172108,
            ],
        ),
        (
            adams(0.868, 1.91, 5.56e-4, 0.001),
            [
                12.814933320566585,
                19.039826694209122,
                0.4982278446278873,
                2.422_007_351_890_514,
            ],
        ),
        (
            adams(5.4, 2.0, 4e-4, 0.1),
            [
                27.732297550385738,
                36.48483338003129,
                0.5652913734503426,
                2.761318970218087,
            ],
        ),
    ];
    let round = Shape::Ellipse {
        semi_axes: [RADIUS; 2],
        tilt: 0.3,
    };
    for (law, [contact, support, interval, velocity]) in cases {
        for shape in [disc(0.0, 0.0), round] {
            let found = drop(&law, &body(shape, 0.3), Some(PLATE), 2);
            let first = &found.impacts[0];
            close(first.impact.peak_contact_force, contact, 1e-8, "contact");
            close(first.impact.peak_support_force, support, 1e-8, "support");
            close(found.intervals[0], interval, 1e-8, "interval");
            close(first.impact.separation_velocity, velocity, 1e-8, "velocity");
            assert_eq!(first.angular_velocity, 0.0);
            assert_eq!(first.tangential_velocity, 0.0);
        }
    }
}

/// A central elastic body loses nothing and comes back after 2 v/g and the
/// contact.
#[test]
fn closed_form_elastic_ball_bounces_for_ever() {
    let found = drop(&law("hertz(k=1e6)"), &body(disc(0.0, 0.0), 0.2), None, 20);
    assert_eq!(found.impacts.len(), 20);
    let velocity = (2.0 * GRAVITY * 0.5).sqrt();
    for impact in &found.impacts {
        close(impact.impact.restitution, 1.0, 1e-10, "restitution");
        close(impact.impact.impact_velocity, velocity, 1e-10, "velocity");
    }
    for (pair, interval) in found.impacts.windows(2).zip(&found.intervals) {
        let contact = pair[0].impact.separation_time - pair[0].impact.onset_time;
        close(
            interval - contact,
            2.0 * velocity / GRAVITY,
            1e-10,
            "flight",
        );
    }
}

/// In the limit of a stiff contact a frictionless impact knows the body by its
/// effective mass alone: v = −v₀ + (1 + e) f v₀ and ω = r (1 + e) f m v₀/I,
/// with e that of a central impact of the mass f m. How far off are both?
fn off_rigid(body: &EccentricBody, law: &Law) -> [f64; 2] {
    let velocity = (2.0 * GRAVITY * 0.5).sqrt();
    let (factor, inertia) = (body.effective_mass_factor(), body.moment_of_inertia());
    let central = simulate_impact(law, factor * MASS, velocity, 0.0, EndRule::ForceZero).unwrap();
    let found = drop(law, body, None, 1).impacts[0];
    let impulse = (1.0 + central.restitution) * factor * MASS * velocity;
    let rebound = -velocity + impulse / MASS;
    let spin = body.shape.lever_arm() * impulse / inertia;
    assert_eq!(found.tangential_velocity, 0.0);
    [
        ((found.impact.separation_velocity - rebound) / velocity).abs(),
        ((found.angular_velocity - spin) / spin).abs(),
    ]
}

#[test]
fn converges_to_the_effective_mass_as_the_contact_stiffens() {
    let shapes = [disc(0.003, 90.0), disc(0.004, -60.0), ellipse(35.0)];
    let laws: [fn(f64) -> Law; 2] = [
        |k| law(&format!("hertz(k={k:e})")),
        |k| law(&format!("kelvin-voigt(k={k:e}, c={:e})", 0.02 * k.sqrt())),
    ];
    for shape in shapes {
        for law in laws {
            let soft = off_rigid(&body(shape, 0.0), &law(1e8));
            let stiff = off_rigid(&body(shape, 0.0), &law(1e12));
            for (soft, stiff) in soft.into_iter().zip(stiff) {
                assert!(soft < 0.05 && stiff < 1e-3, "{shape:?} {soft} {stiff}");
                assert!(stiff < 0.1 * soft, "{shape:?} {soft} {stiff}");
            }
        }
    }
}

fn left(impact: &EccentricImpact) -> bool {
    impact.impact.separation_time.is_finite()
}

fn unbalanced(impact: &EccentricImpact) -> f64 {
    let before =
        impact.translation_energy_before + impact.rotation_energy_before + impact.height_energy;
    let after = impact.translation_energy
        + impact.rotation_energy
        + impact.contact_energy
        + impact.sliding_energy
        + impact.support_energy
        + impact.plate_energy_change;
    ((after - before) / before).abs()
}

#[test]
fn conserves_energy_over_every_impact() {
    let laws = [
        "hertz(k=5e5)",
        "kuwabara-kono(k=5e5, c=400)",
        "kelvin-voigt(k=20000, c=3)",
        "walton-braun(k1=10000, k2=25000)",
        "tsuji(k=5e5, restitution=0.7, mass=0.0048)",
    ];
    for expression in laws {
        let elastic = expression.starts_with("hertz");
        for shape in [disc(0.003, 70.0), ellipse(40.0)] {
            for friction in [0.0, 0.05, 0.6] {
                for plate in [None, Some(PLATE)] {
                    let found = drop(&law(expression), &body(shape, friction), plate, 6);
                    assert!(!found.impacts.is_empty());
                    for impact in found.impacts.iter().filter(|impact| left(impact)) {
                        let lost = unbalanced(impact);
                        assert!(lost < 1e-9, "{expression} {shape:?} {friction} {lost:e}");
                        assert!(impact.sliding_energy >= -1e-15);
                        assert_eq!(impact.sliding_energy == 0.0, friction == 0.0);
                        if elastic {
                            assert!(impact.contact_energy.abs() < 1e-11);
                        }
                    }
                }
            }
        }
    }
}

/// Simpson's rule over equally spaced samples.
fn integral(values: impl Fn(usize) -> f64, samples: usize, width: f64) -> f64 {
    let weight = |i: usize| match i {
        0 => 1.0,
        i if i + 1 == samples => 1.0,
        i if i % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..samples).map(|i| weight(i) * values(i)).sum::<f64>() * width / 3.0
}

/// Momentum and angular momentum: what the forces of the trajectory, summed by
/// Simpson's rule, give the body is what the summary says, with lever arms
/// taken from the outline and not from the integrator.
#[test]
fn conserves_momentum_and_angular_momentum() {
    // Ends of the contact where the force is smooth enough for Simpson's rule.
    let law = law("power-law(k=3e9, n=3, c=0, p=1)");
    for (shape, friction) in [
        (disc(0.003, 70.0), 0.0),
        (ellipse(40.0), 0.0),
        (ellipse(-25.0), 0.05),
    ] {
        let body = body(shape, friction);
        let found = drop(&law, &body, Some(PLATE), 1).impacts[0];
        let (from, to) = (found.impact.onset_time, found.impact.separation_time);
        let samples = 20_001;
        let width = (to - from) / (samples - 1) as f64;
        let times: Vec<_> = (0..samples).map(|i| from + width * i as f64).collect();
        let seen = eccentric_trajectory(
            &law,
            &body,
            Some(PLATE),
            GRAVITY,
            0.5,
            &times,
            EndRule::ForceZero,
        )
        .unwrap();
        let torque = |i: usize| {
            let lever = -shape.lowest_point(seen.rotation[i]).slope;
            let height = seen.height[i] - seen.plate_displacement[i];
            lever * seen.contact_force[i] + height * seen.friction_force[i]
        };
        let turned = integral(torque, samples, width) / body.moment_of_inertia();
        close(turned, found.angular_velocity, 1e-9, "angular velocity");
        let pushed = integral(|i| seen.contact_force[i], samples, width);
        close(pushed, found.impact.impulse, 1e-9, "impulse");
        let rise = found.impact.separation_velocity - found.velocity_before;
        let weight = MASS * GRAVITY * (to - from);
        close(pushed - weight, MASS * rise, 1e-9, "momentum");
        let pulled = integral(|i| seen.friction_force[i], samples, width);
        assert!((pulled - MASS * found.tangential_velocity).abs() < 1e-9 * pushed);
    }
}

/// Coulomb's bound, and both ways of reaching it: a slippery body slides, a
/// rough one sticks.
#[test]
fn conserves_coulombs_bound() {
    let law = law("kuwabara-kono(k=5e5, c=400)");
    let (mut slid, mut stuck) = (0, 0);
    for friction in [0.02, 0.1, 0.4, 1.5] {
        let body = EccentricBody {
            tangential_velocity: 0.5,
            ..body(ellipse(40.0), friction)
        };
        let times: Vec<_> = (0..200_000).map(|i| f64::from(i) * 5e-6).collect();
        let seen = eccentric_trajectory(
            &law,
            &body,
            Some(PLATE),
            GRAVITY,
            0.5,
            &times,
            EndRule::ForceZero,
        )
        .unwrap();
        for (normal, tangential) in seen.contact_force.iter().zip(&seen.friction_force) {
            let limit = friction * normal;
            assert!(*normal >= 0.0);
            assert!(tangential.abs() <= limit * (1.0 + 1e-9) + 1e-12);
            if *normal > 0.0 {
                let used = tangential.abs() / limit;
                slid += usize::from(used > 1.0 - 1e-9);
                stuck += usize::from(used < 0.99);
            }
        }
    }
    assert!(slid > 100 && stuck > 100, "{slid} {stuck}");
}

/// A spinning central sphere on a stiff contact: with little friction it
/// slides throughout and takes μ J; with much it rolls when it leaves, after
/// the impulse P = −u₀/(1/m + R²/I) (Routh 1860).
#[test]
fn closed_form_spinning_sphere() {
    let law = law("hertz(k=1e13)");
    let velocity = (2.0 * GRAVITY * 0.5).sqrt();
    let inertia = 0.4 * MASS * RADIUS * RADIUS;
    for spin in [-200.0, 150.0] {
        let thrown = |friction: f64| EccentricBody {
            angular_velocity: spin,
            ..body(disc(0.0, 0.0), friction)
        };
        let direction = f64::signum(-spin);

        let sliding = drop(&law, &thrown(0.05), None, 1).impacts[0];
        let expected = direction * 0.05 * 2.0 * velocity;
        close(sliding.tangential_velocity, expected, 1e-4, "sliding");
        let slower = RADIUS * direction * 0.05 * 2.0 * velocity * MASS / inertia;
        close(sliding.angular_velocity, spin + slower, 1e-3, "slower spin");

        let rolling = drop(&law, &thrown(0.8), None, 1).impacts[0];
        let expected = -spin * RADIUS / (1.0 / MASS + RADIUS * RADIUS / inertia) / MASS;
        close(rolling.tangential_velocity, expected, 1e-3, "rolling");
        let rolled = rolling.tangential_velocity + RADIUS * rolling.angular_velocity;
        assert!(rolled.abs() < 1e-3 * spin.abs() * RADIUS, "{rolled}");
    }
}

/// Left and right are the same: the mirrored body does the mirrored motion.
#[test]
fn conserves_the_mirror() {
    let law = adams(0.868, 1.91, 5.56e-4, 0.001);
    let mirror = [
        (disc(0.0038, 60.0), disc(0.0038, -60.0)),
        (ellipse(30.0), ellipse(-30.0)),
    ];
    for (one, other) in mirror {
        let [one, other] = [one, other].map(|shape| drop(&law, &body(shape, 0.3), Some(PLATE), 4));
        assert_eq!(one.intervals, other.intervals);
        for (one, other) in one.impacts.iter().zip(&other.impacts) {
            assert_eq!(
                one.impact.peak_contact_force,
                other.impact.peak_contact_force
            );
            assert_eq!(one.angular_velocity, -other.angular_velocity);
            assert_eq!(one.tangential_velocity, -other.tangential_velocity);
        }
    }
}

/// A lossy ball comes to rest; a lossy ellipse ends rocking on the plate.
#[test]
fn closed_form_bodies_come_to_rest() {
    let law = law("kuwabara-kono(k=5e5, c=2000)");
    for shape in [disc(0.0, 0.0), disc(0.002, 50.0), ellipse(30.0)] {
        for plate in [None, Some(PLATE)] {
            let found = drop(&law, &body(shape, 0.2), plate, 10_000);
            assert!(found.at_rest, "{shape:?}");
            let last = found.impacts.last().unwrap();
            assert!(!left(last));
            assert!(last.impact.peak_contact_force.is_finite());
            assert_eq!(found.intervals.len() + 1, found.impacts.len());
        }
    }
}

#[test]
fn rejects_bodies_without_physical_values() {
    let good = body(disc(0.003, 90.0), 0.1);
    let refused = |body: EccentricBody| {
        let law = law("hertz(k=1e6)");
        let made = simulate_eccentric_drop(&law, &body, None, GRAVITY, 0.5, 1, EndRule::ForceZero);
        made.unwrap_err()
    };
    let shape = |shape| EccentricBody { shape, ..good };
    assert_eq!(
        refused(shape(disc(0.0101, 0.0))),
        Error::OffsetOutsideDisc {
            offset: 0.0101,
            radius: RADIUS
        }
    );
    assert_eq!(
        refused(shape(disc(0.0065, 0.0))),
        Error::NoMomentOfInertia {
            offset: 0.0065,
            radius: RADIUS
        }
    );
    let text = refused(EccentricBody {
        friction: -0.1,
        ..good
    });
    assert_eq!(
        text.to_string(),
        "friction is -0.1, but it must be zero or a positive number"
    );
    let text = refused(shape(disc(0.003, f64::NAN)));
    assert_eq!(
        text.to_string(),
        "angle is NaN, but it must be a finite number"
    );
    let text = refused(EccentricBody {
        inertia: Some(0.0),
        ..good
    });
    assert_eq!(
        text.to_string(),
        "moment of inertia is 0, but it must be a positive number"
    );
}

//! Forces of the laws against values that were not computed here.

#![allow(clippy::unwrap_used)]

use windfall_contact::effective::{
    Elastic, effective_mass, effective_modulus, effective_radius, hertz_stiffness,
};
use windfall_contact::expression::parse_law;
use windfall_contact::law::{ContactLaw, EndRule};
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_contact::restitution::{
    damped_power_restitution, damping_for_restitution, kuwabara_kono_pade,
};
use windfall_contact::with_law;

fn law(text: &str) -> Law {
    parse_law(text).unwrap().complete().unwrap()
}

#[track_caller]
fn close(value: f64, expected: f64, tolerance: f64) {
    let error = ((value - expected) / expected).abs();
    assert!(
        error <= tolerance,
        "{value} instead of {expected}: {error:e}"
    );
}

/// windfall reference tables, check_values.json: displacement at rest and the
/// force there, with the parameters of each entry.
#[test]
fn reference_force_at_largest_displacement() {
    let cases = [
        ("hertz(k=753599)", 0.001470604469, 42.49953084),
        (
            "kuwabara-kono(k=753599, c=1524)",
            0.001109922018,
            27.86628108,
        ),
        ("power-law(k=753599, c=1524)", 0.001109922018, 27.86628108),
        ("kelvin-voigt(k=30000, c=40)", 0.0009097341079, 27.29202324),
        (
            "hunt-crossley(k=753599, lambda=678239.1)",
            0.001327837796,
            36.46345804,
        ),
        (
            "lankarani-nikravesh(k=753599, restitution=0.7, impact_velocity=0.5)",
            0.001345802026,
            37.20592275,
        ),
        (
            "flores(k=753599, restitution=0.7, impact_velocity=0.5)",
            0.001271823608,
            34.18067516,
        ),
        (
            "herbert-mcwhannell(k=753599, restitution=0.7, impact_velocity=0.5)",
            0.001298214438,
            35.25006854,
        ),
        (
            "tsuji(k=753599, restitution=0.7, mass=0.2)",
            0.001288232855,
            34.8443101,
        ),
        (
            "walton-braun(k1=40000, k2=111111.1111)",
            0.001118033989,
            44.72135955,
        ),
        (
            "thornton(E_star=5e6, R_star=0.04, yield_pressure=3e5)",
            0.001265200122,
            43.23201706,
        ),
    ];
    for (text, d, force) in cases {
        // At rest, so only the elastic or plastic part shows.
        close(law(text).force(d, 0.0, 0.0), force, 2e-9);
    }
}

/// Ends of contact of check_values.json: the force is zero there.
#[test]
fn reference_force_at_separation() {
    let cases = [
        (
            "kuwabara-kono(k=753599, c=1524)",
            0.0004834733915,
            -0.2390715645,
            0.0,
        ),
        (
            "power-law(k=753599, c=1524)",
            0.0004834733915,
            -0.2390715645,
            0.0,
        ),
        (
            "kelvin-voigt(k=30000, c=40)",
            0.0003310464589,
            -0.2482848441,
            0.0,
        ),
        (
            "tsuji(k=753599, restitution=0.7, mass=0.2)",
            0.0003429179074,
            -0.3591006805,
            0.0,
        ),
        (
            "adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")",
            0.001261685265,
            -2.433668401,
            0.0,
        ),
        (
            "walton-braun(k1=40000, k2=111111.1111)",
            0.0007155417528,
            0.0,
            0.001118033989,
        ),
    ];
    for (text, d, v, peak) in cases {
        let law = law(text);
        let scale = law.force(d, 0.0, 0.0);
        let force = law.force(d, v, peak);
        assert!(force.abs() < 3e-9 * scale, "{text}: {force} of {scale}");
    }
    // Thornton's unloading touches zero like a power 1.5.
    let thornton = law("thornton(E_star=5e6, R_star=0.04, yield_pressure=3e5)");
    let (end, peak) = (0.0003536361553, 0.001265200122);
    assert!(thornton.force(end, 0.0, peak).abs() < 1e-9);
    assert!(thornton.force(end + 1e-8, 0.0, peak) > 0.0);
    assert!(thornton.force(end - 1e-8, 0.0, peak) < 0.0);
}

/// Damping factors of check_values.json: lambda = a k for e = 0.7, v0 = 0.5.
#[test]
fn reference_damping_of_the_hunt_crossley_family() {
    let cases = [
        ("lankarani-nikravesh", 576503.235),
        ("flores", 1033507.2),
        ("herbert-mcwhannell", 858530.506329114),
    ];
    let (d, v): (f64, f64) = (1e-3, 0.3);
    for (name, lambda) in cases {
        let named = law(&format!(
            "{name}(k=753599, restitution=0.7, impact_velocity=0.5)"
        ));
        let by_hand = (753599.0 + lambda * v) * d * d.sqrt();
        close(named.force(d, v, 0.0), by_hand, 1e-14);
    }
}

/// check_values.json: alpha of Tsuji at e = 0.7, and the damping of ADAMS IMPACT
/// just beyond its full depth.
#[test]
fn reference_damping_of_tsuji_and_adams() {
    let tsuji = law("tsuji(k=753599, restitution=0.7, mass=0.2)");
    let damping = tsuji.force(1e-4, 1.0, 0.0) - tsuji.force(1e-4, 0.0, 0.0);
    close(
        damping,
        0.2522473641872811 * (0.2 * 753599.0_f64).sqrt() * 0.1,
        1e-13,
    );

    let adams = law("adams-impact(k=466143.59924937907, e=1.91, c=0.556, d=1e-6)");
    // While the damping grows to c over d it takes the work c v d/2.
    let v = 3.13 - 0.556 * 1e-6 / (2.0 * 0.0048);
    close(adams.force(1e-6, v, 0.0), 1.740249415, 1e-9);
}

/// MSC Adams: STEP(x, 0, 0, d, c) has 0, half and full height at 0, d/2, d, and
/// zero slope at both ends; at d/4 the cubic is 5/32 of the height.
#[test]
fn closed_form_step_of_adams_is_cubic() {
    let adams = law("adams-impact(k=1e-9, e=1.5, c=8, d=0.004)");
    let damping = |d: f64| adams.force(d, 1.0, 0.0);
    close(damping(0.001), 8.0 * 5.0 / 32.0, 1e-12);
    close(damping(0.002), 4.0, 1e-12);
    close(damping(0.004), 8.0, 1e-12);
    close(damping(0.01), 8.0, 1e-12);
    let steepness = |d: f64| with_law!(&adams, law => by_displacement(law, d));
    assert!(steepness(0.004 - 1e-12).abs() < 1e-4);
    assert!(steepness(0.005) < 1e-6);
    // 6 w (1 - w) c/d at the middle.
    close(steepness(0.002), 1.5 * 8.0 / 0.004, 1e-9);
}

fn by_displacement<const N: usize>(law: &impl ContactLaw<N>, d: f64) -> f64 {
    law.evaluate(d, 1.0, 0.0).by_displacement
}

/// The general power law contains Hertz, Kelvin-Voigt, Kuwabara-Kono and
/// Hunt-Crossley.
#[test]
fn closed_form_power_law_contains_others() {
    let pairs = [
        ("power-law(k=5e5, n=1.5, c=0, p=0.5)", "hertz(k=5e5)"),
        (
            "power-law(k=5e5, n=1, c=40, p=0)",
            "kelvin-voigt(k=5e5, c=40)",
        ),
        ("power-law(k=5e5, c=900)", "kuwabara-kono(k=5e5, c=900)"),
        (
            "power-law(k=5e5, n=2, c=3e5, p=2)",
            "hunt-crossley(k=5e5, lambda=3e5, n=2)",
        ),
    ];
    for (general, special) in pairs {
        let (general, special) = (law(general), law(special));
        for (d, v) in [(1e-5, 0.4), (7e-4, -0.2), (2e-3, 0.0)] {
            close(general.force(d, v, 0.0), special.force(d, v, 0.0), 1e-13);
        }
    }
}

/// Thornton is continuous in value and slope at yield, and unloads along Hertz
/// below it. Yield values: check_values.json.
#[test]
fn reference_thornton_yield() {
    let Law::Thornton(thornton) = law("thornton(E_star=5e6, R_star=0.04, yield_pressure=3e5)")
    else {
        panic!("not Thornton");
    };
    close(thornton.yield_displacement(), 0.0003553057584, 2e-10);
    close(thornton.kink(), 0.0003553057584, 2e-10);
    close(thornton.yield_force(), 8.929807684, 2e-10);

    let d = thornton.yield_displacement();
    let (before, after) = (d * (1.0 - 1e-9), d * (1.0 + 1e-9));
    let at = |d: f64, peak: f64| thornton.evaluate(d, 0.0, peak);
    close(at(before, 0.0).force, at(after, 0.0).force, 1e-8);
    close(
        at(before, 0.0).by_displacement,
        at(after, 0.0).by_displacement,
        1e-8,
    );
    assert_eq!(at(1e-4, 3e-4).force, at(1e-4, 0.0).force);
    assert_eq!(at(1e-4, 3e-4).by_peak, 0.0);
    // Just beyond yield the unloading curve is still Hertz.
    close(at(1e-4, after).force, at(1e-4, 0.0).force, 1e-6);
    // Unloading begins where loading ended.
    close(
        at(1e-3 * (1.0 - 1e-12), 1e-3).force,
        at(1e-3, 1e-3).force,
        1e-9,
    );
}

#[test]
fn closed_form_walton_braun_paths() {
    let law = law("walton-braun(k1=1000, k2=4000)");
    let cases = [
        // Loading, unloading from 4 mm, end of contact, reloading, beyond.
        (0.002, 0.0, 2.0),
        (0.0035, 0.004, 2.0),
        (0.003, 0.004, 0.0),
        (0.004, 0.004, 4.0),
        (0.005, 0.004, 5.0),
    ];
    for (d, peak, force) in cases {
        assert!((law.force(d, 0.0, peak) - force).abs() < 1e-12);
    }
    // Parameters that would create energy act as an elastic spring.
    let odd = LawKind::WaltonBraun
        .with_parameters(&[4000.0, 1000.0])
        .unwrap();
    assert!((odd.force(0.001, 0.0, 0.004) - 4.0).abs() < 1e-12);
}

/// windfall reference tables, check_values.json: hertz_geometry.
#[test]
fn reference_effective_values() {
    let fruit = Elastic {
        modulus: 5e6,
        poisson: 0.35,
    };
    let rigid = Elastic {
        modulus: f64::INFINITY,
        poisson: 0.3,
    };
    let modulus = effective_modulus(fruit, rigid);
    close(modulus, 5698005.698, 1e-9);
    close(
        hertz_stiffness(modulus, effective_radius(0.04, f64::INFINITY)),
        1519468.186,
        1e-9,
    );
    close(effective_radius(0.0415, 0.025), 0.01560150376, 1e-9);
    close(hertz_stiffness(1.28, 10.0), 5.396953873, 1e-9);
    // Equal masses: half of one; a wall changes nothing.
    close(effective_mass(0.2, 0.2), 0.1, 1e-15);
    close(effective_mass(0.2, f64::INFINITY), 0.2, 1e-15);
}

/// A damping factor found for a restitution delivers it, over the whole range;
/// and near e = 1 it is that of Hunt and Crossley, a v0 = 1.5 (1 − e).
#[test]
fn recovers_restitution_from_damping() {
    for e in [1e-3, 0.01, 0.1, 0.4781, 0.7, 0.9, 0.99, 0.9999, 0.999999] {
        let damping = damping_for_restitution(e, 0.5).unwrap();
        let z = damping * 0.5;
        close(damped_power_restitution(z), e, 1e-12);
        // The equation itself, by its plain formula where that is accurate.
        if (0.05..0.95).contains(&e) {
            let plain = ((1.0 + z) / (1.0 - e * z)).ln() - z * (1.0 + e);
            assert!(plain.abs() < 2e-13 / (1.0 - e * z), "{e}: {plain}");
        }
    }
    close(
        damping_for_restitution(0.999999, 1.0).unwrap(),
        1.5e-6,
        2e-6,
    );
    assert_eq!(damping_for_restitution(1.0, 0.5).unwrap(), 0.0);
    for e in [0.0, -0.1, 1.1, f64::NAN] {
        assert!(damping_for_restitution(e, 0.5).is_err(), "{e}");
    }
    // Weak to extreme damping: falls without a jump.
    let mut last = 1.0;
    for power in -120..=90 {
        let e = damped_power_restitution(10_f64.powf(f64::from(power) / 10.0));
        assert!(e < last && e > 0.0, "10^{power}/10: {e} after {last}");
        last = e;
    }
}

/// windfall reference tables, check_values.json: kk_restitution_theory.
#[test]
fn reference_kuwabara_kono_restitution() {
    close(
        kuwabara_kono_pade(0.8670445061_f64.powi(2)),
        0.4815116971,
        1e-9,
    );
    // Exact restitution of the table, in reach for weak damping.
    close(kuwabara_kono_pade(0.01), 0.9885475015, 1e-9);
    close(kuwabara_kono_pade(0.01), 0.9885474396, 1e-6);
    close(kuwabara_kono_pade(0.25), 0.7600371605, 6e-4);
}

#[test]
fn closed_form_law_properties() {
    assert_eq!(EndRule::default(), EndRule::ForceZero);
    let adams = law("adams-impact(k=1e5, e=1.5, c=1, d=\"0.1 mm\")");
    assert_eq!(with_law!(&adams, law => kink(law)), 1e-4);
    assert_eq!(
        with_law!(law("hertz(k=1)"), law => kink(&law)),
        f64::INFINITY
    );
    let flores = law("flores(k=753599, restitution=0.7, impact_velocity=0.5)");
    assert_eq!(flores.nominal_restitution(), Some(0.7));
    assert_eq!(law("hertz(k=753599)").nominal_restitution(), None);
    assert!(with_law!(&law("walton-braun(k1=1, k2=2)"), law => law.history()));
    assert!(!with_law!(&adams, law => law.history()));
}

fn kink<const N: usize>(law: &impl ContactLaw<N>) -> f64 {
    law.kink()
}

//! Laws that the user writes, in simulations and fits: the same numbers as the
//! built-in law of the same formula.

#![allow(clippy::unwrap_used)]

use crate::rubber;

use windfall_contact::expression::{parse_law, parse_law_among};
use windfall_contact::law::{ContactLaw, EndRule};
use windfall_contact::laws::any_law::AnyLaw;
use windfall_contact::laws::define_law::define_law;
use windfall_contact::laws::force_table::ForceTable;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_contact::laws::user::{UserForce, UserLawDefinition, UserParameter};
use windfall_identify::fit::problem::{FitOptions, LawProblem};
use windfall_identify::fit::result::{Fit, fit_impact};
use windfall_identify::rig::kind::{Carriage, Rig};
use windfall_identify::rig::simulate::simulate_rig;

/// `name|unit|start|default`
pub(crate) fn parameter(text: &str) -> UserParameter {
    let words: Vec<&str> = text.split('|').collect();
    UserParameter {
        name: words[0].into(),
        unit: words[1].into(),
        meaning: String::new(),
        lower: 0.0,
        upper: f64::INFINITY,
        start: words[2].parse().ok(),
        default: words[3].parse().ok(),
    }
}

fn defined(formula: &str, parameters: &[&str]) -> LawKind {
    define_law(&UserLawDefinition {
        name: "mine".into(),
        force: UserForce::Formula(formula.into()),
        parameters: parameters.iter().map(|text| parameter(text)).collect(),
    })
    .unwrap_or_else(|error| panic!("{error}"))
}

fn own(kind: LawKind, text: &str) -> Law {
    let law = parse_law_among(text, &[kind]).unwrap();
    law.complete().unwrap()
}

fn built_in(text: &str) -> Law {
    parse_law(text).unwrap().complete().unwrap()
}

fn free_body() -> Rig {
    Rig::Carriage(Carriage {
        mass: 0.2,
        driving_acceleration: 0.0,
    })
}

const KUWABARA_KONO: (&str, [&str; 2]) = (
    "k*x^1.5 + c*x^0.5*v",
    ["k|N/m^1.5|4e5|", "c|N s/m^1.5|600|"],
);
const POWER: (&str, [&str; 4]) = (
    "k*x^n + c*x^p*v",
    ["k|N/m^n|4e5|", "n|1||1.5", "c|N s/m^(p+1)|600|", "p|1||0.5"],
);

#[test]
fn reference_impacts_are_those_of_the_built_in_law() {
    let cases: [(&str, &[&str], &str, &str); 5] = [
        (
            KUWABARA_KONO.0,
            &KUWABARA_KONO.1,
            "mine(k=753599, c=1524)",
            "kuwabara-kono(k=753599, c=1524)",
        ),
        (
            POWER.0,
            &POWER.1,
            "mine(k=2e6, n=1.7, c=1500, p=0.6)",
            "power-law(k=2e6, n=1.7, c=1500, p=0.6)",
        ),
        (
            "k*x + c*v",
            &["k|N/m|1e4|", "c|N s/m|10|"],
            "mine(k=30000, c=40)",
            "kelvin-voigt(k=30000, c=40)",
        ),
        (
            "k*x^1.5 + a*x^0.25*sqrt(m*k)*v",
            &["k|N/m^1.5|1e6|", "a|1|0.3|", "m|kg|0.2|"],
            "mine(k=1e6, a=0.3478087776, m=0.2)",
            "tsuji(k=1e6, restitution=0.6, mass=0.2)",
        ),
        (
            // The damping rises over d as a cubic, then is constant.
            "k*x^e + c*v*if(x < d, (x/d)^2*(3 - 2*x/d), 1)",
            &["k|N/m^e|4e5|", "e|1||1.5", "c|N s/m|20|", "d|m|1e-4|"],
            "mine(k=466000, e=1.5, c=20, d=1e-4)",
            "adams-impact(k=466000, e=1.5, c=20, d=1e-4)",
        ),
    ];
    for (formula, parameters, mine, theirs) in cases {
        let kind = defined(formula, parameters);
        let (mut mine, theirs) = (own(kind, mine), built_in(theirs));
        if let Law::Tsuji(_) = theirs {
            // The damping factor that the built-in law makes of its restitution.
            let factor = AnyLaw(theirs).evaluate(1.0, 1.0, 0.0).by_rate / (0.2_f64 * 1e6).sqrt();
            mine = kind.with_parameters(&[1e6, factor, 0.2]).unwrap();
        }
        assert_eq!(AnyLaw(mine).start_power(), AnyLaw(theirs).start_power());
        for velocity in [0.05, 0.5, 2.0] {
            let one = simulate_rig(&mine, &free_body(), velocity, EndRule::ForceZero).unwrap();
            let two = simulate_rig(&theirs, &free_body(), velocity, EndRule::ForceZero).unwrap();
            let pairs = [
                (one.peak_force, two.peak_force),
                (one.max_displacement, two.max_displacement),
                (one.contact_duration, two.contact_duration),
                (one.restitution, two.restitution),
                (one.impulse, two.impulse),
                (one.absorbed_energy, two.absorbed_energy),
            ];
            for (one, two) in pairs {
                let error = (one - two).abs() / two.abs();
                assert!(
                    error < 1e-10,
                    "{formula} at {velocity}: {one} {two} {error:e}"
                );
            }
        }
    }
}

fn fit(kind: LawKind, text: &str, free: &[&str]) -> Fit {
    let mut problem = LawProblem::from_expression(&parse_law_among(text, &[kind]).unwrap());
    for name in free {
        problem.free[kind.describe().index_of(name).unwrap()] = true;
    }
    fit_impact(
        &rubber::impact(3),
        &rubber::rig(),
        &problem,
        &FitOptions::default(),
    )
    .unwrap()
}

fn same(one: &Fit, two: &Fit) {
    alike(one, two, 1e-8);
}

fn alike(one: &Fit, two: &Fit, tolerance: f64) {
    assert!(one.converged && two.converged);
    for (one, two) in one.parameters.iter().zip(&two.parameters) {
        for (a, b) in [(one.value, two.value), (one.sd, two.sd)] {
            let error = (a - b).abs() / b;
            assert!(error < tolerance, "{}: {a} {b} {error:e}", one.name);
        }
    }
    assert!((one.cost / two.cost - 1.0).abs() < tolerance);
}

#[test]
fn reference_the_fit_of_the_built_in_law() {
    let kind = defined(KUWABARA_KONO.0, &KUWABARA_KONO.1);
    same(&fit(kind, "mine", &[]), &fit(kind, "kuwabara-kono", &[]));
    let kind = defined(POWER.0, &POWER.1);
    same(&fit(kind, "mine", &[]), &fit(kind, "power-law", &[]));
    same(&fit(kind, "mine", &["n"]), &fit(kind, "power-law", &["n"]));
}

#[test]
fn recovers_without_a_start() {
    let kind = defined(KUWABARA_KONO.0, &["k|N/m^1.5||", "c|N s/m^1.5||"]);
    // Another start ends elsewhere within the tolerance of the search.
    alike(
        &fit(kind, "mine", &[]),
        &fit(kind, "kuwabara-kono", &[]),
        1e-6,
    );
    // Three scales: nothing to regress on, the guess alone must do.
    let kind = defined(
        "k*x^1.5 + c*x^0.5*v + b*x^2",
        &["k|N/m^1.5||", "c|N s/m^1.5||", "b|N/m^2||0"],
    );
    // Another start ends elsewhere within the tolerance of the search.
    alike(
        &fit(kind, "mine", &[]),
        &fit(kind, "kuwabara-kono", &[]),
        1e-6,
    );
}

#[test]
fn recovers_a_table_s_scales() {
    // The rubber's law as a table: its scales are one.
    let displacement: Vec<f64> = (0..200)
        .map(|i| 2e-3 * (f64::from(i) / 199.0).powi(2))
        .collect();
    let of = |f: &dyn Fn(f64) -> f64| displacement.iter().map(|d| f(*d)).collect::<Vec<f64>>();
    let kind = define_law(&UserLawDefinition {
        name: "curve".into(),
        force: UserForce::Table(ForceTable {
            force: of(&|d| rubber::K * d.powf(1.5)),
            damping: Some(of(&|d| rubber::C * d.sqrt())),
            displacement: displacement.clone(),
        }),
        parameters: Vec::new(),
    })
    .unwrap();
    let fit = fit(kind, "curve", &[]);
    assert!(fit.converged);
    for estimate in &fit.parameters {
        let off = (estimate.value - 1.0) / estimate.sd;
        assert!(off.abs() < 4.0 && estimate.sd < 0.05, "{estimate:?}");
    }
}

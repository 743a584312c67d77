//! Impacts and fits under laws of the user that remember their largest displacement, against
//! SciPy and the built-in law.

use crate::rubber;
use crate::user_law::parameter;
use windfall_contact::expression::parse_law_among;
use windfall_contact::law::EndRule;
use windfall_contact::laws::define_law::define_law;
use windfall_contact::laws::kind::LawKind;
use windfall_contact::laws::user::{UserForce, UserLawDefinition};
use windfall_identify::fit::problem::{FitOptions, LawProblem};
use windfall_identify::fit::result::{Fit, fit_impact};
use windfall_identify::rig::kind::{Carriage, Rig};
use windfall_identify::rig::simulate::{simulate_rig, trajectory};
use windfall_signal::impact::{Impact, Series};

fn defined(force: &str, unloading: Option<&str>, parameters: &[&str]) -> LawKind {
    let force = force.to_owned();
    let found = define_law(&UserLawDefinition {
        name: "mine".into(),
        force: match unloading {
            None => UserForce::Formula(force),
            Some(unloading) => UserForce::WithMemory {
                force,
                unloading: unloading.into(),
            },
        },
        parameters: parameters.iter().map(|text| parameter(text)).collect(),
    });
    found.unwrap_or_else(|error| panic!("{error}"))
}

fn yielding() -> LawKind {
    let rest = "(x - x_max + (F_max/k)^(2/3))";
    let unloading = format!("k*{rest}*sqrt(abs{rest}) + c*sqrt(abs{rest})*v");
    defined(
        "if(x < d, k*x^1.5, k*d^1.5 + 1.5*k*d^0.5*h*(x - d)) + c*x^0.5*v",
        Some(&unloading),
        &[
            "k|N/m^1.5|7e5|",
            "c|N s/m^1.5|1500|",
            "d|m|4e-4|",
            "h|1||0.5",
        ],
    )
}

fn walton_braun() -> LawKind {
    let parameters = ["k1|N/m|15000|", "k2|N/m|40000|"];
    defined("k1*x", Some("F_max + k2*(x - x_max)"), &parameters)
}

fn body() -> Rig {
    Rig::Carriage(Carriage {
        mass: 0.2,
        driving_acceleration: 0.0,
    })
}

/// Peak force, largest displacement, duration, restitution and displacement left, by another
/// program on SciPy 1.17 (`solve_ivp`, DOP853, relative tolerance 1e-12).
#[test]
fn reference_yield_walton_braun_and_a_stop() {
    let stop = defined(
        "k*x^1.5 + c*x^0.5*v + s*max(x - d, 0)",
        None,
        &[
            "k|N/m^1.5|7e5|",
            "c|N s/m^1.5|1500|",
            "d|m|8e-4|",
            "s|N/m|2e5|",
        ],
    );
    let cases: [(LawKind, &[f64], f64, [f64; 5]); 4] = [
        (
            yielding(),
            &[753_599.0, 1524.0, 4e-4, 0.5],
            0.5,
            [
                25.034_974_12,
                0.001_269_754_489_7,
                0.009_137_940_823,
                0.308_548_283_8,
                0.000_819_457_357_2,
            ],
        ),
        // Too slow to yield: the elastic law.
        (
            yielding(),
            &[753_599.0, 1524.0, 4e-4, 0.5],
            0.1,
            [
                4.891_984_058,
                0.000_327_438_410_7,
                0.010_875_995_44,
                0.571_399_368_4,
                0.000_115_553_847_3,
            ],
        ),
        (
            walton_braun(),
            &[15_000.0, 40_000.0],
            0.5,
            [
                27.386_127_875,
                0.001_825_741_858_4,
                0.009_248_144_575,
                0.612_372_435_7,
                0.001_141_088_661_5,
            ],
        ),
        (
            stop,
            &[753_599.0, 1524.0, 8e-4, 2e5],
            0.5,
            [
                64.835_278_84,
                0.000_997_572_511_6,
                0.005_302_527_276,
                0.527_928_290_7,
                0.000_533_813_550_1,
            ],
        ),
    ];
    for (kind, values, velocity, expected) in cases {
        let law = kind.with_parameters(values).unwrap();
        let found = simulate_rig(&law, &body(), velocity, EndRule::ForceZero).unwrap();
        let found = [
            found.peak_force,
            found.max_displacement,
            found.contact_duration,
            found.restitution,
            found.final_displacement,
        ];
        for (own, other) in found.into_iter().zip(expected) {
            let error = (own / other - 1.0).abs();
            assert!(error < 1e-8, "{velocity}: {own} {other} {error:e}");
        }
    }
}

fn fit(kind: LawKind, text: &str, impact: &Impact, rig: &Rig) -> Fit {
    let problem = LawProblem::from_expression(&parse_law_among(text, &[kind]).unwrap());
    fit_impact(impact, rig, &problem, &FitOptions::default()).unwrap()
}

/// On a recording that neither law made, the formulas give the fit of the built-in law: its
/// parameters, deviations and cost.
#[test]
fn reference_the_fit_of_walton_braun() {
    let (impact, rig) = (rubber::impact(3), rubber::rig());
    let mine = fit(walton_braun(), "mine", &impact, &rig);
    let theirs = fit(walton_braun(), "walton-braun", &impact, &rig);
    assert!(mine.converged && theirs.converged);
    for (own, other) in mine.parameters.iter().zip(&theirs.parameters) {
        for (a, b) in [(own.value, other.value), (own.sd, other.sd)] {
            assert!((a / b - 1.0).abs() < 1e-5, "{}: {a} {b}", own.name);
        }
    }
    assert!((mine.cost / theirs.cost - 1.0).abs() < 1e-6);
}

/// k, c and the displacement of yield of a recording with noise, within their deviations.
#[test]
fn recovers_where_a_fruit_yields() {
    let truth = [753_599.0, 1524.0, 4e-4, 0.5];
    let law = yielding().with_parameters(&truth).unwrap();
    let times: Vec<f64> = (0..3000).map(|i| (f64::from(i) - 600.0) * 5e-6).collect();
    let motion = trajectory(&law, &body(), 0.5, &times, EndRule::ForceZero).unwrap();
    let mut impact = rubber::impact(3);
    let noisy = |values: &[f64], sd: f64, stream: u64| {
        let mut source = windfall_signal::noise::gaussian::noise_source(7, stream);
        let noise = || sd * windfall_signal::noise::gaussian::normal(&mut source);
        let noise: Vec<f64> = std::iter::repeat_with(noise).take(values.len()).collect();
        let values = values.iter().zip(noise).map(|(value, noise)| value + noise);
        (values.collect::<Vec<f64>>(), sd)
    };
    let series = |values: &[f64], sd: f64, stream: u64, like: &Series| {
        let (values, noise) = noisy(values, sd, stream);
        Series {
            times: times.clone(),
            values,
            noise,
            ..like.clone()
        }
    };
    let force = impact.force.clone().unwrap();
    let displacement = impact.displacement.clone().unwrap();
    impact.force = Some(series(&motion.force, 0.2, 1, &force));
    impact.displacement = Some(series(&motion.displacement, 1e-6, 2, &displacement));
    impact.rate = None;
    impact.acceleration = None;
    (impact.onset, impact.end) = (0.0, 0.009_137_9);
    let found = fit(yielding(), "mine", &impact, &body());
    assert!(found.converged);
    for (own, truth) in found.parameters.iter().zip(truth) {
        let apart = (own.value - truth) / own.sd;
        assert!(
            apart.abs() < 4.0 && own.sd < 0.1 * truth,
            "{}: {} ± {}",
            own.name,
            own.value,
            own.sd
        );
    }
}

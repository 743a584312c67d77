//! Each law of the registry: simulated, sampled with noise, fitted from its own
//! starting values, and found again.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::LawKind;
use windfall_identify::finding::Finding;
use windfall_identify::fit::problem::{FitOptions, LawProblem, Quantities, Treatment, Weighting};
use windfall_identify::fit::result::fit_impact;
use windfall_identify::rig::bench::{BenchQuantity, BenchSd};
use windfall_identify::rig::kind::{Carriage, Rig};
use windfall_identify::rig::simulate::{simulate_rig, trajectory};
use windfall_identify::samples::Quantity;
use windfall_signal::impact::{Impact, Measured, Series};
use windfall_signal::noise::gaussian::{noise_source, normal};

const VELOCITY: f64 = 0.5;

/// The law that is simulated, and the expression that is fitted.
const CASES: [(&str, &str); 14] = [
    ("hertz(k=753599)", "hertz"),
    ("kelvin-voigt(k=30000, c=40)", "kelvin-voigt"),
    ("kuwabara-kono(k=753599, c=1524)", "kuwabara-kono"),
    ("power-law(k=753599, n=1.5, c=1524, p=0.5)", "power-law"),
    (
        "power-law(k=753599, n=1.5, c=1524, p=0.25)",
        "power-law(p=0.25)",
    ),
    ("hunt-crossley(k=753599, lambda=678239)", "hunt-crossley"),
    (
        "lankarani-nikravesh(k=753599, restitution=0.7, impact_velocity=0.5)",
        "lankarani-nikravesh",
    ),
    (
        "flores(k=753599, restitution=0.7, impact_velocity=0.5)",
        "flores",
    ),
    (
        "herbert-mcwhannell(k=753599, restitution=0.7, impact_velocity=0.5)",
        "herbert-mcwhannell",
    ),
    ("tsuji(k=753599, restitution=0.7, mass=0.2)", "tsuji"),
    (
        "adams-impact(k=466000, e=1.4, c=20, d=1e-4)",
        "adams-impact(e=1.4, d=1e-4)",
    ),
    ("walton-braun(k1=40000, k2=90000)", "walton-braun"),
    (
        "thornton(E_star=5e6, R_star=0.04, yield_pressure=3e5)",
        "thornton(R_star=0.04)",
    ),
    (
        "adams-impact(k=466000, e=1.5, c=20, d=1e-6)",
        "adams-impact(e=1.5, d=1e-6)",
    ),
];

fn rig() -> Rig {
    Rig::Carriage(Carriage {
        mass: 0.2,
        driving_acceleration: 0.3,
    })
}

/// Instants per sampling interval over which a sensor averages the force: a law
/// that jumps at touch has no force at the instant.
const APERTURE: i32 = 20;

/// Force, a mean over the sampling interval, with 0.1 N and displacement with
/// 1 µm of white noise at 100 kHz.
fn impact(law: &str, seed: u64) -> Impact {
    let law = parse_law(law).unwrap().complete().unwrap();
    let summary = simulate_rig(&law, &rig(), VELOCITY, EndRule::ForceZero).unwrap();
    let times: Vec<f64> = (-150..(summary.contact_duration * 1.2e5) as i32)
        .map(|i| f64::from(i) * 1e-5 + 3e-6)
        .collect();
    let motion = trajectory(&law, &rig(), VELOCITY, &times, EndRule::ForceZero).unwrap();
    let fine: Vec<f64> = times
        .iter()
        .flat_map(|t| {
            (0..APERTURE)
                .map(move |i| t + 1e-5 * ((f64::from(i) + 0.5) / f64::from(APERTURE) - 0.5))
        })
        .collect();
    let force = trajectory(&law, &rig(), VELOCITY, &fine, EndRule::ForceZero)
        .unwrap()
        .force;
    let force: Vec<f64> = force
        .chunks(APERTURE as usize)
        .map(|part| part.iter().sum::<f64>() / f64::from(APERTURE))
        .collect();
    let mut source = noise_source(seed, 1);
    let mut series = |values: &[f64], noise: f64| Series {
        times: times.clone(),
        values: values
            .iter()
            .map(|v| v + noise * normal(&mut source))
            .collect(),
        noise,
        ..Series::default()
    };
    Impact {
        displacement: Some(series(&motion.displacement, 1e-6)),
        rate: None,
        force: Some(series(&force, 0.1)),
        acceleration: None,
        onset: 2e-5,
        end: summary.contact_duration - 2e-5,
        measured: Measured {
            impact_velocity: Some(VELOCITY),
            restitution: Some(summary.restitution),
            peak_force: Some(summary.peak_force),
            max_displacement: Some(summary.max_displacement),
            contact_duration: Some(summary.contact_duration),
            ..Measured::default()
        },
    }
}

/// Every free parameter within five of its own standard deviations, which are
/// small against it, and the residuals as large as the noise.
#[test]
fn recovers_each_law_from_its_own_start() {
    let mut wrong = Vec::new();
    for (seed, (truth, fitted)) in (1..).zip(CASES) {
        let law = parse_law(truth).unwrap().complete().unwrap();
        let problem = LawProblem::from_expression(&parse_law(fitted).unwrap());
        let impact = impact(truth, seed);
        let fit = fit_impact(&impact, &rig(), &problem, &FitOptions::default()).unwrap();
        if !fit.converged {
            wrong.push(format!("{truth}: no convergence {:?}", fit.findings));
        }
        for estimate in &fit.parameters {
            let index = law.kind().describe().index_of(&estimate.name).unwrap();
            let expected = law.parameters()[index];
            let scores = (estimate.value - expected) / estimate.sd;
            if scores.abs() > 5.0 || estimate.sd > 0.1 * expected {
                wrong.push(format!("{truth}: {estimate:?}"));
            }
        }
        for quantity in &fit.quantities {
            let ratio = quantity.rms_residual / quantity.noise;
            if (ratio - 1.0).abs() > 0.1 {
                wrong.push(format!("{truth}: {quantity:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The list above leaves out no law.
#[test]
fn pinned_every_law_has_a_case() {
    for kind in LawKind::ALL {
        let found = CASES.iter().any(|(law, _)| law.starts_with(kind.name()));
        assert!(found, "{} has no case", kind.name());
    }
}

/// A free exponent is found too.
#[test]
fn recovers_a_free_exponent() {
    let mut problem = LawProblem::from_expression(&parse_law("power-law(p=0.5)").unwrap());
    problem.free[1] = true;
    let impact = impact("power-law(k=2e6, n=1.7, c=1500, p=0.5)", 99);
    let fit = fit_impact(&impact, &rig(), &problem, &FitOptions::default()).unwrap();
    let n = &fit.parameters[1];
    assert!(fit.converged && n.name == "n" && n.unit == "1");
    assert!((n.value - 1.7).abs() < 5.0 * n.sd && n.sd < 0.05, "{n:?}");
}

/// An uncertain mass widens the intervals: k and c scale with the mass when
/// the motion alone is fitted.
#[test]
fn closed_form_uncertain_mass() {
    let impact = Impact {
        force: None,
        ..impact("kuwabara-kono(k=753599, c=1524)", 7)
    };
    let problem = LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap());
    let fit = |mass_sd: f64| {
        let options = FitOptions {
            bench: BenchSd::default().with(BenchQuantity::Mass, mass_sd),
            ..FitOptions::default()
        };
        fit_impact(&impact, &rig(), &problem, &options).unwrap()
    };
    let (sure, unsure) = (fit(0.0), fit(0.02));
    for (sure, unsure) in sure.parameters.iter().zip(&unsure.parameters) {
        let expected = sure.sd.hypot(0.1 * sure.value);
        assert!(
            (unsure.sd / expected - 1.0).abs() < 1e-3,
            "{sure:?} {unsure:?}"
        );
    }
}

/// What a bench that is not as told moves, for one standard uncertainty: a force that reads
/// 1 % more, in a fit of the force alone, is a law with k and c 1 % larger.
#[test]
fn closed_form_uncertain_force() {
    let exact = impact("kuwabara-kono(k=753599, c=1524)", 7);
    let problem = LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap());
    let fit = |quantities: &[Quantity], quantity, sd: f64| {
        let options = FitOptions {
            quantities: Quantities::of(quantities),
            bench: BenchSd::default().with(quantity, sd),
            ..FitOptions::default()
        };
        fit_impact(&exact, &rig(), &problem, &options).unwrap()
    };
    let both = [Quantity::Displacement, Quantity::Force];
    // A mass and a force that are both 1 % more say the same of every law, the other way round.
    let by_mass = fit(&both, BenchQuantity::Mass, 0.002);
    let by_gain = fit(&both, BenchQuantity::ForceGain, 0.01);
    let (mass, gain) = (&by_mass.common[0], &by_gain.common[0]);
    assert_eq!((mass.cause.name().as_str(), mass.sd), ("mass", 0.002));
    for (i, own) in by_mass.parameters.iter().enumerate() {
        let sum = (mass.shifts[i] - gain.shifts[i]) / own.value;
        assert!((sum - 0.01).abs() < 2e-4, "{}: {sum}", own.name);
        assert!(own.sd > mass.shifts[i].abs(), "{own:?}");
    }
    let code = by_gain.findings.iter().map(Finding::code);
    assert!(code.into_iter().any(|code| code == "uncertain-bench"));
}

/// Without noise the law comes out to the accuracy of the integration, with
/// either weights, although the onset is free and the force starts like √t.
#[test]
fn recovers_exactly_without_noise() {
    let times: Vec<f64> = (-150..900).map(|i| f64::from(i) * 1e-5 + 3e-6).collect();
    let law = parse_law("kuwabara-kono(k=753599, c=1524)").unwrap();
    let law = law.complete().unwrap();
    let motion = trajectory(&law, &rig(), VELOCITY, &times, EndRule::ForceZero).unwrap();
    let series = |values: &[f64], noise: f64| Series {
        times: times.clone(),
        values: values.to_vec(),
        noise,
        ..Series::default()
    };
    let exact = Impact {
        displacement: Some(series(&motion.displacement, 1e-6)),
        rate: Some(series(&motion.rate, 1e-3)),
        force: Some(series(&motion.force, 0.1)),
        ..impact("kuwabara-kono(k=753599, c=1524)", 1)
    };
    let problem = LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap());
    for weighting in [Weighting::InverseVariance, Weighting::InverseMean] {
        let options = FitOptions {
            weighting,
            ..FitOptions::default()
        };
        let fit = fit_impact(&exact, &rig(), &problem, &options).unwrap();
        println!(
            "{weighting:?} {} evaluations {:?}",
            fit.evaluations, fit.parameters
        );
        assert!(
            fit.converged && fit.evaluations < 60,
            "{weighting:?} {fit:?}"
        );
        for (estimate, truth) in fit.parameters.iter().zip([753_599.0, 1524.0]) {
            assert!(
                (estimate.value / truth - 1.0).abs() < 1e-6,
                "{weighting:?} {estimate:?}"
            );
        }
    }
}

/// A velocity can be given; one that was never measured is not held silently.
#[test]
fn rejects_holding_a_velocity_that_was_not_measured() {
    let mut impact = impact("kuwabara-kono(k=753599, c=1524)", 3);
    impact.measured.impact_velocity = None;
    let problem = LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap());
    let mut options = FitOptions {
        initial_velocity: Treatment::Fixed,
        ..FitOptions::default()
    };
    let error = fit_impact(&impact, &rig(), &problem, &options).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the velocity at first touch is to be held, but the recording does not show the motion before contact; give the velocity, or let it be estimated"
    );
    options.known_velocity = Some(VELOCITY);
    let fit = fit_impact(&impact, &rig(), &problem, &options).unwrap();
    assert!(fit.converged && fit.velocity == VELOCITY);
    for (estimate, truth) in fit.parameters.iter().zip([753_599.0, 1524.0]) {
        assert!(
            (estimate.value - truth).abs() < 5.0 * estimate.sd,
            "{estimate:?}"
        );
    }
}

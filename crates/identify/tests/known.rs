//! Priors, bounds and noise that are given.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::rubber::{C, K, impact, rig};
use windfall_contact::expression::parse_law;
use windfall_identify::finding::Finding;
use windfall_identify::fit::interval::{IntervalMethod, IntervalOptions};
use windfall_identify::fit::problem::{
    FitOptions, Known, LawProblem, NoiseModel, Prior, Quantities, Treatment,
};
use windfall_identify::fit::result::{Estimate, Fit, fit_impact};
use windfall_identify::rig::kind::{Carriage, Rig};
use windfall_identify::samples::Quantity;
use windfall_signal::impact::{Impact, Measured, Series};

const ALL: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

fn known(name: &str, prior: Option<(f64, f64)>, range: (f64, f64)) -> Known {
    Known {
        name: name.to_owned(),
        prior: prior.map(|(mean, sd)| Prior { mean, sd }),
        range,
    }
}

fn fit(impact: &Impact, rig: &Rig, known: &[Known], options: &FitOptions) -> Fit {
    let mut problem = LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap());
    problem.known = known.to_vec();
    fit_impact(impact, rig, &problem, options).unwrap()
}

fn own<'a>(fit: &'a Fit, name: &str) -> &'a Estimate {
    let mut all = fit.parameters.iter().chain(&fit.nuisances);
    all.find(|own| own.name == name).unwrap()
}

fn codes(fit: &Fit) -> Vec<&'static str> {
    fit.findings.iter().map(Finding::code).collect()
}

const MASS: f64 = 0.2;
const VELOCITY: f64 = 0.5;
const FORCE_SD: f64 = 2.0;
const DISPLACEMENT_SD: f64 = 2e-5;

/// What bench/prior_reference.py fits with SciPy: k = 753,599, c = 1,524, a mass of 0.2 kg at
/// 0.5 m/s, 80 samples, and in the place of noise sines that no law describes. The motion is that
/// of another integrator (DOP853 of SciPy at 1e-12).
fn reference_impact() -> Impact {
    let text = include_str!("data/prior_reference.csv");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let series = |column: usize, noise: f64| Series {
        times: rows.iter().map(|row| row[0]).collect(),
        values: rows.iter().map(|row| row[column]).collect(),
        noise,
        ..Series::default()
    };
    Impact {
        displacement: Some(series(1, 1e-6)),
        rate: None,
        force: Some(series(2, 0.1)),
        acceleration: None,
        onset: 0.0,
        end: 8e-3,
        measured: Measured {
            impact_velocity: Some(VELOCITY),
            contact_duration: Some(7.65e-3),
            ..Measured::default()
        },
    }
}

fn carriage() -> Rig {
    Rig::Carriage(Carriage {
        mass: MASS,
        driving_acceleration: 0.0,
    })
}

/// Everything but k and c held, noise as given: what SciPy's problem is.
fn reference_options() -> FitOptions {
    let mut noise_sd = [None; 4];
    noise_sd[Quantity::Force as usize] = Some(FORCE_SD);
    noise_sd[Quantity::Displacement as usize] = Some(DISPLACEMENT_SD);
    FitOptions {
        quantities: Quantities::of(&[Quantity::Displacement, Quantity::Force]),
        noise: NoiseModel::White,
        noise_sd,
        initial_velocity: Treatment::Fixed,
        known_velocity: Some(VELOCITY),
        onset: Treatment::Fixed,
        displacement_offset: Treatment::Fixed,
        ..FitOptions::default()
    }
}

/// SciPy's least_squares with a residual for each prior, from bench/prior_reference.py:
/// values and deviations (JᵀJ)⁻¹ of k and c under no prior, one of k, one of both.
const SCIPY: [[f64; 4]; 3] = [
    [745632.8033, 4938.385169, 1555.21484, 22.86885396],
    [748746.5786, 4779.719718, 1545.261787, 22.48133367],
    [750433.2514, 4711.233848, 1533.507305, 21.85144429],
];
const K_PRIOR: (f64, f64) = (8e5, 2e4);
const C_PRIOR: (f64, f64) = (1300.0, 100.0);

#[test]
fn reference_scipy_fits_with_priors() {
    let cases = [
        (vec![], SCIPY[0]),
        (vec![known("k", Some(K_PRIOR), ALL)], SCIPY[1]),
        (
            vec![
                known("k", Some(K_PRIOR), ALL),
                known("c", Some(C_PRIOR), ALL),
            ],
            SCIPY[2],
        ),
    ];
    for (known, [k, k_sd, c, c_sd]) in cases {
        let found = fit(
            &reference_impact(),
            &carriage(),
            &known,
            &reference_options(),
        );
        for (name, value, sd) in [("k", k, k_sd), ("c", c, c_sd)] {
            let own = own(&found, name);
            println!("{name} {} {} against {value} {sd}", own.value, own.sd);
            assert!((own.value - value).abs() < 1e-3 * sd, "{own:?} {value}");
            assert!((own.sd / sd - 1.0).abs() < 1e-3, "{own:?} {sd}");
        }
    }
}

/// Near its minimum the problem is linear: a prior is averaged with the data by precision, and
/// what it moves is part of the deviation.
#[test]
fn closed_form_precision_weighted_mean() {
    let (impact, rig, options) = (reference_impact(), carriage(), reference_options());
    let data = fit(&impact, &rig, &[], &options);
    let data = own(&data, "k");
    for (away, of_sd) in [(0.5, 1.0), (-0.4, 0.5), (0.3, 2.0)] {
        let (mean, sd) = (data.value + away * data.sd, of_sd * data.sd);
        let found = fit(
            &impact,
            &rig,
            &[known("k", Some((mean, sd)), ALL)],
            &options,
        );
        let own = own(&found, "k");
        let weights = [data.sd.powi(-2), sd.powi(-2)];
        let total = weights[0] + weights[1];
        let value = (weights[0] * data.value + weights[1] * mean) / total;
        assert!(
            (own.value - value).abs() < 5e-3 * data.sd,
            "{own:?} {value}"
        );
        assert!((own.sd * total.sqrt() - 1.0).abs() < 5e-3, "{own:?}");
        // Moving the prior by its deviation moves the estimate by that times its weight.
        let common = &found.common[0];
        assert_eq!(common.cause.name(), "prior.k");
        let moved = sd * weights[1] / total;
        assert!((common.shifts[0] / moved - 1.0).abs() < 1e-2, "{common:?}");
        let mostly = weights[1] > weights[0];
        assert_eq!(codes(&found).contains(&"mostly-prior"), mostly);
    }
}

/// Intervals of each method with a prior as sharp as the data.
#[test]
fn closed_form_intervals_of_all_methods() {
    let rubber = impact(3);
    let plain = FitOptions::default();
    let data = fit(&rubber, &rig(), &[], &plain);
    let data = own(&data, "c").clone();
    let prior = [known("c", Some((data.value + 0.5 * data.sd, data.sd)), ALL)];
    for method in [
        IntervalMethod::Profile,
        IntervalMethod::Bootstrap,
        IntervalMethod::Posterior,
    ] {
        let options = FitOptions {
            intervals: IntervalOptions {
                method,
                replicates: 400,
                draws: 500,
                ..IntervalOptions::default()
            },
            ..plain
        };
        let found = fit(&rubber, &rig(), &prior, &options);
        let own = own(&found, "c");
        let width = (own.high - own.low) / (2.0 * 1.96 * data.sd / 2f64.sqrt());
        let centre = (0.5 * (own.high + own.low) - data.value) / data.sd;
        println!("{}: width {width:.3}, centre {centre:.3}", method.name());
        assert!((width - 1.0).abs() < 0.12, "{} {width}", method.name());
        assert!((centre - 0.25).abs() < 0.12, "{} {centre}", method.name());
    }
}

/// At a bound the interval begins there and ends where the cost, with the parameter held, has
/// risen by the square of the quantile.
#[test]
fn closed_form_interval_at_a_bound() {
    let (impact, rig, options) = (reference_impact(), carriage(), reference_options());
    let free = fit(&impact, &rig, &[], &options);
    let bound = own(&free, "c").value + 0.7 * own(&free, "c").sd;
    let range = (bound, f64::INFINITY);
    let found = fit(&impact, &rig, &[known("c", None, range)], &options);
    let c = own(&found, "c");
    assert!((c.value - bound).abs() < 1e-9 * bound && c.low == bound && c.sd.is_infinite());
    let told = found.findings.iter().map(ToString::to_string);
    assert!(told.into_iter().any(|own| own.contains("which was given")));
    let held = |c: f64| {
        let law = parse_law(&format!("kuwabara-kono(c={c:?})")).unwrap();
        let problem = LawProblem::from_expression(&law);
        fit_impact(&impact, &rig, &problem, &options).unwrap().cost
    };
    let rise = held(c.high) - held(bound);
    assert!((rise - 1.975_f64.powi(2)).abs() < 0.05, "{rise}");
    // A bound that is not reached moves nothing, and cuts the interval.
    let near = own(&free, "c").value - own(&free, "c").sd;
    let cut = fit(&impact, &rig, &[known("c", None, (near, 1e4))], &options);
    let c = own(&cut, "c");
    assert_eq!(c.low, near);
    assert!((c.value - own(&free, "c").value).abs() < 1e-3 * c.sd);
}

#[test]
fn rejects_a_prior_that_the_data_contradict() {
    let rubber = impact(5);
    let data = fit(&rubber, &rig(), &[], &FitOptions::default());
    let data = own(&data, "k").clone();
    // As sharp as the data, and ten of its deviations away.
    let sharp = known("k", Some((data.value + 10.0 * data.sd, data.sd)), ALL);
    let found = fit(&rubber, &rig(), &[sharp], &FitOptions::default());
    assert!(
        codes(&found).contains(&"prior-contradicted"),
        "{:?}",
        codes(&found)
    );
    for finding in &found.findings {
        if let Finding::PriorContradicted {
            data: told, apart, ..
        } = finding
        {
            // The data alone are what a fit without the prior says.
            assert!((told.0 - data.value).abs() < 1e-6 * data.value);
            assert!((apart - 10.0 / 2f64.sqrt()).abs() < 0.01, "{apart}");
        }
    }
    // Far away and vague: the data decide.
    let vague = known(
        "k",
        Some((data.value + 400.0 * data.sd, 100.0 * data.sd)),
        ALL,
    );
    let found = fit(&rubber, &rig(), &[vague], &FitOptions::default());
    assert!(
        codes(&found).contains(&"prior-outweighed"),
        "{:?}",
        codes(&found)
    );
    // In accord: nothing is said.
    let good = known("k", Some((data.value, 5.0 * data.sd)), ALL);
    let found = fit(&rubber, &rig(), &[good], &FitOptions::default());
    assert!(!codes(&found).iter().any(|code| code.starts_with("prior-")));
}

/// Noise that is given is not what residuals say.
#[test]
fn closed_form_noise_that_is_given() {
    let (impact, rig) = (reference_impact(), carriage());
    let once = reference_options();
    let mut twice = once;
    twice.noise_sd = once.noise_sd.map(|sd| sd.map(|sd| 2.0 * sd));
    let (once, twice) = (
        fit(&impact, &rig, &[], &once),
        fit(&impact, &rig, &[], &twice),
    );
    for (a, b) in once.parameters.iter().zip(&twice.parameters) {
        assert!((b.sd / a.sd - 2.0).abs() < 1e-3, "{a:?} {b:?}");
        assert!((b.value - a.value).abs() < 1e-3 * a.sd);
    }
    assert!((once.cost / twice.cost - 4.0).abs() < 1e-3);
    // The rubber fit with the noise that it has.
    let rubber = crate::rubber::impact(11);
    let mut options = FitOptions::default();
    options.noise_sd[Quantity::Force as usize] = Some(rubber.force.as_ref().unwrap().noise);
    let found = fit(&rubber, &crate::rubber::rig(), &[], &options);
    for (name, value) in [("k", K), ("c", C)] {
        let own = own(&found, name);
        assert!((own.value - value).abs() < 4.0 * own.sd, "{own:?}");
    }
}

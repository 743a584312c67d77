//! Mixed models against lme4, lmerTest and pbkrtest (`bench/mixed_reference.R`).

mod mixed_cases;

use mixed_cases::{assert_near, fitted_case, numbers, reference, rows};
use windfall_statistics::mixed_finding::MixedFinding;

#[test]
fn reference_estimates_of_lme4() {
    for case in reference()["cases"].as_array().unwrap() {
        let name = format!("{} {}", case["formula"], case["method"]);
        let fit = fitted_case(case);
        let near = |what: &str, found: &[f64], tolerance: f64| {
            let what = format!("{name}, {what}");
            assert_near(
                &what,
                found,
                &numbers(&case[what.rsplit(' ').next().unwrap()]),
                tolerance,
            );
        };
        near("coefficients", &fit.coefficients, 1e-8);
        near("theta", &fit.theta, 1e-6);
        near("sigma", &[fit.residual_sd], 1e-8);
        near("log_likelihood", &[fit.log_likelihood], 1e-10);
        near("aic", &[fit.aic], 1e-10);
        near("bic", &[fit.bic], 1e-10);
        near("fitted_first", &fit.fitted[..5], 1e-7);
        let covariance: Vec<f64> = rows(&case["covariance"]).concat();
        let transposed = fit.covariance.transpose();
        assert_near(
            &format!("{name}, covariance"),
            transposed.as_slice(),
            &covariance,
            1e-6,
        );
    }
}

#[test]
fn reference_singular_fits_are_exact_and_reported() {
    for case in reference()["cases"].as_array().unwrap() {
        let fit = fitted_case(case);
        let zeros = numbers(&case["theta"])
            .iter()
            .filter(|t| **t == 0.0)
            .count();
        let found = fit.theta.iter().filter(|t| **t == 0.0).count();
        assert_eq!(found, zeros, "{}", case["formula"]);
        let reported = fit
            .findings
            .iter()
            .filter(|f| f.code() == "singular")
            .count();
        assert_eq!(reported, zeros, "{:?}", fit.findings);
        let unconverged = |f: &MixedFinding| f.code() == "no_convergence";
        assert!(!fit.findings.iter().any(unconverged), "{}", case["formula"]);
    }
}

#[test]
fn reference_random_effects_of_lme4() {
    for case in reference()["cases"].as_array().unwrap() {
        let fit = fitted_case(case);
        for (effects, term) in fit.effects.iter().zip(fit.model.terms()) {
            let name = format!("{} {}", case["formula"], effects.term);
            let names = &case["effect_names"][&effects.term];
            let values = rows(&case["effects"][&effects.term]);
            let sds = rows(&case["effect_sds"][&effects.term]);
            for (k, expected) in names.as_array().unwrap().iter().enumerate() {
                let group = term.group_names.iter().position(|g| g == expected).unwrap();
                assert_near(&name, &effects.values[group], &values[k], 1e-5);
                assert_near(&format!("{name}, sd"), &effects.sds[group], &sds[k], 1e-5);
            }
        }
    }
}

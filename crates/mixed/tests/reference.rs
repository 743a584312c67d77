//! Mixed models against lme4, lmerTest and pbkrtest (`bench/mixed_reference.R`).

use crate::cases;

use cases::{assert_near, fitted_case, numbers, reference, rows};
use windfall_mixed::finding::MixedFinding;
use windfall_mixed::fit::MixedMethod;
use windfall_mixed::inference::{
    coefficient_tests, f_test, picking_contrast, variance_uncertainty,
};
use windfall_mixed::kenward_roger::{kenward_roger, kenward_roger_f, kenward_roger_tests};
use windfall_mixed::profile::profile_variances;
use windfall_mixed::summary::variance_shares;

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

#[test]
fn reference_satterthwaite_of_lmer_test() {
    for case in reference()["cases"].as_array().unwrap() {
        let fit = fitted_case(case);
        let uncertainty = variance_uncertainty(&fit).unwrap();
        let tests = coefficient_tests(&fit, &uncertainty, 0.95);
        let name = format!("{} {}", case["formula"], case["method"]);
        type Column = fn(&windfall_mixed::coefficient::Coefficient) -> f64;
        let columns: [(&str, Column, f64); 4] = [
            ("se", |t| t.se, 1e-7),
            ("df", |t| t.df, 1e-5),
            ("t", |t| t.t, 1e-7),
            ("p", |t| t.p, 1e-5),
        ];
        for (test, p) in tests.iter().zip(numbers(&case["p"])) {
            assert!((test.p / p - 1.0).abs() < 1e-4, "{name}: {} {p}", test.p);
        }
        for (key, of, tolerance) in columns {
            let found: Vec<f64> = tests.iter().map(of).collect();
            assert_near(
                &format!("{name}, {key}"),
                &found,
                &numbers(&case[key]),
                tolerance,
            );
        }
    }
}

#[test]
fn reference_type_three_tests_of_lmer_test() {
    for case in reference()["cases"].as_array().unwrap() {
        let fit = fitted_case(case);
        let uncertainty = variance_uncertainty(&fit).unwrap();
        let Some(tests) = case["f_tests"].as_array() else {
            continue;
        };
        let mut first = 1;
        for test in tests {
            let count = test["numerator"].as_u64().unwrap() as usize;
            let picked: Vec<usize> = (first..first + count).collect();
            first += count;
            let contrast = picking_contrast(fit.coefficients.len(), &picked);
            let found = f_test(&fit, &uncertainty, &contrast).unwrap();
            let name = format!("{}, {}", case["formula"], test["term"]);
            assert_eq!(found.numerator, count, "{name}");
            assert_near(&name, &[found.f], &numbers(&test["f"]), 1e-7);
            assert_near(
                &name,
                &[found.denominator],
                &numbers(&test["denominator"]),
                1e-5,
            );
            assert_near(&name, &[found.p], &numbers(&test["p"]), 1e-5);
        }
    }
}

#[test]
fn reference_kenward_roger_of_pbkrtest() {
    let mut compared = 0;
    for case in reference()["cases"].as_array().unwrap() {
        if case["kr_df"].is_null() {
            continue;
        }
        let fit = fitted_case(case);
        let name = format!("{}, Kenward-Roger", case["formula"]);
        let adjusted = kenward_roger(&fit).unwrap();
        let expected = rows(&case["kr_covariance"]).concat();
        assert_near(&name, adjusted.covariance.as_slice(), &expected, 1e-6);
        let tests = kenward_roger_tests(&fit, &adjusted, 0.95);
        let df: Vec<f64> = tests.iter().map(|t| t.df).collect();
        assert_near(&name, &df, &numbers(&case["kr_df"]), 1e-6);
        for test in case["kr_f"].as_array().unwrap() {
            let picked: Vec<usize> = numbers(&test["columns"])
                .iter()
                .map(|k| *k as usize - 1)
                .collect();
            let contrast = picking_contrast(fit.coefficients.len(), &picked);
            let found = kenward_roger_f(&fit, &adjusted, &contrast).unwrap();
            assert_near(&name, &[found.f], &numbers(&test["f"]), 1e-6);
            assert_near(
                &name,
                &[found.denominator],
                &numbers(&test["denominator"]),
                1e-6,
            );
            assert_near(&name, &[found.p], &numbers(&test["p"]), 1e-5);
            compared += 1;
        }
    }
    assert!(compared >= 10, "{compared}");
}

#[test]
fn reference_profile_intervals_of_lme4() {
    let mut compared = 0;
    for case in reference()["cases"].as_array().unwrap() {
        if case["profile"].is_null() {
            continue;
        }
        let fit = fitted_case(case);
        let profiles = profile_variances(&fit, MixedMethod::MaximumLikelihood, 0.95).unwrap();
        assert_eq!(profiles.findings, []);
        for (found, expected) in profiles.intervals.iter().zip(rows(&case["profile"])) {
            let name = format!("{}, {}", case["formula"], found.name);
            assert_near(&name, &[found.low, found.high], &expected, 1e-6);
            compared += 1;
        }
    }
    assert!(compared >= 15, "{compared}");
}

#[test]
fn reference_shares_of_variance_from_the_estimates_of_lme4() {
    for case in reference()["cases"].as_array().unwrap() {
        let shares = variance_shares(&fitted_case(case));
        let found = [shares.r2_marginal, shares.r2_conditional];
        assert_near(
            &case["formula"].to_string(),
            &found,
            &numbers(&case["r2"]),
            1e-6,
        );
    }
}

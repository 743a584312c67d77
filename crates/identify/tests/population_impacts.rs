//! Likelihoods of impacts, and populations of them.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::rubber;

use rubber::{impact, rig};
use windfall_contact::expression::parse_law;
use windfall_identify::fit::problem::{FitOptions, LawProblem};
use windfall_identify::fit::result::fit_impact;
use windfall_identify::population::likelihood::{ImpactLikelihood, impact_likelihood};

fn rubber_likelihood(law: &str, seed: u64) -> ImpactLikelihood {
    let problem = LawProblem::from_expression(&parse_law(law).unwrap());
    impact_likelihood(&impact(seed), &rig(), &problem, &FitOptions::default()).unwrap()
}

/// The likelihood is largest at the fit, and its curvature there is the fit's
/// covariance.
#[test]
fn closed_form_likelihood_at_the_fit() {
    let problem = LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap());
    let fit = fit_impact(&impact(5), &rig(), &problem, &FitOptions::default()).unwrap();
    let likelihood = rubber_likelihood("kuwabara-kono", 5);
    let estimate = likelihood.estimate();
    let sds: Vec<f64> = fit.parameters.iter().map(|e| e.sd / e.value).collect();
    for (phi, parameter) in estimate.iter().zip(&fit.parameters) {
        assert!((phi - parameter.value.ln()).abs() < 1e-12);
    }
    let at = likelihood.expand(&estimate).unwrap();
    let h = &at.curvature;
    let determinant = h[0][0] * h[1][1] - h[0][1] * h[1][0];
    for (i, sd) in sds.iter().enumerate() {
        let variance = h[1 - i][1 - i] / determinant;
        assert!((variance.sqrt() / sd - 1.0).abs() < 1e-3, "{variance} {sd}");
        // The gradient, in standard errors.
        assert!(at.gradient[i].abs() * sd < 1e-2);
    }
}

/// Over several standard errors, for the field's usual law and one that goes
/// through the registry.
#[test]
fn derivative_of_the_likelihood() {
    for law in ["kuwabara-kono", "hunt-crossley"] {
        let likelihood = rubber_likelihood(law, 6);
        let covariance = likelihood.covariance();
        let sd = |i: usize| covariance[i][i].sqrt();
        let at: Vec<f64> = likelihood.estimate();
        let at = vec![at[0] + 2.0 * sd(0), at[1] - 3.0 * sd(1)];
        let here = likelihood.expand(&at).unwrap();
        for i in 0..2 {
            let shifted = |side: f64| {
                let mut other = at.clone();
                other[i] += side * 0.05 * sd(i);
                likelihood.expand(&other).unwrap()
            };
            let (up, down) = (shifted(1.0), shifted(-1.0));
            let slope = (up.value - down.value) / (0.1 * sd(i));
            let error = (slope - here.gradient[i]) * sd(i);
            println!("{law} {i}: {slope:e} {:e}", here.gradient[i]);
            assert!(
                error.abs() < 2e-3 * (1.0 + (slope * sd(i)).abs()),
                "{error:e}"
            );
        }
    }
}

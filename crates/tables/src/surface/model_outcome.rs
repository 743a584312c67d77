//! A fitted surface as it is shown.

use crate::regress::findings::{aliased_findings, finding, fit_findings, lack_finding};
use crate::regress::outcome::RowOutcomes;
use crate::surface::blocks::block_outcome;
use crate::surface::outcome::{
    ActualTerm, CanonicalOutcome, RidgeOutcome, SurfaceModel, SurfaceTerm,
};
use crate::surface::random::random_outcome;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::table::data::Data;
use windfall_mixed::coefficient::Coefficient;
use windfall_statistics::model::anova::{AnovaRow, AnovaType, SumOfSquares, anova_within};
use windfall_statistics::residuals::diagnostics::{Inflation, Influence, inflation, influence};
use windfall_statistics::surface::analysis::{Surface, surface_lack_of_fit};
use windfall_statistics::surface::canonical::{Shape, canonical, ridge};
use windfall_statistics::surface::coding::CodedFactors;
use windfall_statistics::surface::random_groups::RandomGroups;
use windfall_statistics::surface::terms::{contains, is_hierarchical, monomial_name};

/// A fitted surface with what it was fitted to.
pub(crate) struct Modelled<'a> {
    /// The response, as it was asked for.
    pub response: &'a str,
    pub surface: &'a Surface,
    pub coded: &'a CodedFactors,
    /// The response of each run.
    pub y: &'a [f64],
    pub data: &'a Data,
    /// Type of the analysis of variance.
    pub anova: AnovaType,
    /// Level of the intervals.
    pub confidence: f64,
}

/// A fitted surface as it is shown, and what is to be said of it.
///
/// # Errors
/// Variances between random groups without profiles.
pub(crate) fn model_of(own: &Modelled) -> Result<(SurfaceModel, Vec<FindingOutcome>), Error> {
    let (surface, y) = (own.surface, own.y);
    let fit = &surface.fit;
    let vif = inflation(&surface.frame, fit);
    let names: Vec<String> = surface.factors.iter().map(|f| f.name.clone()).collect();
    let mut findings = aliased_findings(&surface.frame, &fit.aliased);
    let lack_of_fit = surface_lack_of_fit(surface, &own.coded.values, y);
    findings.extend(lack_finding(lack_of_fit.as_ref()));
    if !is_hierarchical(&surface.terms.monomials) {
        findings.push(finding(
            "not-hierarchical",
            "the model has a term without the terms that it is made of: what it says depends on \
             the coding, and the equation in actual units has terms beside the model's"
                .to_owned(),
        ));
    }
    let actual = surface.actual.iter();
    let mut outcome = SurfaceModel {
        response: own.response.to_owned(),
        terms: Vec::new(),
        actual_terms: actual
            .map(|(powers, coefficient)| ActualTerm {
                name: monomial_name(powers, &names, false),
                coefficient: *coefficient,
            })
            .collect(),
        blocks: block_outcome(surface),
        random: None,
        model: fit.whole(),
        residual: fit.residual(),
        total: fit.total(),
        cv_percent: f64::NAN,
        quality: fit.quality(y),
        anova_type: own.anova.roman(),
        lack_of_fit,
        canonical: canonical_of(surface, own.coded),
        ridge: ridge_of(surface, own.coded),
        influence: RowOutcomes::default(),
    };
    match &surface.random {
        None => {
            let tests = tests_of(surface, own.anova);
            outcome.terms = terms_of(surface, (&fit.coefficients, &tests), &vif);
            let influence = influence(fit, y);
            findings.extend(fit_findings(fit, &influence, &vif, &own.data.lines, &[]));
            let influence = Influence::of(fit.clone(), y.to_vec());
            outcome.influence = RowOutcomes::new(influence, own.data.lines.clone());
        }
        Some(random) => {
            let estimates = random.coefficients();
            let tests = random_tests(surface, random);
            outcome.terms = terms_of(surface, (&estimates, &tests), &vif);
            let (shown, model, found) = random_outcome(surface, random, own.confidence)?;
            (outcome.random, outcome.model) = (Some(shown), model);
            outcome.residual = SumOfSquares {
                ss: f64::NAN,
                df: f64::NAN,
            };
            outcome
                .blocks
                .iter_mut()
                .for_each(|own| own.sum.ss = f64::NAN);
            outcome.quality = random.quality(&surface.x);
            findings.extend(found);
        }
    }
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    outcome.cv_percent = 100.0 * outcome.quality.sigma / mean;
    findings.iter_mut().for_each(|finding| {
        finding.message = format!("{}: {}", own.response, finding.message);
    });
    Ok((outcome, findings))
}

/// F test of a term.
struct TermTest {
    row: AnovaRow,
    df_denominator: f64,
}

fn tests_of(surface: &Surface, kind: AnovaType) -> Vec<Option<TermTest>> {
    let monomials = &surface.terms.monomials;
    let every: Vec<usize> = (0..monomials.len()).collect();
    let whole = (&surface.frame, &surface.reduced);
    let contained = |outer: usize, inner: usize| contains(&monomials[outer], &monomials[inner]);
    let found = anova_within(whole, &surface.block_columns(), &every, kind, &contained);
    let test = |row| {
        Some(TermTest {
            row,
            df_denominator: surface.fit.residual_df as f64,
        })
    };
    found.rows.into_iter().map(test).collect()
}

fn random_tests(surface: &Surface, random: &RandomGroups) -> Vec<Option<TermTest>> {
    let columns = 1..surface.coded.len();
    let test = |column: usize| {
        let test = random.test(&[column])?;
        Some(TermTest {
            row: AnovaRow {
                term: surface.frame.names[column].clone(),
                ss: f64::NAN,
                df: test.numerator as f64,
                f: test.f,
                p: test.p,
            },
            df_denominator: test.denominator,
        })
    };
    columns.map(test).collect()
}

fn terms_of(
    surface: &Surface,
    (estimates, tests): (&[Coefficient], &[Option<TermTest>]),
    vif: &[Inflation],
) -> Vec<SurfaceTerm> {
    let names: Vec<String> = surface.factors.iter().map(|f| f.name.clone()).collect();
    let none = vec![0; names.len()];
    let monomials = std::iter::once(&none).chain(&surface.terms.monomials);
    monomials
        .enumerate()
        .map(|(column, monomial)| {
            let place = surface.fit.columns.iter().position(|own| *own == column);
            let own = place.map(|place| &estimates[place]);
            let test = column.checked_sub(1).and_then(|term| tests[term].as_ref());
            let row = test.map(|test| &test.row);
            let term = &surface.frame.names[column];
            let actual = surface.actual.iter().find(|(powers, _)| powers == monomial);
            SurfaceTerm {
                term: term.clone(),
                name: monomial_name(monomial, &names, false),
                coded: own.map_or(f64::NAN, |c| c.estimate),
                se: own.map_or(f64::NAN, |c| c.se),
                low: own.map_or(f64::NAN, |c| c.low),
                high: own.map_or(f64::NAN, |c| c.high),
                actual: actual.map_or(f64::NAN, |(_, value)| *value),
                ss: row.map(|row| row.ss).filter(|ss| !ss.is_nan()),
                df: row.map(|row| row.df),
                df_denominator: test.map(|test| test.df_denominator),
                f: row.map(|row| row.f),
                p: row.map(|row| row.p),
                vif: vif.iter().find(|v| v.term == *term).map(|v| v.factor),
            }
        })
        .collect()
}

fn canonical_of(surface: &Surface, coded: &CodedFactors) -> Option<CanonicalOutcome> {
    let found = canonical(surface)?;
    let inside = (0..coded.factors.len()).all(|factor| {
        let (low, high) = coded.range(factor);
        (low..=high).contains(&found.stationary[factor])
    });
    Some(CanonicalOutcome {
        shape: match found.shape {
            Shape::Maximum => "maximum",
            Shape::Minimum => "minimum",
            Shape::Saddle => "saddle",
            Shape::Ridge => "ridge",
        },
        actual: coded.actual(&found.stationary),
        coded: found.stationary,
        distance: found.distance,
        inside,
        value: found.value,
        eigenvalues: found.eigenvalues,
        directions: found.directions,
    })
}

/// Steps from the centre to the farthest run.
const RIDGE_STEPS: usize = 5;

fn ridge_of(surface: &Surface, coded: &CodedFactors) -> Vec<RidgeOutcome> {
    let runs = 0..coded.values[0].len();
    let distance = |run: usize| {
        let parts = coded.values.iter().map(|factor| factor[run].powi(2));
        parts.sum::<f64>().sqrt()
    };
    let farthest = runs.map(distance).fold(0.0, f64::max);
    let radii: Vec<f64> = (0..=RIDGE_STEPS)
        .map(|step| farthest * step as f64 / RIDGE_STEPS as f64)
        .collect();
    [("maximum", true), ("minimum", false)]
        .into_iter()
        .flat_map(|(of, maximum)| {
            let points = ridge(surface, &radii, maximum).into_iter();
            points.map(move |point| (of, point))
        })
        .map(|(of, point)| RidgeOutcome {
            of,
            radius: point.radius,
            actual: coded.actual(&point.point),
            value: point.value,
        })
        .collect()
}

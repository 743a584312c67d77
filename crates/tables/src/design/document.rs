//! A design as JSON. Levels are in the unit of their factor, not in SI.

use crate::design::factor::fifteen_digits;
use crate::design::run::DesignOutcome;
use serde::Serialize;
use windfall_design::kind::{Design, Factor};
use windfall_design::word::{AliasChain, Fraction, aliases, letter};

/// Effects of up to so many factors are shown in aliases.
pub const ALIAS_ORDER: usize = 2;

/// A design for scripts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignDocument {
    /// Its kind.
    pub kind: String,
    /// The factors.
    pub factors: Vec<FactorDocument>,
    /// The runs in run order.
    pub runs: Vec<RunDocument>,
    /// Number of blocks.
    pub blocks: usize,
    /// Seed of the run order; null in standard order.
    pub seed: Option<u64>,
    /// Axial distance of a composite design, in half-ranges.
    pub alpha: Option<f64>,
    /// What follows from generators; null where there are none.
    pub fraction: Option<FractionDocument>,
    /// The model the design is judged by.
    pub model: String,
    /// Its figures; null where no model can be estimated.
    pub quality: Option<QualityDocument>,
    /// What to know.
    pub findings: Vec<DesignNote>,
}

/// A factor: actual = centre + half · coded.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FactorDocument {
    /// Its letter in models.
    pub letter: String,
    /// Its name.
    pub name: String,
    /// Unit of its levels.
    pub unit: String,
    /// Actual value at coded 0.
    pub centre: f64,
    /// Exact half-range.
    pub half: f64,
    /// Decimals of printed settings.
    pub decimals: Option<usize>,
    /// Categories; empty for a number.
    pub categories: Vec<String>,
}

/// A run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunDocument {
    /// Place in the run order, from 1.
    pub run: usize,
    /// Place in the standard order, from 1.
    pub standard_order: usize,
    /// Block, from 1.
    pub block: usize,
    /// Where it lies.
    pub point: &'static str,
    /// Exact coded values.
    pub coded: Vec<f64>,
    /// What is set: numbers to their printed decimals, or categories.
    pub settings: Vec<Setting>,
}

/// What a factor is set to.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Setting {
    /// A number.
    Number(f64),
    /// A category.
    Category(String),
}

/// A fraction of two levels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FractionDocument {
    /// Generators, "D=AB".
    pub generators: Vec<String>,
    /// Words that equal I.
    pub defining_relation: Vec<String>,
    /// Length of the shortest.
    pub resolution: Option<usize>,
    /// Chains of main effects and two-factor interactions, "A = BD = CE".
    pub aliases: Vec<String>,
}

/// Figures of a design; variances in units of the variance of one run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct QualityDocument {
    /// Columns of the model.
    pub terms: Vec<String>,
    /// Variance of each coefficient, coded.
    pub variances: Vec<f64>,
    /// |X'X|^(1/p) / n.
    pub d_efficiency: f64,
    /// Largest leverage of a run.
    pub max_leverage: f64,
    /// Mean variance of prediction over the region −1 … 1.
    pub mean_variance: f64,
    /// Largest variance of prediction at points of the region and the runs.
    pub max_variance: f64,
    /// Degrees of freedom left for error.
    pub residual_df: usize,
}

/// Something to know.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignNote {
    /// Short name.
    pub code: String,
    /// What it says.
    pub message: String,
}

/// A design for scripts.
#[must_use]
pub fn design_document(outcome: &DesignOutcome) -> DesignDocument {
    let design = &outcome.design;
    let fraction = generated(design).map(|fraction| FractionDocument {
        generators: fraction.generators.iter().map(|g| g.to_string()).collect(),
        defining_relation: fraction
            .defining
            .iter()
            .map(|word| word.to_string())
            .collect(),
        resolution: fraction.resolution(),
        aliases: alias_chains(fraction)
            .iter()
            .map(|chain| chain.to_string())
            .collect(),
    });
    let quality = outcome.quality.as_ref().map(|quality| QualityDocument {
        terms: outcome.terms.clone(),
        variances: quality.variances.clone(),
        d_efficiency: quality.d_efficiency,
        max_leverage: quality.max_leverage,
        mean_variance: quality.mean_variance,
        max_variance: quality.max_variance,
        residual_df: quality.runs - quality.terms,
    });
    let notes = design.findings.iter().map(|finding| DesignNote {
        code: finding.code().to_owned(),
        message: finding.to_string(),
    });
    DesignDocument {
        kind: design.kind.clone(),
        factors: factor_documents(&design.factors),
        runs: run_documents(design),
        blocks: design.blocks(),
        seed: design.order_seed,
        alpha: design.alpha,
        fraction,
        model: outcome.model.clone(),
        quality,
        findings: notes.collect(),
    }
}

/// The fraction of a design that has generators.
#[must_use]
pub fn generated(design: &Design) -> Option<&Fraction> {
    let fraction = design.fraction.as_ref()?;
    Some(fraction).filter(|fraction| !fraction.generators.is_empty())
}

/// Aliases among main effects and two-factor interactions.
#[must_use]
pub fn alias_chains(fraction: &Fraction) -> Vec<AliasChain> {
    aliases(fraction, ALIAS_ORDER)
}

fn factor_documents(factors: &[Factor]) -> Vec<FactorDocument> {
    let document = |(place, factor): (usize, &Factor)| FactorDocument {
        letter: letter(place).to_string(),
        name: factor.name.clone(),
        unit: factor.unit.clone(),
        centre: factor.centre,
        half: factor.half,
        decimals: factor.decimals,
        categories: factor.categories.clone(),
    };
    factors.iter().enumerate().map(document).collect()
}

fn run_documents(design: &Design) -> Vec<RunDocument> {
    let setting = |(factor, coded): (&Factor, &f64)| match factor.category(*coded) {
        Some(category) => Setting::Category(category.to_owned()),
        None if factor.decimals.is_some() => Setting::Number(factor.setting(*coded)),
        None => Setting::Number(fifteen_digits(factor.actual(*coded))),
    };
    let runs = design
        .runs
        .iter()
        .enumerate()
        .map(|(index, run)| RunDocument {
            run: index + 1,
            standard_order: run.standard_order,
            block: run.block,
            point: run.point.name(),
            coded: run.coded.clone(),
            settings: design.factors.iter().zip(&run.coded).map(setting).collect(),
        });
    runs.collect()
}

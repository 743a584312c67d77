//! A design as JSON. Levels are in the unit of their factor, not in SI.

use crate::design::factor::fifteen_digits;
use crate::design::run::DesignOutcome;
use serde::Serialize;
use windfall_design::kind::{Design, Factor};
use windfall_design::quality::DesignQuality;
use windfall_design::word::{AliasChain, Fraction, aliases, letter};
use windfall_files::found::FindingOutcome;

/// Effects of up to so many factors are shown in aliases.
pub const ALIAS_ORDER: usize = 2;

/// A design for scripts.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DesignDocument {
    /// Its kind.
    pub kind: String,
    /// The factors.
    pub factors: Vec<FactorDocument>,
    /// The runs in run order.
    pub runs: Vec<RunDocument>,
    /// Number of blocks.
    pub blocks: usize,
    /// Number of whole plots of a split-plot design; null for other designs.
    pub whole_plots: Option<usize>,
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
    pub findings: Vec<FindingOutcome>,
}

/// A factor with its letter.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FactorDocument {
    /// Its letter in models.
    pub letter: String,
    /// Name, unit and coding.
    #[serde(flatten)]
    pub factor: Factor,
}

/// A run.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct RunDocument {
    /// Place in the run order, from 1.
    pub run: usize,
    /// Place in the standard order, from 1.
    pub standard_order: usize,
    /// Block, from 1.
    pub block: usize,
    /// Whole plot of a split-plot design, from 1; null in other designs.
    pub whole_plot: Option<usize>,
    /// Where it lies.
    pub point: &'static str,
    /// Exact coded values.
    pub coded: Vec<f64>,
    /// What is set: numbers to their printed decimals, or categories.
    pub settings: Vec<Setting>,
}

/// What a factor is set to.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
#[serde(untagged)]
pub enum Setting {
    /// A number.
    Number(f64),
    /// A category.
    Category(String),
}

/// A fraction of two levels.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
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
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct QualityDocument {
    /// Columns of the model.
    pub terms: Vec<String>,
    /// Its figures over the region −1 … 1.
    #[serde(flatten)]
    pub quality: DesignQuality,
    /// Degrees of freedom left for error.
    pub residual_df: usize,
}

/// A design for scripts.
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
        quality: quality.clone(),
        residual_df: quality.runs - quality.terms,
    });
    let findings = design.findings.iter();
    let findings = findings.map(|found| FindingOutcome::new(found.code(), found.to_string()));
    DesignDocument {
        kind: design.kind.clone(),
        factors: factor_documents(&design.factors),
        runs: run_documents(design),
        blocks: design.blocks(),
        whole_plots: design.whole_plots(),
        seed: design.order_seed,
        alpha: design.alpha,
        fraction,
        model: outcome.model.clone(),
        quality,
        findings: findings.collect(),
    }
}

/// The fraction of a design that has generators.
pub fn generated(design: &Design) -> Option<&Fraction> {
    let fraction = design.fraction.as_ref()?;
    Some(fraction).filter(|fraction| !fraction.generators.is_empty())
}

/// Aliases among main effects and two-factor interactions.
pub fn alias_chains(fraction: &Fraction) -> Vec<AliasChain> {
    aliases(fraction, ALIAS_ORDER)
}

fn factor_documents(factors: &[Factor]) -> Vec<FactorDocument> {
    let document = |(place, factor): (usize, &Factor)| FactorDocument {
        letter: letter(place).to_string(),
        factor: factor.clone(),
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
            whole_plot: run.whole_plot,
            point: run.point.name(),
            coded: run.coded.clone(),
            settings: design.factors.iter().zip(&run.coded).map(setting).collect(),
        });
    runs.collect()
}

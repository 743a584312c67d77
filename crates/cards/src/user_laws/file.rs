//! `[laws.NAME]`: laws of the user as they stand on disk.

use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use windfall_files::text::file_quantity::QuantityText;
use windfall_files::text::spanned::Spanned;

/// Tables of laws by name.
pub type LawsFile = BTreeMap<String, Spanned<LawFile>>;

/// A file of which only the laws are read: a file of laws, or a campaign.toml.
#[derive(Debug, Deserialize, JsonSchema)]
pub struct OnlyLaws {
    /// The laws.
    #[serde(default)]
    pub laws: LawsFile,
}

/// `[laws.NAME]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawFile {
    /// Formula of the force in x (m), v (m/s) and the parameters; N.
    pub force: Option<Spanned<String>>,
    /// Formula below the largest displacement so far, in x, v, x_max (m), F_max (N) and the
    /// parameters; N.
    pub unloading: Option<Spanned<String>>,
    /// CSV file with the columns displacement_m, force_N and, optionally,
    /// damping_N_s_m.
    pub table: Option<Spanned<String>>,
    /// A table in place: displacements; m.
    #[serde(rename = "displacement_m")]
    pub displacement: Option<Vec<f64>>,
    /// Its forces; N.
    #[serde(rename = "force_N")]
    pub table_force: Option<Vec<f64>>,
    /// Its damping; N s/m.
    #[serde(rename = "damping_N_s_m")]
    pub damping: Option<Vec<f64>>,
    /// Parameters of the formula, in their order in the file.
    #[serde(default)]
    pub parameters: BTreeMap<String, Spanned<LawParameterFile>>,
}

/// `parameters.NAME`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawParameterFile {
    /// SI unit; "1" for a number; exponents may be named: "N/m^n".
    pub unit: Spanned<String>,
    /// What it is.
    #[serde(default)]
    pub meaning: String,
    /// Where a fit begins.
    pub start: Option<Spanned<QuantityText>>,
    /// Value where none is given; held in a fit unless freed by name.
    pub default: Option<Spanned<QuantityText>>,
    /// Smallest value; 0 where it is left out.
    pub lower: Option<Spanned<QuantityText>>,
    /// Largest value; none where it is left out.
    pub upper: Option<Spanned<QuantityText>>,
}

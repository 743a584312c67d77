//! The library of published values as it is on disk (`data/library.toml`).

use serde::{Deserialize, Serialize};

/// The file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LibraryFile {
    /// Version of its form.
    pub format: i64,
    /// What was read.
    pub source: Vec<SourceFile>,
    /// What was found there.
    pub entry: Vec<EntryFile>,
}

/// A publication.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SourceFile {
    /// Name within the file.
    pub key: String,
    /// Authors, year, title, journal.
    pub citation: String,
    /// Digital object identifier.
    pub doi: Option<String>,
}

/// Values or models that belong together.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EntryFile {
    /// Name to ask for it.
    pub name: String,
    /// What was struck, dropped or pressed.
    pub body: String,
    /// Its variety or kind.
    pub variety: Option<String>,
    /// What it met.
    pub counterpart: Option<String>,
    /// How it was measured.
    pub conditions: Option<String>,
    /// Key of the publication.
    pub source: String,
    /// Table or section.
    pub r#where: String,
    /// "full text" or "abstract".
    pub seen: String,
    /// What to beware of.
    pub cautions: Vec<String>,
    /// A law expression; for models the law whose parameters they give.
    pub law: Option<String>,
    /// Values.
    #[serde(default)]
    pub value: Vec<ValueFile>,
    /// Variables of the models.
    #[serde(default)]
    pub variable: Vec<LibraryVariable>,
    /// Models.
    #[serde(default)]
    pub model: Vec<LibraryModel>,
}

/// One value.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ValueFile {
    /// What it is.
    pub quantity: String,
    /// Number with unit.
    pub value: String,
    /// Standard deviation with unit.
    pub deviation: Option<String>,
    /// Standard deviation in percent of the value.
    pub variation: Option<String>,
    /// Conditions of this value, where they differ from the entry's.
    pub conditions: Option<String>,
    /// Place of this value, where it differs from the entry's.
    pub r#where: Option<String>,
}

/// A published regression: a sum of terms.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
pub struct LibraryModel {
    /// What it gives.
    pub quantity: String,
    /// SI unit of that.
    pub unit: String,
    /// Coefficient of determination, as printed.
    pub r_squared: f64,
    /// The equation as text, written from its terms.
    #[serde(default)]
    #[schema(required)]
    pub formula: String,
    /// Its terms.
    pub terms: Vec<LibraryTerm>,
}

/// A coefficient and the variables it multiplies.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
pub struct LibraryTerm {
    /// The coefficient; SI.
    pub coefficient: f64,
    /// Symbols of the variables; none for the constant.
    pub of: Vec<String>,
}

/// A variable of a regression.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
pub struct LibraryVariable {
    /// Its symbol.
    pub name: String,
    /// What it is.
    pub meaning: String,
    /// SI unit.
    pub unit: String,
    /// Smallest value it was measured at; SI.
    pub seen_from: f64,
    /// Largest; SI.
    pub seen_to: f64,
}

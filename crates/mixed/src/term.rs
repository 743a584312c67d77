//! Random terms of a mixed model.

use crate::error::MixedError;

/// One random term, `(columns | group)`: effects of `columns` that differ from
/// group to group around zero.
///
/// Terms whose groups are the same (in any numbering) share a grouping factor
/// without being correlated with each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RandomTerm {
    /// Name for messages and tables, as `fruit` or `variety:fruit`.
    pub name: String,
    /// The design columns, each with one number per row; ones for an intercept.
    pub columns: Vec<Vec<f64>>,
    /// Names of the columns.
    pub column_names: Vec<String>,
    /// Group of each row, from 0.
    pub group: Vec<usize>,
    /// Number of groups.
    pub groups: usize,
    /// Names of the groups.
    pub group_names: Vec<String>,
    /// Whether the effects of a group are correlated: `(1 + V | fruit)`, not `||`.
    pub correlated: bool,
}

/// A random intercept.
pub fn random_intercept(name: &str, group: &[usize], group_names: &[String]) -> RandomTerm {
    RandomTerm {
        name: name.to_owned(),
        columns: vec![vec![1.0; group.len()]],
        column_names: vec!["(Intercept)".to_owned()],
        group: group.to_vec(),
        groups: group_names.len(),
        group_names: group_names.to_vec(),
        correlated: true,
    }
}

/// Errors of one term's numbers, among `rows` rows.
pub(crate) fn check_term(term: &RandomTerm, rows: usize) -> Result<(), MixedError> {
    let of = |what: &str| format!("random term ({})", term.name) + what;
    check_length(&of(": groups"), term.group.len(), rows)?;
    check_length(
        &of(": names of groups"),
        term.group_names.len(),
        term.groups,
    )?;
    let effects = term.columns.len();
    check_length(&of(": names of columns"), term.column_names.len(), effects)?;
    if effects == 0 {
        return Err(MixedError::NoColumns { name: of("") });
    }
    for (column, name) in term.columns.iter().zip(&term.column_names) {
        let what = of(&format!(", column {name}"));
        check_length(&what, column.len(), rows)?;
        check_finite(&what, column)?;
    }
    if let Some(row) = term.group.iter().position(|group| *group >= term.groups) {
        return Err(MixedError::UnknownGroup {
            term: term.name.clone(),
            row: row + 1,
            group: term.group[row],
            groups: term.groups,
        });
    }
    check_groups(term, rows)
}

/// Errors where a term's variances cannot be told from the residual variance.
fn check_groups(term: &RandomTerm, rows: usize) -> Result<(), MixedError> {
    let mut seen = vec![false; term.groups];
    term.group.iter().for_each(|group| seen[*group] = true);
    let groups = seen.iter().filter(|seen| **seen).count();
    let effects = term.columns.len();
    if groups < effects.max(2) {
        return Err(MixedError::FewGroups {
            term: term.name.clone(),
            groups,
            needed: effects.max(2),
        });
    }
    if groups * effects >= rows {
        return Err(MixedError::ManyRandomEffects {
            term: term.name.clone(),
            effects: groups * effects,
            rows,
        });
    }
    Ok(())
}

pub(crate) fn check_length(what: &str, found: usize, expected: usize) -> Result<(), MixedError> {
    if found == expected {
        return Ok(());
    }
    Err(MixedError::WrongLength {
        what: what.to_owned(),
        found,
        expected,
    })
}

pub(crate) fn check_finite(what: &str, column: &[f64]) -> Result<(), MixedError> {
    match column.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(row) => Err(MixedError::NotFinite {
            what: what.to_owned(),
            row: row + 1,
            value: column[row],
        }),
    }
}

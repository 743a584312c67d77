//! Force against displacement as a table: a monotone piecewise cubic.

use crate::formula::error::FormulaError;

/// Names of the columns of a table: displacement, force, damping.
pub const COLUMNS: [&str; 3] = ["displacement_m", "force_N", "damping_N_s_m"];

/// Rows of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceTable {
    /// Displacements, rising from 0; m.
    pub displacement: Vec<f64>,
    /// Forces at rest, from 0 and never falling; N.
    pub force: Vec<f64>,
    /// Damping, at or above 0, where there is any; N s/m.
    pub damping: Option<Vec<f64>>,
}

const BEGINS: &str = "a table begins with displacement 0 and force 0: add that row";

/// Whether a table can be a law.
pub(crate) fn check_table(table: &ForceTable) -> Result<(), FormulaError> {
    let [x_name, force_name, damping_name] = COLUMNS;
    let wrong = |row, column, reason| {
        Err(FormulaError::Table {
            row,
            column,
            reason,
        })
    };
    let rows = table.displacement.len();
    let columns = [
        (Some(&table.force), force_name),
        (table.damping.as_ref(), damping_name),
    ];
    let other = |(own, _): &(Option<&Vec<f64>>, _)| own.is_some_and(|own| own.len() != rows);
    if let Some((_, column)) = columns.into_iter().find(other) {
        let reason = "its columns have different lengths: every row needs every column";
        return wrong(0, column, reason);
    }
    if rows < 3 {
        let reason = "it has fewer than three rows: give at least three";
        return wrong(0, x_name, reason);
    }
    for row in 0..rows {
        let (x, force) = (table.displacement[row], table.force[row]);
        let damping = table.damping.as_ref().map_or(0.0, |c| c[row]);
        let numbers = [(x, x_name), (force, force_name), (damping, damping_name)];
        if let Some((_, column)) = numbers.into_iter().find(|(own, _)| !own.is_finite()) {
            return wrong(row + 1, column, "a value is not a finite number");
        }
        let (column, reason) = match () {
            () if damping < 0.0 => {
                let reason = "the damping is negative: it must be at or above 0 N s/m";
                (damping_name, reason)
            }
            () if row == 0 && x != 0.0 => (x_name, BEGINS),
            () if row == 0 && force != 0.0 => (force_name, BEGINS),
            () if row > 0 && x <= table.displacement[row - 1] => {
                let reason = "the displacement does not rise: sort the rows by displacement and \
                              merge equal ones";
                (x_name, reason)
            }
            () if row > 0 && force < table.force[row - 1] => {
                let reason = "the force falls: a table holds the force while loading, which rises \
                              with the displacement";
                (force_name, reason)
            }
            () => continue,
        };
        return wrong(row + 1, column, reason);
    }
    Ok(())
}

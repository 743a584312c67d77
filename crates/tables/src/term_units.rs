//! Units of coefficients, from the names of the columns.

use windfall_files::text::column_title::column_title;
use windfall_files::text::columns::{Column, cells_of_rows};
use windfall_files::text::number::unit_text;
use windfall_files::text::table::page_tables;

/// Unit of the coefficient of a term: that of the response over that of the term, such as
/// "N/(m/s)". Blank where a column's name says no unit, or the term is no product of powers of
/// columns and levels.
///
/// * `term`: as models name it, `(Intercept)`, `speed_m_s`, `variety[Gala]:I(speed_m_s^2)`
pub fn coefficient_unit(response: &str, term: &str) -> String {
    let (_, above) = column_title(response);
    if above.is_empty() || response.contains('(') {
        return String::new();
    }
    let mut below = Vec::new();
    for factor in term.split(':').filter(|factor| *factor != "(Intercept)") {
        if factor.ends_with(']') {
            continue;
        }
        let factor = match factor.strip_prefix("I(") {
            Some(rest) => rest.trim_end_matches(')'),
            None => factor,
        };
        for part in factor.split('*').map(str::trim) {
            let (name, power) = part.split_once('^').unwrap_or((part, "1"));
            let (_, unit) = column_title(name.trim());
            if unit.is_empty() || name.contains('(') {
                return String::new();
            }
            below.push(match (power.trim(), unit.contains(['/', ' '])) {
                ("1", false) => unit,
                ("1", true) => format!("({unit})"),
                (power, false) => format!("{unit}^{power}"),
                (power, true) => format!("({unit})^{power}"),
            });
        }
    }
    match below.as_slice() {
        [] => above,
        [one] => format!("{above}/{one}"),
        several => format!("{above}/({})", several.join(" ")),
    }
}

/// Terms as a table with the units of their coefficients, where the names of columns say some.
///
/// * `title`, `unit`: title of the column of units, and the unit of a row
/// * `left`: places of the columns that are flush left
pub(crate) fn table_of_terms<T>(
    rows: &[T],
    columns: &[Column<T>],
    (title, unit): (&str, impl Fn(&T) -> String),
    left: &[usize],
) -> String {
    let mut cells = cells_of_rows(rows, columns);
    let units: Vec<String> = rows.iter().map(|row| unit_text(&unit(row))).collect();
    let mut left = left.to_vec();
    if units.iter().any(|unit| !unit.is_empty()) {
        left.push(cells.header.len());
        cells.header.push(title.to_owned());
        for (row, unit) in cells.rows.iter_mut().zip(units) {
            row.push(unit);
        }
    }
    page_tables(&cells.header, &cells.rows, &left)
}

/// A number with the unit of a column, where its name says one: "0.5972 N".
pub(crate) fn in_unit_of(column: &str, number: String) -> String {
    let unit = coefficient_unit(column, "(Intercept)");
    format!("{number} {}", unit_text(&unit))
        .trim_end()
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_units_of_coefficients() {
        for (response, term, unit) in [
            ("force_N", "(Intercept)", "N"),
            ("force_N", "speed_m_s", "N/(m/s)"),
            ("force_N", "mass_g", "N/g"),
            ("force_N", "I(speed_m_s^2)", "N/(m/s)^2"),
            ("force_N", "speed_m_s:mass_g", "N/((m/s) g)"),
            ("force_N", "variety[Gala]", "N"),
            ("force_N", "variety[Gala]:mass_g", "N/g"),
            ("force_N", "dose", ""),
            ("force_N", "log(mass_g)", ""),
            ("k", "mass_g", ""),
            ("log(force_N)", "mass_g", ""),
        ] {
            assert_eq!(coefficient_unit(response, term), unit, "{response} {term}");
        }
        assert_eq!(in_unit_of("force_N", "1.2".to_owned()), "1.2 N");
        assert_eq!(in_unit_of("k", "1.2".to_owned()), "1.2");
    }
}

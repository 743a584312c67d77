//! Titles of axes from the names of columns: `force_N` is a force in N.

use windfall_numerics::unit::quantity::parse_unit;

/// Name and unit of a column as an axis shows them: what follows an underscore and is
/// a unit becomes the unit, `density_kg_m3` in kg/m³; "" where the name says none.
pub fn column_title(column: &str) -> (String, String) {
    let underscores = column.match_indices('_').map(|(place, _)| place);
    for place in underscores {
        let (name, written) = (&column[..place], &column[place + 1..]);
        if let (false, Some(unit)) = (name.is_empty(), unit_text(written)) {
            return (name.replace('_', " "), unit);
        }
    }
    (column.replace('_', " "), String::new())
}

/// A unit in the name of a column: one symbol, or a quotient of two.
fn unit_text(written: &str) -> Option<String> {
    let mut text = written.replacen("_per_", "/", 1);
    if text == written {
        text = written.replacen('_', "/", 1);
    }
    let mut raised = String::new();
    let mut before = ' ';
    for c in text.chars() {
        if c.is_ascii_digit() && before.is_alphabetic() {
            raised.push('^');
        }
        raised.push(c);
        before = c;
    }
    parse_unit(&raised).is_ok().then_some(raised)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_titles_of_columns() {
        for (column, name, unit) in [
            ("force_N", "force", "N"),
            ("interval_ms", "interval", "ms"),
            ("density_kg_m3", "density", "kg/m^3"),
            ("impact_velocity_m_s", "impact velocity", "m/s"),
            ("stiffness_N_per_mm", "stiffness", "N/mm"),
            ("days_of_storage", "days of storage", ""),
            ("k", "k", ""),
            ("_N", " N", ""),
            ("log(force_N)", "log(force N)", ""),
        ] {
            let found = column_title(column);
            assert_eq!(found, (name.to_owned(), unit.to_owned()), "{column}");
        }
    }
}

//! Predictions over what was measured.

use crate::compare::agreement::AgreementRequest;
use crate::figures::thinning::{drawn_rows, largest};
use windfall_draw::files::{FigureFolder, Painting, Picture, write_paintings};
use windfall_draw::grid::{Grid, GridPanel};
use windfall_draw::xy::{Mark, Panel, Series, Side, Style};
use windfall_files::error::Error;
use windfall_files::table::data::Data;
use windfall_files::table::write::csv_text;
use windfall_files::text::column_title::column_title;
use windfall_files::write_file::check_outputs;
use windfall_statistics::numbers::Numbers;

/// Size of a panel; px.
const SIZE: (f64, f64) = (280.0, 230.0);

/// Rows that are named in each panel.
const NAMED: usize = 3;

/// Draws predicted over measured values, and their differences.
///
/// # Errors
/// A column is missing or holds text; a figure cannot be written.
pub fn draw_agreement(
    folder: &FigureFolder,
    data: &Data,
    request: &AgreementRequest,
) -> Result<(), Error> {
    check_outputs([Some(folder.directory.as_path())])?;
    let column = |name: &str| {
        let numbers = data.table.numbers(name);
        numbers
            .map(Numbers::values)
            .map_err(|error| data.told(error))
    };
    let (measured, predicted) = (column(&request.measured)?, column(&request.predicted)?);
    let whole = |row: &usize| !measured[*row].is_nan() && !predicted[*row].is_nan();
    let rows: Vec<usize> = (0..measured.len()).filter(whole).collect();
    let difference = |row: usize| predicted[row] - measured[row];
    let size = |place: usize| difference(rows[place]).abs();
    let drawn = drawn_rows(rows.len(), &[("differences", &size)]);
    let named: Vec<usize> = largest(rows.len(), NAMED, &size);
    let named: Vec<usize> = named.into_iter().map(|place| rows[place]).collect();
    let shown: Vec<usize> = drawn.rows.iter().map(|place| rows[*place]).collect();
    let ((m, m_unit), (p, p_unit)) = (
        column_title(&request.measured),
        column_title(&request.predicted),
    );
    let panel = |title: &str, series: Series, y: &str, value: &dyn Fn(usize) -> f64| {
        let dots = shown.iter().map(|row| (measured[*row], value(*row)));
        let dots = Series::new("", Style::Dots, dots.collect()).coloured(0);
        let mut panel = Panel::new((&m, &m_unit), (y, &p_unit), vec![series, dots]);
        let marks = named.iter().map(|row| Mark {
            label: data.line(*row).to_string(),
            at: (measured[*row], value(*row)),
            side: match difference(*row) < 0.0 {
                true => Side::BelowRight,
                false => Side::AboveLeft,
            },
        });
        panel.marks = marks.collect();
        GridPanel::new(title, panel)
    };
    let values = rows
        .iter()
        .flat_map(|row| [measured[*row], predicted[*row]]);
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let equal = Series::new("equal", Style::Dashed, vec![(low, low), (high, high)]).coloured(6);
    let bias = rows.iter().map(|row| difference(*row)).sum::<f64>() / rows.len() as f64;
    let bias = vec![(low, bias)];
    let bias = Series::new("mean difference", Style::Level, bias).coloured(1);
    let mut notes = vec!["Numbers at points are lines of the table.".to_owned()];
    notes.extend(drawn.note);
    let picture = Picture::Grid(Grid {
        title: format!("{p} against {m}"),
        panels: vec![
            panel("Predicted against measured", equal, &p, &|row| {
                predicted[row]
            })
            .with_equal_axes(),
            panel("Differences", bias, "predicted less measured", &difference),
        ],
        columns: 2,
        size: SIZE,
        notes: notes.clone(),
    });
    let rows = shown.iter().map(|row| {
        let numbers = [measured[*row], predicted[*row], difference(*row)];
        let line = data.line(*row).to_string();
        std::iter::once(line)
            .chain(numbers.map(|own| own.to_string()))
            .collect()
    });
    let painting = Painting {
        name: "agreement".to_owned(),
        caption: notes.join(" "),
        picture,
        csv: csv_text(&["line", "measured", "predicted", "difference"], rows)?,
    };
    write_paintings(folder, &[painting]).map(|_| ())
}

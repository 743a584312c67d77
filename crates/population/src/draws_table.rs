//! The draws of a population's posterior as a table: one row for each draw.

use serde_json::Value;
use windfall_files::sheet::{Cell, Column, Kind, Schema};

/// Raised when a column goes or changes its meaning.
const VERSION: u32 = 1;

/// A table of draws.
pub struct DrawsTable<'a> {
    /// `chain`, `draw`, and a column for each quantity, called as ArviZ calls it: `median[k]`.
    pub schema: Schema,
    /// Of each quantity its draws, chain by chain.
    columns: Vec<(&'a [Value], usize)>,
}

impl<'a> DrawsTable<'a> {
    /// The table of a document of draws ([`crate::detail::draws_document`]).
    pub fn new(document: &'a Value) -> Self {
        let number = |name: String| Column::new(name, Kind::Number, "");
        let mut named = vec![
            Column::new("chain", Kind::Count, "number of the chain, from 0"),
            Column::new(
                "draw",
                Kind::Count,
                "number of the draw in its chain, from 0",
            ),
        ];
        let mut columns = Vec::new();
        let units = texts(&document["attrs"]["parameter_units"]);
        for (variable, chains) in document["posterior"].as_object().into_iter().flatten() {
            let dimension = document["dims"][variable][0].as_str().unwrap_or("");
            let names = texts(&document["coords"][dimension]);
            for (place, name) in names.iter().enumerate() {
                let column = number(format!("{variable}[{name}]"));
                let unit = units.get(place).filter(|_| variable == "median");
                named.push(column.in_unit(unit.copied().unwrap_or("")));
                columns.push((chains.as_array().map_or(&[][..], Vec::as_slice), place));
            }
        }
        let schema = Schema {
            table: "draws",
            version: VERSION,
            columns: named,
            notes: Vec::new(),
        };
        Self { schema, columns }
    }

    /// Its rows, chain by chain.
    pub fn rows(&self) -> impl Iterator<Item = Vec<Cell<'a>>> + Clone {
        let chains = self.columns.first().map_or(&[][..], |own| own.0);
        let draws = chains.iter().enumerate().flat_map(|(chain, draws)| {
            let draws = draws.as_array().map_or(0, Vec::len);
            (0..draws).map(move |draw| (chain, draw))
        });
        draws.map(|(chain, draw)| {
            let own = [chain, draw].map(|number| Cell::Count(number as u64));
            let values = self.columns.iter();
            let values = values.map(|(chains, place)| chains[chain][draw][*place].as_f64());
            own.into_iter().chain(values.map(Cell::number)).collect()
        })
    }
}

fn texts(list: &Value) -> Vec<&str> {
    let texts = list.as_array().into_iter().flatten();
    texts.filter_map(Value::as_str).collect()
}

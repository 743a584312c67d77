//! The tables of a calibration: name, title, header and rows, for text and CSV
//! alike. Those of the study keep its numbers.

use crate::calibrate::outcome::{
    CalibrateOutcome, DesignSurfaceOutcome, DesignWayOutcome, HeightFeatures, VerifiedResponse,
};
use crate::calibrate::target::same_height;
use windfall_files::text::number::plain;
use windfall_files::text::table::header_of;
use windfall_statistics::model::anova::AnovaRow;

/// A cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Word(String),
    /// A number.
    Number(f64),
    /// A part, shown in percent.
    Part(f64),
    /// A probability.
    Probability(f64),
    /// Nothing.
    Blank,
}

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrateTable {
    /// Name of its file.
    pub name: &'static str,
    /// What it shows.
    pub title: String,
    /// Headings.
    pub header: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<Cell>>,
}

fn word(text: &str) -> Cell {
    Cell::Word(text.to_owned())
}

fn maybe(value: Option<f64>) -> Cell {
    value.map_or(Cell::Blank, Cell::Number)
}

/// Seconds as people read them in a bounce: milliseconds.
fn shown(value: f64, unit: &str) -> f64 {
    match unit {
        "s" => 1e3 * value,
        _ => value,
    }
}

fn heading(name: &str, unit: &str) -> String {
    let unit = if unit == "s" { "ms" } else { unit };
    format!("{name} ({unit})")
}

fn unit_of(feature: &str) -> &'static str {
    match feature.contains("force") {
        true => "N",
        false => "s",
    }
}

fn level_headings(design: &DesignWayOutcome) -> Vec<String> {
    let factors = design.factors.iter();
    factors.map(|f| with_unit(&f.name, &f.unit)).collect()
}

fn with_unit(name: &str, unit: &str) -> String {
    match unit {
        "1" | "" => name.to_owned(),
        unit => format!("{name} ({unit})"),
    }
}

/// Tables 2 to 6 of the study and what it had no space for.
pub fn design_tables(outcome: &CalibrateOutcome) -> Vec<CalibrateTable> {
    let Some(design) = &outcome.design else {
        return Vec::new();
    };
    let mut tables = Vec::new();
    tables.extend(depth_table(design));
    tables.push(run_table(design));
    let names = ["table_4_force", "table_5_interval"];
    for (surface, name) in design.surfaces.iter().zip(names) {
        tables.push(anova_table(surface, name));
    }
    tables.push(equation_table(design));
    tables.push(optimum_table(design));
    tables.push(heights_table(design));
    if !design.family.is_empty() {
        tables.push(family_table(design, outcome.target.height));
    }
    tables
}

fn depth_table(design: &DesignWayOutcome) -> Option<CalibrateTable> {
    let depth = design.depth.as_ref()?;
    let responses = || design.surfaces.iter().map(|s| s.unit.as_str());
    let row = |first: Cell, values: &[f64]| {
        let cells = responses()
            .zip(values)
            .map(|(unit, v)| Cell::Number(shown(*v, unit)));
        std::iter::once(first).chain(cells).collect::<Vec<_>>()
    };
    let mut rows: Vec<Vec<Cell>> = depth
        .rows
        .iter()
        .map(|(d, values)| row(Cell::Number(1e3 * d), values))
        .collect();
    rows.push(row(word("mean"), &depth.mean));
    rows.push(row(word("standard deviation (÷ n)"), &depth.sd));
    let parts = depth.cv.iter().map(|cv| Cell::Part(*cv));
    rows.push(
        std::iter::once(word("coefficient of variation"))
            .chain(parts)
            .collect(),
    );
    let own = design
        .surfaces
        .iter()
        .map(|s| heading(&s.response, &s.unit));
    Some(CalibrateTable {
        name: "table_2_penetration_depth",
        title: format!("Table 2: depth of full damping, at {}", depth.law),
        header: std::iter::once("d (mm)".to_owned()).chain(own).collect(),
        rows,
    })
}

fn run_table(design: &DesignWayOutcome) -> CalibrateTable {
    let letters = design.factors.iter().map(|factor| factor.letter.clone());
    let responses = design
        .surfaces
        .iter()
        .map(|s| heading(&s.response, &s.unit));
    let header = std::iter::once("run".to_owned())
        .chain(letters)
        .chain(level_headings(design))
        .chain(responses);
    let rows = design.runs.iter().enumerate().map(|(place, run)| {
        let numbers = run
            .coded
            .iter()
            .chain(&run.levels)
            .map(|v| Cell::Number(*v));
        let responses = design.surfaces.iter().zip(&run.responses);
        let responses = responses.map(|(s, v)| Cell::Number(shown(*v, &s.unit)));
        std::iter::once(word(&(place + 1).to_string()))
            .chain(numbers)
            .chain(responses)
            .collect()
    });
    CalibrateTable {
        name: "table_3_design",
        title: format!(
            "Table 3: {}, axial points at ±{:.4}, with the simulator's responses",
            design.kind, design.alpha
        ),
        header: header.collect(),
        rows: rows.collect(),
    }
}

fn anova_table(surface: &DesignSurfaceOutcome, name: &'static str) -> CalibrateTable {
    // Squares of milliseconds, as the study has them.
    let squared = shown(1.0, &surface.unit).powi(2);
    let sums = |term: &str, ss: f64, df: f64| {
        vec![word(term), Cell::Number(squared * ss), Cell::Number(df)]
    };
    let mean = |ss: f64, df: f64| Cell::Number(squared * ss / df);
    let row = |row: &AnovaRow| {
        let tested = [
            mean(row.ss, row.df),
            Cell::Number(row.f),
            Cell::Probability(row.p),
        ];
        [sums(&row.term, row.ss, row.df), tested.to_vec()].concat()
    };
    let mut rows = vec![row(&surface.whole)];
    rows.extend(surface.anova.iter().map(row));
    let (ss, df) = (surface.residual_ss, surface.residual_df);
    let untested = vec![mean(ss, df), Cell::Blank, Cell::Blank];
    rows.push([sums("residual", ss, df), untested].concat());
    let total = sums("total", surface.total_ss, df + surface.whole.df);
    rows.push([total, vec![Cell::Blank; 3]].concat());
    let place = if name.contains('4') { 4 } else { 5 };
    CalibrateTable {
        name,
        title: format!(
            "Table {place}: analysis of variance of {}, {}; R² {:.4}, adjusted {:.4}, predicted {:.4}",
            surface.response, surface.model, surface.r2, surface.r2_adjusted, surface.r2_predicted
        ),
        header: header_of(&["source", "SS", "df", "mean square", "F", "p"]),
        rows,
    }
}

fn equation_table(design: &DesignWayOutcome) -> CalibrateTable {
    let rows = design.surfaces.iter().flat_map(|surface| {
        surface.terms.iter().map(|term| {
            vec![
                word(&surface.response),
                word(&term.term),
                Cell::Number(shown(term.coded, &surface.unit)),
                Cell::Number(shown(term.actual, &surface.unit)),
            ]
        })
    });
    CalibrateTable {
        name: "equations_14_15",
        title: "Equations 14 and 15: coefficients of the surfaces (N, ms)".to_owned(),
        header: header_of(&["response", "term", "coded", "actual"]),
        rows: rows.collect(),
    }
}

fn verified_row(first: Vec<Cell>, response: &VerifiedResponse, with_surface: bool) -> Vec<Cell> {
    let of = |value: Option<f64>| maybe(value.map(|v| shown(v, &response.unit)));
    let mut row = first;
    row.push(word(&heading(&response.response, &response.unit)));
    row.push(of(response.measured));
    if with_surface {
        row.push(of(Some(response.predicted)));
    }
    row.push(of(response.simulated));
    row.push(response.difference.map_or(Cell::Blank, Cell::Part));
    row
}

fn optimum_table(design: &DesignWayOutcome) -> CalibrateTable {
    let rows = design.optimum.responses.iter();
    let levels = design.factors.iter().zip(&design.optimum.levels);
    let levels = levels.map(|(factor, level)| format!("{} = {}", factor.name, plain(*level)));
    CalibrateTable {
        name: "table_6_optimum",
        title: format!(
            "Table 6: measured against simulated at the optimum, {} (desirability {:.4}; one of a \
             family)",
            levels.collect::<Vec<_>>().join(", "),
            design.optimum.desirability
        ),
        header: header_of(&["response", "measured", "surface", "simulated", "difference"]),
        rows: rows
            .map(|response| verified_row(Vec::new(), response, true))
            .collect(),
    }
}

fn heights_table(design: &DesignWayOutcome) -> CalibrateTable {
    let rows = design.heights.iter().flat_map(|at| {
        at.responses.iter().map(|response| {
            let first = vec![Cell::Number(1e3 * at.height), Cell::Number(at.drops as f64)];
            verified_row(first, response, false)
        })
    });
    CalibrateTable {
        name: "other_heights",
        title: "The optimum at every height of the campaign".to_owned(),
        header: header_of(&[
            "height (mm)",
            "drops",
            "response",
            "measured",
            "simulated",
            "difference",
        ]),
        rows: rows.collect(),
    }
}

/// Headings and cells of features at heights: first peak and interval, and at the
/// target's own height what else tells laws apart.
fn height_cells(heights: &[HeightFeatures], target: f64) -> (Vec<String>, Vec<Cell>) {
    let (mut headings, mut cells) = (Vec::new(), Vec::new());
    for at in heights {
        for (name, short, at_all) in SHORT {
            let Some(value) = at.features.get(name) else {
                continue;
            };
            if at_all || same_height(at.height, target) {
                let unit = unit_of(name);
                let height = (1e4 * at.height).round() / 10.0;
                headings.push(format!("{height} mm: {}", heading(short, unit)));
                cells.push(Cell::Number(shown(*value, unit)));
            }
        }
    }
    (headings, cells)
}

/// Features in headings, and whether they are shown at every height.
const SHORT: [(&str, &str, bool); 4] = [
    ("peak_support_force_1", "peak", true),
    ("interval_1", "interval", true),
    ("peak_support_force_2", "2nd peak", false),
    ("contact_duration_1", "contact", false),
];

fn family_table(design: &DesignWayOutcome, target: f64) -> CalibrateTable {
    let (headings, _) = height_cells(&design.family[0].heights, target);
    let header = level_headings(design)
        .into_iter()
        .chain(["desirability".to_owned()])
        .chain(headings);
    let rows = design.family.iter().map(|member| {
        let levels = member.levels.iter().map(|level| Cell::Number(*level));
        levels
            .chain([Cell::Number(member.desirability)])
            .chain(height_cells(&member.heights, target).1)
            .collect()
    });
    CalibrateTable {
        name: "design_family",
        title: "Settings that are as good on the surfaces, and the simulator there".to_owned(),
        header: header.collect(),
        rows: rows.collect(),
    }
}

/// The line of laws that have the target, by the simulator itself.
pub fn line_table(outcome: &CalibrateOutcome) -> Option<CalibrateTable> {
    let family = outcome.family.as_ref().filter(|f| !f.members.is_empty())?;
    let units = outcome.parameter_units();
    let names = outcome.free.iter().zip(&units);
    let (headings, _) = height_cells(&family.members[0].heights, outcome.target.height);
    let rows = family.members.iter().map(|member| {
        let values = member.parameters.iter().map(|value| Cell::Number(*value));
        values
            .chain(height_cells(&member.heights, outcome.target.height).1)
            .collect()
    });
    Some(CalibrateTable {
        name: "family",
        title: format!(
            "Laws with the first peak and interval of the {}: one of these is as good as another",
            outcome.target.of
        ),
        header: names
            .map(|(name, unit)| with_unit(name, unit))
            .chain(headings)
            .collect(),
        rows: rows.collect(),
    })
}

/// What each kind of knowledge makes of the uncertainties.
pub fn closing_table(outcome: &CalibrateOutcome) -> CalibrateTable {
    let sds = outcome.free.iter().map(|name| format!("sd of {name}"));
    let rows = outcome.closing.iter().map(|row| {
        let open = |sd: &Option<f64>| sd.map_or_else(|| word("open"), Cell::Number);
        [word(&row.with), Cell::Number(row.rank as f64)]
            .into_iter()
            .chain(row.sds.iter().map(open))
            .collect()
    });
    CalibrateTable {
        name: "what_closes",
        title: "What closes the family (standard uncertainties: relative, of exponents absolute)"
            .to_owned(),
        header: header_of(&["known", "determined"])
            .into_iter()
            .chain(sds)
            .collect(),
        rows: rows.collect(),
    }
}

/// The next experiment.
pub fn next_table(outcome: &CalibrateOutcome) -> Option<CalibrateTable> {
    let next = outcome.next.as_ref()?;
    let sds = outcome.free.iter().map(|name| format!("sd of {name}"));
    let header = header_of(&["height (mm)", "mass (g)", "fruit", "drops", "impacts"])
        .into_iter()
        .chain(sds)
        .chain(header_of(&["gain"]))
        .chain([format!("gain of {}", next.interest)]);
    let rows = next.candidates.iter().map(|candidate| {
        let open = |sd: &Option<f64>| sd.map_or_else(|| word("open"), Cell::Number);
        [
            Cell::Number(1e3 * candidate.height),
            Cell::Number(1e3 * candidate.mass),
            word(&candidate.fruit),
            Cell::Number(candidate.drops as f64),
            Cell::Number(candidate.impacts as f64),
        ]
        .into_iter()
        .chain(candidate.sds.iter().map(open))
        .chain([
            candidate.gain.map_or_else(|| word("closes"), Cell::Number),
            candidate
                .gain_of_interest
                .map_or_else(|| word("closes"), Cell::Number),
        ])
        .collect()
    });
    Some(CalibrateTable {
        name: "next_experiment",
        title: "The next drops that would tell most, best first (gain: of ln det of the \
                information)"
            .to_owned(),
        header: header.collect(),
        rows: rows.collect(),
    })
}

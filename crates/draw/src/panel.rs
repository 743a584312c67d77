//! Panels: series of points and named places over two axes.

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Dots.
    Dots,
    /// A line.
    Line,
    /// A thick line behind the others.
    Broad,
    /// A broken line across the panel at the height of each point.
    Level,
    /// A broken line.
    Dashed,
    /// A thin upright line through the panel at the place of each point.
    Upright,
    /// A tint from top to bottom of the panel between the first and the second
    /// point, the third and the fourth, and so on.
    Shade,
    /// A tinted shape with corners at the points: a band, or the area within an
    /// ellipse.
    Band,
    /// A thin upright line from the first to the second point, from the third to
    /// the fourth, and so on: intervals.
    Bars,
    /// As [`Style::Bars`], level.
    LevelBars,
    /// As [`Style::Bars`], thick: intervals of what stands out.
    ThickBars,
    /// As [`Style::LevelBars`], thick.
    LevelThickBars,
    /// Large dots, set off from what is below them.
    Spots,
}

impl Style {
    /// Whether its points come in pairs or enclose an area, so that none can be left out.
    pub(crate) fn has_ends(self) -> bool {
        matches!(
            self,
            Self::Shade
                | Self::Band
                | Self::Bars
                | Self::LevelBars
                | Self::ThickBars
                | Self::LevelThickBars
        )
    }
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What the legend says.
    pub label: String,
    /// How it is drawn.
    pub style: Style,
    /// Which colour it has; that of its place among the series where it is `None`.
    pub colour: Option<usize>,
    /// The points, in the units of the axes.
    pub points: Vec<(f64, f64)>,
}

impl Series {
    /// A series in the colour of its place among the series.
    pub fn new(label: impl Into<String>, style: Style, points: Vec<(f64, f64)>) -> Self {
        Self {
            label: label.into(),
            style,
            colour: None,
            points,
        }
    }

    /// The series in a colour of its own.
    #[must_use]
    pub fn coloured(self, colour: usize) -> Self {
        let colour = Some(colour);
        Self { colour, ..self }
    }
}

/// A place that is named.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// What is there.
    pub label: String,
    /// Where, in the units of the axes.
    pub at: (f64, f64),
    /// On which side of the place the label stands.
    pub side: Side,
}

/// Side of a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Above and to the left.
    AboveLeft,
    /// Below and to the right.
    BelowRight,
}

/// One panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Name of the horizontal axis.
    pub x: String,
    /// Its unit.
    pub x_unit: String,
    /// Name of the vertical axis.
    pub y: String,
    /// Its unit.
    pub y_unit: String,
    /// The series, drawn in their order.
    pub series: Vec<Series>,
    /// Named places.
    pub marks: Vec<Mark>,
    /// Whether both axes show one quantity: then they have one range and one scale.
    pub equal: bool,
}

impl Panel {
    /// A panel without marks, from name and unit of each axis; the unit "1" is not shown.
    pub fn new(x: (&str, &str), y: (&str, &str), series: Vec<Series>) -> Self {
        let shown = |unit: &str| if unit == "1" { "" } else { unit }.to_owned();
        Self {
            x: x.0.to_owned(),
            x_unit: shown(x.1),
            y: y.0.to_owned(),
            y_unit: shown(y.1),
            series,
            marks: Vec::new(),
            equal: false,
        }
    }

    /// The panel with the same range and scale on both axes.
    #[must_use]
    pub fn with_equal_axes(self) -> Self {
        Self {
            equal: true,
            ..self
        }
    }
}

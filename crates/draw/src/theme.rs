//! Colours of figures: light for paper, dark for a dark screen, and those of the
//! page that contains a figure.

/// Series that have colours of their own.
pub const SERIES: usize = 7;

/// Steps of the scale from low to high.
pub const SCALE: usize = 12;

/// The colours of a figure, as CSS writes them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Theme {
    /// Behind everything.
    pub background: &'static str,
    /// Text.
    pub text: &'static str,
    /// Axes and ticks.
    pub frame: &'static str,
    /// Lines behind the data.
    pub grid: &'static str,
    /// Series, in their order; people who are colour-blind tell them apart.
    pub series: [&'static str; SERIES],
    /// From low to high: its lightness alone tells the order, so that those who are
    /// colour-blind read it too, and [`text`](Self::text) can be read on every step.
    pub scale: [&'static str; SCALE],
}

/// Colours of the files of figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum FigureTheme {
    /// For paper.
    #[default]
    Light,
    /// For dark screens and slides.
    Dark,
}

impl FigureTheme {
    /// The colours.
    pub fn colours(self) -> &'static Theme {
        match self {
            Self::Light => &LIGHT,
            Self::Dark => &DARK,
        }
    }
}

/// For paper.
///
/// # Source
/// Series: M. Okabe, K. Ito (2008), "Color Universal Design".
pub const LIGHT: Theme = Theme {
    background: "#fff",
    text: "#222",
    frame: "#777",
    grid: "#e4e4e4",
    series: [
        "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
    ],
    scale: [
        "#fcf7d4", "#edf1cf", "#deecca", "#cfe6c5", "#c0e1c0", "#b0dbbb", "#a0d3ba", "#90c9bc",
        "#7fbebe", "#6eb4bf", "#5daac0", "#4b9fc0",
    ],
};

/// For dark screens: the hues of [`LIGHT`], as light as the background asks.
pub const DARK: Theme = Theme {
    background: "#14171a",
    text: "#e6e6e6",
    frame: "#8b9096",
    grid: "#2c3136",
    series: [
        "#4ba3e3", "#ff8a3d", "#2fc79a", "#e39cc4", "#f0b93a", "#8fd0f5", "#f2f2f2",
    ],
    scale: [
        "#1d1f45", "#1f2a4e", "#213558", "#214061", "#214b6b", "#205675", "#216079", "#276978",
        "#2c7176", "#327974", "#398271", "#3f8a6e",
    ],
};

/// For a figure within a page whose style sheet sets these variables.
pub const PAGE: Theme = Theme {
    background: "var(--figure-background)",
    text: "var(--figure-text)",
    frame: "var(--figure-frame)",
    grid: "var(--figure-grid)",
    series: [
        "var(--series-1)",
        "var(--series-2)",
        "var(--series-3)",
        "var(--series-4)",
        "var(--series-5)",
        "var(--series-6)",
        "var(--series-7)",
    ],
    scale: [
        "var(--scale-1)",
        "var(--scale-2)",
        "var(--scale-3)",
        "var(--scale-4)",
        "var(--scale-5)",
        "var(--scale-6)",
        "var(--scale-7)",
        "var(--scale-8)",
        "var(--scale-9)",
        "var(--scale-10)",
        "var(--scale-11)",
        "var(--scale-12)",
    ],
};

/// The variables of [`PAGE`] with the colours of a theme, as declarations of CSS.
pub fn declarations(theme: &Theme) -> String {
    let named = [
        ("figure-background", theme.background),
        ("figure-text", theme.text),
        ("figure-frame", theme.frame),
        ("figure-grid", theme.grid),
    ];
    let mut text: String = named
        .iter()
        .map(|(name, colour)| format!("--{name}: {colour}; "))
        .collect();
    for (index, colour) in theme.series.iter().enumerate() {
        text += &format!("--series-{}: {colour}; ", index + 1);
    }
    for (index, colour) in theme.scale.iter().enumerate() {
        text += &format!("--scale-{}: {colour}; ", index + 1);
    }
    text.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every variable that the page's theme uses is declared.
    #[test]
    fn closed_form_the_page_declares_what_it_uses() {
        let css = declarations(&DARK);
        let plain = [PAGE.background, PAGE.text, PAGE.frame, PAGE.grid];
        for used in plain.iter().chain(&PAGE.series).chain(&PAGE.scale) {
            let name = used.trim_start_matches("var(").trim_end_matches(')');
            assert!(css.contains(&format!("{name}: #")), "{name} in {css}");
        }
    }

    /// Relative luminance of a colour of six digits (WCAG 2.1).
    fn luminance(colour: &str) -> f64 {
        let part = |from: usize| {
            let value = u8::from_str_radix(&colour[from..from + 2], 16).unwrap();
            let value = f64::from(value) / 255.0;
            match value <= 0.03928 {
                true => value / 12.92,
                false => ((value + 0.055) / 1.055).powf(2.4),
            }
        };
        0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5)
    }

    /// The scale's lightness rises or falls from step to step, and text on it keeps a
    /// contrast of 3 (WCAG 2.1, 1.4.11).
    #[test]
    fn closed_form_the_scale_is_told_by_lightness_and_bears_text() {
        for (theme, text) in [(&LIGHT, "#222222"), (&DARK, "#e6e6e6")] {
            let steps = theme.scale.map(luminance);
            let rises = steps.windows(2).filter(|pair| pair[1] > pair[0]).count();
            assert!(rises == 0 || rises == SCALE - 1, "{steps:?}");
            for step in steps {
                let (a, b) = (luminance(text).max(step), luminance(text).min(step));
                assert!((a + 0.05) / (b + 0.05) > 3.0, "{step}");
            }
        }
    }
}

//! Colours of figures: light for paper, dark for a dark screen, and those of the
//! page that a figure stands in.

/// Series that have colours of their own.
pub const SERIES: usize = 7;

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
};

/// The variables of [`PAGE`] with the colours of a theme, as declarations of CSS.
#[must_use]
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
        for used in plain.iter().chain(&PAGE.series) {
            let name = used.trim_start_matches("var(").trim_end_matches(')');
            assert!(css.contains(&format!("{name}: #")), "{name} in {css}");
        }
    }
}

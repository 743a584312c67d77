//! Figures of nothing in particular: SVG, axes, themes, contours, PNG, plots in a terminal, pages of HTML.

pub mod axis;
pub mod colour_map;
pub mod contour_lines;
pub mod curve;
pub mod files;
pub mod frame;
pub mod grid;
mod grid_panel;
pub mod page;
pub mod panel;
mod panel_drawing;
mod paper;
pub mod pdf;
pub mod plot;
pub mod png;
mod raised;
mod shapes;
pub mod svg;
pub mod terminal_plot;
pub mod text_width;
pub mod theme;
pub mod width;
pub mod xy;

//! One simulated impact as a figure: the loop of force and displacement, and
//! the force over time.

use crate::impact::{SimulatedMotion, motion_at};
use crate::request::event::{Event, impact_of_event};
use std::path::{Path, PathBuf};
use windfall_draw::plot::write_plot;
use windfall_draw::theme::LIGHT;
use windfall_draw::width::Width;
use windfall_draw::xy::{Figure, Panel, Series, Style, csv_of_figure, drawing_of_figure};
use windfall_files::error::Error;

/// Points over a contact: lines look smooth and files stay small.
const POINTS: u32 = 160;
/// What is shown before and after contact, as a part of its duration.
const MARGIN: f64 = 0.1;

/// Simulates an impact and writes its figure (SVG, PNG or PDF) with its data.
///
/// * `width`: on paper; as wide as a screen shows it if left out
///
/// # Errors
/// It cannot be simulated, or a file cannot be written.
pub fn write_impact_figure(
    path: &Path,
    event: &Event,
    width: Option<Width>,
) -> Result<[PathBuf; 2], Error> {
    let figure = figure_of_motion(event.law.kind().name(), &motion_of_figure(event)?);
    let csv = csv_of_figure(&figure)?;
    let svg = drawing_of_figure(&figure, width).svg(&LIGHT);
    write_plot("--plot", path, &svg, &csv)
}

/// The motion at instants that are close together after first touch, where a law
/// may start like √x.
fn motion_of_figure(event: &Event) -> Result<SimulatedMotion, Error> {
    let impact = impact_of_event(event)?;
    let duration = impact.contact_duration;
    let part = |i: u32| (f64::from(i) / f64::from(POINTS)).powi(2);
    let mut times = vec![-MARGIN * duration, -f64::MIN_POSITIVE];
    times.extend((0..=POINTS).map(|i| part(i) * duration));
    times.push((1.0 + MARGIN) * duration);
    let trajectory = motion_at(&event.law, &event.rig, event.velocity, event.end, &times)?;
    Ok(SimulatedMotion { impact, trajectory })
}

/// * `law`: its name, for the title
fn figure_of_motion(law: &str, motion: &SimulatedMotion) -> Figure {
    let impact = &motion.impact;
    let [loading, unloading] = loop_of(motion);
    let path = &motion.trajectory;
    let times = path.times.iter().map(|time| 1e3 * time);
    let over_time = times.zip(path.force.clone()).collect();
    let force = ("contact force F", "N");
    let loops = vec![
        Series::new("loading", Style::Line, loading).coloured(0),
        Series::new("unloading", Style::Line, unloading).coloured(1),
    ];
    let course = vec![Series::new("", Style::Line, over_time).coloured(0)];
    let (mass, velocity) = (impact.effective_mass, impact.impact_velocity);
    Figure::new(
        format!("{law}: {mass} kg at {velocity} m/s"),
        vec![
            Panel::new(("displacement x", "mm"), force, loops),
            Panel::new(("time t from first touch", "ms"), force, course),
        ],
    )
}

/// Force over displacement in mm, to the largest displacement and back.
fn loop_of(motion: &SimulatedMotion) -> [Vec<(f64, f64)>; 2] {
    let (impact, path) = (&motion.impact, &motion.trajectory);
    let points = |from: f64, to: f64| -> Vec<(f64, f64)> {
        let inside = (0..path.times.len()).filter(|i| (from..to).contains(&path.times[*i]));
        inside
            .map(|i| (1e3 * path.displacement[i], path.force[i]))
            .collect()
    };
    let turn = impact.time_of_max_displacement;
    let mut loading = vec![(0.0, 0.0)];
    loading.extend(points(0.0, turn));
    // The way back begins where the way in ends.
    let mut unloading: Vec<(f64, f64)> = loading.last().copied().into_iter().collect();
    unloading.extend(points(turn, impact.contact_duration));
    unloading.push((1e3 * impact.final_displacement, 0.0));
    [loading, unloading]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::request::impact::{ImpactRequest, impact_event};

    fn event(law: &str) -> Event {
        impact_event(&ImpactRequest {
            law: law.to_owned(),
            laws: None,
            mass: "0.2 kg".to_owned(),
            velocity: Some("0.5 m/s".to_owned()),
            height: None,
            driving_acceleration: None,
            end: "force-zero".to_owned(),
        })
        .unwrap()
    }

    /// A table of the user's own, such as the points of a law, is not replaced;
    /// the data of an earlier figure are.
    #[test]
    fn rejects_data_in_the_place_of_another_table() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("curve.svg");
        let table = folder.path().join("curve.csv");
        std::fs::write(&table, "displacement_m,force_N\n0,0\n").unwrap();
        let law = event("hertz(k=753599)");
        let refused = write_impact_figure(&path, &law, None)
            .unwrap_err()
            .to_string();
        assert!(
            refused.contains("curve.csv: this file was not written by windfall"),
            "{refused}"
        );
        assert!(!path.exists());
        std::fs::remove_file(&table).unwrap();
        write_impact_figure(&path, &law, None).unwrap();
        let first = std::fs::read(&table).unwrap();
        write_impact_figure(&path, &event("hertz(k=400000)"), None).unwrap();
        assert_ne!(std::fs::read(&table).unwrap(), first);
    }

    /// The area within the loop is the energy that the contact has absorbed, and
    /// the area under the force over time its impulse.
    #[test]
    fn conserves_energy_and_impulse_in_the_figure() {
        for law in [
            "kuwabara-kono(k=753599, c=1524)",
            "kelvin-voigt(k=30000, c=40)",
            "walton-braun(k1=40000, k2=111000)",
        ] {
            let event = event(law);
            let motion = motion_of_figure(&event).unwrap();
            let figure = figure_of_motion("x", &motion);
            let area = |points: &[(f64, f64)]| -> f64 {
                points
                    .windows(2)
                    .map(|p| 0.5e-3 * (p[1].0 - p[0].0) * (p[0].1 + p[1].1))
                    .sum()
            };
            let drawn = |panel: usize| -> f64 {
                let series = figure.panels[panel].series.iter();
                series.map(|series| area(&series.points)).sum()
            };
            let close = |value: f64, expected: f64| (value / expected - 1.0).abs() < 0.01;
            let impact = &motion.impact;
            assert!(
                close(drawn(0), impact.absorbed_energy),
                "{law}: {} J",
                drawn(0)
            );
            assert!(close(drawn(1), impact.impulse), "{law}: {} N s", drawn(1));
        }
    }
}

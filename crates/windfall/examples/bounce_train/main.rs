//! Bounces of a real cart: tables and figures of docs/guide/src/compared/bounce_train.md.
//!
//!     cargo run --example bounce_train -- DATA/impact/foam_pads/bounce_train.csv OUT

#![allow(clippy::print_stdout, missing_docs)]

mod analysis;
mod figures;

use analysis::{LEAST_SPEED, Run, calibrate, evaluate, masses};
use figures::{restitution_figure, train_figure, waveform_figure};
use windfall_draw::theme::LIGHT;
use windfall_draw::xy::svg_of_figure;

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, file, out] = arguments.as_slice() else {
        return Err("usage: bounce_train bounce_train.csv DIRECTORY".to_owned());
    };
    let runs = evaluate(std::path::Path::new(file))?;
    for run in &runs {
        show(run);
    }
    let all: Vec<&Run> = runs.iter().collect();
    let mut fits = Vec::new();
    for run in &runs {
        for law in ["kelvin-voigt", "power-law"] {
            let fit = calibrate(&[run], law, LEAST_SPEED)?;
            let estimates = fit.names.iter().zip(&fit.estimates);
            let texts: Vec<String> = estimates
                .map(|(name, e)| format!("{name} {:.3} ± {:.3}", e.value, e.sd))
                .collect();
            println!("{} {law}: {texts:?} misfit {:.1}", run.name, fit.misfit);
        }
    }
    for law in [
        "kelvin-voigt",
        "hertz",
        "kuwabara-kono",
        "power-law",
        "hunt-crossley",
    ] {
        match calibrate(&all, law, LEAST_SPEED) {
            Ok(fit) => {
                let estimates = fit.names.iter().zip(&fit.estimates);
                let texts: Vec<String> = estimates
                    .map(|(name, e)| format!("{name} {:.4} ± {:.4}", e.value, e.sd))
                    .collect();
                println!(
                    "{law}: {texts:?} by records {} misfit {:.1} converged {} records {} samples {}",
                    fit.by_records,
                    fit.misfit,
                    fit.converged,
                    fit.records.len(),
                    fit.samples
                );
                fits.push((law, fit));
            }
            Err(error) => println!("{law}: {error}"),
        }
    }
    let figures = [
        ("trains", train_figure(&runs)),
        ("restitution", restitution_figure(&runs, &fits)),
        ("waveforms", waveform_figure(&runs, &fits)),
    ];
    for (name, figure) in figures {
        let path = std::path::Path::new(out).join(format!("bounce_{name}.svg"));
        std::fs::write(&path, svg_of_figure(&figure, &LIGHT)).map_err(|e| e.to_string())?;
    }
    Ok(())
}

fn show(run: &Run) {
    println!(
        "\n{}: noise {:.4} N, level {:.4} N",
        run.name, run.train.noise, run.train.static_level.value
    );
    for (k, bounce) in run.train.bounces.iter().enumerate() {
        println!(
            "  {} onset {:.3} ± {:.3}({:.3}) T {:.3} ± {:.3} peak {:.3} J {:.4} ± {:.4} complete {}",
            k + 1,
            bounce.onset.value,
            bounce.onset.sd,
            bounce.onset_shape,
            bounce.end.value - bounce.onset.value,
            bounce.end.sd,
            bounce.peak,
            bounce.impulse.value,
            bounce.impulse.sd,
            bounce.complete
        );
        for motion in run.motions.iter().filter(|m| m.bounce == k) {
            println!(
                "    v {:.4} ± {:.4} → {:.4} ± {:.4}; a {:?} {:?}",
                motion.before.value,
                motion.before.sd,
                motion.after.value,
                motion.after.sd,
                motion.acceleration_before.map(|a| (a.value, a.sd)),
                motion.acceleration_after.map(|a| (a.value, a.sd))
            );
        }
        for r in run.restitutions.iter().filter(|r| r.bounce == k) {
            println!(
                "    e {:.4} ± {:.4} by {}",
                r.restitution.value, r.restitution.sd, r.method
            );
        }
    }
    println!("  masses {:?}", masses(run));
    for finding in &run.train.findings {
        println!("  {}: {finding}", finding.code());
    }
}

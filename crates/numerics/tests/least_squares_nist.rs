//! Least squares against NIST StRD: values and standard deviations of every
//! nonlinear data set, from both starts.
//!
//! The files are read from `$WINDFALL_DATA/nist` (default `../shared/data/nist`
//! beside the repository); sets that are not there are named and left out.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod strd;

const SETS: [&str; 27] = [
    "Bennett5", "BoxBOD", "Chwirut1", "Chwirut2", "DanWood", "ENSO", "Eckerle4", "Gauss1",
    "Gauss2", "Gauss3", "Hahn1", "Kirby2", "Lanczos1", "Lanczos2", "Lanczos3", "MGH09", "MGH10",
    "MGH17", "Misra1a", "Misra1b", "Misra1c", "Misra1d", "Nelson", "Rat42", "Rat43", "Roszman1",
    "Thurber",
];

#[test]
fn reference_nist_from_both_starts() {
    for tol in [1e-10, 1e-20] {
        for name in SETS {
            match strd::fit_named(name, tol).unwrap() {
                None => println!("{name:9} left out: no such file"),
                Some(outcomes) => {
                    for (start, o) in outcomes.iter().enumerate() {
                        println!(
                            "{name:9} start {} values {:5.1} sd {:5.1} cost {:5.1} evaluations {:5} {}",
                            start + 1,
                            o.value_digits,
                            o.sd_digits,
                            o.cost_digits,
                            o.evaluations,
                            o.stop
                        );
                    }
                }
            }
        }
    }
}

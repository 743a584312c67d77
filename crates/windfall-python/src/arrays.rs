//! Arrays of Python as a file of NumPy.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use windfall_files::npy::{not_finite, npy_of_columns};

/// The bytes of a file of NumPy with the columns of a table.
///
/// * `columns`: name and doubles, in the order of bytes of this machine
///
/// # Errors
/// A column is empty, holds what is not finite, or is not as long as the first one.
pub fn npy_of(columns: &[(&str, &[u8])]) -> PyResult<Vec<u8>> {
    let length = columns.first().map_or(0, |own| own.1.len());
    for (name, doubles) in columns {
        check(name, doubles, length).map_err(PyValueError::new_err)?;
    }
    let names: Vec<String> = columns.iter().map(|own| own.0.to_owned()).collect();
    let columns: Vec<&[u8]> = columns.iter().map(|own| own.1).collect();
    Ok(npy_of_columns(&names, &columns))
}

fn check(name: &str, doubles: &[u8], length: usize) -> Result<(), String> {
    let samples = |bytes: usize| bytes / size_of::<f64>();
    let (own, length) = (samples(doubles.len()), samples(length));
    if own == 0 {
        return Err(format!("{name}: expected samples, found none"));
    }
    if own != length {
        return Err(format!("{name} has {own} samples, and t has {length}"));
    }
    let Some((first, value, count)) = not_finite(doubles) else {
        return Ok(());
    };
    // As Python writes it.
    let value = value.to_string().to_lowercase();
    Err(format!(
        "{name}: sample {first} is {value}; leave out the rows of samples that are missing \
         ({count} of {length})"
    ))
}

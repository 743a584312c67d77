//! One level of a population whose posterior is drawn: its covariance matrix as
//! coordinates with their prior, and its members.

use crate::population::model::{Structure, Variation};
use nalgebra::{DMatrix, DVector};

/// Smallest standard deviation at the start, in units of the noise below it.
const LEAST: f64 = 0.3;

/// One covariance matrix S = L Lᵀ. Coordinates: ln L_ii, then L_ij in units of
/// the i-th standard deviation of the fit, row by row.
pub(crate) struct Level {
    size: usize,
    full: bool,
    /// Whether the members differ by more than their noise: then they are drawn
    /// themselves, else their deviations in units of L, so that coordinates are nearly
    /// independent.
    resolved: bool,
    /// Standard deviations of the fit.
    scale: Vec<f64>,
    /// L of the fit.
    pub(crate) centre: DMatrix<f64>,
    /// Number of members.
    members: f64,
}

impl Level {
    /// `noise`: variances of the members' own estimates.
    pub fn new(
        variation: &Variation,
        structure: Structure,
        members: usize,
        noise: &DVector<f64>,
    ) -> Option<Self> {
        let size = variation.sds.len();
        if structure == Structure::Zero {
            return None;
        }
        let sds = variation.sds.iter().zip(noise);
        let scale: Vec<f64> = sds
            .clone()
            .map(|(sd, noise)| sd.value.max(LEAST * noise.sqrt()))
            .collect();
        let resolved = sds.into_iter().all(|(sd, noise)| sd.value > noise.sqrt());
        // Where the fit ends at a bound its matrix is singular: less correlated,
        // it is a place to start from.
        let covariance = DMatrix::from_fn(size, size, |i, j| match i == j {
            true => scale[i] * scale[i],
            false => 0.9 * variation.covariance[i][j],
        });
        Some(Self {
            size,
            full: structure == Structure::Full,
            resolved,
            centre: covariance.cholesky()?.l(),
            scale,
            members: members as f64,
        })
    }

    pub(crate) fn pairs(&self) -> usize {
        match self.full {
            true => self.size * (self.size - 1) / 2,
            false => 0,
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.size + self.pairs()
    }

    /// Positions below the diagonal.
    fn below(&self) -> impl Iterator<Item = (usize, usize)> {
        let rows = if self.full { self.size } else { 0 };
        (0..rows).flat_map(|i| (0..i).map(move |j| (i, j)))
    }

    pub(crate) fn root(&self, z: &[f64]) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(self.size, self.size);
        for i in 0..self.size {
            out[(i, i)] = self.centre[(i, i)] * (z[i] / (2.0 * self.members).sqrt()).exp();
        }
        for ((i, j), z) in self.below().zip(&z[self.size..]) {
            out[(i, j)] = self.centre[(i, j)] + self.scale[i] * z / self.members.sqrt();
        }
        out
    }

    /// Logarithm of the prior's density in the coordinates, and the gradient of
    /// that and of `by_root` by them.
    pub(crate) fn prior(
        &self,
        root: &DMatrix<f64>,
        by_root: &DMatrix<f64>,
        gradient: &mut [f64],
    ) -> f64 {
        let mut by_root = by_root.clone();
        let mut density = 0.0;
        for i in 0..self.size {
            // dS = 2^Q Π L_ii^(Q−i) dL (i from 0), and flat standard deviations
            // with uniform correlations are Π σ_i^(−Q) dS.
            let rank = if self.full { self.size as f64 } else { 1.0 };
            let power = if self.full {
                (self.size - i) as f64
            } else {
                1.0
            };
            let row = root.row(i);
            let variance = row.dot(&row);
            density -= 0.5 * rank * variance.ln();
            for j in 0..=i {
                by_root[(i, j)] -= rank * row[j] / variance;
            }
            // One more for dL_ii = L_ii d ln L_ii.
            density += (power + 1.0) * root[(i, i)].ln();
            by_root[(i, i)] += (power + 1.0) / root[(i, i)];
        }
        for i in 0..self.size {
            gradient[i] = by_root[(i, i)] * root[(i, i)] / (2.0 * self.members).sqrt();
        }
        for (k, (i, j)) in self.below().enumerate() {
            gradient[self.size + k] = by_root[(i, j)] * self.scale[i] / self.members.sqrt();
        }
        density
    }

    /// Standard deviations and correlations.
    pub(crate) fn spreads(&self, root: &DMatrix<f64>) -> Vec<f64> {
        let covariance = root * root.transpose();
        let sd = |i: usize| covariance[(i, i)].sqrt();
        let mut out: Vec<f64> = (0..self.size).map(sd).collect();
        if self.full {
            let pairs = (0..self.size).flat_map(|k| (k + 1..self.size).map(move |l| (k, l)));
            out.extend(pairs.map(|(k, l)| covariance[(k, l)] / (sd(k) * sd(l))));
        }
        out
    }
}

/// Log-density of deviations of which each is N(0, L Lᵀ), with what its
/// derivatives are made of.
pub(crate) struct Normal<'a> {
    resolved: bool,
    root: &'a DMatrix<f64>,
    pub(crate) by_root: DMatrix<f64>,
    pub(crate) density: f64,
}

impl<'a> Normal<'a> {
    pub fn new(level: &Level, root: &'a DMatrix<f64>) -> Self {
        Self {
            resolved: level.resolved,
            root,
            by_root: DMatrix::zeros(root.nrows(), root.ncols()),
            density: 0.0,
        }
    }

    /// A member at its coordinates: around `centre` in `unit`, or around what is
    /// expected of it in units of L.
    pub(crate) fn member(
        &self,
        (centre, unit): (&[f64], &DMatrix<f64>),
        expected: &DVector<f64>,
        z: &[f64],
    ) -> DVector<f64> {
        let z = DVector::from_column_slice(z);
        match self.resolved {
            true => DVector::from_column_slice(centre) + unit * z,
            false => expected + self.root * z,
        }
    }

    /// Adds one member: `deviation` from what is expected of it, its coordinates
    /// `z` in `unit`, and what pulls at it, `slope`. Writes the gradient by the
    /// coordinates and returns that by what is expected.
    pub(crate) fn add(
        &mut self,
        deviation: DVector<f64>,
        slope: DVector<f64>,
        (unit, z): (&DMatrix<f64>, &[f64]),
        gradient: &mut [f64],
    ) -> Option<DVector<f64>> {
        if !self.resolved {
            let z = DVector::from_column_slice(z);
            self.density -= 0.5 * z.dot(&z);
            self.by_root += &slope * z.transpose();
            let own = self.root.tr_mul(&slope) - z;
            gradient.copy_from_slice(own.as_slice());
            return Some(slope);
        }
        let mut white = deviation;
        if !self.root.solve_lower_triangular_mut(&mut white) {
            return None;
        }
        let mut pull = white.clone();
        if !self.root.tr_solve_lower_triangular_mut(&mut pull) {
            return None;
        }
        self.density -= 0.5 * white.dot(&white);
        self.by_root += &pull * white.transpose();
        for i in 0..white.len() {
            self.density -= self.root[(i, i)].ln();
            self.by_root[(i, i)] -= 1.0 / self.root[(i, i)];
        }
        let own = unit.tr_mul(&(slope - &pull));
        gradient.copy_from_slice(own.as_slice());
        Some(pull)
    }
}

//! The covariance matrices of a population as unconstrained parameters.

use nalgebra::{DVector, SMatrix, SVector};

/// Shape of a covariance matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Structure {
    /// Every variance and every correlation.
    #[default]
    Full,
    /// Variances only.
    Diagonal,
    /// No variation.
    Zero,
}

impl Structure {
    fn count(self, size: usize) -> usize {
        match self {
            Self::Full => size * (size + 1) / 2,
            Self::Diagonal => size,
            Self::Zero => 0,
        }
    }

    /// Rows and columns of the factor's entries, in the order of the parameters.
    fn entries(self, size: usize) -> Vec<(usize, usize)> {
        match self {
            Self::Full => (0..size)
                .flat_map(|i| (0..=i).map(move |j| (i, j)))
                .collect(),
            Self::Diagonal => (0..size).map(|i| (i, i)).collect(),
            Self::Zero => Vec::new(),
        }
    }
}

/// One covariance matrix S = R Rᵀ, the entries of the triangle of R in units of
/// `scale`. Entries on the diagonal may have either sign and may be zero: the
/// likelihood is smooth where a variance vanishes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factor<const Q: usize> {
    pub structure: Structure,
    /// Unit of each parameter's standard deviation.
    pub scale: SVector<f64, Q>,
    /// Parameter in each row of the triangle: the first row is one standard
    /// deviation by itself, the second holds the correlation with it.
    pub order: [usize; Q],
}

impl<const Q: usize> Factor<Q> {
    pub(crate) fn count(&self) -> usize {
        self.structure.count(Q)
    }

    pub(crate) fn root(&self, theta: &[f64]) -> SMatrix<f64, Q, Q> {
        let mut out = SMatrix::zeros();
        for ((i, j), value) in self.structure.entries(Q).into_iter().zip(theta) {
            out[(self.order[i], j)] = self.scale[self.order[i]] * value;
        }
        out
    }

    /// Parameters of a covariance matrix; variances that are zero are raised a
    /// little, because zero is a stationary point.
    pub(crate) fn parameters(&self, covariance: &SMatrix<f64, Q, Q>, least: f64) -> Vec<f64> {
        let mut scaled = SMatrix::<f64, Q, Q>::from_fn(|i, j| {
            let (a, b) = (self.order[i], self.order[j]);
            covariance[(a, b)] / (self.scale[a] * self.scale[b])
        });
        for i in 0..Q {
            scaled[(i, i)] += least * least;
        }
        let lower = match scaled.cholesky() {
            Some(factor) => factor.l(),
            None => SMatrix::from_diagonal(&scaled.diagonal().map(|v| v.max(least * least).sqrt())),
        };
        let entries = self.structure.entries(Q).into_iter();
        match self.structure {
            Structure::Diagonal => entries.map(|(i, _)| scaled[(i, i)].sqrt()).collect(),
            _ => entries.map(|(i, j)| lower[(i, j)]).collect(),
        }
    }

    /// Derivatives by the parameters, where tr(G dS) is the change by S.
    pub(crate) fn gradient(
        &self,
        root: &SMatrix<f64, Q, Q>,
        by_covariance: &SMatrix<f64, Q, Q>,
    ) -> Vec<f64> {
        let by_root = 2.0 * by_covariance * root;
        let entries = self.structure.entries(Q).into_iter();
        entries
            .map(|(i, j)| self.scale[self.order[i]] * by_root[(self.order[i], j)])
            .collect()
    }
}

/// A level of variation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Level {
    /// Between fruit.
    Between,
    /// Between the impacts of one fruit.
    Within,
}

impl Level {
    /// Name in messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Between => "between",
            Self::Within => "within",
        }
    }
}

/// Both covariance matrices, that between fruit first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Variances<const Q: usize> {
    pub between: Factor<Q>,
    pub within: Factor<Q>,
}

impl<const Q: usize> Variances<Q> {
    /// The matrix of a level.
    pub(crate) fn of(&self, level: Level) -> &Factor<Q> {
        match level {
            Level::Between => &self.between,
            Level::Within => &self.within,
        }
    }

    /// R of both.
    pub(crate) fn roots(&self, theta: &DVector<f64>) -> [SMatrix<f64, Q, Q>; 2] {
        let (first, second) = theta.as_slice().split_at(self.between.count());
        [self.between.root(first), self.within.root(second)]
    }

    pub(crate) fn parameters(
        &self,
        between: &SMatrix<f64, Q, Q>,
        within: &SMatrix<f64, Q, Q>,
        least: f64,
    ) -> DVector<f64> {
        let mut out = self.between.parameters(between, least);
        out.extend(self.within.parameters(within, least));
        DVector::from_vec(out)
    }

    pub(crate) fn gradient(
        &self,
        roots: &[SMatrix<f64, Q, Q>; 2],
        by: [&SMatrix<f64, Q, Q>; 2],
    ) -> DVector<f64> {
        let mut out = self.between.gradient(&roots[0], by[0]);
        out.extend(self.within.gradient(&roots[1], by[1]));
        DVector::from_vec(out)
    }
}

/// The order in which `first` come before the others.
pub(crate) fn order_with<const Q: usize>(first: &[usize]) -> [usize; Q] {
    let rest = (0..Q).filter(|i| !first.contains(i));
    let mut all = first.iter().copied().chain(rest);
    std::array::from_fn(|_| all.next().unwrap_or(0))
}

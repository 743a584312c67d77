//! Ascending whole numbers, most of which follow on each other: rows that are kept, lines of
//! a file. A million of them without a gap take no more memory than one.

/// Ascending whole numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Runs {
    /// Place at which a run begins, and its first number.
    starts: Vec<(usize, usize)>,
    len: usize,
}

impl Runs {
    /// Appends a number, which is larger than those before it.
    pub fn push(&mut self, number: usize) {
        let next = self.starts.last();
        if next.map(|(place, first)| first + (self.len - place)) != Some(number) {
            self.starts.push((self.len, number));
        }
        self.len += 1;
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The number at a place, from 0.
    pub fn get(&self, place: usize) -> Option<usize> {
        let run = self.starts.partition_point(|start| start.0 <= place);
        let (begins, first) = *self.starts.get(run.checked_sub(1)?)?;
        (place < self.len).then_some(first + place - begins)
    }

    /// The numbers in their order.
    pub fn iter(&self) -> impl Iterator<Item = usize> {
        let ends = self.starts.iter().skip(1).map(|start| start.0);
        let runs = self.starts.iter().zip(ends.chain([self.len]));
        runs.flat_map(|((begins, first), end)| *first..first + (end - begins))
    }

    /// The numbers at some places, from 0.
    pub fn at(&self, places: &Self) -> Self {
        let mut found = Self::default();
        for run in places.within(0..places.len()) {
            self.within(run).for_each(|own| found.push_run(own));
        }
        found
    }

    /// Appends numbers, which are larger than those before them.
    pub fn append(&mut self, others: &Self) {
        let runs = others.within(0..others.len());
        runs.for_each(|run| self.push_run(run));
    }

    fn push_run(&mut self, mut run: std::ops::Range<usize>) {
        if let Some(first) = run.next() {
            self.push(first);
            self.len += run.len();
        }
    }

    /// Runs of numbers at some places, from 0, in their order.
    pub fn within(
        &self,
        places: std::ops::Range<usize>,
    ) -> impl Iterator<Item = std::ops::Range<usize>> {
        let first = self.starts.partition_point(|start| start.0 <= places.start);
        let own = &self.starts[first.saturating_sub(1)..];
        let ends = own.iter().skip(1).map(|start| start.0).chain([self.len]);
        let runs = own.iter().zip(ends).map(move |((begins, number), end)| {
            let (from, to) = (places.start.max(*begins), places.end.min(end));
            (from < to).then(|| number + from - begins..number + to - begins)
        });
        runs.map_while(|run| run)
    }
}

impl Extend<usize> for Runs {
    fn extend<I: IntoIterator<Item = usize>>(&mut self, numbers: I) {
        numbers.into_iter().for_each(|number| self.push(number));
    }
}

impl FromIterator<usize> for Runs {
    fn from_iter<I: IntoIterator<Item = usize>>(numbers: I) -> Self {
        let mut found = Self::default();
        found.extend(numbers);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_numbers_with_gaps() {
        let numbers = [2, 3, 4, 7, 9, 10];
        let runs: Runs = numbers.into_iter().collect();
        assert_eq!(runs.starts.len(), 3);
        assert!(runs.iter().eq(numbers));
        let at: Vec<Option<usize>> = (0..7).map(|place| runs.get(place)).collect();
        assert_eq!(at[..6], numbers.map(Some));
        assert_eq!((at[6], Runs::default().get(0)), (None, None));
        let places = [1, 2, 3, 5].into_iter().collect();
        assert!(runs.at(&places).iter().eq([3, 4, 7, 10]));
        assert_eq!(runs.at(&(0..6).collect()), runs);
        for from in 0..=6 {
            for to in from..=6 {
                let found = runs.within(from..to).flatten();
                assert!(found.eq(numbers[from..to].iter().copied()), "{from} {to}");
            }
        }
    }
}

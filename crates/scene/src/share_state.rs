//! What a rank carries from frame to frame, saved and taken up again on any number of ranks.

use crate::binary;
use crate::contacts::store::NONE;
use crate::energy::Account;
use crate::error::Error;
use crate::motion::simulation::FruitState;
use crate::share::{Seen, Share};
use crate::state::{PairState, Saved, WallContactState};
use crate::vector::Vector;

/// All that a rank remembers between two frames.
#[derive(Clone, Debug, Default)]
pub struct ShareState {
    frames: u64,
    rebuilds: u64,
    /// Fruit up to this number have been in the scene.
    released: usize,
    account: Account,
    /// Its own fruit, and those of others that it sees, by number.
    own: Vec<FruitState>,
    others: Vec<FruitState>,
    pairs: Vec<PairState>,
    walls: Vec<(u32, WallContactState)>,
}

binary!(ShareState {
    frames,
    rebuilds,
    released,
    account,
    own,
    others,
    pairs,
    walls
});

impl Share {
    /// The state now, to be written. From here on this share gives the same bits as one that takes
    /// up the state with [`Share::resume`]: like [`crate::motion::simulation::Simulation::checkpoint`]
    /// it forgets the order of its neighbour list.
    ///
    /// # Errors
    /// See [`Share::resume`].
    pub fn checkpoint(&mut self) -> Result<ShareState, Error> {
        let state = self.state();
        self.take_up(std::slice::from_ref(&state))?;
        Ok(state)
    }

    fn state(&self) -> ShareState {
        let states = |numbers: &[i32]| {
            let mut all: Vec<FruitState> = numbers
                .iter()
                .map(|number| self.last[*number as usize - 1])
                .collect();
            all.sort_unstable_by_key(|own| own.fruit);
            all
        };
        let (own, others) = self.numbers.split_at(self.local);
        ShareState {
            frames: self.simulation.steps,
            rebuilds: self.simulation.rebuilds,
            released: self.simulation.released,
            account: self.simulation.account,
            own: states(own),
            others: states(others),
            pairs: Saved(&self.simulation).pairs().collect(),
            walls: self.walls(|own| self.has(own)),
        }
    }

    /// Puts a new share where others were: it has what they had. The next frame hands over what
    /// belongs to other ranks by then.
    ///
    /// * `states`: of no rank where it had no fruit
    ///
    /// # Errors
    /// A state is of another scene, or a fruit is there twice.
    pub fn resume(&mut self, frames: u64, states: &[ShareState]) -> Result<(), Error> {
        if let Some(other) = states.iter().find(|own| own.frames != frames) {
            return Err(unfit(&format!(
                "it is of frame {}, where {frames} is to be",
                other.frames
            )));
        }
        self.simulation.steps = frames;
        self.take_up(states)
    }

    fn take_up(&mut self, states: &[ShareState]) -> Result<(), Error> {
        let mut own: Vec<FruitState> = states.iter().flat_map(|own| own.own.clone()).collect();
        own.sort_by_key(|own| own.fruit);
        let has = |fruit: u32| own.binary_search_by_key(&fruit, |own| own.fruit).is_ok();
        let others = states.iter().flat_map(|own| own.others.clone());
        let mut others: Vec<FruitState> = others.filter(|own| !has(own.fruit)).collect();
        others.sort_by_key(|own| own.fruit);
        others.dedup_by_key(|own| own.fruit);
        let sees = |fruit: u32| {
            let other = others.binary_search_by_key(&fruit, |own| own.fruit);
            has(fruit) || other.is_ok()
        };
        let pairs: Vec<PairState> = states.iter().flat_map(|own| own.pairs.clone()).collect();
        let walls: Vec<_> = states.iter().flat_map(|own| own.walls.clone()).collect();
        let facets = self.simulation.walls.facets.len();
        let known = own
            .iter()
            .chain(&others)
            .all(|own| (own.fruit as usize) < self.known.len())
            && states.iter().all(|own| own.released <= self.known.len())
            && pairs.iter().all(|own| own.fruit.into_iter().all(sees))
            && walls
                .iter()
                .all(|(fruit, own)| has(*fruit) && (own.facet as usize) < facets);
        if !known {
            return Err(unfit("it is none of this scene"));
        }
        self.forget();
        for own in states {
            let simulation = &mut self.simulation;
            simulation.released = simulation.released.max(own.released);
            simulation.account = simulation.account.plus(&own.account);
        }
        let local = own.len();
        own.extend(others);
        self.see(&own, local, (&pairs, &walls))?;
        let rebuilds = states.iter().map(|own| own.rebuilds).max();
        self.simulation.rebuilds = rebuilds.unwrap_or(0);
        Ok(())
    }

    /// Nothing seen, and nothing counted.
    fn forget(&mut self) {
        (self.numbers, self.local) = (Vec::new(), 0);
        self.atom.fill(NONE);
        self.known.fill(false);
        self.simulation.foreign.fill(true);
        self.simulation.account = Account::default();
        self.simulation.released = 0;
    }

    /// Fruit as they were in the frame before, with the contacts of those that are its own.
    fn see(
        &mut self,
        fruit: &[FruitState],
        local: usize,
        (pairs, walls): (&[PairState], &[(u32, WallContactState)]),
    ) -> Result<(), Error> {
        let numbers: Vec<i32> = fruit.iter().map(|own| own.fruit as i32 + 1).collect();
        let of = |what: fn(&FruitState) -> Vector| fruit.iter().map(what).collect();
        let [place, velocity, spin]: [Vec<Vector>; 3] = [
            of(|own| own.place),
            of(|own| own.velocity),
            of(|own| own.spin),
        ];
        let seen = Seen {
            local,
            numbers: &numbers,
            place: &place,
            velocity: &velocity,
            spin: &spin,
        };
        self.differs(&seen)?;
        self.before = (Vec::new(), 0);
        for own in fruit {
            let number = own.fruit as usize;
            (self.last[number], self.known[number]) = (*own, true);
        }
        self.regroup(&seen, pairs, walls)
    }
}

fn unfit(problem: &str) -> Error {
    Error::StateUnfit {
        problem: problem.to_owned(),
    }
}

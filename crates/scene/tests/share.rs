//! A scene in parts, as ranks of an engine would have them, against the same scene in one.
#![allow(clippy::unwrap_used)]

use crate::follow::scene;
use windfall_scene::binary::Binary;
use windfall_scene::energy::Energy;
use windfall_scene::event::Event;
use windfall_scene::motion::simulation::{FruitState, Leaving, Simulation};
use windfall_scene::scene::{Fruit, Scene};
use windfall_scene::share::{Answer, Offer, Seen, Share};
use windfall_scene::share_state::ShareState;
use windfall_scene::vector::Vector;

/// Apples that roll and collide across the planes x = 0 and y = 0, and leave through a sink.
fn rolling() -> Scene {
    let mut scene = scene(2e-5);
    scene.fruit.clear();
    scene.sinks[0].low[0] = 0.06;
    for number in 0..24 {
        let (column, row) = (f64::from(number % 4), f64::from(number / 4));
        let place = [0.09 * column - 0.3, 0.078 * row - 0.2, 0.036 + 0.004 * row];
        let mut own = Fruit::sphere(0, 0.035 + 0.0005 * row, 840.0, place);
        own.velocity = [1.0 - 0.25 * column, 0.15 * (2.0 - row), -0.2];
        scene.fruit.push(own);
    }
    scene
}

/// A scene in parts: which part has a fruit is asked now and then, as engines do.
struct Parts {
    shares: Vec<Share>,
    own: Vec<Vec<u32>>,
    ghosts: Vec<Vec<u32>>,
    handed: usize,
}

fn moved<T: Binary>(own: &T) -> T {
    let mut bytes = Vec::new();
    own.write(&mut bytes).unwrap();
    T::read(&mut &bytes[..]).unwrap()
}

impl Parts {
    fn new(count: usize) -> Self {
        let share = || Share::new(rolling(), 1).unwrap();
        Self {
            shares: (0..count).map(|_| share()).collect(),
            own: vec![Vec::new(); count],
            ghosts: vec![Vec::new(); count],
            handed: 0,
        }
    }

    fn part_of(&self, place: Vector) -> usize {
        let side = [0, 1].map(|axis| usize::from(place[axis] > 0.0));
        (side[0] + 2 * side[1]) % self.shares.len()
    }

    /// Who has and sees what from now on.
    fn divide(&mut self, fruit: &[FruitState]) {
        let before = self.own.clone();
        for part in 0..self.shares.len() {
            let own: Vec<&FruitState> = fruit
                .iter()
                .filter(|own| self.part_of(own.place) == part)
                .collect();
            let near = |state: &&FruitState| {
                own.iter().any(|own| {
                    let way = [0, 1, 2].map(|axis| own.place[axis] - state.place[axis]);
                    way.iter().map(|own| own * own).sum::<f64>() < 0.09 * 0.09
                })
            };
            let others = fruit.iter().filter(|own| self.part_of(own.place) != part);
            self.ghosts[part] = others.filter(near).map(|own| own.fruit).collect();
            self.own[part] = own.iter().map(|own| own.fruit).collect();
        }
        let gone = before.iter().zip(&self.own);
        let gone = gone.map(|(old, new)| old.iter().filter(|own| !new.contains(own)).count());
        self.handed += gone.sum::<usize>();
    }

    fn follow(&mut self, fruit: &[FruitState], with_energy: bool) -> Energy {
        let find = |number: &u32| fruit.iter().find(|own| own.fruit == *number);
        let mut all = Vec::new();
        for part in 0..self.shares.len() {
            self.own[part].retain(|own| find(own).is_some());
            self.ghosts[part].retain(|own| find(own).is_some());
            let numbers = self.own[part].iter().chain(&self.ghosts[part]);
            let states: Vec<FruitState> = numbers.map(|own| *find(own).unwrap()).collect();
            let of = |what: fn(&FruitState) -> Vector| states.iter().map(what).collect();
            let numbers: Vec<i32> = states.iter().map(|own| own.fruit as i32 + 1).collect();
            let vectors: [Vec<Vector>; 3] = [
                of(|own| own.place),
                of(|own| own.velocity),
                of(|own| own.spin),
            ];
            all.push((numbers, vectors));
        }
        let seen = |part: usize, local: usize| {
            let (numbers, [place, velocity, spin]) = &all[part];
            Seen {
                local,
                numbers,
                place,
                velocity,
                spin,
            }
        };
        let seen: Vec<Seen> = (0..self.own.len())
            .map(|part| seen(part, self.own[part].len()))
            .collect();
        let shares = self.shares.iter_mut().zip(&seen);
        let differs: Vec<bool> = shares
            .map(|(own, seen)| own.differs(seen).unwrap())
            .collect();
        if differs.contains(&true) {
            let offers: Vec<Offer> = self.shares.iter().map(|own| moved(&own.offer())).collect();
            let answers = self.shares.iter().map(|own| moved(&own.answer(&offers)));
            let answers: Vec<Answer> = answers.collect();
            for (own, seen) in self.shares.iter_mut().zip(&seen) {
                own.settle(seen, &offers, &answers).unwrap();
            }
        }
        let shares = self.shares.iter_mut().zip(&seen);
        shares.fold(Energy::default(), |sum, (own, seen)| {
            sum.plus(&own.follow(seen, with_energy).unwrap())
        })
    }

    fn events(&mut self) -> (Vec<Event>, Vec<Leaving>, Vec<FruitState>) {
        let (mut events, mut left, mut fruit) = (Vec::new(), Vec::new(), Vec::new());
        for own in &mut self.shares {
            events.extend(own.take_events());
            events.extend(own.lasting());
            left.extend(own.take_leavings());
            fruit.extend(own.fruit());
        }
        events.sort_by_key(|own| (own.fruit, own.partner, own.number, own.time.to_bits()));
        left.sort_by_key(|own| own.fruit);
        fruit.sort_by_key(|own| own.fruit);
        (events, left, fruit)
    }
}

#[test]
fn repeats_pulses_to_the_last_bit_in_any_number_of_parts() {
    let mut parts = [1, 2, 4].map(Parts::new);
    let mut own = Simulation::new(rolling()).unwrap();
    let mut energies = [Energy::default(); 3];
    let steps = 40_000;
    for step in 0..=steps {
        let fruit = own.fruit();
        for (part, energy) in parts.iter_mut().zip(&mut energies) {
            if step % 50 == 0 {
                part.divide(&fruit);
            }
            *energy = part.follow(&fruit, step == steps);
        }
        own.step().unwrap();
    }
    let [one, two, four] = &mut parts;
    assert!(
        two.handed > 15 && four.handed > 15,
        "{} {}",
        two.handed,
        four.handed
    );
    let found = one.events();
    let (events, left, fruit) = &found;
    assert!(
        events.len() > 100 && left.len() > 2,
        "{} {}",
        events.len(),
        left.len()
    );
    // Contacts of fruit with fruit and loads after the first are among them.
    assert!(events.iter().any(|own| own.number > 1));
    assert_eq!(left.len() + fruit.len(), 24);
    assert_eq!(&two.events(), &found);
    assert_eq!(&four.events(), &found);
    let [one, two, four] = energies;
    for other in [two, four] {
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * one.lost();
        assert!(near(other.lost(), one.lost()) && near(other.closure(), one.closure()));
    }
    // They are the pulses of the simulation itself.
    let mut hard: Vec<f64> = own.take_events().iter().map(|own| own.peak_force).collect();
    let mut followed: Vec<f64> = found.0.iter().map(|own| own.peak_force).collect();
    for all in [&mut hard, &mut followed] {
        all.sort_by(|a, b| b.total_cmp(a));
    }
    for (own, wanted) in followed.iter().zip(&hard).take(50) {
        assert!((own / wanted - 1.0).abs() < 1e-3, "{own} {wanted}");
    }
}

/// Other parts where these were, each of which takes up what some of them had.
fn resumed(parts: &mut Parts, count: usize) -> Parts {
    let frames = parts.shares[0].frames();
    let states = parts.shares.iter_mut();
    let states: Vec<ShareState> = states
        .map(|own| moved(&own.checkpoint().unwrap()))
        .collect();
    let mut new = Parts::new(count);
    for (part, own) in new.shares.iter_mut().enumerate() {
        let taken = states.iter().skip(part).step_by(count).cloned();
        let taken: Vec<ShareState> = taken.collect();
        own.resume(frames, &taken).unwrap();
    }
    new
}

#[test]
fn repeats_pulses_to_the_last_bit_where_parts_resume_on_any_number() {
    let mut whole = Parts::new(2);
    let mut parts = [2, 1, 4].map(|_| Parts::new(2));
    let mut own = Simulation::new(rolling()).unwrap();
    let mut before: [(Vec<Event>, Vec<Leaving>); 3] = Default::default();
    let mut energies = [Energy::default(); 4];
    let steps = 24_000;
    for step in 0..=steps {
        let fruit = own.fruit();
        // Not where parts are divided anew, and twice.
        if step == 7_020 || step == 13_777 {
            resumed(&mut whole, 1);
            for ((part, count), kept) in parts.iter_mut().zip([2, 1, 4]).zip(&mut before) {
                let shares = || 0..part.shares.len();
                for share in shares() {
                    kept.0.extend(part.shares[share].take_events());
                    kept.1.extend(part.shares[share].take_leavings());
                }
                *part = resumed(part, count);
                part.divide(&fruit);
            }
            whole.divide(&fruit);
        }
        let all = std::iter::once(&mut whole).chain(&mut parts);
        for (part, energy) in all.zip(&mut energies) {
            if step % 50 == 0 {
                part.divide(&fruit);
            }
            *energy = part.follow(&fruit, step == steps);
        }
        own.step().unwrap();
    }
    let found = whole.events();
    assert!(found.0.len() > 60 && found.1.len() > 1, "{found:?}");
    for (part, (events, left)) in parts.iter_mut().zip(before) {
        let mut other = part.events();
        other.0.extend(events);
        other.1.extend(left);
        let key = |own: &Event| (own.fruit, own.partner, own.number, own.time.to_bits());
        other.0.sort_by_key(key);
        other.1.sort_by_key(|own| own.fruit);
        for (a, b) in other.0.iter().zip(&found.0) {
            assert_eq!(a, b);
        }
        assert_eq!(other.0.len(), found.0.len());
        assert_eq!(other.1, found.1);
        for (a, b) in other.2.iter().zip(&found.2) {
            assert_eq!(a, b);
        }
        assert!(other == found);
    }
    let [whole, same, others @ ..] = energies;
    assert_eq!(same, whole);
    for other in others {
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * whole.lost();
        assert!(near(other.lost(), whole.lost()) && near(other.closure(), whole.closure()));
    }
}

#[test]
fn rejects_states_of_other_frames_and_of_fruit_that_the_scene_has_not() {
    let mut parts = Parts::new(1);
    let own = Simulation::new(rolling()).unwrap();
    parts.divide(&own.fruit());
    parts.follow(&own.fruit(), false);
    let state = parts.shares[0].checkpoint().unwrap();
    let mut scene = rolling();
    let problem = Share::new(scene.clone(), 1)
        .unwrap()
        .resume(3, std::slice::from_ref(&state));
    let problem = problem.unwrap_err().to_string();
    assert!(problem.contains("frame 1, where 3"), "{problem}");
    scene.fruit.truncate(7);
    let problem = Share::new(scene, 1).unwrap().resume(1, &[state]);
    let problem = problem.unwrap_err().to_string();
    assert!(problem.contains("none of this scene"), "{problem}");
}

#[test]
fn rejects_fruit_that_are_none_and_that_are_there_twice() {
    let place = [[0.0; 3]; 2];
    for numbers in [[1, 25], [0, 1], [3, 3], [-4, 1]] {
        let mut share = Share::new(rolling(), 1).unwrap();
        let seen = Seen {
            local: 2,
            numbers: &numbers,
            place: &place,
            velocity: &place,
            spin: &place,
        };
        let problem = share.differs(&seen).unwrap_err().to_string();
        assert!(problem.contains("fruit"), "{problem}");
    }
}

//! Eight sets in lanes give what each gives alone, to the last bit.
#![allow(clippy::unwrap_used)]

use std::rc::Rc;

use proptest::prelude::*;
use simgap_integrate::exact::lanes::{Batch, LaneObserver, LaneSamples, LaneSet};
use simgap_integrate::exact::{
    Element, ExactPropagator, Excitation, Followed, ForceLaw, MemberMotion, Snapshot, Tangent,
};
use simgap_model::{Node, StructuralMatrices};

/// Stiffening spring with a damper that depends on the speed.
struct Cubic {
    cubic: f64,
    quadratic: f64,
}

impl ForceLaw for Cubic {
    simgap_integrate::lanes!(cubic, quadratic);

    fn force(&self, at: MemberMotion) -> f64 {
        self.cubic * at.displacement.powi(3) + self.quadratic * at.velocity.abs() * at.velocity
    }
}

/// Friction with a level that falls with the speed.
struct Dry {
    level: f64,
    excess: f64,
}

impl ForceLaw for Dry {
    simgap_integrate::lanes!(level, excess);

    fn force(&self, _: MemberMotion) -> f64 {
        0.0
    }

    fn dry_level(&self, speed: f64) -> Option<f64> {
        Some(self.level + self.excess / (1.0 + 100.0 * speed * speed))
    }
}

/// A spring that slips at a force; with a clock besides.
struct Slip {
    stiffness: f64,
    limit: f64,
}

impl ForceLaw for Slip {
    simgap_integrate::lanes!(stiffness, limit);

    fn force(&self, _: MemberMotion) -> f64 {
        0.0
    }

    fn remembers(&self) -> bool {
        true
    }

    fn first_memory(&self) -> f64 {
        0.1 * self.limit
    }

    fn follow_step(&self, memory: f64, _: f64, from: MemberMotion, to: MemberMotion) -> Followed {
        let force = memory + self.stiffness * (to.displacement - from.displacement);
        let force = force.max(-self.limit).min(self.limit);
        Followed::arrived(force + 0.01 * self.limit * to.time_s, force)
    }
}

/// As [`Slip`] without the clock, followed in strides; slower against its force.
struct Strides {
    stiffness: f64,
    limit: f64,
    stride: f64,
}

impl ForceLaw for Strides {
    simgap_integrate::lanes!(stiffness, limit, stride);

    fn force(&self, _: MemberMotion) -> f64 {
        0.0
    }

    fn remembers(&self) -> bool {
        true
    }

    fn follow_step(
        &self,
        memory: f64,
        left: f64,
        from: MemberMotion,
        to: MemberMotion,
    ) -> Followed {
        let moved = to.displacement - from.displacement;
        let way = moved.abs() * left;
        let went = way.min(self.stride);
        let share = if memory * moved < 0.0 { 0.5 } else { 1.0 };
        let force = memory + share * self.stiffness * went.copysign(moved);
        let memory = force.max(-self.limit).min(self.limit);
        Followed {
            force: memory,
            memory,
            left: if went < way {
                (left - went / moved.abs()).max(0.0)
            } else {
                0.0
            },
        }
    }
}

/// A damper that sets in with a jump beyond a point, in some sets.
struct Beyond {
    damping: f64,
    point: f64,
}

impl ForceLaw for Beyond {
    simgap_integrate::lanes!(damping, point);

    fn force(&self, at: MemberMotion) -> f64 {
        self.damping * at.velocity * at.set_in(at.displacement - self.point)
    }

    fn is_spread_over_steps(&self) -> bool {
        self.damping > 0.0
    }
}

/// A damper whose force grows with the root of the speed, solved with others of its kind or after them.
struct Throttle<const TOGETHER: bool> {
    gain: f64,
}

impl<const TOGETHER: bool> ForceLaw for Throttle<TOGETHER> {
    simgap_integrate::lanes!(gain);

    fn force(&self, at: MemberMotion) -> f64 {
        self.tangent(at).force
    }

    fn has_tangent(&self) -> bool {
        TOGETHER
    }

    fn tangent(&self, at: MemberMotion) -> Tangent {
        let square = at.velocity * at.velocity + 1e-4;
        let per_speed = self.gain / square.sqrt().sqrt();
        Tangent {
            force: per_speed * at.velocity,
            damping: per_speed * (1.0 - 0.5 * at.velocity * at.velocity / square),
        }
    }
}

/// As [`Cubic`] without lanes of its own.
struct Alone(Cubic);

impl ForceLaw for Alone {
    fn force(&self, at: MemberMotion) -> f64 {
        self.0.force(at)
    }
}

/// What drives a set, alone or with others.
struct Drive {
    force: Vec<f64>,
    bases: usize,
    base: [Vec<f64>; 2],
    samples: usize,
}

/// Waves on `n` masses and `bases` bases.
fn drive(n: usize, bases: usize, phase: f64, samples: usize) -> Drive {
    let wave = |k: usize, w: f64| (w * k as f64 * STEP_S + phase).sin();
    let waves = |width: usize, size: f64, w: f64| -> Vec<f64> {
        (0..samples * width)
            .map(|k| size * wave(k / width, w + (k % width) as f64))
            .collect()
    };
    Drive {
        force: waves(n, 9.0, 7.0),
        bases,
        base: [waves(bases, 0.02, 5.0), waves(bases, 0.1, 4.0)],
        samples,
    }
}

/// One parameter set with what it needs to be marched.
struct Set {
    propagator: ExactPropagator,
    elements: Vec<Element>,
    drive: Rc<Drive>,
    start: [Vec<f64>; 2],
    start_s: f64,
}

const STEP_S: f64 = 0.02;

/// Where laws stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Places {
    Apart,
    /// All between the first mass and the ground: one joint, or some.
    AtOne,
    /// All between a base, or the first mass, and the last: likewise.
    AtTheOther,
}

/// A chain of `n` masses between moving bases and the ground, laws as the digits of `laws` say.
fn set(
    n: usize,
    (laws, places): (&[u8], Places),
    substeps: usize,
    numbers: &[f64],
    drive: &Rc<Drive>,
) -> Set {
    let number = |i: usize| numbers[i % numbers.len()];
    let chain = |value: f64| {
        faer::Mat::from_fn(n, n, |i, j| match i.abs_diff(j) {
            0 => 2.0 * value * (1.0 + 0.1 * number(i)),
            1 => -value,
            _ => 0.0,
        })
    };
    let structure = StructuralMatrices {
        mass_matrix: faer::Mat::from_fn(n, n, |i, j| {
            if i == j {
                1.0 + 0.3 * number(i + 1).abs()
            } else {
                0.0
            }
        }),
        damping_matrix: chain(0.6),
        stiffness_matrix: chain(150.0),
    };
    let elements = laws.iter().enumerate().map(|(i, kind)| {
        let mass = |i: usize| match n {
            0 => Node::Ground,
            n => Node::Dof(i % n),
        };
        let (a, b) = match i % 3 {
            _ if places == Places::AtOne => (mass(0), Node::Ground),
            _ if places == Places::AtTheOther && drive.bases > 0 => {
                (Node::Base(drive.bases - 1), mass(n.saturating_sub(1)))
            }
            _ if places == Places::AtTheOther && n > 1 => (mass(0), mass(n - 1)),
            _ if places == Places::AtTheOther => (Node::Ground, mass(0)),
            0 => (mass(i), Node::Ground),
            1 if drive.bases > 0 => (mass(0), Node::Base(i % drive.bases)),
            _ => (mass(i), mass(i + 1)),
        };
        let size = 1.0 + 0.5 * number(i + 2);
        let cubic = Cubic {
            cubic: 2e3 * size,
            quadratic: 3.0 * size,
        };
        let law: Box<dyn ForceLaw> = match kind {
            0 => Box::new(cubic),
            1 => Box::new(Dry {
                level: 2.0 * size,
                excess: size,
            }),
            // Sets beside each other may follow the same member in different ways.
            3 | 4 if *kind == 3 || number(6) > 0.0 => Box::new(Strides {
                stiffness: 60.0 * size,
                limit: 3.0 * size,
                stride: 0.004 * size,
            }),
            2 | 4 => Box::new(Slip {
                stiffness: 60.0 * size,
                limit: 3.0 * size,
            }),
            6 => Box::new(Beyond {
                damping: (3.0 * number(i + 3)).max(0.0),
                point: 0.01 * number(i + 1),
            }),
            7 => Box::new(Throttle::<true> { gain: 4.0 * size }),
            8 => Box::new(Throttle::<false> { gain: 4.0 * size }),
            _ => Box::new(Alone(cubic)),
        };
        Element::between(a, b, law)
    });
    Set {
        propagator: ExactPropagator::new(&structure, STEP_S / substeps as f64).unwrap(),
        elements: elements.collect(),
        drive: Rc::clone(drive),
        start: [
            (0..n).map(|i| 0.02 * number(i)).collect(),
            (0..n).map(|i| 0.3 * number(i + 4)).collect(),
        ],
        start_s: number(5),
    }
}

impl Set {
    fn excitation(&self, substeps: usize) -> Excitation<'_> {
        Excitation {
            dof_force: &self.drive.force,
            base_displacement: &self.drive.base[0],
            base_velocity: &self.drive.base[1],
            base_count: self.drive.bases,
            sample_count: self.drive.samples,
            start_s: self.start_s,
            substeps,
        }
    }

    fn lanes(&self, substeps: usize) -> LaneSet<'_> {
        LaneSet {
            propagator: &self.propagator,
            elements: &self.elements,
            excitation: self.excitation(substeps),
            displacement: &self.start[0],
            velocity: &self.start[1],
        }
    }

    /// Every number of every sample, set by set; of the accelerations every so many.
    fn alone(&self, substeps: usize, every: usize) -> Vec<f64> {
        let mut path = Vec::new();
        let mut acceleration = vec![0.0; self.start[0].len()];
        self.propagator.march(
            &self.elements,
            &self.excitation(substeps),
            &self.start[0],
            &self.start[1],
            &mut |at: &Snapshot<'_>| {
                self.propagator.acceleration(at, &mut acceleration);
                for (i, value) in acceleration.iter_mut().enumerate() {
                    *value = if i % every == 0 { *value } else { 0.0 };
                }
                for part in [
                    at.displacement,
                    at.velocity,
                    at.element_force,
                    &acceleration,
                ] {
                    path.extend_from_slice(part);
                }
            },
        );
        path
    }
}

/// Collects the same from a batch.
struct Paths(Vec<Vec<f64>>, Vec<usize>, usize);

impl LaneObserver for Paths {
    fn reads_acceleration(&self, coordinate: usize) -> bool {
        coordinate.is_multiple_of(self.2)
    }

    fn observe(&mut self, samples: &LaneSamples<'_>) {
        let lanes = (0..samples.count).flat_map(|k| (0..samples.set_count).map(move |l| (k, l)));
        for (k, lane) in lanes {
            let set = samples.first_set + lane;
            if samples.first + k >= self.1[set] {
                continue;
            }
            for part in [
                samples.displacement(k),
                samples.velocity(k),
                samples.element_force(k),
                samples.acceleration(k),
            ] {
                self.0[set].extend(part.iter().map(|pack| pack.0[lane]));
            }
        }
    }
}

fn together(sets: &[Set], substeps: usize, every: usize) -> Vec<Vec<f64>> {
    let lanes = sets.iter().map(|set| set.lanes(substeps)).collect();
    let counts = sets.iter().map(|set| set.drive.samples).collect();
    let mut paths = Paths(vec![vec![]; sets.len()], counts, every);
    Batch::new(lanes).unwrap().march(&mut paths);
    paths.0
}

fn bits(path: &[f64]) -> Vec<u64> {
    path.iter().map(|value| value.to_bits()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Batches of any size, with any neighbours, of which some share what drives them, against one
    /// set at a time.
    #[test]
    fn prop_lanes_are_the_sets_to_the_last_bit(
        n in 0_usize..8,
        bases in 0_usize..3,
        laws in proptest::collection::vec(0_u8..9, 0..5),
        places in prop_oneof![
            Just(Places::Apart),
            Just(Places::AtOne),
            Just(Places::AtTheOther)
        ],
        substeps in 1_usize..4,
        every in 1_usize..4,
        drives in proptest::collection::vec((-1.0_f64..1.0, 0_usize..60), 1..5),
        numbers in proptest::collection::vec(
            (proptest::collection::vec(-1.0_f64..1.0, 7), 0_usize..4), 1..20),
    ) {
        let drives: Vec<Rc<Drive>> = drives
            .iter()
            .map(|(phase, samples)| Rc::new(drive(n, bases, *phase, *samples)))
            .collect();
        let sets: Vec<Set> = numbers
            .iter()
            .map(|(numbers, k)| set(n, (&laws, places), substeps, numbers, &drives[k % drives.len()]))
            .collect();
        for (lanes, set) in together(&sets, substeps, every).iter().zip(&sets) {
            let alone = set.alone(substeps, every);
            prop_assert!(alone.iter().all(|value| value.is_finite()));
            prop_assert_eq!(bits(lanes), bits(&alone));
        }
    }
}

/// What the accuracy of the forces leaves of the path of a plant over 60 samples.
const FORCES: f64 = 1e-6;

#[test]
fn verify_laws_solved_together_are_those_solved_one_after_the_other() {
    let drive = Rc::new(drive(5, 0, 0.3, 60));
    let numbers = [0.4, -0.7, 0.2, 0.9, -0.3, 0.1, 0.6];
    // Beside them a law that is not.
    for beside in [vec![], vec![0_u8], vec![1]] {
        let path = |kind: u8| {
            let laws = [vec![kind; 3], beside.clone()].concat();
            set(5, (&laws, Places::Apart), 2, &numbers, &drive).alone(2, 1)
        };
        let (one, other) = (path(7), path(8));
        let size = other
            .iter()
            .fold(0.0_f64, |size, value| size.max(value.abs()));
        let off = one.iter().zip(&other).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f64::max) / size;
        assert!(off < FORCES, "{off} beside {beside:?}");
        let free = set(5, (&beside, Places::Apart), 2, &numbers, &drive).alone(2, 1);
        assert!(free.len() != one.len() && one.iter().all(|value| value.is_finite()));
    }
}

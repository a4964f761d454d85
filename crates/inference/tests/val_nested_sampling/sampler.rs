//! Nested sampling: an integral over a prior, without any quadratic.
//!
//! ```text
//! Z = ∫ L dX,   X(λ) = prior mass where L > λ                             (1)
//! Z ≈ Σ_i L_i (X_{i−1} − X_i) + X_end ⟨L⟩,   X_i = e^{−i/n}               (2)
//! H = Σ_i p_i ln(L_i / Z),   σ(ln Z) = √(H/n)                             (3)
//! ```
//!
//! n points live, drawn from the prior. The worst of them, L_i, leaves; a draw from the prior where L > L_i takes its place;
//! p_i are the terms of (2) over their sum. The prior is even over the unit cube.
//!
//! Draws are even over an ellipsoid about all living points, made larger by [`LARGER`], and those above L_i are kept. Where
//! hardly one is kept, points walk: slice sampling along chords of that ellipsoid, from points that live.
//!
//! Reference: \[Skilling2006\].

use faer::{Mat, Side};

use crate::random::Random;

/// Radius of the ellipsoid of draws over that which holds the living points: what lies beyond them has room.
const LARGER: f64 = 1.1;
/// The same for its volume, at the least.
const LARGER_IN_VOLUME: f64 = 1.5;
/// Draws that are evaluated together.
const TOGETHER: usize = 64;
/// Draws from the ellipsoid over those kept from which on points walk, and steps of a walk for each dimension.
const FEW: usize = 100;
const STEPS: usize = 3;
/// Length of a chord that a walk gives up, in standard deviations of the living points.
const SHORTEST: f64 = 1e-9;
/// Part of Z that the living points may hold at the end, as their sum is a mean of few.
const REST: f64 = 0.01;

pub(crate) struct Settings {
    /// Points that live.
    pub(crate) live: usize,
    pub(crate) seed: u64,
    /// Points walk from the beginning: a second way to draw, to hold the first against.
    pub(crate) walks: bool,
}

/// What nested sampling finds of an integral.
pub(crate) struct Found {
    pub(crate) log_z: f64,
    /// √(H/n) of (3).
    pub(crate) error: f64,
    /// H of (3).
    pub(crate) information: f64,
    /// Points at which the likelihood was asked for.
    pub(crate) evaluations: usize,
    /// Whether points ever walked.
    pub(crate) walked: bool,
}

/// The log-likelihood at many points of the unit cube; minus infinity where the prior has no density.
pub(crate) type LogLikelihood<'a> = dyn FnMut(&[Vec<f64>]) -> Vec<f64> + 'a;

/// ln of ∫ L over the unit cube.
pub(crate) fn nested_sampling(
    dim: usize,
    likelihood: &mut LogLikelihood<'_>,
    settings: &Settings,
) -> Found {
    let n = settings.live as f64;
    let mut source = Source {
        random: Random::new(settings.seed),
        likelihood,
        evaluations: 0,
        ready: vec![],
        walks: settings.walks,
        walked: settings.walks,
    };
    let (mut live, mut values, log_support) = source.first(dim, settings.live);
    let mut terms: Vec<(f64, f64)> = vec![];
    let mut log_z = f64::NEG_INFINITY;
    let mut log_x = log_support;
    let log_share = (1.0 - (-1.0 / n).exp()).ln();
    loop {
        let best = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if log_x + best < log_z + REST.ln() {
            break;
        }
        let worst = (0..values.len())
            .min_by(|&a, &b| values[a].total_cmp(&values[b]))
            .unwrap();
        let floor = values[worst];
        terms.push((floor, log_x + log_share));
        log_z = log_sum(log_z, floor + log_x + log_share);
        log_x -= 1.0 / n;
        (live[worst], values[worst]) = source.above(floor, &live);
    }
    for value in values {
        terms.push((value, log_x - n.ln()));
        log_z = log_sum(log_z, value + log_x - n.ln());
    }
    let share =
        |&(value, log_width): &(f64, f64)| (value + log_width - log_z).exp() * (value - log_z);
    let information: f64 = terms.iter().map(share).sum();
    Found {
        log_z,
        error: (information.max(0.0) / n).sqrt(),
        information,
        evaluations: source.evaluations,
        walked: source.walked,
    }
}

fn log_sum(a: f64, b: f64) -> f64 {
    let (large, small) = if a > b { (a, b) } else { (b, a) };
    if large == f64::NEG_INFINITY {
        return large;
    }
    large + (small - large).exp().ln_1p()
}

/// Where draws come from.
struct Source<'a, 'b> {
    random: Random,
    likelihood: &'a mut LogLikelihood<'b>,
    evaluations: usize,
    /// Draws that are evaluated and not yet used.
    ready: Vec<(Vec<f64>, f64)>,
    walks: bool,
    walked: bool,
}

impl Source<'_, '_> {
    /// Points from the prior where it has density, and ln of the part of the cube that it has.
    fn first(&mut self, dim: usize, count: usize) -> (Vec<Vec<f64>>, Vec<f64>, f64) {
        let (mut live, mut values) = (vec![], vec![]);
        let mut drawn = 0;
        while live.len() < count {
            let draws: Vec<Vec<f64>> = (0..TOGETHER)
                .map(|_| (0..dim).map(|_| self.random.uniform()).collect())
                .collect();
            for (point, value) in self.evaluated(draws) {
                if live.len() < count {
                    drawn += 1;
                    if value > f64::NEG_INFINITY {
                        live.push(point);
                        values.push(value);
                    }
                }
            }
        }
        (live, values, (count as f64 / f64::from(drawn)).ln())
    }

    fn evaluated(
        &mut self,
        points: Vec<Vec<f64>>,
    ) -> impl Iterator<Item = (Vec<f64>, f64)> + use<> {
        self.evaluations += points.len();
        let values = (self.likelihood)(&points);
        points.into_iter().zip(values)
    }

    /// A draw from the prior where the log-likelihood is above a floor. What was drawn for a lower floor and is above this
    /// one is as good.
    fn above(&mut self, floor: f64, live: &[Vec<f64>]) -> (Vec<f64>, f64) {
        let mut in_vain = 0;
        loop {
            while let Some((point, value)) = self.ready.pop() {
                if value > floor {
                    return (point, value);
                }
            }
            let ellipsoid = Ellipsoid::about(live);
            if self.walks || in_vain >= FEW {
                self.walked = true;
                self.ready = self.walk(floor, live, &ellipsoid);
            } else {
                let draws = (0..TOGETHER)
                    .map(|_| ellipsoid.draw(&mut self.random))
                    .collect();
                self.ready = self
                    .evaluated(draws)
                    .filter(|(_, value)| *value > floor)
                    .collect();
                in_vain += TOGETHER;
            }
        }
    }

    /// Points that have walked from living ones above a floor, side by side.
    fn walk(
        &mut self,
        floor: f64,
        live: &[Vec<f64>],
        ellipsoid: &Ellipsoid,
    ) -> Vec<(Vec<f64>, f64)> {
        let dim = ellipsoid.centre.len();
        let mut walkers: Vec<Walker> = (0..TOGETHER)
            .map(|_| {
                let start = live[self.random.index(live.len())].clone();
                Walker::new(start, ellipsoid, &mut self.random)
            })
            .collect();
        loop {
            let moving: Vec<usize> = (0..walkers.len())
                .filter(|&k| walkers[k].taken < STEPS * dim)
                .collect();
            if moving.is_empty() {
                break;
            }
            let tried: Vec<f64> = moving
                .iter()
                .map(|&k| walkers[k].try_at(&mut self.random))
                .collect();
            let points = moving
                .iter()
                .zip(&tried)
                .map(|(&k, &along)| walkers[k].at(along))
                .collect();
            for ((point, value), (&k, &along)) in
                self.evaluated(points).zip(moving.iter().zip(&tried))
            {
                // The start itself is above the floor of the walk, or at it.
                if value > floor {
                    walkers[k].moves(point, value, ellipsoid, &mut self.random);
                } else {
                    walkers[k].shrinks(along, ellipsoid, &mut self.random);
                }
            }
        }
        walkers
            .into_iter()
            .map(|walker| (walker.here, walker.value))
            .collect()
    }
}

/// A point on its way, by slice sampling along one line after the other.
struct Walker {
    here: Vec<f64>,
    value: f64,
    direction: Vec<f64>,
    /// Ends of the chord, from `here` along `direction`.
    chord: [f64; 2],
    taken: usize,
}

impl Walker {
    fn new(here: Vec<f64>, ellipsoid: &Ellipsoid, random: &mut Random) -> Walker {
        let (direction, chord) = ellipsoid.chord(&here, random);
        Walker {
            here,
            value: f64::NEG_INFINITY,
            direction,
            chord,
            taken: 0,
        }
    }

    fn try_at(&self, random: &mut Random) -> f64 {
        self.chord[0] + (self.chord[1] - self.chord[0]) * random.uniform()
    }

    fn at(&self, along: f64) -> Vec<f64> {
        self.here
            .iter()
            .zip(&self.direction)
            .map(|(x, d)| x + along * d)
            .collect()
    }

    fn moves(&mut self, point: Vec<f64>, value: f64, ellipsoid: &Ellipsoid, random: &mut Random) {
        (self.here, self.value) = (point, value);
        self.taken += 1;
        (self.direction, self.chord) = ellipsoid.chord(&self.here, random);
    }

    /// Shortens the chord; one so short that nothing on it is above the floor is left for another.
    fn shrinks(&mut self, along: f64, ellipsoid: &Ellipsoid, random: &mut Random) {
        self.chord[usize::from(along > 0.0)] = along;
        if self.chord[1] - self.chord[0] < SHORTEST {
            (self.direction, self.chord) = ellipsoid.chord(&self.here, random);
        }
    }
}

/// x = centre + radius · L z, |z| ≤ 1, with L Lᵀ the covariance of points that it holds.
struct Ellipsoid {
    centre: Vec<f64>,
    lower: Mat<f64>,
    radius: f64,
}

impl Ellipsoid {
    fn about(points: &[Vec<f64>]) -> Ellipsoid {
        let (dim, count) = (points[0].len(), points.len() as f64);
        let mean = |i: usize| points.iter().map(|p| p[i]).sum::<f64>() / count;
        let centre: Vec<f64> = (0..dim).map(mean).collect();
        let mut covariance = Mat::<f64>::zeros(dim, dim);
        for point in points {
            for i in 0..dim {
                for j in 0..=i {
                    covariance[(i, j)] += (point[i] - centre[i]) * (point[j] - centre[j]) / count;
                }
            }
        }
        let factor = covariance.llt(Side::Lower).unwrap();
        let mut ellipsoid = Ellipsoid {
            centre,
            lower: factor.L().to_owned(),
            radius: 1.0,
        };
        let most = points
            .iter()
            .map(|point| square(&ellipsoid.inward(point)))
            .fold(0.0, f64::max);
        ellipsoid.radius = most.sqrt() * LARGER.max(LARGER_IN_VOLUME.powf(1.0 / dim as f64));
        ellipsoid
    }

    /// z of a point, times the radius.
    fn inward(&self, point: &[f64]) -> Vec<f64> {
        let from_centre: Vec<f64> = point.iter().zip(&self.centre).map(|(x, c)| x - c).collect();
        self.solve(&from_centre)
    }

    /// L⁻¹ of a vector.
    fn solve(&self, right: &[f64]) -> Vec<f64> {
        let mut z: Vec<f64> = vec![];
        for (i, value) in right.iter().enumerate() {
            let known: f64 = z
                .iter()
                .enumerate()
                .map(|(j, z)| self.lower[(i, j)] * z)
                .sum();
            z.push((value - known) / self.lower[(i, i)]);
        }
        z
    }

    /// L of a vector.
    fn outward(&self, z: &[f64]) -> Vec<f64> {
        let row = |i: usize| (0..=i).map(|j| self.lower[(i, j)] * z[j]).sum();
        (0..z.len()).map(row).collect()
    }

    /// A point evenly drawn, within the cube.
    fn draw(&self, random: &mut Random) -> Vec<f64> {
        let dim = self.centre.len();
        // The cube itself where it is the smaller of the two.
        let log_unit = (0..dim)
            .map(|i| (self.lower[(i, i)] * self.radius).ln())
            .sum::<f64>();
        let is_large = log_unit + log_unit_ball(dim) > 0.0;
        loop {
            let point: Vec<f64> = if is_large {
                (0..dim).map(|_| random.uniform()).collect()
            } else {
                let reach = self.radius * random.uniform().powf(1.0 / dim as f64);
                let z: Vec<f64> = random.direction(dim).iter().map(|x| reach * x).collect();
                self.outward(&z)
                    .iter()
                    .zip(&self.centre)
                    .map(|(x, c)| x + c)
                    .collect()
            };
            if point.iter().all(|x| 0.0 < *x && *x < 1.0) {
                return point;
            }
        }
    }

    /// A line through a point in a direction that is even in z, and where it leaves the ellipsoid or the cube.
    fn chord(&self, point: &[f64], random: &mut Random) -> (Vec<f64>, [f64; 2]) {
        let turned = random.direction(point.len());
        let direction = self.outward(&turned);
        // |z + t e|² = radius².
        let z = self.inward(point);
        let along: f64 = z.iter().zip(&turned).map(|(a, b)| a * b).sum();
        let root = (along * along + (self.radius.powi(2) - square(&z)).max(0.0)).sqrt();
        let mut chord = [-along - root, -along + root];
        for (x, d) in point.iter().zip(&direction) {
            let (a, b) = (-x / d, (1.0 - x) / d);
            chord = [chord[0].max(a.min(b)), chord[1].min(a.max(b))];
        }
        (direction, chord)
    }
}

fn square(z: &[f64]) -> f64 {
    z.iter().map(|x| x * x).sum()
}

/// ln of the volume of the unit ball: V_d = 2π/d · V_{d−2}.
fn log_unit_ball(dim: usize) -> f64 {
    let mut log = if dim.is_multiple_of(2) {
        0.0
    } else {
        2.0_f64.ln()
    };
    let mut d = if dim.is_multiple_of(2) { 2 } else { 3 };
    while d <= dim {
        log += (std::f64::consts::TAU / d as f64).ln();
        d += 2;
    }
    log
}

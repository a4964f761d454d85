//! What several further effects would bring together, without fitting them.
//!
//! Friction alone may fit with the wrong sign and a quadratic damping alone with a sixth of its value, where both together
//! explain a gap. (1) of [`score`](crate::score()) holds for the columns C of several effects as for those of one: all columns are
//! taken past the nuisance together, and then pairs, and the best pairs with every third, are scored by their rows and columns of S alone.

use rayon::prelude::*;
use simgap_effects::Placed;

use crate::Candidate;
use crate::base::{Base, Past, Regressor, Trial};
use crate::score::{Way, trials, way};

/// Pairs that are scored with every third effect.
const EXTENDED: usize = 12;

/// Sets with one candidate that are chosen at the most.
const OFTEN: usize = 4;

/// What some effects would bring together.
#[derive(Clone)]
pub struct JointScore {
    /// Expected fall of the objective.
    pub gain: f64,
    /// The effects with the sizes the data ask for.
    pub starts: Vec<Placed>,
}

/// An effect in one shape, with its sizes.
struct Column<'a> {
    candidate: &'a Candidate,
    shape: &'a [f64],
    /// Places of its sizes among its parameters.
    sizes: Vec<usize>,
    /// The trial of the first size; the others follow.
    first_trial: usize,
}

/// Scores pairs and sets of three of the given effects, each in a given shape, best first: the best pairs, and as
/// many sets of three. Candidates without a size that they are in proportion to are left out, and sets that need a size outside
/// its bounds.
#[must_use]
pub fn joint_scores(
    base: &Base<'_>,
    shapes: &[(Candidate, Vec<f64>)],
    most: usize,
) -> Vec<JointScore> {
    let simulated = shapes.par_iter().filter_map(|(candidate, shape)| {
        let Way::BySize(sizes) = way(candidate, shape) else {
            return None;
        };
        let trial: Vec<Trial> = trials(candidate, shape);
        // A trial from which the plant runs away explains nothing.
        let found = base.columns(candidate, &trial, None).ok()?;
        Some((candidate, shape, sizes, found))
    });
    let mut columns: Vec<Column<'_>> = vec![];
    let mut signals = vec![];
    for (candidate, shape, sizes, found) in simulated.collect::<Vec<_>>() {
        columns.push(Column {
            candidate,
            shape,
            sizes,
            first_trial: signals.len(),
        });
        signals.extend(found);
    }
    let everywhere = (0..signals.len()).map(|trial| Regressor { trial, run: None });
    let past = base.past(&base.in_common(&signals), &everywhere.collect::<Vec<_>>());
    let scored = |set: &[usize]| base.joint_score(&columns, &past, set);
    let mut pairs: Vec<(Vec<usize>, JointScore)> = vec![];
    for i in 0..columns.len() {
        for j in i + 1..columns.len() {
            let set = vec![i, j];
            pairs.extend(scored(&set).map(|score| (set, score)));
        }
    }
    sort(&mut pairs);
    let mut threes: Vec<(Vec<usize>, JointScore)> = vec![];
    for (pair, _) in pairs.iter().take(EXTENDED) {
        for k in 0..columns.len() {
            let mut set = vec![pair[0], pair[1], k];
            set.sort_unstable();
            set.dedup();
            if set.len() == 3 && threes.iter().all(|(known, _)| *known != set) {
                threes.extend(scored(&set).map(|score| (set, score)));
            }
        }
    }
    sort(&mut threes);
    let mut all = various(pairs, &columns, most);
    all.extend(various(threes, &columns, most));
    all
}

/// The best of some sets in which no candidate is met again and again.
fn various(
    list: Vec<(Vec<usize>, JointScore)>,
    columns: &[Column<'_>],
    most: usize,
) -> Vec<JointScore> {
    let mut met: Vec<&Candidate> = vec![];
    let mut chosen = vec![];
    for (set, score) in list {
        let members = || set.iter().map(|k| columns[*k].candidate);
        let is_new =
            |candidate: &&Candidate| met.iter().filter(|known| known == &candidate).count() < OFTEN;
        if chosen.len() < most && members().all(|candidate| is_new(&candidate)) {
            met.extend(members());
            chosen.push(score);
        }
    }
    chosen
}

fn sort(list: &mut [(Vec<usize>, JointScore)]) {
    list.sort_by(|(a, one), (b, other)| other.gain.total_cmp(&one.gain).then_with(|| a.cmp(b)));
}

impl Base<'_> {
    /// The score of a set of columns; `None` where two are of one candidate, or where a size is outside its bounds.
    fn joint_score(
        &self,
        columns: &[Column<'_>],
        past: &Past,
        set: &[usize],
    ) -> Option<JointScore> {
        let of = |k: &usize| &columns[*k];
        for (n, k) in set.iter().enumerate() {
            if set[..n]
                .iter()
                .any(|other| of(other).candidate == of(k).candidate)
            {
                return None;
            }
        }
        let trials_of = |column: &Column<'_>| {
            let first = column.first_trial;
            first..first + column.sizes.len()
        };
        let trials: Vec<usize> = set.iter().flat_map(|k| trials_of(of(k))).collect();
        let (amplitudes, energy) = past.amplitudes(&trials)?;
        let mut amplitudes = amplitudes.into_iter();
        let mut starts = Vec::with_capacity(set.len());
        for column in set.iter().map(of) {
            let effect = column.candidate.effect;
            let mut values = column.shape.to_vec();
            for (&size, amplitude) in column.sizes.iter().zip(amplitudes.by_ref()) {
                let parameter = &effect.parameters()[size];
                let neutral = parameter.neutral.unwrap_or(0.0);
                let value = neutral + amplitude * (column.shape[size] - neutral);
                if !(parameter.lower..=parameter.upper).contains(&value) || value == neutral {
                    return None;
                }
                values[size] = value;
            }
            effect.make_physical(&mut values);
            starts.push(Placed::new(effect, column.candidate.at.clone(), values));
        }
        let share = (energy / self.energy).clamp(0.0, 1.0 - 1e-9);
        Some(JointScore {
            gain: -0.5 * self.observations * (1.0 - share).ln(),
            starts,
        })
    }
}

//! Inner products of sensitivities, kept from one step of a fit to the next.
//!
//! Most sensitivities of a fit belong to nominal parameters and initial states, and stay as they are for many steps, and as they are
//! in the base that the fit starts from: their products are those of before. Channels are kept apart, since the weights change.

use std::collections::HashMap;
use std::sync::Arc;

use faer::Mat;

use crate::effort::Effort;
use crate::linearise::Column;
use crate::products::{add_scaled, products_of};
use crate::signals::Signals;

/// The inner products of the sensitivities of one run with each other.
pub(crate) struct Gram {
    columns: Vec<Column>,
    /// Channel by channel, below the diagonal and on it.
    of_channel: Vec<Mat<f64>>,
}

impl Gram {
    /// Of these columns; what others hold of them is taken from there.
    fn of(columns: &[Column], channels: usize, known: [Option<&Gram>; 2], effort: &Effort) -> Gram {
        let places: Vec<Vec<Option<usize>>> = known
            .iter()
            .map(|gram| {
                let theirs = gram.iter().flat_map(|gram| gram.columns.iter().enumerate());
                let theirs: HashMap<*const Signals, usize> =
                    theirs.map(|(i, column)| (Arc::as_ptr(column), i)).collect();
                let mine = columns.iter().map(Arc::as_ptr);
                mine.map(|column| theirs.get(&column).copied()).collect()
            })
            .collect();
        let taken = |a: usize, b: usize| {
            let mut grams = known.iter().zip(&places);
            grams.find_map(|(gram, places)| {
                let (i, j) = places[a].zip(places[b])?;
                Some((*gram).as_ref()?.at(i.max(j), i.min(j)))
            })
        };
        let signals: Vec<&Signals> = columns.iter().map(AsRef::as_ref).collect();
        let is_wanted = |a: usize, b: usize| b <= a && taken(a, b).is_none();
        let mut of_channel: Vec<Mat<f64>> = (0..channels)
            .map(|c| products_of(&signals, &signals, c, is_wanted))
            .collect();
        let mut computed = 0;
        for a in 0..columns.len() {
            for b in 0..=a {
                let Some(known) = taken(a, b) else {
                    computed += channels;
                    continue;
                };
                for (own, known) in of_channel.iter_mut().zip(known) {
                    own[(a, b)] = known;
                }
            }
        }
        let lengths = signals.iter().flat_map(|signals| signals.iter());
        effort.add_products(computed, lengths.map(Vec::len).max().unwrap_or(0));
        Gram {
            columns: columns.to_vec(),
            of_channel,
        }
    }

    /// The products of two columns, channel by channel, the first not before the second.
    fn at(&self, row: usize, column: usize) -> impl Iterator<Item = f64> + '_ {
        self.of_channel.iter().map(move |of| of[(row, column)])
    }

    /// All channels together, below the diagonal and on it.
    pub(crate) fn weighted(&self, weights: &[f64]) -> Mat<f64> {
        let len = self.columns.len();
        let mut all = Mat::zeros(len, len);
        for (weight, of) in weights.iter().zip(&self.of_channel) {
            add_scaled(&mut all, *weight, of);
        }
        all
    }
}

/// Those of all runs, with what is known from elsewhere: run by run as well, or nothing.
pub(crate) fn grams(
    columns: &[Vec<Column>],
    channels: usize,
    known: [&[Gram]; 2],
    effort: &Effort,
) -> Vec<Gram> {
    let runs = columns.iter().enumerate();
    let of = |(run, columns): (usize, &Vec<Column>)| {
        Gram::of(columns, channels, known.map(|known| known.get(run)), effort)
    };
    runs.map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(seed: usize) -> Column {
        let channel = |c: usize| (0..700).map(|n| ((n * seed + c) as f64).sin()).collect();
        Arc::new(vec![channel(0), channel(3)])
    }

    /// To the last bit, whatever was known, in whatever order.
    #[test]
    fn verify_products_that_are_taken_are_those_that_are_computed() {
        let all: Vec<Column> = (1..8).map(column).collect();
        let order = |places: &[usize]| places.iter().map(|&i| all[i].clone()).collect();
        let base: Vec<Column> = order(&[0, 2, 4, 5]);
        let last: Vec<Column> = order(&[6, 1, 5, 0]);
        let now: Vec<Column> = order(&[3, 5, 0, 6, 2, 4]);
        let fresh = |columns: &[Column]| Gram::of(columns, 2, [None, None], &Effort::default());
        let known = [Some(&fresh(&last)), Some(&fresh(&base))];
        let taken = Gram::of(&now, 2, known, &Effort::default()).weighted(&[2.0, 0.3]);
        let computed = fresh(&now).weighted(&[2.0, 0.3]);
        for a in 0..now.len() {
            for b in 0..=a {
                assert_eq!(taken[(a, b)], computed[(a, b)], "{a} {b}");
            }
        }
    }
}

//! What each of several causes explains.
//!
//! Laws help each other, so that neither what one explains alone nor what is lost without it is its share. The Shapley value
//! of player i among n is the mean, over all orders in which they come, of what it adds:
//!
//! ```text
//! φ_i = Σ over the sets S without i  |S|! (n − |S| − 1)! / n!  (v(S and i) − v(S)),   Σ φ_i = v(all) − v(none)   (1)
//! ```
//!
//! Reference: \[Shapley1953\].

/// (1) for `count` players. `value` is asked once for each set of them, by their places in rising order.
///
/// # Errors
/// The first error of `value`.
pub(crate) fn shapley_values<E>(
    count: usize,
    mut value: impl FnMut(&[usize]) -> Result<f64, E>,
) -> Result<Vec<f64>, E> {
    let holds = |set: usize, player: usize| (set >> player) & 1 == 1;
    let members = |set: usize| (0..count).filter(move |player| holds(set, *player));
    let values: Vec<f64> = (0..1_usize << count)
        .map(|set| value(&members(set).collect::<Vec<_>>()))
        .collect::<Result<_, E>>()?;
    let of_player = |player: usize| {
        let without = (0..values.len()).filter(|set| !holds(*set, player));
        let added = without.map(|set| {
            let gain = values[set | (1 << player)] - values[set];
            weight(members(set).count(), count) * gain
        });
        added.sum()
    };
    Ok((0..count).map(of_player).collect())
}

/// |S|! (n − |S| − 1)! / n!
fn weight(size: usize, count: usize) -> f64 {
    let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
    factorial(size) * factorial(count - size - 1) / factorial(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(count: usize, value: impl Fn(&[usize]) -> f64) -> Vec<f64> {
        shapley_values(count, |set| Ok::<f64, ()>(value(set))).unwrap()
    }

    #[test]
    fn verify_the_glove_game() {
        // One left glove (0), two right ones: only pairs are worth anything.
        let pairs = |set: &[usize]| f64::from(u8::from(set.contains(&0) && set.len() > 1));
        let found = values(3, pairs);
        let wanted = [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0];
        assert!(found.iter().zip(wanted).all(|(f, w)| (f - w).abs() < 1e-12));
    }

    proptest::proptest! {
        #[test]
        fn verify_shares_add_up_and_what_adds_nothing_has_none(
            table in proptest::collection::vec(-10.0..10.0_f64, 8),
        ) {
            // Player 3 adds nothing to any set.
            let value = |set: &[usize]| {
                let place: usize = set.iter().filter(|p| **p < 3).map(|p| 1 << p).sum();
                table[place]
            };
            let found = values(4, value);
            let sum: f64 = found.iter().sum();
            proptest::prop_assert!((sum - (table[7] - table[0])).abs() < 1e-9);
            proptest::prop_assert!(found[3].abs() < 1e-12);
        }
    }
}

//! Which parameters a force grows in proportion to.
//!
//! ```text
//! F(d, v, t; λ s, q) = λ F(d, v, t; s, q)   for every λ ≥ 0                                          (1)
//! ```
//!
//! s are the sizes of the law, q the values that shape it. The degree of an expression in s is followed from its leaves to
//! its root, as units are: a size has the degree one, everything else none; a product adds degrees, a sum needs equal ones.

use simgap_model::{Expression, Function, Operation, Symbol};

use super::program::reads;

/// Parameters of a law: their sets are looked through one by one.
pub(super) const MOST_PARAMETERS: usize = 8;

/// Places of the sizes of a force: the smallest set s of (1), of these the one that is listed first; `None` where the force is in
/// proportion to no set.
pub(super) fn sizes(expression: &Expression, parameters: usize) -> Option<Vec<usize>> {
    let parameters = parameters.min(MOST_PARAMETERS);
    let sets = 1..1_usize << parameters;
    let of = |set: usize| (0..parameters).filter(move |k| set >> k & 1 == 1);
    let mut sets: Vec<Vec<usize>> = sets.map(|set| of(set).collect()).collect();
    sets.sort_by(|a, b| a.len().cmp(&b.len()).then(a.cmp(b)));
    sets.into_iter().find(|set| {
        let degree = Degrees {
            sizes: set,
            is_alone: set.len() == 1,
        };
        degree.of(expression) == Some(Degree::Is(1.0))
    })
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Degree {
    Is(f64),
    /// Zero, which is of every degree.
    Any,
}

struct Degrees<'a> {
    sizes: &'a [usize],
    /// With several sizes the force is their sum as well: no power, root, absolute value or choice of them.
    is_alone: bool,
}

impl Degrees<'_> {
    fn is_size(&self, symbol: Symbol) -> bool {
        matches!(symbol, Symbol::Parameter(place) if self.sizes.contains(&place))
    }

    /// The degree of an expression, `None` where it has none.
    fn of(&self, expression: &Expression) -> Option<Degree> {
        if !reads(expression, &|symbol| self.is_size(symbol)) {
            return Some(match expression {
                Expression::Number(0.0) => Degree::Any,
                _ => Degree::Is(0.0),
            });
        }
        match expression {
            Expression::Number(_) => None,
            Expression::Symbol(_) => Some(Degree::Is(1.0)),
            Expression::Function(Function::Negative, of) => self.of(of),
            Expression::Function(_, _) if !self.is_alone => None,
            Expression::Function(Function::Abs, of) => self.of(of),
            Expression::Function(Function::Sign, of) => self.of(of).map(|_| Degree::Is(0.0)),
            Expression::Function(Function::Sqrt, of) => match self.of(of)? {
                Degree::Is(degree) => Some(Degree::Is(0.5 * degree)),
                Degree::Any => Some(Degree::Any),
            },
            Expression::Function(_, of) => self.of(of).filter(|degree| *degree == Degree::Is(0.0)),
            Expression::Operation(operation, of) => {
                let [a, b] = [0, 1].map(|k| self.of(&of[k]));
                self.of_two(*operation, a?, b?, &of[1])
            }
        }
    }

    fn of_two(
        &self,
        operation: Operation,
        a: Degree,
        b: Degree,
        second: &Expression,
    ) -> Option<Degree> {
        let is_choice = matches!(operation, Operation::Min | Operation::Max);
        match (operation, a, b) {
            (Operation::Multiply, Degree::Any, _) | (Operation::Multiply, _, Degree::Any) => {
                Some(Degree::Any)
            }
            (Operation::Multiply, Degree::Is(a), Degree::Is(b)) => Some(Degree::Is(a + b)),
            (Operation::Divide, Degree::Any, Degree::Is(_)) => Some(Degree::Any),
            (Operation::Divide, Degree::Is(a), Degree::Is(b)) => Some(Degree::Is(a - b)),
            (Operation::Power, Degree::Is(0.0), Degree::Is(0.0)) => Some(Degree::Is(0.0)),
            (Operation::Power, Degree::Is(a), _) => match second {
                Expression::Number(n) if self.is_alone => Some(Degree::Is(a * n)),
                _ => None,
            },
            (Operation::Divide | Operation::Power, ..) => None,
            _ if is_choice && !self.is_alone => None,
            // Sums, differences and choices.
            (_, Degree::Any, other) | (_, other, Degree::Any) => Some(other),
            (_, a, b) => (a == b).then_some(a),
        }
    }
}

#[cfg(test)]
mod tests {
    use simgap_model::{Law, LawParameter};

    use super::*;

    #[test]
    fn verify_sizes_are_what_the_force_is_in_proportion_to() {
        let names = ["a", "b", "c"];
        for (force, wanted) in [
            ("a * tanh(v / b) * (1 + c * d^2)", Some(vec![0])),
            ("a * v + b * v^3 + c * t", Some(vec![0, 1, 2])),
            ("a * b * v / c", Some(vec![0])),
            (
                "(a + (b - a) * exp(-(v / c)^2)) * sign(v)",
                Some(vec![0, 1]),
            ),
            ("max(0, c * (d - a)) * b / b", Some(vec![2])),
            ("-abs(b) * v * exp(a + c)", Some(vec![1])),
            ("sqrt(a^2 * v^2) * sin(b * c)", Some(vec![0])),
            ("tanh(a * v) + b - b + c", None),
            ("a + b * c + 1", None),
            ("a^b * c * v", Some(vec![2])),
            ("exp(a) + exp(b) + exp(c)", None),
        ] {
            let parameters = names.map(|name| LawParameter::of_size(name, "1", 1.0));
            let law = Law {
                name: "law".into(),
                summary: None,
                between: vec![],
                force: force.into(),
                parameters: parameters.into(),
            };
            let found = sizes(&law.expression().unwrap(), names.len());
            assert_eq!(found, wanted, "{force}");
        }
    }
}

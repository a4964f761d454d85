//! The text of an expression to its tree.
//!
//! [`super::text`] finds what is wrong with the text and where, and writes it in the form that the parser of the crate
//! `exmex` takes; the tree is what its operators make of values that are trees. Signs and powers bind as engineers write
//! them, `-d^2` is −(d²) and `a^b^c` is a^(b^c), where `exmex` reads them from left to right: a group in parentheses is
//! therefore marked, and [`power`] puts the others in order.

use std::str::FromStr;

use exmex::{BinOp, Express, FlatEx, MakeOperators, MatchLiteral, Operator};

use super::expression::{Expression, FUNCTIONS, Function, Operation, Symbol};
use super::text::{BadExpression, GROUP, LEAST, MOST, number_at, ordered, symbol_of};

/// Reads a text over d, v, t and the names of parameters.
pub(super) fn parse(text: &str, parameters: &[&str]) -> Result<Expression, BadExpression> {
    let ordered = ordered(text, parameters)?;
    // What the checks above let pass and the parser does not is told in its own words.
    let refused = |error: exmex::ExError| BadExpression {
        character: 1,
        found: format!("an expression that cannot be read ({error})"),
        needed: "an expression such as c * v * abs(v)".into(),
    };
    let parsed = FlatEx::<Term, Terms, Literal>::parse_wo_compile(&ordered).map_err(refused)?;
    let names = parsed.var_names().iter();
    let values: Vec<Term> = names.map(|name| Term::Symbol(symbol_of(name))).collect();
    parsed.eval(&values).map(Expression::from).map_err(refused)
}

/// An expression whose groups are known.
#[derive(Debug, Clone)]
enum Term {
    Number(f64),
    Symbol(Symbol),
    Function(Function, Box<Term>),
    Operation(Operation, Box<[Term; 2]>),
    Group(Box<Term>),
}

impl Default for Term {
    fn default() -> Term {
        Term::Number(0.0)
    }
}

impl FromStr for Term {
    type Err = std::num::ParseFloatError;

    fn from_str(text: &str) -> Result<Term, Self::Err> {
        text.parse().map(Term::Number)
    }
}

impl From<Term> for Expression {
    fn from(term: Term) -> Expression {
        match term {
            Term::Number(value) => Expression::Number(value),
            Term::Symbol(symbol) => Expression::Symbol(symbol),
            Term::Function(function, of) => Expression::Function(function, Box::new((*of).into())),
            Term::Operation(operation, of) => {
                Expression::Operation(operation, Box::new(of.map(Expression::from)))
            }
            Term::Group(of) => (*of).into(),
        }
    }
}

/// A power whose base is no group: a sign in front goes to the whole of it, and of several powers the last is the first.
fn power(base: Term, exponent: Term) -> Term {
    match base {
        Term::Function(Function::Negative, of) => {
            Term::Function(Function::Negative, Box::new(power(*of, exponent)))
        }
        Term::Operation(Operation::Power, of) => {
            let [base, first] = *of;
            operation(Operation::Power, base, power(first, exponent))
        }
        base => operation(Operation::Power, base, exponent),
    }
}

fn operation(operation: Operation, a: Term, b: Term) -> Term {
    Term::Operation(operation, Box::new([a, b]))
}

fn function(function: Function, of: Term) -> Term {
    Term::Function(function, Box::new(of))
}

/// What the parser makes trees with.
#[derive(Debug, Clone)]
struct Terms;

impl MakeOperators<Term> for Terms {
    fn make<'a>() -> Vec<Operator<'a, Term>> {
        // What is commutative may be taken out of order.
        let bin = |apply: fn(Term, Term) -> Term, prio: i64| BinOp {
            apply,
            prio,
            is_commutative: false,
        };
        let least = bin(|a, b| operation(Operation::Min, a, b), 0);
        let most = bin(|a, b| operation(Operation::Max, a, b), 0);
        let add = bin(|a, b| operation(Operation::Add, a, b), 1);
        let subtract = bin(|a, b| operation(Operation::Subtract, a, b), 1);
        let multiply = bin(|a, b| operation(Operation::Multiply, a, b), 2);
        let divide = bin(|a, b| operation(Operation::Divide, a, b), 2);
        let of: [fn(Term) -> Term; FUNCTIONS.len()] = [
            |x| function(Function::Abs, x),
            |x| function(Function::Sign, x),
            |x| function(Function::Sqrt, x),
            |x| function(Function::Exp, x),
            |x| function(Function::Ln, x),
            |x| function(Function::Sin, x),
            |x| function(Function::Cos, x),
            |x| function(Function::Tanh, x),
            |x| function(Function::Atan, x),
        ];
        let functions = FUNCTIONS.into_iter().zip(of);
        let mut all = vec![
            Operator::make_bin(LEAST, least),
            Operator::make_bin(MOST, most),
            Operator::make_bin_unary("+", add, |x| x),
            Operator::make_bin_unary("-", subtract, |x| function(Function::Negative, x)),
            Operator::make_bin("*", multiply),
            Operator::make_bin("/", divide),
            Operator::make_bin("^", bin(power, 3)),
            Operator::make_unary(GROUP, |x| Term::Group(Box::new(x))),
        ];
        all.extend(functions.map(|(name, of)| Operator::make_unary(name, of)));
        all
    }
}

/// The numbers of an expression.
#[derive(Debug, Clone)]
struct Literal;

impl MatchLiteral for Literal {
    fn is_literal(text: &str) -> Option<&str> {
        let length = number_at(text);
        (length > 0).then(|| &text[..length])
    }
}

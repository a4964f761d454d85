//! The expression of a law as a tree.

/// What an expression of a law reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Symbol {
    /// d, relative displacement, m or rad.
    Displacement,
    /// v, relative velocity, m/s or rad/s.
    Velocity,
    /// t, time of the record, s.
    Time,
    /// A parameter of the law, by its place in the list.
    Parameter(usize),
}

/// A function of one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Function {
    /// −x.
    Negative,
    /// |x|.
    Abs,
    /// −1, 0 or 1.
    Sign,
    /// Square root.
    Sqrt,
    /// eˣ.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Sine of an angle in rad.
    Sin,
    /// Cosine of an angle in rad.
    Cos,
    /// Hyperbolic tangent.
    Tanh,
    /// Arc tangent, rad.
    Atan,
}

/// An operation on two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operation {
    /// a + b.
    Add,
    /// a − b.
    Subtract,
    /// a b.
    Multiply,
    /// a / b.
    Divide,
    /// aᵇ.
    Power,
    /// The smaller of two.
    Min,
    /// The larger of two.
    Max,
}

/// The expression of a law.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// What it reads.
    Symbol(Symbol),
    /// A function of an expression.
    Function(Function, Box<Expression>),
    /// An operation on two expressions.
    Operation(Operation, Box<[Expression; 2]>),
}

/// The functions of one number by their names.
pub(super) const FUNCTIONS: [&str; 9] = [
    "abs", "sign", "sqrt", "exp", "ln", "sin", "cos", "tanh", "atan",
];

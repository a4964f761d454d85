//! The expression of a law as a list of operations, each on one number or on eight side by side.
//!
//! What reads no motion is computed once for a set of parameters; the rest is written down in an order that needs few
//! intermediate numbers. One and eight are computed by the same code, so that a set's force is the same to the last bit in a
//! batch and alone.

use simgap_integrate::exact::elementary;
use simgap_integrate::exact::lanes::{LANES, PackLaw, together};
use simgap_integrate::exact::{ForceLaw, LaneLaw, MemberMotion, lanes::Pack};
use simgap_model::{Expression, Function, Operation, Symbol};

/// Intermediate numbers at once. An expression needs at the most one more than the logarithm to base two of its values, of
/// which a text of the length that is read has fewer than a thousand.
const SLOTS: usize = 11;

/// Largest whole power that is computed by products.
const LARGEST_POWER: f64 = 16.0;

/// What an operation reads.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Operand {
    /// d, v or t.
    Motion(usize),
    /// What was computed from the parameters.
    Held(usize),
    /// What was computed before.
    Slot(usize),
}

/// What is done with one or two numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    Of(Function),
    Between(Operation),
    /// A whole power.
    PowerOf(i32),
}

#[derive(Debug, Clone, Copy)]
struct Instruction {
    step: Step,
    a: Operand,
    /// Read by operations on two numbers; elsewhere as `a`.
    b: Operand,
    to: usize,
}

/// The expression of a law, ready to be computed.
#[derive(Debug, Clone)]
pub(super) struct Program {
    /// What reads no motion, each computed once for a set of parameters.
    held: Vec<Expression>,
    instructions: Vec<Instruction>,
    result: Operand,
}

impl Program {
    pub(super) fn of(expression: &Expression) -> Program {
        let mut program = Program {
            held: vec![],
            instructions: vec![],
            result: Operand::Held(0),
        };
        program.result = program.write(expression, 0);
        program
    }

    /// Writes down an expression that may use the slots from `free` on; where its value is then.
    fn write(&mut self, expression: &Expression, free: usize) -> Operand {
        if !reads_motion(expression) {
            self.held.push(expression.clone());
            return Operand::Held(self.held.len() - 1);
        }
        let (step, a, b) = match expression {
            Expression::Symbol(Symbol::Velocity) => return Operand::Motion(1),
            Expression::Symbol(Symbol::Time) => return Operand::Motion(2),
            // Numbers and parameters are held.
            Expression::Symbol(_) | Expression::Number(_) => return Operand::Motion(0),
            Expression::Function(function, of) => {
                let a = self.write(of, free);
                (Step::Of(*function), a, a)
            }
            Expression::Operation(operation, of) => {
                let [a, b] = &**of;
                match (operation, b) {
                    (Operation::Power, Expression::Number(n)) if is_whole(*n) => {
                        let a = self.write(a, free);
                        (Step::PowerOf(*n as i32), a, a)
                    }
                    // The one that needs more slots comes first.
                    _ if slots(a) >= slots(b) => {
                        let a = self.write(a, free);
                        let b = self.write(b, free + usize::from(matches!(a, Operand::Slot(_))));
                        (Step::Between(*operation), a, b)
                    }
                    _ => {
                        let b = self.write(b, free);
                        let a = self.write(a, free + usize::from(matches!(b, Operand::Slot(_))));
                        (Step::Between(*operation), a, b)
                    }
                }
            }
        };
        let to = free.min(SLOTS - 1);
        self.instructions.push(Instruction { step, a, b, to });
        Operand::Slot(to)
    }

    /// The law with values of its parameters.
    pub(super) fn with(&'static self, parameters: &[f64]) -> Law {
        let held = self.held.iter();
        Law {
            program: self,
            held: held.map(|of| [value_of(of, parameters)]).collect(),
        }
    }

    /// The force at a motion, N.
    pub(super) fn force(&self, parameters: &[f64], motion: [f64; 3]) -> f64 {
        let held = self.held.iter().map(|of| [value_of(of, parameters)]);
        let held: Vec<[f64; 1]> = held.collect();
        self.run(&held, motion.map(|x| [x]))[0]
    }

    /// The operations in their order, each on `N` numbers.
    #[inline(always)]
    fn run<const N: usize>(&self, held: &[[f64; N]], motion: [[f64; N]; 3]) -> [f64; N] {
        let mut slots = [[0.0; N]; SLOTS];
        for instruction in &self.instructions {
            let a = read(instruction.a, held, &motion, &slots);
            let b = read(instruction.b, held, &motion, &slots);
            slots[instruction.to] = match instruction.step {
                Step::Of(function) => of(function, &a),
                Step::Between(operation) => between(operation, &a, &b),
                Step::PowerOf(n) => map(&a, |x| power_of(x, n)),
            };
        }
        read(self.result, held, &motion, &slots)
    }
}

#[inline(always)]
fn read<const N: usize>(
    operand: Operand,
    held: &[[f64; N]],
    motion: &[[f64; N]; 3],
    slots: &[[f64; N]; SLOTS],
) -> [f64; N] {
    match operand {
        Operand::Motion(k) => motion[k],
        Operand::Held(k) => held[k],
        Operand::Slot(k) => slots[k],
    }
}

/// Whether an exponent is a whole number that is computed by products.
fn is_whole(exponent: f64) -> bool {
    exponent.fract() == 0.0 && exponent.abs() <= LARGEST_POWER
}

/// Whether an expression reads d, v or t.
pub(super) fn reads_motion(expression: &Expression) -> bool {
    reads(expression, &|symbol| {
        !matches!(symbol, Symbol::Parameter(_))
    })
}

/// Whether an expression reads one of some symbols.
pub(super) fn reads(expression: &Expression, is_one: &dyn Fn(Symbol) -> bool) -> bool {
    match expression {
        Expression::Number(_) => false,
        Expression::Symbol(symbol) => is_one(*symbol),
        Expression::Function(_, of) => reads(of, is_one),
        Expression::Operation(_, of) => of.iter().any(|part| reads(part, is_one)),
    }
}

/// Slots that an expression needs.
fn slots(expression: &Expression) -> usize {
    if !reads_motion(expression) {
        return 0;
    }
    match expression {
        Expression::Number(_) | Expression::Symbol(_) => 0,
        Expression::Function(_, of) => slots(of).max(1),
        Expression::Operation(_, of) => match [slots(&of[0]), slots(&of[1])] {
            [a, b] if a == b => a + 1,
            [a, b] => a.max(b),
        },
    }
}

/// The value of an expression that reads no motion.
fn value_of(expression: &Expression, parameters: &[f64]) -> f64 {
    match expression {
        Expression::Number(value) => *value,
        Expression::Symbol(Symbol::Parameter(place)) => parameters[*place],
        Expression::Symbol(_) => 0.0,
        Expression::Function(function, inner) => of(*function, &[value_of(inner, parameters)])[0],
        Expression::Operation(operation, pair) => {
            let [a, b] = [0, 1].map(|k| value_of(&pair[k], parameters));
            match pair[1] {
                Expression::Number(n) if *operation == Operation::Power && is_whole(n) => {
                    power_of(a, n as i32)
                }
                _ => between(*operation, &[a], &[b])[0],
            }
        }
    }
}

#[inline(always)]
fn map<const N: usize>(a: &[f64; N], of: impl Fn(f64) -> f64) -> [f64; N] {
    let mut out = [0.0; N];
    for l in 0..N {
        out[l] = of(a[l]);
    }
    out
}

#[inline(always)]
fn zip<const N: usize>(a: &[f64; N], b: &[f64; N], of: impl Fn(f64, f64) -> f64) -> [f64; N] {
    let mut out = [0.0; N];
    for l in 0..N {
        out[l] = of(a[l], b[l]);
    }
    out
}

#[inline(always)]
fn of<const N: usize>(function: Function, a: &[f64; N]) -> [f64; N] {
    match function {
        Function::Negative => map(a, |x| -x),
        Function::Abs => map(a, f64::abs),
        Function::Sign => map(a, |x| {
            if x > 0.0 {
                1.0
            } else if x < 0.0 {
                -1.0
            } else {
                x
            }
        }),
        Function::Sqrt => map(a, f64::sqrt),
        Function::Exp => map(a, elementary::exp),
        Function::Ln => map(a, f64::ln),
        Function::Sin => map(a, elementary::sin),
        Function::Cos => map(a, |x| elementary::sin_cos(x).1),
        Function::Tanh => map(a, elementary::tanh),
        Function::Atan => map(a, f64::atan),
    }
}

#[inline(always)]
fn between<const N: usize>(operation: Operation, a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    match operation {
        Operation::Add => zip(a, b, |a, b| a + b),
        Operation::Subtract => zip(a, b, |a, b| a - b),
        Operation::Multiply => zip(a, b, |a, b| a * b),
        Operation::Divide => zip(a, b, |a, b| a / b),
        Operation::Power => zip(a, b, f64::powf),
        // What is not a number stays so.
        Operation::Min => zip(a, b, |a, b| if a < b || a.is_nan() { a } else { b }),
        Operation::Max => zip(a, b, |a, b| if a > b || a.is_nan() { a } else { b }),
    }
}

/// xⁿ by products.
#[inline(always)]
fn power_of(x: f64, n: i32) -> f64 {
    let (mut power, mut square, mut left) = (1.0, x, n.unsigned_abs());
    while left > 0 {
        if left & 1 == 1 {
            power *= square;
        }
        square *= square;
        left >>= 1;
    }
    if n < 0 { 1.0 / power } else { power }
}

/// A law with values of its parameters.
pub(super) struct Law {
    program: &'static Program,
    held: Vec<[f64; 1]>,
}

impl ForceLaw for Law {
    fn force(&self, motion: MemberMotion) -> f64 {
        let motion = [motion.displacement, motion.velocity, motion.time_s];
        self.program.run(&self.held, motion.map(|x| [x]))[0]
    }

    fn lanes(&self, peers: &[&dyn ForceLaw]) -> Option<Box<dyn LaneLaw>> {
        let mut held = vec![[0.0; LANES]; self.held.len()];
        for lane in 0..LANES {
            let law: &dyn std::any::Any = *peers.get(lane)?;
            let law = law.downcast_ref::<Law>()?;
            if !std::ptr::eq(law.program, self.program) {
                return None;
            }
            for (column, [value]) in held.iter_mut().zip(&law.held) {
                column[lane] = *value;
            }
        }
        Some(together(Eight {
            program: self.program,
            held,
        }))
    }
}

/// The laws of eight sets.
struct Eight {
    program: &'static Program,
    held: Vec<[f64; LANES]>,
}

impl PackLaw for Eight {
    #[inline(always)]
    fn forces(&self, displacement: &Pack, velocity: &Pack, time_s: &Pack) -> Pack {
        let motion = [displacement.0, velocity.0, time_s.0];
        Pack(self.program.run(&self.held, motion))
    }
}

//! What is wrong with the text of an expression, and where.

use super::expression::{FUNCTIONS, Symbol};

/// Longest text, characters: bounds the work of whatever walks through the tree.
const LONGEST: usize = 1000;

/// Stands before a group in parentheses, so that it is known from a term that happens to be alike.
pub(super) const GROUP: &str = "#";
/// Stands between what `min` is of.
pub(super) const LEAST: &str = "<";
/// Stands between what `max` is of.
pub(super) const MOST: &str = ">";

/// Why an expression is refused.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct BadExpression {
    /// Character of the text, from 1.
    pub(crate) character: usize,
    /// What is there.
    pub(crate) found: String,
    /// What could be.
    pub(crate) needed: String,
}

/// What an open parenthesis belongs to.
#[derive(Clone, Copy, PartialEq)]
enum Open {
    Group,
    Function,
    /// `min` or `max`: the sign that stands for it, until the comma is met.
    Pair(&'static str),
    AfterComma,
}

/// The name of a symbol in the ordered text.
fn symbol_name(symbol: Symbol) -> String {
    match symbol {
        Symbol::Displacement => "x_d".into(),
        Symbol::Velocity => "x_v".into(),
        Symbol::Time => "x_t".into(),
        Symbol::Parameter(place) => format!("x_{place}"),
    }
}

/// The symbol of a name in the ordered text.
pub(super) fn symbol_of(name: &str) -> Symbol {
    match name.strip_prefix("x_") {
        Some("v") => Symbol::Velocity,
        Some("t") => Symbol::Time,
        Some(place) => place
            .parse()
            .map_or(Symbol::Displacement, Symbol::Parameter),
        None => Symbol::Displacement,
    }
}

/// Length of the number with which a text begins, zero if it begins with none.
pub(super) fn number_at(text: &str) -> usize {
    let digits = |from: usize| {
        let rest = text.as_bytes()[from..].iter();
        rest.take_while(|byte| byte.is_ascii_digit()).count()
    };
    let whole = digits(0);
    let mut end = whole;
    if text[end..].starts_with('.') {
        let fraction = digits(end + 1);
        if whole + fraction == 0 {
            return 0;
        }
        end += 1 + fraction;
    }
    if end > 0 && text[end..].starts_with(['e', 'E']) {
        let sign = usize::from(text[end + 1..].starts_with(['+', '-']));
        let exponent = digits(end + 1 + sign);
        if exponent > 0 {
            end += 1 + sign + exponent;
        }
    }
    end
}

/// Length of the name with which a text begins, zero if it begins with none.
fn name_at(text: &str) -> usize {
    if !text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        return 0;
    }
    let is_of_name = |c: &char| c.is_ascii_alphanumeric() || *c == '_';
    text.chars().take_while(is_of_name).count()
}

/// One pass over the text.
struct Pass<'a> {
    text: &'a str,
    parameters: &'a [&'a str],
    used: Vec<bool>,
    open: Vec<(Open, usize)>,
    /// Whether a value is to follow, not an operator.
    wants_value: bool,
    out: String,
}

/// Checks a text and writes it for the parser: symbols by names that clash with nothing, groups marked, `min(a, b)` as
/// `#((a)<(b))`.
pub(super) fn ordered(text: &str, parameters: &[&str]) -> Result<String, BadExpression> {
    let mut pass = Pass {
        text,
        parameters,
        used: vec![false; parameters.len()],
        open: vec![],
        wants_value: true,
        out: String::new(),
    };
    let length = text.chars().count();
    if length > LONGEST {
        let found = format!("{length} characters");
        return pass.refuse(0, found, &format!("at the most {LONGEST}"));
    }
    let mut at = 0;
    while at < text.len() {
        at += pass.step(at)?;
    }
    if pass.wants_value {
        return pass.refuse(text.len(), "nothing at its end".into(), VALUE);
    }
    if let Some(&(_, opened)) = pass.open.last() {
        return pass.refuse(opened, "\"(\" that is not closed".into(), "a \")\" to it");
    }
    if let Some(unused) = pass.used.iter().position(|used| !used) {
        let found = format!("no \"{}\"", parameters[unused]);
        return pass.refuse(0, found, "every parameter of the law in its force");
    }
    Ok(pass.out)
}

const VALUE: &str = "a number, a name or \"(\" here";
const OPERATOR: &str = "one of + - * / ^ before it";

impl Pass<'_> {
    fn refuse<T>(&self, at: usize, found: String, needed: &str) -> Result<T, BadExpression> {
        Err(BadExpression {
            character: 1 + self.text[..at].chars().count(),
            found,
            needed: needed.into(),
        })
    }

    /// Takes what stands at a byte; its length.
    fn step(&mut self, at: usize) -> Result<usize, BadExpression> {
        let rest = &self.text[at..];
        let Some(first) = rest.chars().next() else {
            return Ok(1);
        };
        if first.is_whitespace() {
            return Ok(first.len_utf8());
        }
        let number = number_at(rest);
        let name = name_at(rest);
        if number > 0 || name > 0 {
            let word = &rest[..number.max(name)];
            if !self.wants_value {
                return self.refuse(at, format!("\"{word}\" after a value"), OPERATOR);
            }
            if number > 0 {
                self.wants_value = false;
                self.out.push_str(word);
                return Ok(number);
            }
            return self.name(at, word);
        }
        match first {
            '(' if self.wants_value => self.group(at, Open::Group, "#("),
            '(' => self.refuse(at, "\"(\" after a value".into(), OPERATOR)?,
            ')' => self.close(at)?,
            ',' => self.comma(at)?,
            '+' | '-' => self.operator(first),
            '*' | '/' | '^' if !self.wants_value => self.operator(first),
            '*' | '/' | '^' => self.refuse(at, format!("\"{first}\""), VALUE)?,
            other => self.refuse(
                at,
                format!("\"{}\"", other.escape_debug()),
                "numbers, names, + - * / ^ ( ) and commas",
            )?,
        }
        Ok(first.len_utf8())
    }

    fn operator(&mut self, sign: char) {
        self.out.push(sign);
        self.wants_value = true;
    }

    fn group(&mut self, at: usize, open: Open, written: &str) {
        self.open.push((open, at));
        self.out.push_str(written);
    }

    /// A name: a function with its parenthesis, or a symbol.
    fn name(&mut self, at: usize, word: &str) -> Result<usize, BadExpression> {
        let after = &self.text[at + word.len()..];
        let blank = after.len() - after.trim_start().len();
        let is_called = after[blank..].starts_with('(');
        let to_parenthesis = word.len() + blank + 1;
        let pair = match word {
            "min" => Some(LEAST),
            "max" => Some(MOST),
            _ => None,
        };
        if pair.is_some() || FUNCTIONS.contains(&word) {
            if !is_called {
                let needed = "a \"(\" after the name of a function";
                return self.refuse(at, format!("\"{word}\""), needed);
            }
            match pair {
                Some(sign) => self.group(at, Open::Pair(sign), "#(("),
                None => self.group(at, Open::Function, &format!("{word}(")),
            }
            return Ok(to_parenthesis);
        }
        if is_called {
            let needed = format!("one of the functions {}, min, max", FUNCTIONS.join(", "));
            return self.refuse(at, format!("unknown function \"{word}\""), &needed);
        }
        self.wants_value = false;
        if word == "pi" {
            self.out.push_str("3.141592653589793");
            return Ok(word.len());
        }
        let parameter = self.parameters.iter().position(|known| *known == word);
        let symbol = match (word, parameter) {
            ("d", _) => Symbol::Displacement,
            ("v", _) => Symbol::Velocity,
            ("t", _) => Symbol::Time,
            (_, Some(place)) => {
                self.used[place] = true;
                Symbol::Parameter(place)
            }
            (_, None) => {
                let mut known = vec!["d", "v", "t", "pi"];
                known.extend(self.parameters);
                let needed = format!("one of {}", known.join(", "));
                return self.refuse(at, format!("unknown symbol \"{word}\""), &needed);
            }
        };
        self.out.push_str(&symbol_name(symbol));
        Ok(word.len())
    }

    fn close(&mut self, at: usize) -> Result<(), BadExpression> {
        if self.wants_value {
            return self.refuse(at, "\")\"".into(), VALUE);
        }
        match self.open.pop() {
            None => self.refuse(at, "\")\"".into(), "a \"(\" before it"),
            Some((Open::Pair(_), _)) => {
                self.refuse(at, "\")\"".into(), "two values with a comma between them")
            }
            Some((Open::AfterComma, _)) => {
                self.out.push_str("))");
                Ok(())
            }
            Some((Open::Group | Open::Function, _)) => {
                self.out.push(')');
                Ok(())
            }
        }
    }

    fn comma(&mut self, at: usize) -> Result<(), BadExpression> {
        if self.wants_value {
            return self.refuse(at, "\",\"".into(), VALUE);
        }
        match self.open.last_mut() {
            Some((open @ Open::Pair(_), _)) => {
                if let Open::Pair(sign) = *open {
                    self.out.push_str(&format!("){sign}("));
                }
                *open = Open::AfterComma;
                self.wants_value = true;
                Ok(())
            }
            _ => self.refuse(
                at,
                "\",\"".into(),
                "a comma between the two values of min or max only",
            ),
        }
    }
}

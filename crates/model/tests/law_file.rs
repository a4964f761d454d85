//! Laws of the user's in a model file: how expressions are read, what is refused, and where.

use simgap_model::{Expression, Function, Law, LawParameter, Model, Operation, Symbol};

const HEAD: &str = "schema = \"simgap-model/1\"\nname = \"m\"\n[[mass]]\nname = \"a\"\nvalue = 2.0\n[[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"a\"\n";

/// A law of a force over d, v, t, a and b.
fn law(force: &str) -> Law {
    let mut parameters = vec![
        LawParameter::of_size("a", "N", 20.0),
        LawParameter::of_size("b", "m/s", 0.05),
    ];
    // Every parameter has to be read.
    let is_read = |name: &str| {
        force
            .split(|c: char| !c.is_alphanumeric())
            .any(|word| word == name)
    };
    parameters.retain(|one| is_read(&one.name));
    if parameters.is_empty() {
        parameters.push(LawParameter::of_size("a", "N", 20.0));
    }
    Law {
        name: "grease".into(),
        summary: None,
        between: vec![],
        force: force.into(),
        parameters,
    }
}

/// As it is read, with every group in parentheses.
fn shown(expression: &Expression, law: &Law) -> String {
    match expression {
        Expression::Number(value) => value.to_string(),
        Expression::Symbol(Symbol::Displacement) => "d".into(),
        Expression::Symbol(Symbol::Velocity) => "v".into(),
        Expression::Symbol(Symbol::Time) => "t".into(),
        Expression::Symbol(Symbol::Parameter(place)) => law.parameters[*place].name.clone(),
        Expression::Function(Function::Negative, of) => format!("(-{})", shown(of, law)),
        Expression::Function(function, of) => {
            format!(
                "{}({})",
                format!("{function:?}").to_lowercase(),
                shown(of, law)
            )
        }
        Expression::Operation(operation, of) => {
            let sign = match operation {
                Operation::Add => "+",
                Operation::Subtract => "-",
                Operation::Multiply => "*",
                Operation::Divide => "/",
                Operation::Power => "^",
                Operation::Min => " min ",
                Operation::Max => " max ",
            };
            format!("({}{sign}{})", shown(&of[0], law), shown(&of[1], law))
        }
    }
}

#[test]
fn verify_signs_and_powers_bind_as_they_are_written() {
    for (text, read) in [
        (
            "a * tanh(v / b) * (1 + 2 * d^2)",
            "((a*tanh((v/b)))*(1+(2*(d^2))))",
        ),
        ("a - b + d", "((a-b)+d)"),
        ("a - b - d", "((a-b)-d)"),
        ("a / b * d", "((a/b)*d)"),
        ("a / b / d", "((a/b)/d)"),
        ("1 + 2 * 3 + a", "((1+(2*3))+a)"),
        ("a*-d^2", "(a*(-(d^2)))"),
        ("a-d^2", "(a-(d^2))"),
        ("-d^2*a", "((-(d^2))*a)"),
        ("(-d)^2*a", "(((-d)^2)*a)"),
        ("a-(d)^2", "(a-(d^2))"),
        ("a*-(d^2)^3", "(a*(-((d^2)^3)))"),
        ("a*--d^2", "(a*(-(-(d^2))))"),
        ("-a*v", "((-a)*v)"),
        ("a^b^d", "(a^(b^d))"),
        ("(a^b)^d", "((a^b)^d)"),
        ("a^-b^d", "(a^(-(b^d)))"),
        ("a*-sin(d)^2", "(a*(-(sin(d)^2)))"),
        ("a*sin(-d)^2", "(a*(sin((-d))^2))"),
        ("exp(-(v/a)^2)", "exp((-((v/a)^2)))"),
        ("+a", "a"),
        ("1e-3*a + 2.5E+2", "((0.001*a)+250)"),
        (".5*a", "(0.5*a)"),
        ("pi*a", "(3.141592653589793*a)"),
        ("min(a, max(b, d)) * 2", "((a min (b max d))*2)"),
        ("max(a - b, -min(d, v))", "((a-b) max (-(d min v)))"),
        ("a * abs ( v ) * v", "((a*abs(v))*v)"),
        ("a\n * v", "(a*v)"),
        ("((((a))))", "a"),
    ] {
        let law = law(text);
        let found = law.expression().map(|found| shown(&found, &law));
        assert_eq!(found, Ok(read.to_string()), "{text}");
    }
}

fn law_text(force: &str, parameters: &[&str]) -> String {
    let tables = parameters
        .iter()
        .map(|one| format!("[[law.parameter]]\n{one}\n"));
    let tables: String = tables.collect();
    format!("{HEAD}[[law]]\nname = \"grease\"\nforce = {force}\n{tables}")
}

const C: &str = "name = \"c\"\nunit = \"N\"\nusual = 20.0";

#[test]
fn regress_messages() {
    let with_c = |force: &str| law_text(force, &[C]);
    let force = "\"c * v\"";
    let cases = [
        ("unknown symbol", with_c("\"c * w\"")),
        ("unknown function", with_c("\"c * tan(v)\"")),
        ("function without parentheses", with_c("\"c * sin v\"")),
        ("unused parameter", with_c("\"2 * v\"")),
        ("no operator", with_c("\"2 c * v\"")),
        ("no value", with_c("\"c * / v\"")),
        ("the end", with_c("\"c * v +\"")),
        ("empty", with_c("\"\"")),
        ("python's power", with_c("\"c * v**2\"")),
        ("not closed", with_c("\"c * (v + (1 - v)\"")),
        ("not opened", with_c("\"c * v)\"")),
        ("comma", with_c("\"c * sin(v, d)\"")),
        ("one of two", with_c("\"c * min(v)\"")),
        ("character", with_c("\"c * v; d\"")),
        ("several lines", with_c("'''\n  c * v\n  + w'''")),
        ("escapes", with_c("\"c \\t * w\"")),
        ("too long", with_c(&format!("\"c{}\"", " + v".repeat(300)))),
        ("no parameter", law_text("\"v\"", &[])),
        (
            "duplicated law",
            format!("{}{}", with_c(force), &with_c(force)[HEAD.len()..]),
        ),
        ("duplicated parameter", law_text(force, &[C, C])),
        (
            "name",
            with_c(force).replace("\"grease\"", "\"Cold grease\""),
        ),
        ("parameter name", with_c(force).replace("\"c\"", "\"v\"")),
        ("unit", with_c(force).replace("unit = \"N\"", "unit = \"\"")),
        ("nothing known", with_c(force).replace("usual = 20.0", "")),
        (
            "half known",
            with_c(force).replace("usual = 20.0", "value = 1.0"),
        ),
        (
            "two known",
            with_c(force).replace("usual = 20.0", "usual = 1.0\nvalue = 1.0"),
        ),
        ("usual of zero", with_c(force).replace("20.0", "0.0")),
        (
            "usual outside",
            with_c(force).replace("20.0", "20.0\nupper = 10.0"),
        ),
        (
            "turned range",
            with_c(force).replace("usual = 20.0", "lower = 2.0\nupper = 1.0"),
        ),
        (
            "endless range",
            with_c(force).replace("usual = 20.0", "lower = 2.0\nupper = inf"),
        ),
        (
            "uncertainty",
            with_c(force).replace("usual = 20.0", "value = 2.0\nuncertainty = -1.0"),
        ),
        (
            "place",
            with_c(force).replace("force =", "between = [\"a\", \"b\"]\nforce ="),
        ),
        (
            "place of three",
            with_c(force).replace("force =", "between = [\"a\", \"b\", \"c\"]\nforce ="),
        ),
        ("unknown key", with_c(force).replace("usual", "typical")),
    ];
    let lines: Vec<String> = cases
        .iter()
        .map(|(name, text)| match Model::from_toml(text) {
            Ok(_) => format!("{name}: NOT REFUSED"),
            Err(error) => format!("{name}: {error}"),
        })
        .collect();
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn verify_a_law_is_written_as_it_was_read() {
    let one =
        law_text("\"c * v\"", &[C]).replace("force =", "between = [\"a\", \"ground\"]\nforce =");
    let several = one.replace(
        "[\"a\", \"ground\"]",
        "[[\"a\", \"ground\"], [\"ground\", \"a\"]]",
    );
    let either = one.replace("20.0", "20.0\nlower = -inf");
    for text in [one.clone(), several, either, law_text("'c * v'", &[C])] {
        let model = Model::from_toml(&text).unwrap();
        let written = model.to_toml().unwrap();
        assert_eq!(Model::from_toml(&written).unwrap(), model, "{written}");
    }
    let model = Model::from_toml(&one).unwrap();
    assert_eq!(model.law("grease").unwrap().between.len(), 1);
}

proptest::proptest! {
    /// Whatever the text, it is read or refused; what is refused has a place in the text.
    #[test]
    fn prop_no_text_is_too_strange(text in "[-+*/^(), .0-9abdvtex#<>é]{0,40}|([-+*/^(]|a|b|d|v|1|2\\.5|\\)|min\\(|, |sin\\(|abs\\(){0,25}") {
        if let Err(error) = law(&text).expression() {
            proptest::prop_assert!(!error.to_string().contains("cannot be read"), "{text}: {error}");
        }
    }
}

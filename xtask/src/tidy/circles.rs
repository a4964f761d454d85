//! The rule that files of a crate do not import each other in circles.
//!
//! A file needs another when its code names something that the other defines: `crate::`, `super::`,
//! `self::`, a child module or an imported one, in a `use` or in the code. Re-exports are followed to
//! the file that defines; to pass something on (`pub use`) is no need. Tests are left out.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::modules::Crate;
use super::{Finding, Workspace};

/// Which file needs which other, and in which line it says so.
type Needs<'a> = BTreeMap<&'a str, BTreeMap<&'a str, usize>>;

/// No file of a crate needs, over others, itself: one finding for each set of files that do, with a
/// shortest circle in it.
#[must_use]
pub fn no_file_imports_itself_over_others(workspace: &Workspace) -> Vec<Finding> {
    let shipped = || {
        let sources = workspace.sources.iter();
        sources.filter(|source| source.is_shipped())
    };
    let folders: BTreeSet<&str> = shipped().map(super::Source::folder).collect();
    let mut findings = Vec::new();
    for folder in folders {
        let found = Crate::of(shipped().filter(|source| source.folder() == folder));
        let needs = found.needs();
        let mut seen = BTreeSet::new();
        for file in needs.keys() {
            if seen.contains(file) {
                continue;
            }
            let together = together_with(&needs, file);
            seen.extend(together.iter().copied());
            let circles = together.iter().filter_map(|start| circle(&needs, start));
            if let Some(shortest) = circles.min_by_key(Vec::len) {
                findings.push(finding(&needs, &shortest));
            }
        }
    }
    findings
}

/// The files that a file needs, over others, and that need it so too; itself among them.
fn together_with<'a>(needs: &Needs<'a>, file: &'a str) -> BTreeSet<&'a str> {
    let mut backwards: Needs<'a> = BTreeMap::new();
    for (from, needed) in needs {
        for (to, line) in needed {
            backwards.entry(to).or_default().insert(from, *line);
        }
    }
    let onwards = reached(needs, file);
    onwards
        .intersection(&reached(&backwards, file))
        .copied()
        .collect()
}

/// The files that are reached from a file; itself among them.
fn reached<'a>(needs: &Needs<'a>, file: &'a str) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::from([file]);
    let mut open = vec![file];
    while let Some(next) = open.pop() {
        let needed = needs.get(next).into_iter().flat_map(BTreeMap::keys);
        open.extend(needed.filter(|file| found.insert(file)));
    }
    found
}

/// A shortest circle from a file back to it, by breadth-first search; nothing if there is none.
fn circle<'a>(needs: &Needs<'a>, start: &'a str) -> Option<Vec<&'a str>> {
    let mut ways = VecDeque::from([vec![start]]);
    let mut seen = BTreeSet::new();
    while let Some(way) = ways.pop_front() {
        let last = way.last()?;
        for next in needs.get(last).into_iter().flat_map(BTreeMap::keys) {
            let longer = || [way.as_slice(), &[*next]].concat();
            if *next == start {
                return Some(longer());
            }
            if seen.insert(*next) {
                ways.push_back(longer());
            }
        }
    }
    None
}

/// One circle in a line, found where its first file needs the second.
fn finding(needs: &Needs<'_>, circle: &[&str]) -> Finding {
    let line = match circle {
        [first, second, ..] => needs[first][second],
        _ => 1,
    };
    let names: Vec<&str> = circle
        .iter()
        .map(|file| file.split_once("src/").map_or(*file, |(_, inside)| inside))
        .collect();
    Finding {
        file: circle[0].to_owned(),
        line,
        message: format!(
            "imports in a circle: {}; what both need belongs in a file of its own",
            names.join(" -> ")
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Source;
    use super::*;

    fn circles(files: &[(&str, &str)]) -> Vec<String> {
        let source = |(path, text): &(&str, &str)| Source {
            path: format!("crates/model/src/{path}"),
            text: (*text).to_owned(),
        };
        let workspace = Workspace {
            sources: files.iter().map(source).collect(),
            ..Workspace::default()
        };
        no_file_imports_itself_over_others(&workspace)
            .iter()
            .map(ToString::to_string)
            .collect()
    }

    const ROOT: (&str, &str) = ("lib.rs", "mod a;\nmod b;\nmod c;\npub use b::B;\n");

    #[test]
    fn verify_a_circle_is_found_and_named_in_a_line() {
        let files = [
            ROOT,
            ("a.rs", "\nuse crate::b::{self, B};\n"),
            ("b.rs", "pub struct B;\nfn f() {\n    super::c::g();\n}\n"),
            ("c.rs", "use std::{fmt, fs};\nuse crate::{a::{x, y}};\n"),
        ];
        let message = "imports in a circle: a.rs -> b.rs -> c.rs -> a.rs; \
                       what both need belongs in a file of its own";
        assert_eq!(
            circles(&files),
            [format!("crates/model/src/a.rs:2: {message}")]
        );
        assert_eq!(circles(&files[..3]), [""; 0]);
    }

    #[test]
    fn verify_re_exports_are_followed_and_are_no_need() {
        let a = ("a.rs", "use crate::B;\n");
        let to_a = ("b.rs", "use crate::a::A;\npub struct B;\n");
        assert_eq!(circles(&[ROOT, a, to_a]).len(), 1);
        let root = ("lib.rs", "mod a;\nmod b;\npub use b::*;\n");
        assert_eq!(circles(&[root, a, to_a]).len(), 1);
        // `lib.rs` passes B on; it needs it only where its own code names it.
        let to_root = ("b.rs", "use crate::LARGEST;\npub struct B;\n");
        let root = "mod b;\npub use b::B;\npub const LARGEST: usize = 3;\n";
        assert_eq!(circles(&[("lib.rs", root), to_root]), [""; 0]);
        // Nor does it need what has the name of the module it declares.
        let named = root.replace("b::B", "b::{B, b}");
        assert_eq!(circles(&[("lib.rs", &named), to_root]), [""; 0]);
        let root = format!("{root}fn f(b: B) {{}}\n");
        assert_eq!(circles(&[("lib.rs", &root), to_root]).len(), 1);
    }

    #[test]
    fn verify_a_child_that_uses_what_its_parent_defines_is_found() {
        let root = ("lib.rs", "mod p;\n");
        let child = ("p/child.rs", "use super::LANES;\npub fn f() {}\n");
        let parent = "mod child;\npub const LANES: usize = 8;\n";
        for call in [
            "fn g() { child::f(); }\n",
            "use self::child::f;\n",
            "use child::f as h;\n",
        ] {
            let parent = format!("{parent}{call}");
            for path in ["p.rs", "p/mod.rs"] {
                let found = circles(&[root, (path, &parent), child]);
                assert_eq!(found.len(), 1, "{path} {call}");
            }
        }
        assert_eq!(circles(&[root, ("p/mod.rs", parent), child]), [""; 0]);
    }

    #[test]
    fn verify_modules_by_another_name_are_followed() {
        let a = ("a.rs", "use crate::b;\nfn f() {\n    b::g();\n}\n");
        let b = ("b.rs", "use super::a as other;\nfn g() { other::f(); }\n");
        assert_eq!(circles(&[ROOT, a, b]).len(), 1);
        let b = ("b.rs", "use super::a as other;\nfn g() {}\n");
        assert_eq!(circles(&[ROOT, a, b]), [""; 0]);
    }

    #[test]
    fn verify_tests_text_and_other_crates_are_no_needs() {
        let a = ("a.rs", "use crate::b::g;\n");
        for b in [
            "fn g() {}\n#[cfg(test)]\nmod tests {\n    use crate::a::A;\n}\n",
            "#[cfg(test)]\nuse crate::a::A;\nfn g() {}\n",
            "fn g() {}\n#[cfg(all(test, unix))]\nmod tests {\n    use crate::a::A;\n}\n",
            "//! [`crate::a::A`]\nfn g() { h(\"crate::a::A\"); }\n",
            "use other::a::A;\npub(in crate::a) fn g() {}\n",
        ] {
            assert_eq!(circles(&[ROOT, a, ("b.rs", b)]), [""; 0], "{b}");
        }
        let root = ("lib.rs", "mod a;\n#[cfg(test)]\nmod b;\npub use a::A;\n");
        let b = ("b.rs", "use crate::A;\n");
        assert_eq!(circles(&[root, a, b]), [""; 0]);
        // A program beside a library is another crate.
        let main = ("main.rs", "mod a;\nfn f() { a::g(); }\n");
        let a = ("a.rs", "use crate::f;\n");
        assert_eq!(circles(&[("lib.rs", "pub mod a;\n"), main, a]), [""; 0]);
        assert_eq!(circles(&[main, a]).len(), 1);
    }
}

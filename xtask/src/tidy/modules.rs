//! The modules of a crate: what each file defines, imports and names, and where a path leads.

use std::collections::{BTreeMap, BTreeSet};

use super::Source;
use super::tokens::{Token, tokens};

/// A path of a module inside its crate; empty for the root.
type ModulePath = Vec<String>;

/// A path in the code, such as `crate::a::B`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Named {
    /// Line, from 1.
    pub(super) line: usize,
    /// Parts of the path; the last is `*` where everything is imported.
    pub(super) parts: Vec<String>,
}

/// What a `use` brings in.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Import {
    named: Named,
    /// Name in the file; `*` where everything is imported.
    name: String,
    /// Whether it is passed on (`pub use`).
    passed_on: bool,
}

/// A file of a crate.
#[derive(Debug, Default)]
struct Module {
    /// Path from the root of the workspace.
    file: String,
    /// Items at the top of the file.
    defined: BTreeSet<String>,
    imports: Vec<Import>,
    /// Paths of two parts and more outside `use`.
    paths: Vec<Named>,
    /// Names outside `use`.
    names: BTreeSet<String>,
}

/// Where a path leads.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Target {
    /// To a module itself.
    Module(ModulePath),
    /// To an item of a module.
    Item(ModulePath),
}

/// The modules of one crate.
#[derive(Debug, Default)]
pub(super) struct Crate {
    modules: BTreeMap<ModulePath, Module>,
}

/// Longest chain of re-exports that is followed.
const LONGEST_CHAIN: usize = 16;

/// Keywords that an item's name follows.
const ITEMS: [&str; 9] = [
    "const", "enum", "fn", "mod", "static", "struct", "trait", "type", "union",
];

impl Crate {
    /// The modules of the library of a package, or of its program where it has none.
    pub(super) fn of<'a>(sources: impl Iterator<Item = &'a Source>) -> Crate {
        let mut modules = BTreeMap::new();
        for source in sources {
            let Some((_, inside)) = source.path.split_once("src/") else {
                continue;
            };
            let inside = inside.trim_end_matches(".rs");
            let mut path: ModulePath = inside.split('/').map(ToOwned::to_owned).collect();
            if matches!(path.last().map(String::as_str), Some("mod" | "lib")) {
                path.pop();
            }
            modules.insert(path, Module::of(source));
        }
        // A program beside a library uses it by the name of the package, as anybody does.
        let program = modules.remove(&["main".to_owned()][..]);
        if let Some(program) = program {
            modules.entry(Vec::new()).or_insert(program);
        }
        for outside in tests_of(&modules) {
            modules.remove(&outside);
        }
        Crate { modules }
    }

    /// Which file needs which other, with the line of the first path that says so.
    pub(super) fn needs(&self) -> BTreeMap<&str, BTreeMap<&str, usize>> {
        let mut needs: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
        for (path, module) in &self.modules {
            let needed = needs.entry(&module.file).or_default();
            // What is only passed on to others is not needed here.
            let used = |import: &&Import| !import.passed_on || module.names.contains(&import.name);
            let imported = module.imports.iter().filter(used).map(|i| &i.named);
            for named in imported.chain(&module.paths) {
                if let Some(Target::Item(target)) = self.resolve(path, &named.parts, 0)
                    && let Some(target) = self.modules.get(&target)
                {
                    let line = needed.entry(&target.file).or_insert(named.line);
                    *line = named.line.min(*line);
                }
            }
            needed.remove(module.file.as_str());
        }
        needs
    }

    /// Where a path of a module leads; nothing where it leads out of the crate.
    fn resolve(&self, from: &ModulePath, parts: &[String], chain: usize) -> Option<Target> {
        let (first, rest) = parts.split_first()?;
        let mut target = match first.as_str() {
            "crate" => Target::Module(Vec::new()),
            "self" => Target::Module(from.clone()),
            "super" => Target::Module(parent(from)?),
            _ => self.in_scope(from, first, chain)?,
        };
        for part in rest {
            let Target::Module(module) = &target else {
                break;
            };
            target = match part.as_str() {
                "self" => continue,
                "super" => Target::Module(parent(module)?),
                "*" => return Some(Target::Item(module.clone())),
                name => self.look_up(module, name, chain)?,
            };
        }
        Some(target)
    }

    /// What the first name of a path stands for in a module: a child, or what is imported.
    fn in_scope(&self, module: &ModulePath, name: &str, chain: usize) -> Option<Target> {
        let child = [module.as_slice(), &[name.to_owned()]].concat();
        if self.modules.contains_key(&child) {
            return Some(Target::Module(child));
        }
        self.imported(module, name, chain)?
    }

    /// What an import of this name stands for: nothing if there is none, and nothing inside if it
    /// leads out of the crate.
    fn imported(&self, module: &ModulePath, name: &str, chain: usize) -> Option<Option<Target>> {
        let imports = &self.modules.get(module)?.imports;
        let import = imports.iter().find(|import| import.name == name)?;
        if chain == LONGEST_CHAIN || import.named.parts.first().is_some_and(|part| part == name) {
            return Some(None);
        }
        Some(self.resolve(module, &import.named.parts, chain + 1))
    }

    /// What a name of a module stands for, re-exports followed. A name that is not seen (a macro may
    /// make it) is taken for an item of the module.
    fn look_up(&self, module: &ModulePath, name: &str, chain: usize) -> Option<Target> {
        let child = [module.as_slice(), &[name.to_owned()]].concat();
        if self.modules.contains_key(&child) {
            return Some(Target::Module(child));
        }
        let here = Some(Target::Item(module.clone()));
        let found = self.modules.get(module)?;
        if found.defined.contains(name) || chain == LONGEST_CHAIN {
            return here;
        }
        if let Some(imported) = self.imported(module, name, chain) {
            return imported;
        }
        let all = found.imports.iter().filter(|import| import.name == "*");
        for import in all {
            let (_, path) = import.named.parts.split_last()?;
            if let Some(Target::Module(other)) = self.resolve(module, path, chain + 1)
                && self.modules.get(&other)?.defined.contains(name)
            {
                return Some(Target::Item(other));
            }
        }
        here
    }
}

/// Files that are modules of tests: `#[cfg(test)] mod tests;`.
fn tests_of(modules: &BTreeMap<ModulePath, Module>) -> Vec<ModulePath> {
    let declared = |path: &ModulePath| {
        let (name, above) = path.split_last()?;
        let above = modules.get(above)?;
        Some(above.defined.contains(name))
    };
    let is_outside = |path: &&ModulePath| declared(path) == Some(false);
    modules.keys().filter(is_outside).cloned().collect()
}

fn parent(module: &ModulePath) -> Option<ModulePath> {
    module.split_last().map(|(_, above)| above.to_vec())
}

impl Module {
    fn of(source: &Source) -> Module {
        let all = tokens(&source.text);
        let mut module = Module {
            file: source.path.clone(),
            ..Module::default()
        };
        let (mut at, mut depth) = (0, 0_usize);
        while at < all.len() {
            let begun = at;
            match all[at].text {
                "use" => at = module.take_imports(&all, at),
                "#" if is_for_tests(&all[at..]) => at = after_item(&all, at),
                "{" => depth += 1,
                "}" => depth = depth.saturating_sub(1),
                item if depth == 0 && ITEMS.contains(&item) => {
                    let next = all.get(at + 1).filter(|token| token.is_name());
                    module
                        .defined
                        .extend(next.map(|token| token.text.to_owned()));
                    // To declare a child is not to use it.
                    at += 2 * usize::from(item == "mod");
                }
                _ => {}
            }
            if at == begun {
                at = module.take_path(&all, at);
            }
        }
        module
    }

    /// Takes the imports of the `use` at this token; returns what follows.
    fn take_imports(&mut self, all: &[Token<'_>], at: usize) -> usize {
        let before = |back: usize| at.checked_sub(back).map_or("", |k| all[k].text);
        let passed_on = before(1) == "pub" || before(1) == ")";
        let end = at + all[at..].iter().take_while(|t| t.text != ";").count();
        let mut imports = Vec::new();
        use_tree(&all[at + 1..end], &[], &mut imports);
        self.imports
            .extend(imports.into_iter().map(|(named, name)| Import {
                named,
                name,
                passed_on,
            }));
        end + 1
    }

    /// Takes the name or the path at this token; returns what follows.
    fn take_path(&mut self, all: &[Token<'_>], at: usize) -> usize {
        if !all[at].is_name() {
            return at + 1;
        }
        let mut parts = vec![all[at].text.to_owned()];
        let mut next = at + 1;
        while let [colons, name, ..] = &all[next..]
            && colons.text == "::"
            && name.is_name()
        {
            parts.push(name.text.to_owned());
            next += 2;
        }
        self.names.insert(parts[0].clone());
        let goes_on = at > 0 && all[at - 1].text == "::";
        if parts.len() > 1 && !goes_on {
            let line = all[at].line;
            self.paths.push(Named { line, parts });
        }
        next
    }
}

/// Whether `#[cfg(test)]` or `#[cfg(all(test, ..))]` stands here.
fn is_for_tests(all: &[Token<'_>]) -> bool {
    let begins = |texts: &[&str]| {
        let tokens = all.iter().take(texts.len()).map(|token| token.text);
        tokens.eq(texts.iter().copied())
    };
    begins(&["#", "[", "cfg", "(", "test", ")"])
        || begins(&["#", "[", "cfg", "(", "all", "(", "test"])
}

/// What follows the item at this token: its `;`, or the end of its braces.
fn after_item(all: &[Token<'_>], at: usize) -> usize {
    let mut depth = 0_usize;
    for (k, token) in all.iter().enumerate().skip(at) {
        match token.text {
            "{" => depth += 1,
            "}" if depth <= 1 => return k + 1,
            "}" => depth -= 1,
            ";" if depth == 0 => return k + 1,
            _ => {}
        }
    }
    all.len()
}

/// The paths of a tree of imports, each with its name in the file.
fn use_tree(tree: &[Token<'_>], above: &[String], imports: &mut Vec<(Named, String)>) {
    let mut parts = above.to_vec();
    let mut name = None;
    let mut at = 0;
    while let Some(token) = tree.get(at) {
        match token.text {
            "::" => {}
            "as" => {
                at += 1;
                name = tree.get(at).map(|token| token.text.to_owned());
            }
            "{" => {
                let inside = &tree[at + 1..tree.len().saturating_sub(1)];
                for part in divided(inside) {
                    use_tree(part, &parts, imports);
                }
                return;
            }
            text => parts.push(text.to_owned()),
        }
        at += 1;
    }
    let own = |parts: &[String]| parts.iter().rev().find(|part| *part != "self").cloned();
    if let (Some(token), Some(own)) = (tree.first(), own(&parts)) {
        let line = token.line;
        imports.push((Named { line, parts }, name.unwrap_or(own)));
    }
}

/// The parts of a group, divided at commas outside braces.
fn divided<'t, 'a>(group: &'t [Token<'a>]) -> Vec<&'t [Token<'a>]> {
    let mut depth = 0_usize;
    let parts = group.split(|token| {
        match token.text {
            "{" => depth += 1,
            "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        token.text == "," && depth == 0
    });
    parts.filter(|part| !part.is_empty()).collect()
}

//! What the rules look at: packages, sources, and the page of references.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::Deserialize;

use super::TidyError;

/// A package of the workspace.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Package {
    /// Name, such as `simgap-model`.
    pub name: String,
    /// Last part of its folder, such as `model`.
    pub folder: String,
    /// Its manifest, from the root of the workspace.
    pub manifest: String,
    /// Text of the manifest.
    pub manifest_text: String,
    /// `package.metadata.simgap.floor`.
    pub floor: Option<u64>,
    /// Packages of the workspace it needs to be built.
    pub normal: Vec<String>,
    /// Packages of the workspace that its tests, benches and build script need besides.
    pub other: Vec<String>,
}

/// A Rust file of the workspace.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Path from the root of the workspace, with `/`.
    pub path: String,
    /// Text.
    pub text: String,
}

/// Everything the rules look at.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Workspace {
    /// Packages, by name.
    pub packages: Vec<Package>,
    /// Rust files of all packages: libraries, binaries, tests, benches, examples.
    pub sources: Vec<Source>,
    /// Kinds of the catalogue of effects.
    pub kinds: Vec<String>,
    /// Text of `docs/references.md`.
    pub references: String,
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<MetadataPackage>,
    workspace_root: PathBuf,
}

#[derive(Deserialize)]
struct MetadataPackage {
    name: String,
    manifest_path: PathBuf,
    metadata: serde_json::Value,
    dependencies: Vec<MetadataDependency>,
}

#[derive(Deserialize)]
struct MetadataDependency {
    name: String,
    kind: Option<String>,
    path: Option<PathBuf>,
}

/// Page that lists the references.
pub(super) const REFERENCES: &str = "docs/references.md";

/// Folders of a package that hold Rust files.
const AREAS: [&str; 4] = ["src", "tests", "benches", "examples"];

impl Workspace {
    /// Reads the workspace this program was built in.
    ///
    /// # Errors
    /// [`TidyError`] when cargo does not tell, or a file cannot be read.
    pub fn load() -> Result<Workspace, TidyError> {
        let metadata = metadata()?;
        let root = &metadata.workspace_root;
        let mut workspace = Workspace {
            kinds: simgap_effects::catalogue()
                .iter()
                .map(|effect| effect.kind().to_owned())
                .collect(),
            references: read(&root.join(REFERENCES))?,
            ..Workspace::default()
        };
        for package in &metadata.packages {
            let folder = package.manifest_path.parent().unwrap_or(root);
            workspace.packages.push(describe(root, folder, package)?);
            for area in AREAS {
                collect(root, &folder.join(area), &mut workspace.sources)?;
            }
        }
        workspace.packages.sort_by(|a, b| a.name.cmp(&b.name));
        workspace.sources.sort_by(|a, b| a.path.cmp(&b.path));
        Ok(workspace)
    }

    /// The package of a name.
    #[must_use]
    pub fn package(&self, name: &str) -> Option<&Package> {
        self.packages.iter().find(|package| package.name == name)
    }
}

impl Source {
    /// Name of the folder of its package: `model` for `crates/model/src/lib.rs`.
    #[must_use]
    pub fn folder(&self) -> &str {
        let mut parts = self.path.split('/');
        match parts.next() {
            Some("crates") => parts.next().unwrap_or_default(),
            first => first.unwrap_or_default(),
        }
    }

    /// Whether it belongs to the library or the binary, not to tests, benches or examples.
    #[must_use]
    pub fn is_shipped(&self) -> bool {
        self.path.contains("/src/")
    }
}

fn metadata() -> Result<Metadata, TidyError> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| env!("CARGO").into());
    let output = Command::new(cargo)
        .args([
            "metadata",
            "--format-version",
            "1",
            "--no-deps",
            "--offline",
        ])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .map_err(|source| TidyError::Start { source })?;
    if !output.status.success() {
        return Err(TidyError::Cargo {
            found: String::from_utf8_lossy(&output.stderr).trim().to_owned(),
        });
    }
    serde_json::from_slice(&output.stdout).map_err(|source| TidyError::Metadata { source })
}

fn describe(root: &Path, folder: &Path, package: &MetadataPackage) -> Result<Package, TidyError> {
    let of_kind = |normal: bool| {
        package
            .dependencies
            .iter()
            .filter(|dependency| dependency.path.is_some() && dependency.kind.is_none() == normal)
            .map(|dependency| dependency.name.clone())
            .collect()
    };
    let name = folder.file_name().unwrap_or_default();
    Ok(Package {
        name: package.name.clone(),
        folder: name.to_string_lossy().into_owned(),
        manifest: relative(root, &package.manifest_path),
        manifest_text: read(&package.manifest_path)?,
        floor: package.metadata["simgap"]["floor"].as_u64(),
        normal: of_kind(true),
        other: of_kind(false),
    })
}

fn collect(root: &Path, folder: &Path, sources: &mut Vec<Source>) -> Result<(), TidyError> {
    let refused = |source| TidyError::File {
        path: folder.to_owned(),
        source,
    };
    if !folder.is_dir() {
        return Ok(());
    }
    for entry in fs::read_dir(folder).map_err(refused)? {
        let path = entry.map_err(refused)?.path();
        if path.is_dir() {
            collect(root, &path, sources)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            sources.push(Source {
                path: relative(root, &path),
                text: read(&path)?,
            });
        }
    }
    Ok(())
}

fn read(path: &Path) -> Result<String, TidyError> {
    fs::read_to_string(path).map_err(|source| TidyError::File {
        path: path.to_owned(),
        source,
    })
}

fn relative(root: &Path, path: &Path) -> String {
    let path = path.strip_prefix(root).unwrap_or(path);
    path.to_string_lossy().replace('\\', "/")
}

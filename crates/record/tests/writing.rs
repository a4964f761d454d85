//! Files that are written together, and what is never replaced.
#![allow(clippy::unwrap_used)]
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::{FileTypeExt as _, symlink};
use std::path::Path;

use simgap_record::{Batch, ensure_replaceable, write_text_atomic};

fn names(dir: &Path) -> Vec<String> {
    let entries = fs::read_dir(dir).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn verify_all_files_or_none() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fs::write(at("a"), "old a").unwrap();
    fs::write(at("b"), "old b").unwrap();
    fs::create_dir_all(at("folder/inside")).unwrap();
    let mut batch = Batch::default();
    batch.add(&at("a"), "new a").unwrap();
    batch.add(&at("fresh"), "new").unwrap();
    batch.add(&at("folder"), "no place").unwrap();
    batch.add(&at("b"), "new b").unwrap();
    assert_eq!(fs::read_to_string(at("a")).unwrap(), "old a");
    batch.commit().unwrap_err();
    // Those that were in their places already are taken back.
    assert_eq!(fs::read_to_string(at("a")).unwrap(), "old a");
    assert_eq!(fs::read_to_string(at("b")).unwrap(), "old b");
    assert_eq!(names(dir.path()), ["a", "b", "folder"]);
    // What is dropped leaves no trace.
    let mut batch = Batch::default();
    batch.add(&at("a"), "new a").unwrap();
    assert_eq!(names(dir.path()).len(), 4);
    drop(batch);
    assert_eq!(names(dir.path()), ["a", "b", "folder"]);
    let mut batch = Batch::default();
    batch.add(&at("a"), "new a").unwrap();
    batch.add(&at("c"), "new c").unwrap();
    batch.commit().unwrap();
    assert_eq!(fs::read_to_string(at("a")).unwrap(), "new a");
    assert_eq!(names(dir.path()), ["a", "b", "c", "folder"]);
}

#[test]
fn verify_symbolic_links_are_written_through() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fs::create_dir(at("elsewhere")).unwrap();
    fs::write(at("elsewhere/real"), "old").unwrap();
    symlink("elsewhere/real", at("link")).unwrap();
    symlink("link", at("link to the link")).unwrap();
    write_text_atomic(&at("link to the link"), "new").unwrap();
    assert_eq!(fs::read_to_string(at("elsewhere/real")).unwrap(), "new");
    for link in ["link", "link to the link"] {
        assert!(fs::symlink_metadata(at(link)).unwrap().is_symlink());
    }
    // A link to what is not there yet.
    symlink("elsewhere/later", at("dangling")).unwrap();
    write_text_atomic(&at("dangling"), "made").unwrap();
    assert_eq!(fs::read_to_string(at("elsewhere/later")).unwrap(), "made");
    symlink("circle", at("circle")).unwrap();
    write_text_atomic(&at("circle"), "nowhere").unwrap_err();
}

#[test]
fn regress_what_is_never_replaced() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let made = std::process::Command::new("mkfifo")
        .arg(at("fifo"))
        .status();
    assert!(made.unwrap().success());
    let _socket = std::os::unix::net::UnixListener::bind(at("socket")).unwrap();
    symlink("fifo", at("link")).unwrap();
    let mut told = vec![];
    for path in [at("fifo"), at("socket"), at("link"), "/dev/null".into()] {
        let checked = ensure_replaceable(&path).unwrap_err().to_string();
        assert_eq!(
            write_text_atomic(&path, "x").unwrap_err().to_string(),
            checked
        );
        told.push(checked.replace(&dir.path().display().to_string(), "[dir]"));
    }
    assert!(fs::metadata(at("fifo")).unwrap().file_type().is_fifo());
    assert!(fs::metadata(at("socket")).unwrap().file_type().is_socket());
    assert!(
        fs::metadata("/dev/null")
            .unwrap()
            .file_type()
            .is_char_device()
    );
    assert_eq!(names(dir.path()), ["fifo", "link", "socket"]);
    insta::assert_snapshot!(told.join("\n"), @r"
    [dir]/fifo: cannot be written: it is a pipe (FIFO), which is never replaced; a file or nothing there is needed
    [dir]/socket: cannot be written: it is a socket, which is never replaced; a file or nothing there is needed
    [dir]/link: cannot be written: it is a pipe (FIFO), which is never replaced; a file or nothing there is needed
    /dev/null: cannot be written: it is a device, which is never replaced; a file or nothing there is needed
    ");
}

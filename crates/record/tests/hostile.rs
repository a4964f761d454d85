//! Damaged and hostile files of every format: a record or one clear line, in bounded time.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use proptest::prelude::*;
use simgap_record::{ReadOptions, parse_file};

/// One of each reader, and of each way through it.
const FILES: &[&str] = &[
    "vectors.mat",
    "vectors-compressed.mat",
    "struct.mat",
    "ascii.uff",
    "binary.uff",
    "pairs.uff",
    "waveform.tdms",
    "logger.csv",
    "variants/offset.tdms",
    "variants/big-endian.tdms",
    "variants/dspace.mat",
    "variants/simulink.mat",
    "variants/others.mat",
    "variants/epoch-ns.mat",
    "variants/table-v7.mat",
    "variants/timetable-v7.mat",
    "variants/timetable-v6.mat",
    "variants/each.mat",
    "variants/milliseconds.tdms",
    "variants/late.uff",
    "instruments/lvm-no-x.lvm",
    "instruments/siglent-sds.csv",
    "instruments/keysight-daq.csv",
    "variants/savetxt-header.txt",
    "instruments/lvm-one-x.lvm",
    "instruments/lvm-each-x.lvm",
    "instruments/F0000CH1.CSV",
    "instruments/rigol-ds1000z.csv",
    "instruments/rigol-mso5000.csv",
    "instruments/gw-instek-fast.csv",
    "instruments/twincat-scope.csv",
    "instruments/campbell-toa5.dat",
    "instruments/iba-clock.txt",
    "instruments/ros-topic.csv",
    #[cfg(feature = "arrow")]
    "variants/lz4.feather",
    #[cfg(feature = "arrow")]
    "variants/zstd.feather",
    #[cfg(feature = "arrow")]
    "variants/polars.arrow",
    #[cfg(feature = "xlsx")]
    "variants/dated.xlsx",
    #[cfg(feature = "mdf")]
    "variants/transposed.mf4",
    #[cfg(feature = "mdf")]
    "variants/converted.mf4",
    #[cfg(feature = "mdf")]
    "variants/version-3.mdf",
    #[cfg(feature = "parquet")]
    "variants/polars-duration.parquet",
    #[cfg(feature = "parquet")]
    "variants/half-decimal.parquet",
    #[cfg(feature = "matlab73")]
    "variants/latest.h5",
    #[cfg(feature = "matlab73")]
    "variants/extents.h5",
    #[cfg(feature = "matlab73")]
    "variants/timetable-v73.mat",
    #[cfg(feature = "matlab73")]
    "variants/signals-v73.mat",
    #[cfg(feature = "matlab73")]
    "variants/records.h5",
    #[cfg(feature = "parquet")]
    "snappy.parquet",
    #[cfg(feature = "parquet")]
    "gzip.parquet",
    #[cfg(feature = "parquet")]
    "stamps.parquet",
    #[cfg(feature = "matlab73")]
    "matlab73.mat",
    #[cfg(feature = "matlab73")]
    "struct73.mat",
    #[cfg(feature = "matlab73")]
    "plain.h5",
];
/// A damaged file of 20 kB is read in milliseconds of a processor; so long takes none.
const LONGEST: Duration = Duration::from_secs(10);
/// Milliseconds of the slowest so far, for the report of the long run.
static SLOWEST: AtomicU64 = AtomicU64::new(0);
/// Minutes of the long run, for each reader: `SIMGAP_FUZZ_MINUTES=10 cargo test ... --ignored`.
const MINUTES: &str = "SIMGAP_FUZZ_MINUTES";

fn bytes_of(name: &str) -> Vec<u8> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/records");
    std::fs::read(folder.join(name)).unwrap()
}

/// Time this thread was on a processor, which a busy machine does not stretch; where the system
/// does not tell, time on the clock.
fn busy(start: Instant) -> Duration {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanos = told.and_then(|text| text.split_whitespace().next()?.parse().ok());
    nanos.map_or_else(|| start.elapsed(), Duration::from_nanos)
}

/// Reads, whatever comes of it, and whether it is a record; an error has one line.
fn survives(name: &str, bytes: &[u8]) -> bool {
    let start = Instant::now();
    let before = busy(start);
    let mut read = false;
    for options in [ReadOptions::all(), ReadOptions::channels(["u"], ["y"])] {
        match parse_file(name, bytes, &options) {
            Ok(_) => read = true,
            Err(error) => {
                let line = error.to_string();
                assert!(
                    !line.is_empty() && !line.contains(char::is_control),
                    "{name}: {line:?}"
                );
            }
        }
    }
    let took = busy(start).saturating_sub(before);
    assert!(took < LONGEST, "{name}: {took:?}");
    SLOWEST.fetch_max(took.as_millis() as u64, Ordering::Relaxed);
    read
}

/// What is done to a file.
#[derive(Debug, Clone)]
enum Damage {
    Cut(prop::sample::Index),
    Flip(prop::sample::Index, u8),
    /// All bits of a word set: a size of gigabytes or terabytes.
    Claim(prop::sample::Index, bool),
    Insert(prop::sample::Index, Vec<u8>),
    Remove(prop::sample::Index, u8),
    Repeat(prop::sample::Index, u8),
}

fn damage() -> impl Strategy<Value = Damage> {
    let at = any::<prop::sample::Index>;
    prop_oneof![
        at().prop_map(Damage::Cut),
        (at(), any::<u8>()).prop_map(|(at, bits)| Damage::Flip(at, bits)),
        (at(), any::<bool>()).prop_map(|(at, long)| Damage::Claim(at, long)),
        (at(), prop::collection::vec(any::<u8>(), 1..9)).prop_map(|(at, b)| Damage::Insert(at, b)),
        (at(), any::<u8>()).prop_map(|(at, count)| Damage::Remove(at, count)),
        (at(), any::<u8>()).prop_map(|(at, count)| Damage::Repeat(at, count)),
    ]
}

fn damaged(mut bytes: Vec<u8>, damages: &[Damage]) -> Vec<u8> {
    for damage in damages {
        if bytes.is_empty() {
            break;
        }
        let len = bytes.len();
        let end = |at: usize, count: u8| (at + usize::from(count)).min(len);
        match damage {
            Damage::Cut(at) => bytes.truncate(at.index(len)),
            Damage::Flip(at, bits) => bytes[at.index(len)] ^= bits,
            Damage::Claim(at, long) => {
                let at = at.index(len);
                bytes[at..end(at, if *long { 8 } else { 4 })].fill(0xff);
            }
            Damage::Insert(at, new) => {
                let at = at.index(len);
                bytes.splice(at..at, new.iter().copied());
            }
            Damage::Remove(at, count) => {
                let at = at.index(len);
                bytes.drain(at..end(at, *count));
            }
            Damage::Repeat(at, count) => {
                let at = at.index(len);
                let again = bytes[at..end(at, *count)].to_vec();
                bytes.splice(at..at, again);
            }
        }
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn prop_damaged_files_are_read_or_refused_in_one_line(
        file in prop::sample::select(FILES.to_vec()),
        damages in prop::collection::vec(damage(), 1..6),
    ) {
        survives(file, &damaged(bytes_of(file), &damages));
    }

    #[test]
    fn prop_any_bytes_after_a_magic_are_read_or_refused_in_one_line(
        file in prop::sample::select(FILES.to_vec()),
        kept in 0usize..200,
        bytes in prop::collection::vec(any::<u8>(), 0..600),
    ) {
        let head = bytes_of(file);
        survives(file, &[&head[..kept.min(head.len())], &bytes].concat());
    }
}

#[test]
fn verify_no_name_of_a_column_breaks_a_message() {
    let mut text = String::from("t [s];u\r\tv [N\tN];y [mm]\n");
    for k in 0..20 {
        text += &format!("0,{k:02};{};1,5\n", if k < 10 { "NaN" } else { "2,5" });
    }
    let error = parse_file("A.csv", text.as_bytes(), &ReadOptions::all()).unwrap_err();
    let line = error.to_string();
    assert!(!line.contains(char::is_control), "{line:?}");
    assert!(line.contains("10 of 20 samples of column"), "{line:?}");
}

/// Every length a file can be cut to.
#[test]
fn verify_a_file_cut_anywhere_is_no_fault_of_ours() {
    for file in FILES {
        let bytes = bytes_of(file);
        // All of the heads, some of the long rest.
        let lengths = (0..bytes.len()).filter(|&k| k < 700 || k % 37 == 0);
        for length in lengths {
            survives(file, &bytes[..length]);
        }
    }
}

/// A block of zeros that unpacks to far more than the file: the limit stops it, not the memory.
#[test]
fn verify_a_bomb_does_not_go_off() {
    use std::io::Write as _;
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    let zeros = vec![0; 1 << 20];
    for _ in 0..64 {
        packed.write_all(&zeros).unwrap();
    }
    let packed = packed.finish().unwrap();
    let mut bytes = bytes_of("vectors.mat")[..128].to_vec();
    for _ in 0..40 {
        bytes.extend(15_u32.to_le_bytes());
        bytes.extend(u32::try_from(packed.len()).unwrap().to_le_bytes());
        bytes.extend(&packed);
    }
    // 40 elements of 64 MiB are 2.5 GiB.
    let error = parse_file("bomb.mat", &bytes, &ReadOptions::all()).unwrap_err();
    insta::assert_snapshot!(error.to_string());
}

/// Billions of structures without fields take no time.
#[test]
fn verify_an_array_of_nothing_is_passed_over() {
    let words = |words: &[u32]| -> Vec<u8> { words.iter().flat_map(|w| w.to_le_bytes()).collect() };
    let (flags, sizes) = ([6, 8, 2, 0], [5, 8, 1 << 18, 1 << 18]);
    // A name of one letter, a length of 32 for names of fields, none of them, and one element more.
    let rest = [1 << 16 | 1, u32::from(b'x'), 4 << 16 | 5, 32, 1, 0, 14, 0];
    let body = words(&[&flags[..], &sizes, &rest].concat());
    let mut bytes = bytes_of("vectors.mat")[..128].to_vec();
    bytes.extend(words(&[14, u32::try_from(body.len()).unwrap()]));
    bytes.extend(body);
    assert!(!survives("nothing.mat", &bytes));
}

/// Names that a file gives to columns stay in one line.
#[test]
fn verify_names_of_oscilloscopes_break_no_message() {
    for header in [
        "CH1\u{8e}1V,t0 = 0, tInc = 1e-3,\n",
        "X,CH\u{8e}1,Start,Increment,\nSequence,Volt,0,1e-3\n",
    ] {
        let text = header.to_owned() + &"x,x,,\n".repeat(9);
        assert!(!survives("scope.csv", text.as_bytes()));
    }
}

/// Memory that this process has had at most, where the system tells it.
fn peak_mib() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024)
}

/// A file that is written down if reading it fails.
struct Kept<'a>(&'a str, &'a [u8]);

impl Drop for Kept<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let path = std::env::temp_dir().join(format!("hostile-{}", self.0.replace('/', "-")));
            let written = std::fs::write(&path, self.1);
            println!("{}: {written:?}", path.display());
        }
    }
}

/// A long run with its own random numbers, a reader after the other; those with a part of their
/// name in `SIMGAP_FUZZ_FILES`, if it is set.
#[test]
#[ignore = "takes the minutes it is given for each reader"]
fn verify_a_long_run_of_damage() {
    use proptest::strategy::ValueTree as _;
    use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
    let minutes: f64 = std::env::var(MINUTES).map_or(0.1, |text| text.parse().unwrap());
    let part = std::env::var("SIMGAP_FUZZ_FILES").unwrap_or_default();
    let seed = std::process::id().to_le_bytes().repeat(8);
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    let damages = prop::collection::vec(damage(), 1..8);
    // Whoever sets a hook last sees all: readers hush their own panics from the first call on.
    assert!(FILES.iter().all(|file| survives(file, &bytes_of(file))));
    // Panics of other crates do not come out of the reader, but the hook sees them.
    let panics = Arc::new(AtomicU64::new(0));
    let counted = Arc::clone(&panics);
    std::panic::set_hook(Box::new(move |info| {
        let ours = info.location().is_some_and(|place| place.file() == file!());
        if ours || counted.fetch_add(1, Ordering::Relaxed) < 5 {
            println!("{info}");
        }
    }));
    for file in FILES.iter().filter(|file| file.contains(&part)) {
        let whole = bytes_of(file);
        let (start, mut runs, mut read) = (Instant::now(), 0_u64, 0_u64);
        while start.elapsed().as_secs_f64() < 60.0 * minutes {
            let damages = damages.new_tree(&mut runner).unwrap().current();
            let bytes = damaged(whole.clone(), &damages);
            let kept = Kept(file, &bytes);
            read += u64::from(survives(file, kept.1));
            runs += 1;
        }
        let (peak, panics) = (peak_mib(), panics.load(Ordering::Relaxed));
        let slowest = SLOWEST.load(Ordering::Relaxed);
        println!(
            "{file}: {runs} damaged files, {read} read; so far {panics} panics inside, peak {peak:?} MiB, slowest {slowest} ms"
        );
    }
}

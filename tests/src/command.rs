//! Running the command line as a user does.

use std::ffi::OsStr;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use low_action::setups::FOLDER_VARIABLE;
use tempfile::TempDir;

/// How a run of the command line ended.
#[derive(Debug)]
pub struct Finished {
    /// Exit code.
    pub code: i32,
    /// Standard output.
    pub output: Vec<u8>,
    /// Standard error.
    pub error: String,
}

impl Finished {
    /// Standard output as text.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.output).into_owned()
    }
}

/// A folder of its own to run the command line in; gone when dropped.
#[derive(Debug)]
pub struct Workplace {
    program: PathBuf,
    folder: TempDir,
}

impl Workplace {
    /// An empty folder, and the program: `env!("CARGO_BIN_EXE_low-action-command")`.
    pub fn new(program: &str) -> Workplace {
        Workplace {
            program: program.into(),
            folder: tempfile::tempdir().expect("temporary folders can be made"),
        }
    }

    /// The path of a file in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Makes a file in the folder.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, bytes).expect("files can be written");
        path
    }

    /// Names of all there is in the folder, hidden or not, in order.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("the folder can be read");
        let name = |entry: std::io::Result<fs::DirEntry>| {
            entry.map(|e| e.file_name().to_string_lossy().into_owned())
        };
        let mut names: Vec<_> = entries.filter_map(|entry| name(entry).ok()).collect();
        names.sort();
        names
    }

    /// Runs the command line in the folder with nothing on standard input.
    pub fn run<S: AsRef<OsStr>>(&self, arguments: &[S]) -> Finished {
        self.run_with(arguments, &[])
    }

    /// Runs the command line in the folder with these bytes on standard input.
    pub fn run_with<S: AsRef<OsStr>>(&self, arguments: &[S], input: &[u8]) -> Finished {
        let mut child = Command::new(&self.program)
            .args(arguments)
            .current_dir(self.folder.path())
            // A user without set-ups of their own, but for what is installed here.
            .env(FOLDER_VARIABLE, self.folder.path().join("instruments"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program was built with the tests");
        let mut pipe = child.stdin.take().expect("standard input is a pipe");
        // The program may refuse its arguments and never read.
        pipe.write_all(input).ok();
        drop(pipe);
        let done = child.wait_with_output().expect("the program ends");
        Finished {
            code: done.status.code().unwrap_or(-1),
            output: done.stdout,
            error: String::from_utf8_lossy(&done.stderr).into_owned(),
        }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }
}

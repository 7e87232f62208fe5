//! Files that appear whole or not at all.

use std::fs::{self, File};
use std::io::{self, Seek};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use tempfile::TempPath;

use super::unfinished::Unfinished;
use crate::files::beside;

/// Where a result goes.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Target {
    StandardOutput,
    /// A device or a pipe: written directly, since it cannot be replaced.
    Stream(PathBuf),
    /// An ordinary file, made or replaced.
    File(PathBuf),
}

/// A result being written. It is kept apart until [`publish`](Self::publish) and vanishes if that
/// never comes: an ordinary file is written beside its place and then renamed; standard output,
/// devices and pipes receive a finished copy.
#[derive(Debug)]
pub struct Draft {
    target: Target,
    file: File,
    beside: Option<(TempPath, Unfinished)>,
}

impl Draft {
    /// Begins a result that is to appear at `path`, where `-` is standard output.
    ///
    /// # Errors
    /// When the place is a folder, or nothing can be written beside it.
    pub fn begin(path: &Path) -> Result<Self> {
        let target = Target::find(path)?;
        let describe = || format!("cannot write {}", path.display());
        let (file, beside) = match &target {
            Target::File(path) => {
                let (file, beside) = beside(path).with_context(describe)?.into_parts();
                let unfinished = Unfinished::new(&beside);
                (file, Some((beside, unfinished)))
            }
            Target::StandardOutput | Target::Stream(_) => {
                (tempfile::tempfile().context("cannot make a temporary file")?, None)
            }
        };
        Ok(Self { target, file, beside })
    }

    /// A handle to write (and seek) with.
    ///
    /// # Errors
    /// When the system has no more handles.
    pub fn handle(&self) -> io::Result<File> {
        self.file.try_clone()
    }

    /// Lets the finished result appear.
    ///
    /// # Errors
    /// When the disk, device or pipe takes no more; nothing is left behind.
    pub fn publish(mut self) -> Result<()> {
        match (&self.target, self.beside) {
            (Target::StandardOutput, _) => {
                copy(&mut self.file, &mut io::stdout().lock()).context("cannot write to standard output")
            }
            (Target::Stream(path), _) => File::options()
                .write(true)
                .open(path)
                .and_then(|mut stream| copy(&mut self.file, &mut stream))
                .with_context(|| format!("cannot write {}", path.display())),
            (Target::File(path), beside) => beside
                .map_or(Ok(()), |(beside, _unfinished)| beside.persist(path).map_err(|error| error.error))
                .with_context(|| format!("cannot write {}", path.display())),
        }
    }
}

impl Target {
    fn find(path: &Path) -> Result<Self> {
        if path == Path::new("-") {
            return Ok(Self::StandardOutput);
        }
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => bail!("cannot write {}: it is a folder", path.display()),
            // Replaces what a link points to, not the link.
            Ok(found) if found.is_file() => Ok(Self::File(fs::canonicalize(path)?)),
            Ok(_) => Ok(Self::Stream(path.to_owned())),
            Err(_) => Ok(Self::File(path.to_owned())),
        }
    }
}

fn copy(from: &mut File, to: &mut impl io::Write) -> io::Result<()> {
    from.rewind()?;
    io::copy(from, to)?;
    to.flush()
}

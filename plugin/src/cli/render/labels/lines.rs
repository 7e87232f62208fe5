//! JSON that people can read and compare: a line for each key of the whole, and for each entry of its lists.

use std::io::{self, Write};

use serde_json::ser::Formatter;

/// The end of a whole, which comes nowhere else.
pub(super) const END: [u8; 3] = *b"\n}\n";

/// How deep in objects and lists the next thing is.
#[derive(Debug, Default)]
pub(super) struct Lines {
    depth: usize,
}

impl Formatter for Lines {
    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth += 1;
        out.write_all(b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth -= 1;
        out.write_all(if self.depth == 0 { &END } else { b"}" })
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.next(out, first, 1)
    }

    fn begin_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth += 1;
        out.write_all(b"[")
    }

    fn end_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth -= 1;
        out.write_all(b"]")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.next(out, first, 2)
    }
}

impl Lines {
    /// Goes on to the next key or entry, which has a line of its own at some depth.
    fn next<W: ?Sized + Write>(&self, out: &mut W, first: bool, own_line: usize) -> io::Result<()> {
        if !first {
            out.write_all(b",")?;
        }
        if self.depth == own_line { out.write_all(b"\n") } else { Ok(()) }
    }
}

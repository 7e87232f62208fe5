//! The user's own set-ups as one plugin sees them, and the one its session keeps.
//!
//! The files of the user's folder are numbered, in the order of their names, as they are when the plugin is loaded; others that are
//! found when a list of them opens come after those.
//! One that is chosen by its number is read and from then on kept, text and all: the session saves the text, and so
//! the project sounds the same on another machine and after the file was changed. Choosing another number lets go of
//! it, as does choosing anything in the editor's list. The audio thread sees nothing but numbers.

mod kept;
#[cfg(all(test, feature = "editor"))]
mod tests;

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};

use low_action_dsp::Setup;
use nice_plug::prelude::nice_error;

use crate::cli::one_line;
use crate::locked::lock;
use crate::setups::{self, SetupFile};
pub(crate) use kept::Kept;
pub use kept::Saved;

/// Files that can be chosen; those beyond are passed over.
pub const MOST_FILES: usize = 64;

/// Under which name the kept file is saved.
pub(crate) const KEPT: &str = "instrument_file";

/// The number that chooses no file.
pub(crate) const NONE: u32 = 0;

/// The name of a number without a file.
const NO_FILE: &str = "no such file";

#[derive(Debug)]
struct Inside {
    files: Mutex<Vec<SetupFile>>,
    kept: Mutex<Option<Kept>>,
    /// The number for which the kept file stands, [`NONE`] if for none.
    stands_for: AtomicU32,
    /// A number, and what it is to stand for when it is chosen: a file, or what the folder has.
    promised: Mutex<Option<(u32, Option<Kept>)>>,
    /// The number that was promised something else while it was chosen, until all that belongs to it is there; or [`NONE`].
    awaited: AtomicU32,
    chosen: AtomicU32,
    /// Grows when the same number comes to mean something else.
    edition: AtomicU32,
    /// How many sessions have been loaded.
    loads: AtomicU32,
    message: Mutex<Option<String>>,
    /// The file, and its edition, that cannot be played whatever is done to it, as was last found.
    replaced: Mutex<Option<(u32, u32)>>,
}

/// A shelf; clones are the same one.
#[derive(Debug, Clone)]
pub struct Shelf(Arc<Inside>);

impl Shelf {
    /// With the files that are in the user's folder now.
    pub(crate) fn of_user() -> Self {
        let mut files = setups::installed();
        if files.len() > MOST_FILES {
            nice_error!("{} set-up files, of which the first {MOST_FILES} can be chosen", files.len());
            files.truncate(MOST_FILES);
        }
        Self::new(files)
    }

    /// With these files.
    pub(crate) fn new(files: Vec<SetupFile>) -> Self {
        Self(Arc::new(Inside {
            files: Mutex::new(files),
            kept: Mutex::new(None),
            stands_for: AtomicU32::new(NONE),
            promised: Mutex::new(None),
            awaited: AtomicU32::new(NONE),
            chosen: AtomicU32::new(NONE),
            edition: AtomicU32::new(0),
            loads: AtomicU32::new(0),
            message: Mutex::new(None),
            replaced: Mutex::new(None),
        }))
    }

    /// Why what was chosen is not played, in one line, if it is not.
    pub fn message(&self) -> Option<String> {
        lock(&self.0.message).clone()
    }

    /// Takes in, after those that are known, files that somebody else has put into the user's folder since: another window, or
    /// `low-action instruments`.
    #[cfg(feature = "editor")]
    pub(crate) fn look_again(&self) {
        let found = setups::installed();
        let mut files = lock(&self.0.files);
        for file in found {
            let is_known = files.iter().any(|known| setups::is_same_name(&known.name, &file.name));
            if !is_known && files.len() < MOST_FILES {
                files.push(file);
            }
        }
    }

    /// How many files can be chosen.
    pub fn count(&self) -> usize {
        lock(&self.0.files).len()
    }

    /// Their names, that of number 1 first.
    pub fn names(&self) -> Vec<String> {
        lock(&self.0.files).iter().map(|file| file.name.clone()).collect()
    }

    /// The name of a number's file; none for 0 or if there is no such file.
    pub fn name(&self, number: u32) -> Option<String> {
        let name = |kept: &Kept| kept.name.clone();
        let known = self.of_held(number, name).or_else(|| self.of_promised(number, name));
        known.or_else(|| Some(self.file(number)?.name))
    }

    /// Takes in a file that has been written to the user's folder with such a text, and gives it back with its number: that
    /// of the file of this name, or the next one.
    ///
    /// # Errors
    /// When there are as many files as can be chosen.
    #[cfg(feature = "editor")]
    pub(crate) fn add(&self, file: SetupFile, text: String) -> Result<Kept, String> {
        let mut files = lock(&self.0.files);
        let place = files
            .iter()
            .position(|known| setups::is_same_name(&known.name, &file.name))
            .unwrap_or(files.len());
        if place == MOST_FILES {
            return Err(format!("{}: saved, but only {MOST_FILES} files can be chosen", file.name));
        }
        let kept = Kept { number: place as u32 + 1, name: file.name.clone(), text };
        match files.get_mut(place) {
            Some(known) => *known = file,
            None => files.push(file),
        }
        Ok(kept)
    }

    /// A file is chosen by its number. Called wherever parameters change: neither waits nor allocates.
    pub(crate) fn choose(&self, number: u32) {
        self.0.chosen.store(number, Ordering::Relaxed);
        let stands_for = self.0.stands_for.load(Ordering::Relaxed);
        if stands_for != NONE && stands_for != number {
            self.0.stands_for.store(NONE, Ordering::Relaxed);
            self.0.edition.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// The file that is kept for a number, if one is, or is to be: what is promised for it counts already.
    #[cfg(feature = "editor")]
    pub(crate) fn held(&self, number: u32) -> Option<Kept> {
        let kept = lock(&self.0.kept);
        let promised = lock(&self.0.promised).clone().filter(|(known, _)| *known == number && number != NONE);
        promised.map_or_else(|| self.stands(number, &kept).cloned(), |(_, file)| file)
    }

    fn of_held<T>(&self, number: u32, read: impl FnOnce(&Kept) -> T) -> Option<T> {
        self.stands(number, &lock(&self.0.kept)).map(read)
    }

    /// What is kept, if it stands for a number.
    fn stands<'a>(&self, number: u32, kept: &'a Option<Kept>) -> Option<&'a Kept> {
        let stands = number != NONE && self.0.stands_for.load(Ordering::Relaxed) == number;
        kept.as_ref().filter(|_| stands)
    }

    /// Has a number stand for a file that was kept before, or for what the folder has: once it is chosen, and where it is
    /// already, once [all that belongs to it](Self::keep_promise) is there.
    #[cfg(feature = "editor")]
    pub(crate) fn promise(&self, number: u32, file: Option<Kept>) {
        let mut promised = lock(&self.0.promised);
        *promised = Some((number, file));
        let is_chosen = self.0.chosen.load(Ordering::Relaxed) == number;
        self.0.awaited.store(if is_chosen { number } else { NONE }, Ordering::Release);
    }

    /// Whether what is chosen is about to become another file, of whose values some may be there and some not: what would be
    /// built now is neither. Neither waits nor allocates.
    pub(super) fn is_awaited(&self) -> bool {
        let awaited = self.0.awaited.load(Ordering::Acquire);
        awaited != NONE && awaited == self.0.chosen.load(Ordering::Relaxed)
    }

    fn of_promised<T>(&self, number: u32, read: impl FnOnce(&Kept) -> T) -> Option<T> {
        let promised = lock(&self.0.promised);
        let (_, file) = promised.as_ref().filter(|(known, _)| *known == number && number != NONE)?;
        file.as_ref().map(read)
    }

    /// All values that were asked for with a promise are there: it counts now, or no more.
    #[cfg(feature = "editor")]
    pub(crate) fn keep_promise(&self) {
        let mut kept = lock(&self.0.kept);
        let Some((number, file)) = lock(&self.0.promised).take() else { return };
        if number != NONE && self.0.chosen.load(Ordering::Relaxed) == number {
            self.stand(&mut kept, number, file);
        }
        // Whoever sees that nothing is awaited sees the edition, too.
        self.0.awaited.store(NONE, Ordering::Release);
    }

    /// Has the chosen number stand for a file, or for what the folder has.
    #[cfg(feature = "editor")]
    fn stand(&self, kept: &mut Option<Kept>, number: u32, file: Option<Kept>) {
        let is_file = file.is_some();
        let stands_for = if is_file { number } else { NONE };
        if is_file {
            *kept = file;
        }
        if self.0.stands_for.swap(stands_for, Ordering::Relaxed) == number || is_file {
            // Whoever has read it has read another, or has tried to and found none.
            self.0.edition.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Keeps a file from the start, and chooses it; gives back its number.
    pub(crate) fn keep(&self, name: &str, text: &str) -> u32 {
        let number = MOST_FILES as u32;
        *lock(&self.0.kept) = Some(Kept { number, name: name.into(), text: text.into() });
        self.0.stands_for.store(number, Ordering::Relaxed);
        self.0.chosen.store(number, Ordering::Relaxed);
        number
    }

    /// A number that tells apart what one number of a file means at different times.
    pub(super) fn edition(&self) -> u32 {
        self.0.edition.load(Ordering::Relaxed)
    }

    /// How many sessions have been loaded: what was done before the last one was done to another.
    #[cfg(feature = "editor")]
    pub(crate) fn loads(&self) -> u32 {
        self.0.loads.load(Ordering::Relaxed)
    }

    /// The set-up of a number.
    ///
    /// # Errors
    /// When there is no such file, or it is no set-up; in one line that names it.
    pub(super) fn setup(&self, number: u32) -> Result<Setup, String> {
        let Kept { name, text, .. } = self.take_up(number)?;
        if text.is_empty() {
            return Err(format!("{name}: the file could not be read when the session was saved"));
        }
        Setup::from_toml(&text).map_err(|error| one_line(&format!("{name}: {error}")))
    }

    /// Whether a number's own file is played when it is chosen, and nothing in its place.
    #[cfg(feature = "editor")]
    pub(crate) fn plays(&self, number: u32) -> bool {
        self.replaced() != Some((number, self.edition())) && self.setup(number).is_ok()
    }

    /// The file of a number, which is kept from now on.
    fn take_up(&self, number: u32) -> Result<Kept, String> {
        let mut kept = lock(&self.0.kept);
        if self.0.stands_for.load(Ordering::Relaxed) == number
            && let Some(kept) = &*kept
        {
            return Ok(kept.clone());
        }
        // Nobody may promise another one meanwhile: it would be taken for this.
        let mut promised = lock(&self.0.promised);
        let file = promised.as_ref().filter(|(known, _)| *known == number).and_then(|(_, file)| file.clone());
        let found = match file {
            Some(file) => file,
            None => self.read(number)?,
        };
        if self.0.chosen.load(Ordering::Relaxed) == number {
            *kept = Some(found.clone());
            self.0.stands_for.store(number, Ordering::Relaxed);
            // Also where it was what the folder has: kept later, it would be read once more.
            if promised.take_if(|(known, _)| *known == number).is_some() {
                self.0.awaited.store(NONE, Ordering::Release);
            }
        }
        Ok(found)
    }

    /// The file that the folder has under a number.
    fn read(&self, number: u32) -> Result<Kept, String> {
        let SetupFile { name, path } =
            self.file(number).ok_or_else(|| format!("there is no set-up file {number}"))?;
        let text = setups::read(&path).map_err(|error| one_line(&format!("{error:#}")))?;
        Ok(Kept { number, name, text })
    }

    fn file(&self, number: u32) -> Option<SetupFile> {
        lock(&self.0.files).get((number as usize).checked_sub(1)?).cloned()
    }

    /// Remembers why the chosen file is not played, or that all is well.
    pub fn tell(&self, message: Option<String>) {
        let mut present = lock(&self.0.message);
        if *present != message {
            if let Some(message) = &message {
                nice_error!("{message}");
            }
            *present = message;
        }
    }

    /// Remembers in whose place, by its number and edition, another instrument is played.
    pub(super) fn replace(&self, file: Option<(u32, u32)>) {
        *lock(&self.0.replaced) = file;
    }

    /// In whose place that is.
    #[cfg(feature = "editor")]
    pub(super) fn replaced(&self) -> Option<(u32, u32)> {
        *lock(&self.0.replaced)
    }

    /// Remembers something else, beside what has been told of the chosen file.
    pub(super) fn tell_also(&self, message: String) {
        let message = match self.message() {
            Some(present) => format!("{present}; {message}"),
            None => message,
        };
        self.tell(Some(message));
    }

    /// A number as hosts show it: with the name of its file, and what is wrong with the one that is chosen.
    pub(crate) fn title(&self, number: u32) -> String {
        if number == NONE {
            return "none".into();
        }
        let name = self.name(number).unwrap_or_else(|| NO_FILE.into());
        match self.message() {
            Some(message) if self.0.chosen.load(Ordering::Relaxed) == number => {
                format!("{number}: {name} ({message})")
            }
            _ => format!("{number}: {name}"),
        }
    }

    /// The number of a title, of a file's name or of the number itself.
    pub(crate) fn number(&self, title: &str) -> Option<i32> {
        let title = title.trim();
        if title.eq_ignore_ascii_case("none") {
            return Some(NONE as i32);
        }
        let place =
            lock(&self.0.files).iter().position(|file| file.name == title).map(|place| place as i32 + 1);
        place.or_else(|| title.split(':').next()?.trim().parse().ok())
    }
}

//! What is written of a scene: sound, trace and picture.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use low_action_dsp::digits::plain;
use low_action_dsp::{Scene, Simulation};
use low_action_figures::SceneFigure;

use super::scene_name;
use crate::cli::SceneArgs;
use crate::cli::names::shown;
use crate::cli::output::{Draft, publish_all};
use crate::cli::paths::is_dash;
use crate::cli::trace::Trace;
use crate::cli::wav::{BitDepth, Findings, WavFile};

/// What is written.
pub(super) struct Outputs {
    pub wav: Option<WavFile>,
    pub trace: Option<Trace>,
    pub figure: Option<Picture>,
}

impl Outputs {
    pub(super) fn begin(
        arguments: &SceneArgs,
        text: &str,
        scene: &Scene,
        simulation: &Simulation,
    ) -> Result<Outputs> {
        if arguments.wav.is_some() {
            check_sound(scene, simulation).with_context(|| scene_name(&arguments.file))?;
        }
        let begin = |path| WavFile::begin(path, 1, scene.sample_rate as u32, BitDepth::Float32);
        let wav = arguments.wav.as_deref().map(begin).transpose()?;
        let trace =
            arguments.trace.as_ref().map(|path| Trace::begin(path, text, simulation, arguments.every));
        let figure = arguments.figure.as_ref().map(|path| Picture::begin(path, arguments, scene, simulation));
        Ok(Outputs { wav, trace: trace.transpose()?, figure: figure.transpose()? })
    }

    /// Completes all files, then lets them appear: a disk that is full for one leaves none.
    pub(super) fn finish(self) -> Result<Option<Findings>> {
        let trace = self.trace.map(Trace::complete).transpose()?;
        let figure = self.figure.map(Picture::complete).transpose()?;
        let sound = self.wav.as_ref().map(WavFile::findings);
        let wav = self.wav.map(WavFile::complete).transpose()?;
        publish_all([wav, trace, figure].into_iter().flatten().collect())?;
        Ok(sound)
    }
}

/// A picture being made. Its file is opened at the beginning, so that a place where nothing can be written
/// is found out before anything is computed.
pub(super) struct Picture {
    path: PathBuf,
    draft: Draft,
    title: String,
    pub figure: SceneFigure,
}

impl Picture {
    fn begin(path: &Path, arguments: &SceneArgs, scene: &Scene, simulation: &Simulation) -> Result<Picture> {
        let title = match arguments.file.file_name() {
            Some(name) if !is_dash(&arguments.file) => shown(Path::new(name)),
            _ => "A scene".into(),
        };
        let figure = SceneFigure::new(scene, simulation);
        Ok(Picture { path: path.to_owned(), draft: Draft::begin(path)?, title, figure })
    }

    /// Draws it into its file, which then waits to be published.
    fn complete(self) -> Result<Draft> {
        let picture = self.figure.draw(&self.title)?;
        let written = self.draft.handle().and_then(|mut file| file.write_all(picture.as_bytes()));
        written.with_context(|| format!("cannot write {}", shown(&self.path)))?;
        Ok(self.draft)
    }
}

/// Refuses what no WAV file holds.
fn check_sound(scene: &Scene, simulation: &Simulation) -> Result<()> {
    let rate = scene.sample_rate;
    if rate.fract() != 0.0 {
        bail!("sample_rate = {} is refused: --wav needs a whole number of hertz", plain(rate));
    }
    let longest = BitDepth::Float32.largest_length(1);
    if simulation.samples() > longest {
        let longest = (longest as f64 / rate).floor();
        let (given, rate) = (plain(scene.duration), plain(rate));
        bail!("duration = {given} is refused: --wav holds at most {longest} s at {rate} Hz");
    }
    Ok(())
}

//! Tones for the participant, played by the system's player.
//!
//! A library for sound would need the headers of ALSA to build. A player of the system needs nothing, finds the desktop's sound
//! server by itself, and is there on the desktops of Linux and macOS. Its delay, some tens of milliseconds and that of the
//! loudspeaker, is in neither case known to the program: a tone's time is that of its request.

use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::{env, fs, process, thread};

use thermal_session::Cue;

/// Samples a second.
const RATE_HZ: u32 = 44_100;
/// Length of a tone, s.
const TONE_S: f64 = 0.2;
/// Time of rise and fall, s, without which a tone clicks.
const RAMP_S: f64 = 0.01;
/// Loudest sample, of 32767.
const AMPLITUDE: f64 = 16_000.0;
/// Tones that wait for the player; more are left out.
const WAITING_MAX: usize = 4;
/// Players, the first that is there is taken; each takes the file as its last argument.
const PLAYERS: [(&str, &[&str]); 4] =
    [("pw-play", &[]), ("paplay", &[]), ("aplay", &["-q"]), ("afplay", &[])];

/// A tone as a WAV file: mono, 16 bits.
pub fn wav(frequency_hz: u32) -> Vec<u8> {
    let count = (TONE_S * f64::from(RATE_HZ)) as u32;
    let bytes = 2 * count;
    let mut file = Vec::with_capacity(44 + bytes as usize);
    file.extend(b"RIFF");
    file.extend((36 + bytes).to_le_bytes());
    file.extend(b"WAVEfmt ");
    file.extend(16_u32.to_le_bytes());
    // PCM, one channel.
    file.extend([1, 0, 1, 0]);
    file.extend(RATE_HZ.to_le_bytes());
    file.extend((2 * RATE_HZ).to_le_bytes());
    file.extend([2, 0, 16, 0]);
    file.extend(b"data");
    file.extend(bytes.to_le_bytes());
    for index in 0..count {
        let t_s = f64::from(index) / f64::from(RATE_HZ);
        let ramp = (t_s.min(TONE_S - t_s) / RAMP_S).clamp(0.0, 1.0);
        let sample =
            AMPLITUDE * ramp * (std::f64::consts::TAU * f64::from(frequency_hz) * t_s).sin();
        file.extend((sample as i16).to_le_bytes());
    }
    file
}

/// A player of tones in a thread of its own.
#[derive(Clone, Debug)]
pub struct Tones {
    sender: SyncSender<Cue>,
    player: Option<&'static str>,
}

impl Tones {
    /// Starts the thread. Without a player it rings the terminal's bell.
    pub fn start() -> Self {
        let player = PLAYERS.into_iter().find(|(name, _)| is_in_path(name));
        let (sender, receiver) = sync_channel(WAITING_MAX);
        // Ends when nobody can send any more.
        thread::spawn(move || play_all(&receiver, player));
        Self { sender, player: player.map(|(name, _)| name) }
    }

    /// Name of the player; `None` if there is none.
    pub const fn player(&self) -> Option<&'static str> {
        self.player
    }

    /// Requests a tone; does not wait.
    pub fn play(&self, cue: Cue) {
        // A player that hangs costs tones, not the session.
        let _full = self.sender.try_send(cue);
    }
}

fn is_in_path(name: &str) -> bool {
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path).any(|folder| folder.join(name).is_file())
}

fn play_all(cues: &Receiver<Cue>, player: Option<(&str, &[&str])>) {
    let mut files: Vec<(u32, PathBuf)> = Vec::new();
    for cue in cues {
        let frequency_hz = cue.frequency_hz();
        let played = player.is_some_and(|(name, arguments)| {
            let known = files.iter().find(|(of, _)| *of == frequency_hz);
            let path = known.map(|(_, path)| path.clone()).or_else(|| {
                let file = format!("thermal-lab-{}-{frequency_hz}.wav", process::id());
                let path = env::temp_dir().join(file);
                fs::write(&path, wav(frequency_hz)).ok()?;
                files.push((frequency_hz, path.clone()));
                Some(path)
            });
            let Some(path) = path else { return false };
            let mut command = Command::new(name);
            command.args(arguments).arg(path).stdin(Stdio::null());
            let status = command.stdout(Stdio::null()).stderr(Stdio::null()).status();
            status.is_ok_and(|status| status.success())
        });
        if !played {
            // The bell says that something is to be done, if not what.
            let mut screen = std::io::stderr();
            let _ignored = screen.write_all(b"\x07").and_then(|()| screen.flush());
        }
    }
    for (_, path) in files {
        let _ignored = fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tone_has_its_length_and_its_frequency_and_no_click() {
        for cue in [Cue::Reach, Cue::Touch, Cue::Lift] {
            let file = wav(cue.frequency_hz());
            let (header, data) = file.split_at(44);
            assert_eq!(&header[..4], b"RIFF");
            let size = u32::from_le_bytes(header[40..44].try_into().unwrap());
            assert_eq!(size as usize, data.len());
            let (pairs, _) = data.as_chunks::<2>();
            let samples: Vec<_> = pairs.iter().map(|pair| i16::from_le_bytes(*pair)).collect();
            assert_eq!(samples.len(), 8820);
            let crossings = samples.windows(2).filter(|pair| pair[0] < 0 && pair[1] >= 0).count();
            let wanted = 0.2 * f64::from(cue.frequency_hz());
            assert!((crossings as f64 - wanted).abs() <= 1.5, "{crossings} {wanted}");
            assert!(samples[0].abs() < 100 && samples[8819].abs() < 200);
        }
    }

    #[test]
    fn a_flood_of_tones_does_not_wait() {
        let (sender, _receiver) = sync_channel(WAITING_MAX);
        let tones = Tones { sender, player: None };
        for _ in 0..100 {
            tones.play(Cue::Touch);
        }
    }
}

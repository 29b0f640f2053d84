//! The courses of a finger: the one that plays and the one that was loaded last.

use super::{Course, CourseChunk};

/// Two buffers: a course is loaded into the one that does not play, so loading never changes a course that plays.
#[derive(Clone, Debug, Default)]
pub struct CourseMemory {
    courses: [Course; 2],
    /// Whether a course was loaded, as a whole, since the start.
    loaded: bool,
    /// Whether the course that was loaded last is the second one.
    loaded_second: bool,
    /// Whether the course that plays, or did last, is the second one.
    playing_second: bool,
}

impl CourseMemory {
    /// Loads a chunk of a course, the first one first. The course replaces one that was loaded before and does not play; until
    /// its last chunk, none is loaded.
    pub fn load_chunk(&mut self, chunk: &CourseChunk<'_>) {
        self.loaded_second = !self.playing_second;
        self.loaded = self.courses[usize::from(self.loaded_second)].copy_chunk(chunk);
    }

    /// The course that was loaded last.
    pub fn loaded(&self) -> Option<&Course> {
        self.loaded.then(|| &self.courses[usize::from(self.loaded_second)])
    }

    /// Makes the course that was loaded last the one that plays.
    pub const fn play_loaded(&mut self) {
        self.playing_second = self.loaded_second;
    }

    /// The course that plays.
    pub fn playing(&self) -> &Course {
        &self.courses[usize::from(self.playing_second)]
    }
}

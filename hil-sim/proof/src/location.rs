//! The source location of a panic: the `core::panic::Location` among the arguments of its call.
use crate::flow::Target;
use crate::graph::Graph;
use crate::image::Image;

/// A place in a source file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    path: String,
    /// Line, from 1.
    pub line: u32,
}

/// Number of instructions before a call that may load its arguments.
const ARGUMENTS: usize = 6;

impl Location {
    /// The location that the call at an address passes; if it passes none, the one that the called function passes.
    pub fn of_call(image: &Image, graph: &Graph, at: u32) -> Option<Self> {
        let passed = image.loaded_before(at, ARGUMENTS).into_iter();
        passed.filter_map(|address| Self::read(image, address)).next_back().or_else(|| {
            let function = image.functions().find(|f| (f.start..f.end).contains(&at))?;
            let call = graph.flow(function.start)?.calls.get(&at)?;
            let Target::Function(called) = call.target else {
                return None;
            };
            let (inner, _) = graph.flow(called)?.calls.first_key_value()?;
            Self::of_call(image, graph, *inner)
        })
    }

    /// Reads address and length of the path, line and column.
    fn read(image: &Image, address: u32) -> Option<Self> {
        let word = |place: u32| image.word(address.checked_add(4 * place)?);
        let (path, length, line, column) = (word(0)?, word(1)?, word(2)?, word(3)?);
        if !(1..=1024).contains(&length) || line == 0 || column == 0 {
            return None;
        }
        let path = String::from_utf8(image.at(path, length as usize)?.to_vec()).ok()?;
        path.ends_with(".rs").then_some(Self { path, line })
    }

    /// Whether it is a file of this project: its path is relative to the workspace.
    pub fn is_ours(&self) -> bool {
        !self.path.starts_with('/')
    }

    /// Package and file, without the package's version.
    pub fn file(&self) -> String {
        let Some((before, file)) = self.path.rsplit_once("/src/") else {
            return self.path.clone();
        };
        let package = before.rsplit('/').next().unwrap_or(before);
        let name = package.split_once("-0.").or(package.split_once("-1."));
        format!("{}/src/{file}", name.map_or(package, |(name, _)| name))
    }
}

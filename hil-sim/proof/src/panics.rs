//! Panics: calls of functions that never return, and the handlers that can reach them.
use std::collections::BTreeMap;

use anyhow::Result;

use crate::allowed::{Allowed, CONTROL, HOST, LEARN, PANICS};
use crate::flow::Target;
use crate::graph::Graph;
use crate::image::Image;
use crate::location::Location;
use crate::names::{Frame, Names};
use crate::{Proof, Section};

/// A call of a function that never returns.
#[derive(Clone, Debug)]
pub struct Site {
    /// Address of the call.
    pub at: u32,
    /// The function that contains it: the innermost outside of the core library, or the outermost of the core library; if
    /// the compiler has merged several calls, their source file.
    pub owner: String,
    /// Whether it belongs to this project.
    pub ours: bool,
    /// Inlined functions at the address, innermost first.
    pub chain: String,
    /// The called function.
    pub called: String,
}

impl Site {
    fn new(image: &Image, graph: &Graph, names: &Names, at: u32, called: u32) -> Self {
        let frames = names.frames(at);
        let owner = frames.iter().find(|frame| !frame.is_core()).or(frames.last());
        let owner = owner.cloned().unwrap_or_else(|| Frame::unknown(at));
        // Without a line, the compiler has merged several panics; only their argument contains the location.
        let merged =
            Location::of_call(image, graph, at).filter(|_| !owner.has_line() && !owner.is_core());
        Self {
            at,
            ours: merged.as_ref().map_or(owner.is_ours(), Location::is_ours),
            owner: merged.map_or(owner.function, |location| location.file()),
            chain: names.chain(at),
            called: image.name(called).into(),
        }
    }
}

impl Site {
    fn violation(&self, tree: &str) -> String {
        let Self { at, called, chain, .. } = self;
        let whose = if self.ours { "our own code" } else { "a library" };
        format!("{tree} can panic in {whose} at {at:#010x}, {called}: {chain}")
    }
}

/// All such calls that are reachable from a function, by address.
pub fn sites(image: &Image, graph: &Graph, names: &Names, root: u32) -> Vec<Site> {
    let mut sites = Vec::new();
    for function in &graph.reached(root) {
        for (at, call) in graph.flow(*function).into_iter().flat_map(|flow| &flow.calls) {
            if let Target::Function(called) = call.target
                && !graph.returns(called)
            {
                sites.push(Site::new(image, graph, names, *at, called));
            }
        }
    }
    sites.sort_by_key(|site| site.at);
    sites
}

/// Checks that the control path, the learner and the task that answers the host contain no panic of this project's own code
/// and only the allowed panics of libraries.
///
/// # Errors
/// A handler is missing.
pub fn check(proof: &Proof) -> Result<Section> {
    let mut section = Section { title: "panics".into(), ..Section::default() };
    let mut allowed = Allowed::new(&PANICS);
    for tree in CONTROL.into_iter().chain([LEARN, HOST]) {
        let root = proof.root(tree)?;
        let reached = proof.graph.reached(root);
        let sites = sites(&proof.image, &proof.graph, &proof.names, root);
        let ours = sites.iter().filter(|site| site.ours).count();
        section.lines.push(format!(
            "{tree}: {} functions, {} calls of what never returns, {ours} of them in our own code",
            reached.len(),
            sites.len()
        ));
        let mut owners = BTreeMap::<&str, usize>::new();
        for site in &sites {
            *owners.entry(&site.owner).or_default() += 1;
            if allowed.why(tree, &site.owner).is_none() {
                let list =
                    if site.ours { &mut section.violations } else { &mut section.differences };
                list.push(site.violation(tree));
            }
        }
        section.lines.extend(owners.iter().map(|(owner, count)| format!("  {count} in {owner}")));
        for function in &reached {
            let undefined =
                proof.graph.flow(*function).into_iter().flat_map(|flow| &flow.undefined);
            let violation = |at: &u32| {
                format!("{tree} can run into an undefined instruction: {}", proof.names.chain(*at))
            };
            section.violations.extend(undefined.map(violation));
        }
    }
    section.differences.extend(allowed.unused());
    Ok(section)
}

//! Which function calls which, in the whole image.
use std::collections::{BTreeMap, BTreeSet};

use crate::flow::{Call, Flow, Target, follow};
use crate::image::Image;

/// The functions of an image and their calls.
pub struct Graph {
    flows: BTreeMap<u32, Flow>,
    returns: BTreeSet<u32>,
    /// What a call through a register can reach: every function whose address is taken, but for exceptions' handlers.
    targets: BTreeSet<u32>,
}

impl Graph {
    /// Follows every function, and again until it is settled which of them return: at first none is taken to, so that
    /// those remain that cannot.
    pub fn new(image: &Image, handlers: &BTreeSet<u32>) -> Self {
        let mut graph = Self {
            flows: BTreeMap::new(),
            returns: BTreeSet::new(),
            targets: image.taken().difference(handlers).copied().collect(),
        };
        loop {
            let known = graph.returns.len();
            for function in image.functions() {
                let flow = follow(image, function, &graph.returns);
                if flow.returns {
                    graph.returns.insert(function.start);
                }
                graph.flows.insert(function.start, flow);
            }
            if graph.returns.len() == known {
                return graph;
            }
        }
    }

    /// What is known of the function that begins at an address.
    pub fn flow(&self, start: u32) -> Option<&Flow> {
        self.flows.get(&start)
    }

    /// Whether a function can return.
    pub fn returns(&self, start: u32) -> bool {
        self.returns.contains(&start)
    }

    /// What a call can reach.
    pub fn targets(&self, call: &Call) -> impl Iterator<Item = u32> {
        let (one, any) = match call.target {
            Target::Function(start) => (Some(start), None),
            Target::Register => (None, Some(&self.targets)),
        };
        one.into_iter().chain(any.into_iter().flatten().copied())
    }

    /// All functions that run on behalf of one while none is entered that never returns.
    pub fn reached(&self, root: u32) -> BTreeSet<u32> {
        let mut reached = BTreeSet::from([root]);
        let mut waiting = vec![root];
        while let Some(at) = waiting.pop() {
            for call in self
                .flows
                .get(&at)
                .into_iter()
                .flat_map(|flow| flow.calls.values())
            {
                for to in self.targets(call) {
                    if self.returns(to) && reached.insert(to) {
                        waiting.push(to);
                    }
                }
            }
        }
        reached
    }
}

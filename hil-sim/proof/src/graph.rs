//! The call graph of the image.
use std::collections::{BTreeMap, BTreeSet};

use crate::flow::{Call, Flow, Target, follow};
use crate::image::Image;

/// The functions of an image and their calls.
pub struct Graph {
    flows: BTreeMap<u32, Flow>,
    returns: BTreeSet<u32>,
    /// Possible targets of an indirect call: every function whose address is taken, without exception handlers.
    targets: BTreeSet<u32>,
}

impl Graph {
    /// Analyses every function, repeatedly until the set of functions that return no longer grows. It begins empty, so
    /// that functions which cannot return never enter it.
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
                graph.leave_out_shared_ends(image);
                return graph;
            }
        }
    }

    /// Leaves out what is only jumped to from functions that it ends: it was followed with each of them.
    fn leave_out_shared_ends(&mut self, image: &Image) {
        let calls = self.flows.values().flat_map(|flow| flow.calls.values());
        let called: BTreeSet<u32> = (calls.map(|call| call.target))
            .filter_map(|target| match target {
                Target::Function(start) => Some(start),
                Target::Register => None,
            })
            .collect();
        (self.flows).retain(|start, _| image.outlined(*start).is_none() || called.contains(start));
    }

    /// Analysis of the function that begins at an address.
    pub fn flow(&self, start: u32) -> Option<&Flow> {
        self.flows.get(&start)
    }

    /// Whether a function can return.
    pub fn returns(&self, start: u32) -> bool {
        self.returns.contains(&start)
    }

    /// Possible targets of a call.
    pub fn targets(&self, call: &Call) -> impl Iterator<Item = u32> {
        let (one, any) = match call.target {
            Target::Function(start) => (Some(start), None),
            Target::Register => (None, Some(&self.targets)),
        };
        one.into_iter().chain(any.into_iter().flatten().copied())
    }

    /// All functions that are reachable from one without a call of a function that never returns.
    pub fn reached(&self, root: u32) -> BTreeSet<u32> {
        let mut reached = BTreeSet::from([root]);
        let mut waiting = vec![root];
        while let Some(at) = waiting.pop() {
            for call in self.flows.get(&at).into_iter().flat_map(|flow| flow.calls.values()) {
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

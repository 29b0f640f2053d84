//! Which function calls which, in the whole image.
use std::collections::{BTreeMap, BTreeSet};

use crate::flow::{Flow, Target, follow};
use crate::image::Image;

/// The functions of an image and their calls.
pub struct Graph {
    flows: BTreeMap<u32, Flow>,
    returns: BTreeSet<u32>,
}

impl Graph {
    /// Follows every function, and again until it is settled which of them return: at first none is taken to, so that
    /// those remain that cannot.
    pub fn new(image: &Image) -> Self {
        let mut graph = Self {
            flows: BTreeMap::new(),
            returns: BTreeSet::new(),
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

    /// All functions that run on behalf of one while none is entered that never returns; each with its caller.
    pub fn reached(&self, root: u32) -> BTreeMap<u32, u32> {
        let mut callers = BTreeMap::from([(root, root)]);
        let mut waiting = vec![root];
        while let Some(at) = waiting.pop() {
            for call in self
                .flows
                .get(&at)
                .into_iter()
                .flat_map(|flow| flow.calls.values())
            {
                if let Target::Function(to) = call.target
                    && self.returns(to)
                    && !callers.contains_key(&to)
                {
                    callers.insert(to, at);
                    waiting.push(to);
                }
            }
        }
        callers
    }
}

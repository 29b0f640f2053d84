//! Loops of the control path and of the learner: each is listed in [`allowed`](crate::allowed) with the reason why it ends.
use std::collections::BTreeMap;

use anyhow::Result;

use crate::allowed::{Allowed, CONTROL, LEARN, LOOPS};
use crate::flow::Flow;
use crate::{Proof, Section};

/// Whether a loop repeats an exclusive access, once for each exception between its load and its store.
fn is_exclusive(flow: &Flow, (last, first): (u32, u32)) -> bool {
    flow.exclusive.range(first.min(last)..=last).next().is_some()
}

/// The function whose source contains a loop: at its last instruction, the innermost outside of the core library.
fn owner(proof: &Proof, last: u32) -> String {
    let frames = proof.names.frames(last);
    let owner = frames.iter().find(|frame| !frame.is_core()).or(frames.first());
    owner.map_or_else(String::new, |frame| frame.function.clone())
}

/// Checks that the control path and the learner have only allowed loops, no recursion and no indirect calls.
///
/// # Errors
/// A handler is missing.
pub fn check(proof: &Proof) -> Result<Section> {
    let mut section = Section { title: "loops".into(), ..Section::default() };
    let mut allowed = Allowed::new(&LOOPS);
    for tree in CONTROL.into_iter().chain([LEARN]) {
        let (mut exclusive, mut owners) = (0, BTreeMap::<String, usize>::new());
        for function in &proof.graph.reached(proof.root(tree)?) {
            let Some(flow) = proof.graph.flow(*function) else {
                continue;
            };
            for edge in &flow.loops {
                if is_exclusive(flow, *edge) {
                    exclusive += 1;
                    continue;
                }
                let owner = owner(proof, edge.0);
                if allowed.why(tree, &owner).is_none() {
                    let chain = proof.names.chain(edge.0);
                    section.violations.push(format!("{tree} loops: {chain}"));
                }
                *owners.entry(owner).or_default() += 1;
            }
            for (at, _) in flow.calls.iter().filter(|(_, call)| call.is_indirect()) {
                let chain = proof.names.chain(*at);
                section.violations.push(format!("{tree} calls through a register: {chain}"));
            }
        }
        section.lines.push(format!(
            "{tree}: {exclusive} of exclusive accesses, {} others",
            owners.values().sum::<usize>()
        ));
        section.lines.extend(owners.iter().map(|(owner, count)| format!("  {count} in {owner}")));
    }
    section.lines.extend(allowed.unused());
    Ok(section)
}

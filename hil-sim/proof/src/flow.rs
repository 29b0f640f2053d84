//! Control flow of one function: its calls with the stack in use at each, its loops and its floating-point instructions.
use std::collections::{BTreeMap, BTreeSet};

use crate::image::{Function, Image, goes_on};
use crate::thumb::Effect;

/// Target of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Target {
    /// The function that begins here.
    Function(u32),
    /// Address in a register.
    Register,
}

/// A call, or a jump to another function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Call {
    /// Target.
    pub target: Target,
    /// Stack in use by the caller at the call, in bytes.
    pub stack: u32,
}

impl Call {
    /// Whether the target is an address in a register.
    pub fn is_indirect(&self) -> bool {
        self.target == Target::Register
    }
}

/// Analysis of a function.
#[derive(Clone, Debug, Default)]
pub struct Flow {
    /// Largest stack of the function itself, bytes.
    pub stack: u32,
    /// Calls, by the address of the instruction.
    pub calls: BTreeMap<u32, Call>,
    /// Last and first instruction of each loop.
    pub loops: BTreeSet<(u32, u32)>,
    /// Exclusive stores: each ends a loop that repeats an access which an exception has interrupted.
    pub exclusive: BTreeSet<u32>,
    /// Floating-point instructions.
    pub float: BTreeSet<u32>,
    /// Reachable undefined instructions.
    pub undefined: BTreeSet<u32>,
    /// Whether it can return.
    pub returns: bool,
    /// Code that could not be analysed, described in words.
    pub troubles: BTreeSet<String>,
}

/// Follows all paths through a function. A path ends at a call of a function that is not in `returns`.
pub fn follow(image: &Image, function: &Function, returns: &BTreeSet<u32>) -> Flow {
    let mut walk = Walk {
        image,
        function,
        returns,
        flow: Flow::default(),
        depths: BTreeMap::new(),
        edges: BTreeMap::new(),
        waiting: Vec::new(),
    };
    walk.reach(None, function.start, 0);
    while let Some(at) = walk.waiting.pop() {
        walk.step(at);
    }
    walk.flow.loops = loops(function.start, &walk.edges);
    walk.flow
}

struct Walk<'a> {
    image: &'a Image,
    function: &'a Function,
    returns: &'a BTreeSet<u32>,
    flow: Flow,
    /// Stack in use before each instruction.
    depths: BTreeMap<u32, i32>,
    edges: BTreeMap<u32, Vec<u32>>,
    waiting: Vec<u32>,
}

impl Walk<'_> {
    fn trouble(&mut self, at: u32, what: &str) {
        self.flow.troubles.insert(format!("{} at {at:#010x}: {what}", self.function.name));
    }

    /// Adds an edge from one instruction of this function to another.
    fn reach(&mut self, from: Option<u32>, to: u32, depth: i32) {
        if let Some(from) = from {
            self.edges.entry(from).or_default().push(to);
        }
        match self.depths.get(&to) {
            None => {
                self.depths.insert(to, depth);
                self.waiting.push(to);
            }
            Some(known) if *known != depth => {
                self.trouble(to, "reached with two depths of the stack")
            }
            Some(_) => {}
        }
    }

    /// End of the code around an address: of this function, or of what the compiler has taken out of it.
    fn end(&self, at: u32) -> u32 {
        if (self.function.start..self.function.end).contains(&at) {
            self.function.end
        } else {
            self.image.outlined(at).map_or(0, |outlined| outlined.end)
        }
    }

    /// Adds the edge to the instruction that follows.
    fn go_on(&mut self, from: u32, last: u32, to: u32, depth: i32) {
        if to < self.end(last) {
            self.reach(Some(from), to, depth);
        } else {
            self.trouble(to, "control runs out of the code");
        }
    }

    fn step(&mut self, at: u32) {
        let depth = self.depths[&at];
        let Some(instruction) = self.image.instruction(at) else {
            return self.trouble(at, "control runs out of the code");
        };
        let next = at + instruction.length;
        if let Effect::IfThen { same, count } = instruction.effect {
            for first_runs in [true, false] {
                self.block(at, next, depth, same, count, first_runs);
            }
        } else if let Some(depth) = self.run(at, depth) {
            self.go_on(at, at, next, depth);
        }
    }

    /// Follows a block of conditional instructions for one value of the condition.
    fn block(
        &mut self,
        start: u32,
        mut at: u32,
        mut depth: i32,
        same: u8,
        count: u8,
        first_runs: bool,
    ) {
        for place in 0..count {
            let Some(instruction) = self.image.instruction(at) else {
                return self.trouble(at, "control runs out of the code");
            };
            if (same >> place & 1 == 1) == first_runs {
                match self.run(at, depth) {
                    Some(after) => depth = after,
                    None => return,
                }
            }
            at += instruction.length;
        }
        self.go_on(start, start, at, depth);
    }

    /// Follows one instruction and returns the depth after it, if control continues there.
    fn run(&mut self, at: u32, depth: i32) -> Option<i32> {
        let instruction = self.image.instruction(at)?;
        if instruction.exclusive {
            self.flow.exclusive.insert(at);
        }
        if instruction.float {
            self.flow.float.insert(at);
        }
        match instruction.effect {
            Effect::Next | Effect::IfThen { .. } => {}
            Effect::Stack(grown) => {
                let depth = depth + grown;
                match u32::try_from(depth) {
                    Ok(used) => self.flow.stack = self.flow.stack.max(used),
                    Err(_) => self.trouble(at, "takes more off the stack than it has put there"),
                }
                return Some(depth);
            }
            Effect::StackUnknown => self.trouble(at, "the stack grows by an unknown amount"),
            Effect::Jump(to) | Effect::Branch(to) => self.jump(at, to, depth),
            Effect::Call(to) => {
                self.call(at, Target::Function(to), depth);
                if !self.returns.contains(&to) {
                    return None;
                }
            }
            Effect::CallRegister => self.call(at, Target::Register, depth),
            Effect::JumpRegister => {
                self.call(at, Target::Register, depth);
                self.flow.returns = true;
            }
            Effect::Table { entry } => self.table(at, entry, depth),
            Effect::Return(taken) => {
                if depth != taken {
                    self.trouble(at, "returns with something left on the stack");
                }
                self.flow.returns = true;
            }
            Effect::Undefined => {
                self.flow.undefined.insert(at);
            }
        }
        goes_on(instruction.effect).then_some(depth)
    }

    fn call(&mut self, at: u32, target: Target, depth: i32) {
        if let Target::Function(start) = target
            && self.image.function(start).is_none()
        {
            self.trouble(at, "calls what is no function");
        }
        let stack = depth.unsigned_abs();
        self.flow.calls.insert(at, Call { target, stack });
    }

    /// A jump within the function, also to an end that it shares with others, or a tail call.
    fn jump(&mut self, at: u32, to: u32, depth: i32) {
        let is_inside = (self.function.start..self.function.end).contains(&to);
        if is_inside || self.image.outlined(to).is_some() {
            return self.reach(Some(at), to, depth);
        }
        self.call(at, Target::Function(to), depth);
        self.flow.returns |= self.returns.contains(&to);
    }

    /// Follows a jump table: the constants behind the jump, up to the padding before the next instruction (zero or a NOP,
    /// which as offsets would lead into the table).
    fn table(&mut self, at: u32, entry: u32, depth: i32) {
        const NOP: u32 = 0xbf00;
        let start = at + 4;
        let mut place = start;
        while self.image.is_constant(place) {
            let offset = match entry {
                1 => self.image.byte(place).map(u32::from),
                _ => self.image.half(place).map(u32::from),
            };
            let to = match offset {
                Some(offset) if offset != 0 && (entry, offset) != (2, NOP) => start + 2 * offset,
                _ => break,
            };
            if self.image.is_constant(to) {
                self.trouble(at, "the table leads into constants");
            } else {
                self.reach(Some(at), to, depth);
            }
            place += entry;
        }
        if place == start {
            self.trouble(at, "no table behind the jump");
        }
    }
}

/// Back edges of a depth-first search.
fn loops(start: u32, edges: &BTreeMap<u32, Vec<u32>>) -> BTreeSet<(u32, u32)> {
    let mut back = BTreeSet::new();
    let mut seen = BTreeSet::from([start]);
    let mut path = vec![(start, 0)];
    let mut open = BTreeSet::from([start]);
    while let Some((at, place)) = path.last_mut() {
        let at = *at;
        let Some(&to) = edges.get(&at).and_then(|to| to.get(*place)) else {
            open.remove(&at);
            path.pop();
            continue;
        };
        *place += 1;
        if open.contains(&to) {
            back.insert((at, to));
        } else if seen.insert(to) {
            open.insert(to);
            path.push((to, 0));
        }
    }
    back
}

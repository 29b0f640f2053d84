//! How much a signal has changed lately.

/// A signal of a contact, and a low-pass of it that starts at the landing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recent {
    followed: f32,
    change: f32,
}

impl Recent {
    /// Before the first contact.
    pub const NEW: Self = Self { followed: 0.0, change: 0.0 };

    /// Takes the signal of a window; `share` is the coefficient of the low-pass, 1 in the window of a landing.
    pub fn advance(&mut self, signal: f32, share: f32) {
        self.followed += (signal - self.followed) * share;
        let distance = signal - self.followed;
        let distance = if distance < 0.0 { -distance } else { distance };
        self.change *= 1.0 - share;
        if distance > self.change {
            self.change = distance;
        }
    }

    /// The largest distance of the signal from its low-pass; older ones count less, as in the low-pass.
    pub const fn change(&self) -> f32 {
        self.change
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One window at 1 K, all others at 0: the change is 0.99 K, and is forgotten as the low-pass forgets.
    #[test]
    fn a_change_is_forgotten_like_the_low_pass() {
        let mut recent = Recent::NEW;
        recent.advance(0.0, 1.0);
        recent.advance(1.0, 0.01);
        for windows in 0..300 {
            let expected = 0.99_f64.powi(1 + windows);
            assert!((f64::from(recent.change()) - expected).abs() < 1e-5);
            recent.advance(0.0, 0.01);
        }
    }
}

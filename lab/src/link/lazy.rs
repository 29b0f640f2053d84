//! A line to a device that is not there yet.

use std::thread::sleep;
use std::time::{Duration, Instant};

use super::{Link, LinkError, ReceivedLine};

/// A line that is opened when the first bytes are sent: for a board whose power, and with it its serial port, comes later.
pub struct LazyLink<F> {
    open: F,
    link: Option<Opened>,
    created: Instant,
}

/// An open line, and the time by this link's clock at which its own clock began.
struct Opened {
    link: Box<dyn Link>,
    since: Duration,
}

impl<F: FnMut() -> Result<Box<dyn Link>, String>> LazyLink<F> {
    /// A line that `open` opens, or says why it cannot.
    pub fn new(open: F) -> Self {
        Self { open, link: None, created: Instant::now() }
    }
}

impl<F: FnMut() -> Result<Box<dyn Link>, String>> Link for LazyLink<F> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        if self.link.is_none() {
            let link = (self.open)().map_err(LinkError::Gone)?;
            let since = self.created.elapsed().saturating_sub(link.now());
            let opened = self.link.insert(Opened { link, since });
            // Ends a line that another program has left unfinished.
            opened.link.send(b"\n")?;
        }
        match &mut self.link {
            Some(opened) => opened.link.send(bytes),
            None => Ok(()),
        }
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        let Some(opened) = &mut self.link else {
            sleep(timeout);
            return Ok(None);
        };
        let line = opened.link.receive(timeout)?;
        Ok(line.map(|line| ReceivedLine { at: line.at + opened.since, ..line }))
    }

    fn now(&self) -> Duration {
        match &self.link {
            Some(opened) => opened.link.now() + opened.since,
            None => self.created.elapsed(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::rc::Rc;

    use super::*;

    /// A line that takes note of what is sent, and answers nothing.
    struct Noted(Rc<RefCell<Vec<u8>>>);

    impl Link for Noted {
        fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
            self.0.borrow_mut().extend(bytes);
            Ok(())
        }

        fn receive(&mut self, _timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
            Ok(Some(ReceivedLine { text: "ok".into(), at: Duration::ZERO }))
        }

        fn now(&self) -> Duration {
            Duration::ZERO
        }
    }

    #[test]
    fn it_waits_without_a_device_and_opens_when_something_is_sent() {
        let sent = Rc::new(RefCell::new(Vec::new()));
        let (noted, mut is_there) = (Rc::clone(&sent), false);
        let mut link = LazyLink::new(move || {
            if std::mem::replace(&mut is_there, true) {
                Ok(Box::new(Noted(Rc::clone(&noted))) as Box<dyn Link>)
            } else {
                Err("no such port".into())
            }
        });
        assert_eq!(link.receive(Duration::from_millis(1)), Ok(None));
        assert!(link.now() >= Duration::from_millis(1));
        let gone = LinkError::Gone("no such port".into());
        assert_eq!(link.send(b"id\n"), Err(gone));
        assert_eq!(link.send(b"id\n"), Ok(()));
        assert_eq!(sent.borrow().as_slice(), b"\nid\n");
        let before = link.now();
        let line = link.receive(Duration::ZERO).unwrap().unwrap();
        assert!(line.at >= Duration::from_millis(1) && line.at <= before);
    }
}

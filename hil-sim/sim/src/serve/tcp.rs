//! A served device's line as a TCP port of this machine.

use std::io::{ErrorKind, Write as _};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::time::{Duration, Instant};

use super::ClientLine;
use super::client::{IncomingBytes, OutgoingBytes};

/// Why a device cannot be served at an address.
#[derive(Debug, thiserror::Error)]
pub enum TcpLineError {
    /// No address.
    #[error(
        "'{0}' is no address; allowed is a loopback address with a port, such as 127.0.0.1:4000, [::1]:4000 or 127.0.0.1:0"
    )]
    Malformed(String),
    /// An address that other machines reach.
    #[error(
        "{0} is not a loopback address, and whoever reaches the line drives the device; allowed are 127.0.0.1:PORT and [::1]:PORT"
    )]
    NotLoopback(SocketAddr),
    /// The operating system refuses the address.
    #[error("cannot listen on {address}: {error}")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// Its error.
        error: std::io::Error,
    },
}

/// Time in which a client that has closed its writing side still receives, as the answers to its last lines.
const LAST_ANSWERS: Duration = Duration::from_millis(500);

/// A TCP port with one client at a time. A second one gets a line that says so, and its connection ends.
///
/// A client that has closed its writing side, as one that vanishes does too, is a client no more and holds up no other one.
/// The device executes what it has sent, and the answers of the next half second are sent to it.
#[derive(Debug)]
pub struct TcpLine {
    listener: TcpListener,
    client: Option<Client>,
    /// Clients so far.
    clients: u64,
    incoming: IncomingBytes,
    /// The client that was refused last. Its connection is open until the next one is refused: an early end could take the
    /// line away before the client has read it.
    refused: Option<TcpStream>,
}

#[derive(Debug)]
struct Client {
    stream: TcpStream,
    peer: SocketAddr,
    outgoing: OutgoingBytes,
    /// When its writing side was found closed.
    ended: Option<Instant>,
}

impl TcpLine {
    /// Listens on a loopback address; port 0 lets the operating system choose one.
    ///
    /// # Errors
    /// `address` is no loopback address, or is in use.
    pub fn listen(address: &str) -> Result<Self, TcpLineError> {
        let numeric = address.replacen("localhost:", "127.0.0.1:", 1);
        let address: SocketAddr =
            (numeric.parse()).map_err(|_| TcpLineError::Malformed(address.into()))?;
        if !address.ip().is_loopback() {
            return Err(TcpLineError::NotLoopback(address));
        }
        let listen = || {
            let listener = TcpListener::bind(address)?;
            listener.set_nonblocking(true)?;
            Ok(listener)
        };
        let listener = listen().map_err(|error| TcpLineError::Listen { address, error })?;
        Ok(Self {
            listener,
            client: None,
            clients: 0,
            incoming: IncomingBytes::default(),
            refused: None,
        })
    }

    /// The address on which it listens.
    ///
    /// # Errors
    /// The operating system does not say.
    pub fn address(&self) -> std::io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Receives what the client has sent, and notices that it has closed its writing side.
    fn receive(&mut self) {
        if let Some(client) = self.client.as_mut().filter(|client| client.ended.is_none())
            && !self.incoming.receive(&mut client.stream)
        {
            client.ended = Some(Instant::now());
        }
    }

    fn accept(&mut self, mut stream: TcpStream, peer: SocketAddr) -> std::io::Result<()> {
        stream.set_nonblocking(true)?;
        // The client may have gone since it was last looked at, and the same program have come again.
        self.receive();
        if let Some(first) = self.client.as_ref().filter(|client| client.ended.is_none()) {
            let line = format!(
                "err busy: the client {} is connected, and there is one at a time\n",
                first.peer
            );
            stream.write_all(line.as_bytes())?;
            stream.shutdown(Shutdown::Write)?;
            self.refused = Some(stream);
        } else {
            stream.set_nodelay(true)?;
            self.client =
                Some(Client { stream, peer, outgoing: OutgoingBytes::default(), ended: None });
            self.clients += 1;
        }
        Ok(())
    }
}

impl ClientLine for TcpLine {
    fn poll(&mut self) -> Option<u64> {
        if let Some(client) = &mut self.client {
            client.outgoing.flush(&mut client.stream);
        }
        self.receive();
        self.client.take_if(|client| (client.ended).is_some_and(|at| at.elapsed() > LAST_ANSWERS));
        loop {
            match self.listener.accept() {
                // A client that has gone already needs no answer.
                Ok((stream, peer)) => drop(self.accept(stream, peer)),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => break,
            }
        }
        let client = self.client.as_ref();
        client.is_some_and(|client| client.ended.is_none()).then_some(self.clients)
    }

    fn read(&mut self, limit: usize) -> Vec<u8> {
        self.incoming.take(limit)
    }

    fn write(&mut self, bytes: &[u8], patience: Duration) -> usize {
        match &mut self.client {
            Some(client) => client.outgoing.send(&mut client.stream, bytes, patience),
            None => 0,
        }
    }
}

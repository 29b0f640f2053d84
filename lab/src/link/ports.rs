//! Serial ports of this computer.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serial2::SerialPort;

/// USB vendor of the probes on STMicroelectronics' boards.
const ST_VENDOR: u16 = 0x0483;
/// USB products of probes with a virtual COM port: ST-LINK/V2-1, as on a NUCLEO-F446RE, and STLINK-V3.
const ST_LINK_PRODUCTS: [u16; 7] = [0x374b, 0x3752, 0x374d, 0x374e, 0x374f, 0x3753, 0x3754];

/// USB vendor and product of the adapter behind a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct UsbId {
    /// Vendor.
    pub vendor: u16,
    /// Product.
    pub product: u16,
}

/// A serial port.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PortInfo {
    /// Its name for `--port`.
    pub name: PathBuf,
    /// Its adapter; `None` if it is none on USB, or the operating system does not say (only Linux does).
    pub usb: Option<UsbId>,
}

impl UsbId {
    /// Whether it is a probe with a virtual COM port, as on the device's board.
    pub fn is_st_link(&self) -> bool {
        self.vendor == ST_VENDOR && ST_LINK_PRODUCTS.contains(&self.product)
    }
}

/// All serial ports.
///
/// # Errors
/// The operating system does not list them.
pub fn ports() -> io::Result<Vec<PortInfo>> {
    let mut names = SerialPort::available_ports()?;
    names.sort();
    Ok(names
        .into_iter()
        .map(|name| PortInfo { usb: usb_id(Path::new("/sys/class/tty"), &name), name })
        .collect())
}

/// The USB device above a port in Linux's tree of devices.
fn usb_id(class: &Path, port: &Path) -> Option<UsbId> {
    let device = class.join(port.file_name()?).join("device");
    let device = fs::canonicalize(device).ok()?;
    let number = |folder: &Path, file: &str| {
        let text = fs::read_to_string(folder.join(file)).ok()?;
        u16::from_str_radix(text.trim(), 16).ok()
    };
    device.ancestors().find_map(|folder| {
        Some(UsbId { vendor: number(folder, "idVendor")?, product: number(folder, "idProduct")? })
    })
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    /// The tree of devices as Linux has it: the port's interface lies below the USB device.
    #[test]
    fn a_probes_port_is_known_by_the_usb_device_above_it() {
        let root = std::env::temp_dir().join(format!("thermal-lab-ports-{}", std::process::id()));
        let interface = root.join("usb1/1-2/1-2:1.2");
        fs::create_dir_all(&interface).unwrap();
        fs::create_dir_all(root.join("class/ttyACM0")).unwrap();
        fs::create_dir_all(root.join("class/ttyS0")).unwrap();
        fs::write(root.join("usb1/1-2/idVendor"), "0483\n").unwrap();
        fs::write(root.join("usb1/1-2/idProduct"), "374b\n").unwrap();
        symlink(&interface, root.join("class/ttyACM0/device")).unwrap();
        let class = root.join("class");
        let probe = usb_id(&class, Path::new("/dev/ttyACM0")).unwrap();
        assert!(probe.is_st_link());
        assert_eq!(usb_id(&class, Path::new("/dev/ttyS0")), None);
        fs::write(root.join("usb1/1-2/idVendor"), "0403\n").unwrap();
        let other = usb_id(&class, Path::new("/dev/ttyACM0")).unwrap();
        assert!(!other.is_st_link());
        fs::remove_dir_all(root).unwrap();
    }
}

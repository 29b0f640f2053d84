//! Tools that compile the emulator's CPU (cmake with make or ninja, a C compiler, libclang) and libFuzzer (a C++ compiler).
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use super::{Missing, Needs};
use crate::process::{Invocation, on_path};

const CMAKE: Missing = Missing {
    what: "cmake",
    apt: &["cmake"],
    elsewhere: &["dnf install cmake", "pacman -S cmake", "brew install cmake"],
};
const MAKE: Missing = Missing {
    what: "make",
    apt: &["make"],
    elsewhere: &["dnf install make", "pacman -S make", XCODE],
};
const C_COMPILER: Missing = Missing {
    what: "a C compiler",
    apt: &["gcc", "libc6-dev"],
    elsewhere: &["dnf install gcc", "pacman -S gcc", XCODE],
};
const LIBCLANG: Missing = Missing {
    what: "libclang with its headers",
    apt: &["libclang-dev"],
    elsewhere: &["dnf install clang-devel", "pacman -S clang", "brew install llvm"],
};
const CPP_COMPILER: Missing = Missing {
    what: "a C++ compiler",
    apt: &["g++"],
    elsewhere: &["dnf install gcc-c++", "pacman -S gcc", XCODE],
};
const XCODE: &str = "xcode-select --install";

/// The missing tools of those that are needed.
pub fn missing(needs: Needs) -> Vec<Missing> {
    let runs = |program: &str| Invocation::new(program, ["--version"]).answer().is_some();
    let compiler = |variable: &str, default: &str| {
        runs(&env::var(variable).unwrap_or_else(|_| default.into()))
    };
    let mut tools = Vec::new();
    if needs.emulator {
        let make = on_path("make").is_some() || on_path("ninja").is_some();
        tools.push((runs("cmake"), CMAKE));
        tools.push((make, MAKE));
        tools.push((compiler("CC", "cc"), C_COMPILER));
        tools.push((has_libclang(), LIBCLANG));
    }
    if needs.fuzzer {
        tools.push((compiler("CXX", "c++"), CPP_COMPILER));
    }
    super::missing(&tools)
}

/// Whether bindgen will find libclang and the compiler's own headers.
fn has_libclang() -> bool {
    if let Some(path) = env::var_os("LIBCLANG_PATH").map(PathBuf::from) {
        return holds_libclang(&path)
            || path.file_name().is_some_and(|name| is_libclang(&name.to_string_lossy()));
    }
    let folders = library_folders();
    folders.iter().any(|folder| holds_libclang(folder))
        && folders.iter().any(|folder| holds_headers(folder))
}

/// Folders of LLVM's libraries: that of `llvm-config`, and the usual ones.
fn library_folders() -> Vec<PathBuf> {
    let llvm_config = env::var("LLVM_CONFIG_PATH").unwrap_or_else(|_| "llvm-config".into());
    let mut folders: Vec<PathBuf> = Invocation::new(&llvm_config, ["--libdir"])
        .answer()
        .map(|text| text.trim().into())
        .into_iter()
        .collect();
    folders.extend(env::var_os("LD_LIBRARY_PATH").iter().flat_map(env::split_paths));
    for root in ["/usr/lib", "/usr/lib64", "/usr/local/lib", "/usr/local/lib64"].map(PathBuf::from)
    {
        // Such as /usr/lib/x86_64-linux-gnu and /usr/lib/llvm-14/lib.
        for folder in entries(&root).filter(|folder| folder.is_dir()) {
            folders.push(folder.join("lib"));
            folders.push(folder);
        }
        folders.push(root);
    }
    for root in ["/usr/local/opt", "/opt/homebrew/opt"].map(Path::new) {
        folders.push(root.join("llvm/lib"));
    }
    folders.push("/Library/Developer/CommandLineTools/usr/lib".into());
    folders.push(
        "/Applications/Xcode.app/Contents/Developer/Toolchains/XcodeDefault.xctoolchain/usr/lib"
            .into(),
    );
    folders
}

fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path())
}

fn holds_libclang(folder: &Path) -> bool {
    entries(folder)
        .any(|path| path.file_name().is_some_and(|name| is_libclang(&name.to_string_lossy())))
}

/// Whether `folder/clang/VERSION/include` has the compiler's headers, without which libclang cannot parse C.
fn holds_headers(folder: &Path) -> bool {
    entries(&folder.join("clang")).any(|version| version.join("include/stddef.h").is_file())
}

/// Whether a file is the C interface of clang as a shared library.
fn is_libclang(name: &str) -> bool {
    let Some(rest) = name.strip_prefix("libclang") else {
        return false;
    };
    let (shared, cpp) =
        (rest.contains(".so") || rest.ends_with(".dylib"), rest.starts_with("-cpp"));
    shared && !cpp && rest.starts_with(['.', '-'])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names as the packages of Debian 12, Fedora and macOS have them.
    #[test]
    fn only_the_shared_library_of_the_c_interface_is_libclang() {
        let cases = [
            ("libclang.so", true),
            ("libclang-14.so.1", true),
            ("libclang.so.19.1", true),
            ("libclang.dylib", true),
            ("libclang-cpp.so.14", false),
            ("libclang-cpp.dylib", false),
            ("libclangAST.so", false),
            ("libclang.a", false),
            ("libLLVM-14.so", false),
        ];
        for (name, expected) in cases {
            assert_eq!(is_libclang(name), expected, "{name}");
        }
    }
}

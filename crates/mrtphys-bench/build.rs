//! Notes the compiler for the tables, and says what is missing where a peer cannot be compiled: the peers' own builds take
//! minutes before they find out.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for variable in ["CFLAGS", "CXX", "CC", "CMAKE", "LIBCLANG_PATH", "LD_LIBRARY_PATH", "PATH"] {
        println!("cargo::rerun-if-env-changed={variable}");
    }
    let rustc = env::var("RUSTC").unwrap_or("rustc".into());
    let version =
        Command::new(rustc).arg("--version").output().map(|o| String::from_utf8_lossy(&o.stdout).into_owned());
    println!("cargo::rustc-env=MRTPHYS_BENCH_RUSTC={}", version.unwrap_or_default().trim());

    let wants = |feature: &str| env::var_os(format!("CARGO_FEATURE_{feature}")).is_some();
    // boxddd-sys says nothing of NDEBUG to the compiler, so that Box3D's assertions depend on the flags around it.
    let released = env::var("CFLAGS").is_ok_and(|flags| flags.contains("-DNDEBUG"));
    println!(
        "cargo::rustc-env=MRTPHYS_BENCH_BOX3D={}",
        if released { "" } else { ", WITH ASSERTIONS (CFLAGS lack -DNDEBUG)" }
    );
    let mut missing = Vec::new();
    // Elsewhere than on Unix the compilers are found in other ways, which the peers' own builds know.
    let unix = cfg!(unix);
    if unix && wants("BOX3D") && !runs(&tool("CC", "cc")) {
        missing.push("feature box3d: a C compiler (Debian: apt install gcc)");
    }
    if unix && wants("PHYSX") && !runs(&tool("CXX", if cfg!(target_os = "linux") { "clang++" } else { "c++" })) {
        missing.push("feature physx: a C++ compiler; it looks for clang++ unless CXX says another: CXX=g++ CC=gcc (Debian: apt install g++)");
    }
    if wants("JOLT") {
        if !runs(&tool("CMAKE", "cmake")) {
            missing.push("feature jolt: cmake (Debian: apt install cmake)");
        }
        if unix && !runs(&tool("CXX", "c++")) {
            missing.push("feature jolt: a C++ compiler (Debian: apt install g++)");
        }
        if env::var_os("LIBCLANG_PATH").is_some() {
            // Where it is set, bindgen looks nowhere else.
            if !has_libclang() {
                missing.push("feature jolt: libclang, which LIBCLANG_PATH does not hold (Debian: apt install libclang-dev clang)");
            }
        } else if !has_libclang() {
            // No error: bindgen may know a place that this program does not.
            println!(
                "cargo::warning=feature jolt needs libclang, which is in none of the usual places: apt install libclang-dev \
                 clang (Debian), or LIBCLANG_PATH set to its folder"
            );
        }
        // Neither of the two C++ libraries of this feature names the standard library it needs.
        if env::var("CARGO_CFG_TARGET_ENV").as_deref() == Ok("gnu") {
            println!("cargo::rustc-link-lib=stdc++");
        }
    }
    for what in &missing {
        println!("cargo::error=mrtphys-bench needs, for its {what}");
    }
    if !missing.is_empty() {
        std::process::exit(1);
    }
}

/// The program that a variable names, by the rules of the crates `cc` and `cmake`: for this target first.
fn tool(variable: &str, otherwise: &str) -> String {
    let target = env::var("TARGET").unwrap_or_default();
    let names = [
        format!("{variable}_{target}"),
        format!("{variable}_{}", target.replace('-', "_")),
        format!("HOST_{variable}"),
        format!("TARGET_{variable}"),
        variable.into(),
    ];
    names.iter().find_map(|name| env::var(name).ok()).unwrap_or(otherwise.into())
}

fn runs(program: &str) -> bool {
    // `CC` may hold arguments after the program.
    let program = program.split_whitespace().next().unwrap_or(program);
    Command::new(program).arg("--version").output().is_ok_and(|o| o.status.success())
}

/// Whether libclang is where bindgen looks first. Elsewhere than on Linux bindgen knows better than this program.
fn has_libclang() -> bool {
    if !cfg!(target_os = "linux") {
        return true;
    }
    if let Some(place) = env::var_os("LIBCLANG_PATH").map(PathBuf::from) {
        return place.is_file() || holds_libclang(&place);
    }
    let mut folders: Vec<PathBuf> =
        ["/usr/lib", "/usr/lib64", "/usr/local/lib", "/usr/local/lib64"].map(PathBuf::from).to_vec();
    let libraries = env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
    folders.extend(env::split_paths(&libraries));
    // `/usr/lib/x86_64-linux-gnu`, `/usr/lib/llvm-14/lib`
    for folder in std::fs::read_dir("/usr/lib").into_iter().flatten().flatten() {
        folders.extend([folder.path(), folder.path().join("lib")]);
    }
    if let Ok(output) = Command::new("llvm-config").arg("--libdir").output() {
        folders.push(String::from_utf8_lossy(&output.stdout).trim().into());
    }
    folders.iter().any(|folder| holds_libclang(folder))
}

fn holds_libclang(folder: &Path) -> bool {
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
    files
        .map(|f| f.file_name().to_string_lossy().into_owned())
        .any(|f| (f.starts_with("libclang.so") || f.starts_with("libclang-")) && !f.starts_with("libclang-cpp"))
}

//! Notes the compiler for the tables, and says what is missing where a peer cannot be compiled: the peers' own builds take
//! minutes before they find out.

use std::env;
use std::path::PathBuf;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for variable in ["CFLAGS", "CXX", "CC", "LIBCLANG_PATH", "PATH"] {
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
    if wants("BOX3D") && !runs(&env::var("CC").unwrap_or("cc".into())) {
        missing.push("feature box3d: a C compiler (Debian: apt install gcc)");
    }
    if wants("PHYSX") && !runs(&env::var("CXX").unwrap_or("clang++".into())) {
        missing.push("feature physx: a C++ compiler; it looks for clang++ unless CXX says another: CXX=g++ CC=gcc (Debian: apt install g++)");
    }
    if wants("JOLT") {
        if !runs("cmake") {
            missing.push("feature jolt: cmake (Debian: apt install cmake)");
        }
        if !runs(&env::var("CXX").unwrap_or("c++".into())) {
            missing.push("feature jolt: a C++ compiler (Debian: apt install g++)");
        }
        if !has_libclang() {
            missing.push("feature jolt: libclang, in LIBCLANG_PATH if in no usual place (Debian: apt install libclang-dev clang)");
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

fn runs(program: &str) -> bool {
    // `CC` may hold arguments after the program.
    let program = program.split_whitespace().next().unwrap_or(program);
    Command::new(program).arg("--version").output().is_ok_and(|o| o.status.success())
}

/// Whether libclang is where bindgen looks first. Elsewhere than on Linux bindgen knows better than this program.
fn has_libclang() -> bool {
    if !cfg!(target_os = "linux") || env::var_os("LIBCLANG_PATH").is_some() {
        return true;
    }
    let mut folders: Vec<PathBuf> =
        ["/usr/lib", "/usr/lib64", "/usr/local/lib", "/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu"]
            .map(PathBuf::from)
            .to_vec();
    let versions = std::fs::read_dir("/usr/lib").into_iter().flatten().flatten();
    folders
        .extend(versions.filter(|d| d.file_name().to_string_lossy().starts_with("llvm")).map(|d| d.path().join("lib")));
    if let Ok(output) = Command::new("llvm-config").arg("--libdir").output() {
        folders.push(String::from_utf8_lossy(&output.stdout).trim().into());
    }
    let libraries = folders.iter().flat_map(std::fs::read_dir).flatten().flatten();
    libraries
        .map(|f| f.file_name().to_string_lossy().into_owned())
        .any(|f| f.starts_with("libclang.so") || f.starts_with("libclang-"))
}

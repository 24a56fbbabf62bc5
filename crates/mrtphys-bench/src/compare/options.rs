//! Arguments of the comparison.

use super::scenes::{Scene, chosen};
use crate::peers::{EngineKind, Margin};
use std::path::PathBuf;
use std::time::Duration;

/// Help text.
pub const HELP: &str = "\
Runs the same scenes in this engine and in the peers that were built in, in one run, and prints speed and truth side by side.

Usage: mrtphys-bench peers [--engines NAME,...] [--scenes NAME,...] [--margins default,thin] [--threads N] [--quick]
                           [-o FOLDER] [--markdown FILE] [--patience SECONDS]
       mrtphys-bench peers --from FILE [--markdown FILE]

--engines    ours, rapier, box3d, jolt, physx; all that were built if left out
--scenes     such as spheres-16@512, or spheres-16 for all of its rates; all if left out
--margins    default: what a peer does unless told; thin: a twentieth of it, best for energy; both if left out
--threads    threads of each engine; with more than one, times are wall times, and Rapier needs its feature rapier-parallel
--quick      a few steps of each scene
-o           folder of results.jsonl, written as the results come; out/peers if left out
--markdown   writes the tables into FILE between the lines <!-- tables --> and <!-- end of tables -->
             and the figures into the folder pictures beside it
--patience   seconds after which an engine that does not answer has failed; 900 if left out
--from       makes the tables again from a results.jsonl, also of a run that was broken off
";

/// What was asked for.
pub struct Options {
    /// engines, each with its margin
    pub entries: Vec<(EngineKind, Margin)>,
    /// scenes
    pub scenes: Vec<Scene>,
    /// threads of each engine
    pub threads: usize,
    /// folder of the results
    pub folder: PathBuf,
    /// file into which the tables go
    pub markdown: Option<PathBuf>,
    /// file of results to make tables of
    pub from: Option<PathBuf>,
    /// how long to wait for an engine
    pub patience: Duration,
}

impl Options {
    /// Reads the arguments.
    ///
    /// # Errors
    /// What is wrong with them, in words.
    pub fn parse(args: &[String]) -> Result<Options, String> {
        let (mut engines, mut scenes, mut margins) = (Vec::new(), Vec::new(), Vec::new());
        let mut quick = false;
        let mut options = Options {
            entries: Vec::new(),
            scenes: Vec::new(),
            threads: 1,
            folder: "out/peers".into(),
            markdown: None,
            from: None,
            patience: Duration::from_secs(900),
        };
        let mut rest = args.iter();
        while let Some(arg) = rest.next() {
            let mut value = || rest.next().ok_or(format!("{arg} needs a value"));
            match arg.as_str() {
                "--engines" => engines = names(value()?),
                "--scenes" => scenes = names(value()?),
                "--margins" => margins = names(value()?),
                "--threads" => options.threads = whole(arg, value()?, 256)? as usize,
                "--patience" => options.patience = Duration::from_secs(whole(arg, value()?, 1_000_000)?),
                "-o" => options.folder = value()?.into(),
                "--markdown" => options.markdown = Some(value()?.into()),
                "--from" => options.from = Some(value()?.into()),
                "--quick" => quick = true,
                _ => return Err(format!("'{arg}' is no argument; see --help")),
            }
        }
        options.entries = entries(&engines, &margins)?;
        options.scenes = chosen(&scenes)?;
        if quick {
            options.scenes = options.scenes.into_iter().map(Scene::quick).collect();
        }
        Ok(options)
    }
}

fn names(list: &str) -> Vec<String> {
    list.split(',').map(|s| s.trim().to_string()).filter(|s| !s.is_empty()).collect()
}

fn whole(name: &str, text: &str, most: u64) -> Result<u64, String> {
    match text.parse() {
        Ok(n) if (1..=most).contains(&n) => Ok(n),
        _ => Err(format!("{name}: '{text}' is not a whole number from 1 to {most}")),
    }
}

fn entries(engines: &[String], margins: &[String]) -> Result<Vec<(EngineKind, Margin)>, String> {
    let mut kinds = Vec::new();
    for name in engines {
        let kind = EngineKind::named(name).ok_or(format!("no engine '{name}': ours, rapier, box3d, jolt, physx"))?;
        if !kind.built() {
            return Err(format!("'{name}' was not built: build with --features {name}"));
        }
        kinds.push(kind);
    }
    if kinds.is_empty() {
        kinds = EngineKind::ALL.iter().map(|e| e.0).filter(|e| e.built()).collect();
    }
    let mut chosen = Vec::new();
    for name in margins {
        chosen.push(match name.as_str() {
            "default" => Margin::Default,
            "thin" => Margin::Thin,
            _ => return Err(format!("no margin '{name}': default, thin")),
        });
    }
    if chosen.is_empty() {
        chosen = vec![Margin::Default, Margin::Thin];
    }
    let mut entries = Vec::new();
    for kind in kinds {
        if kind.has_margin() {
            entries.extend(chosen.iter().map(|&margin| (kind, margin)));
        } else {
            entries.push((kind, Margin::Default));
        }
    }
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Options, String> {
        Options::parse(&text.split_whitespace().map(String::from).collect::<Vec<_>>())
    }

    #[test]
    fn arguments_choose() {
        let options = parse("--engines ours --scenes spheres-8,tetrahedra-8@64 --threads 2 --quick -o x").unwrap();
        assert_eq!(options.entries, [(EngineKind::Ours, Margin::Default)]);
        let names: Vec<_> = options.scenes.iter().map(|s| s.name.as_str()).collect();
        assert_eq!(names, ["spheres-8@512", "spheres-8@64", "tetrahedra-8@64"]);
        assert!(options.scenes.iter().all(|s| s.plan.end == 24));
        assert_eq!((options.threads, options.folder.to_str()), (2, Some("x")));
    }

    #[test]
    fn wrong_arguments_are_named() {
        for (text, word) in [
            ("--engines havok", "'havok'"),
            ("--scenes spheres-9", "spheres-8@512"),
            ("--margins fat", "'fat'"),
            ("--threads 0", "--threads"),
            ("--threads", "value"),
            ("quick", "'quick'"),
        ] {
            let error = parse(text).err().unwrap();
            assert!(error.contains(word), "{text}: {error}");
        }
    }
}

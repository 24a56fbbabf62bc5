//! From the command line to a world that is ready to run.
use crate::cast::Cast;
use crate::cli::RunArgs;
use crate::exit::Outcome;
use crate::plan::End;
use mrtphys::World;

pub struct Ready { pub scene: String, pub title: String, pub seed: u64, pub world: World, pub cast: Cast, pub end: End }
pub fn prepare(args: &RunArgs) -> Outcome<Ready> { todo!("{:?}", args.end()) }

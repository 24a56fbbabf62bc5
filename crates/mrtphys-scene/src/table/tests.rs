use super::{NO_MATERIAL, TableRow, TableRows, TableShape, Texts, write_binary, write_csv};
use crate::{Diagnostics, Scene};
use mrtphys::math::{Quat, Vec3};
use std::path::PathBuf;

/// A folder with a scene that names a table; removed in the end.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("mrtphys-table-{test}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder");
        Folder(path)
    }

    fn read(&self, file: &str, contents: &[u8]) -> Result<Scene, Diagnostics> {
        std::fs::write(self.0.join(file), contents).expect("written");
        let text =
            format!("format = 1\n[material.steel]\ndensity = 8000\n[[body_table]]\nname = 'swarm'\nfile = '{file}'\n");
        std::fs::write(self.0.join("scene.toml"), text).expect("written");
        Scene::load(&self.0.join("scene.toml"))
    }

    fn wrong(&self, file: &str, contents: &[u8]) -> String {
        let e = self.read(file, contents).expect_err("wrong");
        let headline = e.first().expect("one").headline();
        headline.replace(&format!("{}/", self.0.display()), "")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn swarm(named: bool) -> TableRows {
    let mut names = Texts::default();
    if named {
        names.push("a, \"b\"");
        names.push("ä");
    }
    let first = TableRow {
        material: 0,
        radius: 0.1,
        position: Vec3::new(0.1, -2.5e-7, 3.0),
        velocity: Vec3::new(1.0 / 3.0, 0.0, -1.0),
        ..TableRow::PLAIN
    };
    let second = TableRow {
        shape: TableShape::Tetrahedron,
        mass: 2.0,
        orientation: Quat::new(0.5, 0.5, 0.5, 0.5),
        angular_velocity: Vec3::new(0.0, 7.0, 1e-9),
        ..TableRow::PLAIN
    };
    TableRows { rows: vec![first, second], materials: vec!["steel".into()], names }
}

#[test]
fn what_is_written_is_read_back() {
    let folder = Folder::new("back");
    for named in [false, true] {
        let table = swarm(named);
        let scene = folder.read("swarm.csv", write_csv(&table).as_bytes()).unwrap_or_else(|e| panic!("{e}"));
        let crate::scene::Content::Table(t) = &scene.contents[0] else { panic!("a table") };
        assert_eq!(*t.rows, table);
        let loaded = scene.build().unwrap_or_else(|e| panic!("{e}"));
        let name = if named { "a, \"b\"" } else { "swarm[0]" };
        let id = loaded.names.body(name).expect("the first");
        assert_eq!(loaded.names.body_name(id).as_deref(), Some(name));
        let body = loaded.world.body(id).expect("a body");
        assert_eq!(body.mass, 8000.0 * body.volume);
        assert_eq!(loaded.names.bodies_of("swarm").map(|b| b.len()), Some(2));
        let again = crate::to_toml(&loaded).expect("text");
        assert!(again.contains("file = \"swarm.csv\""), "{again}");
    }
    let table = swarm(false);
    let scene = folder.read("swarm.bin", &write_binary(&table)).unwrap_or_else(|e| panic!("{e}"));
    let crate::scene::Content::Table(t) = &scene.contents[0] else { panic!("a table") };
    assert_eq!(*t.rows, table);
}

#[test]
fn the_binary_layout_is_the_documented_one() {
    let bytes = write_binary(&swarm(false));
    assert_eq!(bytes.len(), 8 + 4 + (4 + 5) + 8 + 2 * 128);
    assert_eq!(&bytes[..8], b"mrtbody\x01");
    assert_eq!(&bytes[8..12], [1, 0, 0, 0]);
    assert_eq!(&bytes[12..21], b"\x05\0\0\0steel");
    assert_eq!(&bytes[21..29], [2, 0, 0, 0, 0, 0, 0, 0]);
    let second = &bytes[29 + 128..];
    assert_eq!(&second[..4], [1, 0, 0, 0]);
    assert_eq!(&second[4..8], NO_MATERIAL.to_le_bytes());
    assert_eq!(&second[8..16], 1.0_f64.to_le_bytes());
    assert_eq!(&second[16..24], 2.0_f64.to_le_bytes());
    assert_eq!(&second[48..56], 0.5_f64.to_le_bytes());
    assert_eq!(&second[112..120], 7.0_f64.to_le_bytes());
}

#[test]
fn wrong_csv_is_answered_with_line_and_column() {
    let folder = Folder::new("csv");
    let wrong = |text: &str| folder.wrong("swarm.csv", text.as_bytes());
    let header = "body,px,py,pz,kind,radius,material";
    assert_eq!(wrong(""), "swarm.csv: the table is empty; it needs a header line");
    assert_eq!(wrong("px,py,pz,kind"), "swarm.csv:1:1: column 'radius' is missing");
    assert_eq!(wrong("px,py,pz,kind,radius,px"), "swarm.csv:1:22: column 'px' is there twice");
    assert!(wrong("px,py,pz,kind,radios").starts_with("swarm.csv:1:15: unknown column 'radios'; known are body, px"));
    let row = |row: &str| wrong(&format!("{header}\n\"x\",0,0,0,sphere,1,\n{row}\n"));
    assert_eq!(row("b,0,0,0,sphere,1"), "swarm.csv:3:17: 6 fields, the header has 7");
    assert_eq!(row("b,0,zero,0,sphere,1,"), "swarm.csv:3:5: py: 'zero' is not a finite number");
    assert_eq!(row("b,0,nan,0,sphere,1,"), "swarm.csv:3:5: py: 'nan' is not a finite number");
    assert_eq!(row("b,0,1e999,0,sphere,1,"), "swarm.csv:3:5: py: '1e999' is not a finite number");
    assert_eq!(row("b,0,,0,sphere,1,"), "swarm.csv:3:5: py is missing");
    assert_eq!(
        row("\"ä,ö\",0,0,0,cube,1,"),
        "swarm.csv:3:13: kind: unknown value 'cube'; known are sphere, tetrahedron"
    );
    assert_eq!(row("b,0,0,0,sphere,-1,"), "swarm.csv:3:1: radius = -1.0 is out of range: a size from 1e-50 to 1e50 m");
    assert_eq!(row("b,0,0,0,sphere,1,gold"), "swarm.csv:3:18: material: there is no material 'gold'");
    assert_eq!(row("\"b,0,0,0,sphere,1,"), "swarm.csv:3:1: a quoted field is not closed");
    assert_eq!(row("\"b\"c,0,0,0,sphere,1,"), "swarm.csv:3:4: expected a comma after the quoted field");
    assert_eq!(row(",0,0,0,sphere,1,"), "swarm.csv:3:1: body: a name must not be empty");
    let bytes = [header.as_bytes(), b"\n\xFF,0,0,0,sphere,1,\n"].concat();
    assert_eq!(folder.wrong("swarm.csv", &bytes), "swarm.csv:2:1: the text is not UTF-8");
    let long = format!("{header}\n{}", "x".repeat(70_000));
    assert_eq!(wrong(&long), "swarm.csv: line 2: longer than 65536 bytes");
    // A byte-order mark, line ends of Windows and empty lines are accepted.
    let good = format!("\u{FEFF}{header}\r\nx,0,0,0,sphere,1,\r\n\r\n");
    assert!(folder.read("swarm.csv", good.as_bytes()).is_ok());
}

#[test]
fn names_of_a_table_are_unique() {
    let folder = Folder::new("names");
    let text = "body,px,py,pz,kind,radius\na,0,0,0,sphere,1\nb,9,0,0,sphere,1\na,0,9,0,sphere,1\n";
    let e = folder.read("swarm.csv", text.as_bytes()).and_then(|s| s.build().map(drop)).expect_err("twice");
    assert!(e.list[0].message.contains("the name 'a' is there twice"), "{e}");
}

#[test]
fn wrong_binary_tables_are_refused() {
    let folder = Folder::new("bin");
    let good = write_binary(&swarm(false));
    let wrong = |bytes: &[u8]| folder.wrong("swarm.bin", bytes);
    for end in 0..good.len() {
        let message = wrong(&good[..end]);
        assert!(message.contains("ends too early") || message.contains("bodies need"), "{end}: {message}");
    }
    let changed = |at: usize, with: &[u8]| {
        let mut bytes = good.clone();
        bytes[at..at + with.len()].copy_from_slice(with);
        wrong(&bytes)
    };
    assert!(changed(0, b"M").contains("not a binary body table"));
    assert!(changed(7, &[2]).contains("not a binary body table of version 1"));
    // A header that promises more than there is allocates nothing.
    assert!(changed(21, &u64::MAX.to_le_bytes()).contains("more bodies than the 10000000"));
    assert!(changed(21, &9_000_000_u64.to_le_bytes()).contains("9000000 bodies need 1152000029"));
    assert!(changed(8, &u32::MAX.to_le_bytes()).contains("4294967295 materials"));
    assert!(changed(12, &0_u32.to_le_bytes()).contains("the name is 0 bytes long"));
    assert!(changed(16, b"gold!").contains("there is no material 'gold!'"));
    assert!(changed(29, &[7]).contains("body 0: unknown kind 7"));
    assert!(changed(33, &[1]).contains("body 0: material 1 of 1"));
    assert!(changed(37, &f64::NAN.to_le_bytes()).contains("body 0: radius is not a finite number"));
    assert!(changed(29 + 128 + 48, &f64::INFINITY.to_le_bytes()).contains("body 1: qx is not a finite number"));
}

#[test]
fn files_that_are_none_and_links_out_of_the_folder() {
    let folder = Folder::new("links");
    std::fs::create_dir_all(folder.0.join("sub.csv")).expect("a folder");
    std::fs::create_dir_all(folder.0.join("inner")).expect("a folder");
    let load = |file: &str| {
        let text = format!("format = 1\n[[body_table]]\nfile = '{file}'\n");
        std::fs::write(folder.0.join("inner/scene.toml"), text).expect("written");
        let e = Scene::load(&folder.0.join("inner/scene.toml")).expect_err("no table");
        e.first().expect("one").message.clone()
    };
    assert!(load("none.csv").contains("'none.csv': "));
    std::fs::create_dir_all(folder.0.join("inner/sub.csv")).expect("a folder");
    assert!(load("sub.csv").ends_with("'sub.csv' is not a file"));
    std::fs::write(folder.0.join("inner/bodies.txt"), "").expect("written");
    assert!(load("bodies.txt").ends_with("'bodies.txt' ends in neither .csv nor .bin"));
    #[cfg(unix)]
    {
        std::fs::write(folder.0.join("outside.csv"), "px,py,pz,kind,radius\n").expect("written");
        std::os::unix::fs::symlink(folder.0.join("outside.csv"), folder.0.join("inner/link.csv")).expect("a link");
        assert!(load("link.csv").ends_with("'link.csv' is not in the scene's folder or below"));
    }
}

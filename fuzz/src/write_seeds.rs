//! Writes the small valid files of the tests into FOLDER/FORMAT/.

#[path = "../../crates/formats/tests/formats/seeds.rs"]
mod seeds;

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).expect("write_seeds FOLDER");
    for (name, format, bytes) in seeds::seeds() {
        let folder = std::path::Path::new(&folder).join(format.to_string().to_lowercase());
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join(name), bytes)?;
    }
    Ok(())
}

//! Temporary.
use hapticore_model::blocks::core::Core;
use hapticore_model::profile::Profile;
use hapticore_rtl::verilog::Design;
fn main() {
    for name in ["small", "standard"] {
        let design = Design::of(&Core::new(&Profile::bundled(name).unwrap()), "a test");
        std::fs::write(format!("/tmp/lk_{name}.v"), design.text()).unwrap();
    }
}

fn main() {
    for p in hapticore_model::profile::Profile::all() {
        let t = std::time::Instant::now();
        let proof = hapticore_model::proof::prove(&p);
        println!(
            "{} holds {} closed {} rounds {} clocks {} lemmas {:?} in {:?}",
            p.name,
            proof.holds(),
            proof.closed,
            proof.rounds,
            proof.clocks,
            proof.lemmas,
            t.elapsed()
        );
        for v in proof.violations.iter().take(8) {
            println!("   {:?} bits {}", v, 128 - v.range.high.leading_zeros());
        }
        println!("{}", proof.violations.len());
        for (n, f, r) in
            proof.registers.iter().filter(|(_, f, r)| r.high > f.max_code() || r.low < f.min_code()).take(10)
        {
            println!("{n} {f} {r:?}");
        }
    }
}

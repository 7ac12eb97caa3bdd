// SPDX-License-Identifier: MIT OR Apache-2.0
//! Engines that run a plan's chunks: the shell commands for each. All of them run
//! `hapticore sweep run` on one line of `--list` at a time; what is present is done, so that any of
//! them may be stopped, repeated and mixed with others.

/// What distributes chunks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Engine {
    /// HyperQueue.
    HyperQueue,
    /// A Slurm array.
    Slurm,
    /// GNU parallel.
    Parallel,
    /// Snakemake.
    Snakemake,
}

/// What commands are made of, each as a word of the shell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Job {
    program: String,
    plan: String,
    store: String,
    chunks: String,
    folder: String,
}

impl Job {
    /// A plan in a store, run by a program.
    pub fn new(program: &str, plan: &str, store: &str) -> Self {
        Job {
            program: quoted(program),
            plan: quoted(plan),
            store: quoted(store),
            chunks: quoted(&format!("{store}/chunks.jsonl")),
            folder: quoted(&format!("{store}/engine")),
        }
    }

    /// The commands, a line each: chunks, their runs, what is collected.
    pub fn commands(&self, engine: Engine) -> String {
        let Job { program, plan, store, chunks, folder } = self;
        let run = format!("{program} sweep run --store {store}");
        let list = format!(
            "mkdir -p {folder}\n{program} sweep {plan} --store {store} --list >{chunks}.new && mv {chunks}.new {chunks}\n"
        );
        let collect = format!("{program} sweep collect {plan} --store {store}\n");
        let start = match engine {
            // A task's line is in HQ_ENTRY. A worker that is lost is no failure of its task.
            Engine::HyperQueue => format!(
                "hq submit --wait --name hapticore-sweep --each-line {chunks} --crash-limit 100 --stdout none --stderr {folder}/%{{TASK_ID}}.log -- sh -c {}\n",
                quoted(&format!("printf '%s' \"$HQ_ENTRY\" | {run} -"))
            ),
            Engine::Slurm => format!(
                "sbatch --wait --job-name hapticore-sweep --array 1-$(wc -l <{chunks}) --output {folder}/%a.log --wrap {}\n",
                quoted(&format!("sed -n \"${{SLURM_ARRAY_TASK_ID}}p\" {chunks} | {run} -"))
            ),
            Engine::Parallel => format!(
                "parallel --joblog {folder}/joblog --resume-failed {} :::: {chunks}\n",
                quoted(&format!("{run} {{}}"))
            ),
            Engine::Snakemake => self.snakemake(),
        };
        // What an engine did not run, the last command lists.
        let start = start.trim_end().to_string() + " || echo \"the engine ended with $?\" >&2\n";
        list + &start + &collect
    }

    /// A rule that runs a line, with an empty file for each that is done.
    fn snakemake(&self) -> String {
        let Job { program, store, chunks, folder, .. } = self;
        format!(
            "cat >{folder}/Snakefile <<'EOF'\n\
             rule all:\n    input: expand(\"done/{{n}}\", n=range(1, int(config[\"chunks\"]) + 1))\n\
             rule chunk:\n    output: touch(\"done/{{n}}\")\n    \
             shell: \"sed -n {{wildcards.n}}p {{config[lines]:q}} | {{config[program]:q}} sweep run --store {{config[store]:q}} -\"\n\
             EOF\n\
             snakemake --snakefile {folder}/Snakefile --directory {folder} --cores all --rerun-incomplete \
             --config chunks=$(wc -l <{chunks}) lines=\"$(realpath {chunks})\" store=\"$(realpath {store})\" program={program}\n"
        )
    }
}

/// A word of the shell.
fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=:,@%".contains(c);
    match !text.is_empty() && text.chars().all(plain) {
        true => text.into(),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_the_shell_stay_words() {
        assert_eq!(quoted("out/a-1.toml"), "out/a-1.toml");
        assert_eq!(quoted("my plan's"), r"'my plan'\''s'");
        assert_eq!(quoted(""), "''");
    }

    /// Snakemake stands for itself as a script that keeps its arguments, a line each.
    #[cfg(unix)]
    #[test]
    fn blanks_in_paths_stay_within_the_words_of_snakemake() {
        use std::os::unix::fs::PermissionsExt;
        use std::{fs, process::Command};
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name).display().to_string();
        let script = |path: &str, text: &str| {
            fs::write(path, format!("#!/bin/sh\n{text}\n")).expect("a script");
            fs::set_permissions(path, fs::Permissions::from_mode(0o755)).expect("its mode");
        };
        for name in ["my tool", "my store", "bin"] {
            fs::create_dir(at(name)).expect("a folder");
        }
        script(&at("my tool/hapticore"), "echo a; echo b");
        script(&at("bin/snakemake"), &format!("printf '%s\\n' \"$@\" >'{}'", at("arguments")));
        let job = Job::new(&at("my tool/hapticore"), "my plan.toml", &at("my store"));
        let path = format!("{}:{}", at("bin"), std::env::var("PATH").expect("a path"));
        let mut shell = Command::new("sh");
        let output = shell.args(["-c", &job.commands(Engine::Snakemake)]).env("PATH", path);
        assert!(output.output().expect("a shell").status.success());
        let real =
            |name: &str| fs::canonicalize(at(name)).expect("it is there").display().to_string();
        let arguments = fs::read_to_string(at("arguments")).expect("arguments");
        for argument in [
            format!("lines={}", real("my store/chunks.jsonl")),
            format!("store={}", real("my store")),
            format!("program={}", at("my tool/hapticore")),
        ] {
            assert!(arguments.lines().any(|line| line == argument), "{argument}:\n{arguments}");
        }
        let rules = fs::read_to_string(at("my store/engine/Snakefile")).expect("the rules");
        for key in ["lines", "program", "store"] {
            assert!(rules.contains(&format!("{{config[{key}]:q}}")), "{key}: {rules}");
        }
    }

    #[test]
    fn every_engine_lists_runs_and_collects() {
        let job = Job::new("hapticore", "my plan.toml", "s");
        for engine in [Engine::HyperQueue, Engine::Slurm, Engine::Parallel, Engine::Snakemake] {
            let text = job.commands(engine);
            assert!(
                text.contains("sweep 'my plan.toml' --store s --list >s/chunks.jsonl"),
                "{text}"
            );
            assert!(text.contains("sweep run --store"), "{text}");
            assert!(text.ends_with("sweep collect 'my plan.toml' --store s\n"), "{text}");
        }
    }
}

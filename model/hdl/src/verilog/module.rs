// SPDX-License-Identifier: MIT OR Apache-2.0
//! A module as text: head, ports, registers, wires, memories, instances, clock.

use super::clock::Next;
use super::live::Live;
use super::names::{Names, ports, read_register};
use super::scope::{Scope, range};
use super::text::{BREAK, bits, literal};
use super::{Direction, Heading, Port};
use crate::interpretations::netlist::{Module, Named, Netlist, Node, Op, Ram};
use crate::memory::Collision;
use std::fmt::Write;

/// The text of a module.
pub fn print(
    netlist: &Netlist,
    modules: &[String],
    module: &Module,
    name: &str,
    heading: &Heading,
) -> String {
    let (ports, names) = reserved(module);
    let mut printer = Printer {
        scope: Scope::new(module, names),
        netlist,
        modules,
        ports,
        registers: vec![],
        memories: vec![],
    };
    let mut text = printer.head(name, heading);
    text += &printer.declarations();
    printer.wires();
    // These may declare wires yet, which stand before them.
    let users = [printer.instances(), printer.memories(), printer.clock(), printer.outputs()];
    let wires = std::mem::take(&mut printer.scope.body);
    if !wires.is_empty() {
        text += &format!("\n{}\n", wires.join("\n"));
    }
    text += &users.concat();
    let mut unused = printer.scope.unused();
    if !(module.resets && printer.registers.iter().any(Option::is_some))
        && module.instances.is_empty()
    {
        unused.push("reset".into());
    }
    if !unused.is_empty() {
        let _ = write!(
            text,
            "\n    // Unused bits.\n    wire unused = &{{1'b0, {}}};\n",
            folded(&unused)
        );
    }
    text.replace(BREAK, " ") + "\nendmodule\n\n`default_nettype wire\n"
}

/// The names of registers that something needs, and whether each is an output as it stands.
type Registers = Vec<Option<(String, bool)>>;

/// A register that is an output under its own name is the port; another whose name is taken gets `_q`.
fn registers(module: &Module, live: &Live, ports: &[Port], names: &mut Names) -> Registers {
    let outputs =
        |name: &str| ports.iter().any(|p| p.direction == Direction::Output && p.name == name);
    let named = |(index, register): (usize, &Named)| {
        let node = |port: &&Named| module.wires[port.node.0 as usize].op == Op::Register(index);
        let output = module.outputs.iter().find(|port| port.name == register.name).filter(node);
        live.registers[index].then(|| match output {
            Some(_) if outputs(register.name) => (register.name.to_owned(), true),
            _ if names.has(register.name) => (names.unique(&format!("{}_q", register.name)), false),
            _ => (names.unique(register.name), false),
        })
    };
    module.registers.iter().enumerate().map(named).collect()
}

/// The names that the text of a module has for its registers; none for those that it leaves out.
pub fn register_names(module: &Module) -> Vec<Option<String>> {
    let (ports, mut names) = reserved(module);
    let registers = registers(module, &Live::of(module), &ports, &mut names);
    registers.into_iter().map(|register| register.map(|(name, _)| name)).collect()
}

/// The ports of a module, and its names with theirs taken.
fn reserved(module: &Module) -> (Vec<Port>, Names) {
    let ports = ports(module);
    let mut names = Names::default();
    ports.iter().for_each(|port| names.reserve(&port.name));
    (ports, names)
}

/// A list over several lines.
fn folded(items: &[String]) -> String {
    let mut text = String::new();
    let mut column = 28;
    for (index, item) in items.iter().enumerate() {
        let comma = if index + 1 < items.len() { ", " } else { "" };
        if column + item.len() > 118 {
            text.truncate(text.trim_end().len());
            text += "\n        ";
            column = 8;
        }
        column += item.len() + 2;
        text += item;
        text += comma;
    }
    text
}

struct Printer<'a> {
    scope: Scope<'a>,
    netlist: &'a Netlist,
    modules: &'a [String],
    ports: Vec<Port>,
    registers: Registers,
    /// The name of each memory: its own, but for a word of the language or a name that is taken.
    memories: Vec<String>,
}

impl Printer<'_> {
    fn head(&mut self, name: &str, heading: &Heading) -> String {
        self.name_registers();
        let Module { path, .. } = self.scope.module;
        let mut text =
            heading.text(name, path, std::ptr::eq(self.scope.module, self.netlist.top()));
        text += "`default_nettype none\n\n";
        let _ = write!(text, "module {name} (\n    input wire clock,\n    input wire reset");
        let mut comment = String::new();
        for port in &self.ports {
            let direction = match port.direction {
                Direction::Input => "input wire",
                Direction::Output if self.is_register(&port.name) => "output reg",
                Direction::Output => "output wire",
            };
            let range = range(port.format.width, port.format.signed);
            let _ = write!(text, ",{comment}\n    {direction} {range}{}", port.name);
            comment = format!(" // {}{}", port.format, about(port.about, port.states));
        }
        text + &comment + "\n);\n"
    }

    fn is_register(&self, port: &str) -> bool {
        self.registers.iter().flatten().any(|(name, output)| *output && name == port)
    }

    fn name_registers(&mut self) {
        let Scope { module, live, names, .. } = &mut self.scope;
        self.registers = registers(module, live, &self.ports, names);
    }

    /// Registers, memories, and what comes out of instances; each wire that stands for one of them
    /// gets its name.
    fn declarations(&mut self) -> String {
        let module = self.scope.module;
        let mut text = String::new();
        for (register, name) in module.registers.iter().zip(&self.registers) {
            if let Some((name, false)) = name {
                let range = range(register.format.width, register.format.signed);
                let about = about(register.about, register.states);
                let _ = writeln!(text, "    reg {range}{name}; // {}{about}", register.format);
            }
        }
        let names = &mut self.scope.names;
        self.memories = module.memories.iter().map(|ram| names.of_memory(ram.name)).collect();
        let memories = self.memories.clone();
        for (index, ram) in
            module.memories.iter().enumerate().filter(|(index, _)| self.scope.live.memories[*index])
        {
            let (range, name, words) =
                (range(ram.format.width, ram.format.signed), &memories[index], ram.initial.len());
            text += &attributes(module, ram);
            let _ = writeln!(
                text,
                "    reg {range}{name} [0:{}]; // {words} words {}",
                words - 1,
                ram.format
            );
            let _ = writeln!(text, "    reg {range}{}; // its read register", read_register(name));
        }
        for (index, wire) in module.wires.iter().enumerate() {
            let node = Node(index as u32);
            let name = match wire.op {
                Op::Input(port) => self.ports[port].name.clone(),
                Op::Register(register) if self.registers[register].is_some() => {
                    self.registers[register].clone().expect("is some").0
                }
                Op::Data(ram) if self.scope.live.memories[ram] => read_register(&memories[ram]),
                Op::Output(instance, port) => {
                    let of = &module.instances[instance];
                    let port = &self.netlist.modules[of.module].outputs[port];
                    let name = self.scope.names.unique(&format!("{}_{}", of.name, port.name));
                    let range = range(port.format.width, port.format.signed);
                    let _ = writeln!(text, "    wire {range}{name}; // {}", port.format);
                    name
                }
                _ => continue,
            };
            self.scope.bind(node, &name, wire.format);
        }
        if text.is_empty() { text } else { format!("\n{text}") }
    }

    fn wires(&mut self) {
        self.hints();
        for index in 0..self.scope.module.wires.len() {
            if self.scope.live.uses[index] > 0 {
                self.scope.print(Node(index as u32));
            }
        }
    }

    fn hints(&mut self) {
        let module = self.scope.module;
        for (register, name) in module.registers.iter().zip(&self.registers) {
            if let Some((name, _)) = name {
                self.scope.hint(register.node, format!("next_{name}"));
            }
        }
        for instance in &module.instances {
            for (&node, port) in
                instance.inputs.iter().zip(&self.netlist.modules[instance.module].inputs)
            {
                self.scope.hint(node, format!("{}_{}", instance.name, port.name));
            }
        }
        for ram in &module.memories {
            if let Some(node) = ram.address {
                self.scope.hint(node, format!("{}_address", ram.name));
            }
            if let Some((enable, address, word)) = ram.write {
                self.scope.hint(enable, format!("write_{}", ram.name));
                self.scope.hint(address, format!("{}_write_address", ram.name));
                self.scope.hint(word, format!("{}_write_word", ram.name));
            }
        }
    }

    fn instances(&mut self) -> String {
        let mut text = String::new();
        for instance in &self.scope.module.instances {
            let module = &self.netlist.modules[instance.module];
            let (of, name) = (&self.modules[instance.module], super::instance(instance.name));
            let _ = write!(text, "\n    {of} {name} (\n");
            let _ = write!(text, "        .clock(clock),\n        .reset(reset)");
            let ports = ports(module);
            for (port, &node) in ports.iter().zip(&instance.inputs) {
                let driven = self.scope.whole(node).text;
                let _ = write!(text, ",\n        .{}({driven})", port.name);
            }
            for (port, named) in ports[module.inputs.len()..].iter().zip(&module.outputs) {
                let _ = write!(text, ",\n        .{}({}_{})", port.name, instance.name, named.name);
            }
            text += "\n    );\n";
        }
        text
    }

    fn memories(&mut self) -> String {
        let module = self.scope.module;
        let live = |index: &usize| self.scope.live.memories[*index];
        let live: Vec<usize> = (0..module.memories.len()).filter(live).collect();
        live.into_iter()
            .map(|index| self.memory(&module.memories[index], &self.memories[index].clone()))
            .collect()
    }

    fn memory(&mut self, ram: &Ram, name: &str) -> String {
        let mut text = format!("\n{}    always @(posedge clock) begin\n", initial(ram, name));
        if let Some((enable, address, word)) = ram.write {
            let enable = self.scope.whole(enable).text;
            let (address, word) = (self.scope.whole(address).text, self.scope.whole(word).text);
            let _ = writeln!(text, "        if ({enable}) {name}[{address}] <= {word};");
        }
        if let Some(address) = ram.address {
            let _ = writeln!(
                text,
                "        {} <= {name}[{}];",
                read_register(name),
                self.scope.whole(address).text
            );
        }
        text + "    end\n"
    }

    fn clock(&mut self) -> String {
        let (mut resets, mut nexts) = (String::new(), Vec::new());
        for (index, register) in self.scope.module.registers.iter().enumerate() {
            let Some((name, _)) = self.registers[index].clone() else { continue };
            let Named { node, format, .. } = *register;
            let _ = writeln!(resets, "            {name} <= {};", literal(0, format.width));
            nexts.push(Next { name, own: Op::Register(index), node, format });
        }
        if resets.is_empty() {
            return resets;
        }
        if !self.scope.module.resets {
            return format!(
                "\n    always @(posedge clock) begin\n{}    end\n",
                self.scope.statements(nexts, 8)
            );
        }
        let steps = self.scope.statements(nexts, 12);
        let reset = format!(
            "        if (reset) begin\n{resets}        end else begin\n{steps}        end\n"
        );
        format!("\n    always @(posedge clock) begin\n{reset}    end\n")
    }

    fn outputs(&mut self) -> String {
        let module = self.scope.module;
        let mut text = String::new();
        for (index, named) in module.outputs.iter().enumerate() {
            let port = self.ports[module.inputs.len() + index].clone();
            let value = self.scope.whole(named.node).text;
            if !self.is_register(&port.name) {
                let _ = writeln!(text, "    assign {} = {value};", port.name);
            }
        }
        if text.is_empty() { text } else { format!("\n{text}") }
    }
}

/// What a comment says of a port or register besides its format.
fn about(about: &str, states: &[&str]) -> String {
    let states: Vec<String> =
        states.iter().enumerate().map(|(code, name)| format!("{code} {name}")).collect();
    let about = if about.is_empty() { String::new() } else { format!("  {about}") };
    if states.is_empty() { about } else { format!("{about}  {}", states.join(", ")) }
}

/// The words of a memory at the start.
fn initial(ram: &Ram, name: &str) -> String {
    let (width, words) = (ram.format.width, ram.initial.len());
    let mut text = format!("    initial begin : initial_{name}\n");
    if ram.initial.iter().all(|&word| word == 0) {
        let zero = literal(0, width);
        text += "        integer i;\n";
        let _ = writeln!(text, "        for (i = 0; i < {words}; i = i + 1) {name}[i] = {zero};");
    } else {
        for (start, row) in ram.initial.chunks(4).enumerate() {
            let word = |(n, &word): (usize, &i64)| {
                format!("{name}[{}] = {};", 4 * start + n, bits(word as u64, width))
            };
            let _ = writeln!(
                text,
                "        {}",
                row.iter().enumerate().map(word).collect::<Vec<_>>().join(" ")
            );
        }
    }
    text + "    end\n\n"
}

/// Attributes of a memory's declaration.
fn attributes(module: &Module, ram: &Ram) -> String {
    let is_constant = |node: Node| matches!(module.wires[node.0 as usize].op, Op::Constant(_));
    let mut text = String::new();
    if ram.collision == Collision::DontCare && ram.write.is_some() {
        text += "    (* no_rw_check *) // read-during-write: don't care\n";
    }
    if ram.block {
        text += "    (* ram_style = \"block\" *)\n";
    }
    // Yosys makes registers of a memory that only a constant addresses, and warns unless it is asked to.
    if ram.write.is_some_and(|(_, address, _)| is_constant(address)) {
        text += "    (* mem2reg *)\n";
    }
    text
}

#[cfg(test)]
mod tests {
    use super::folded;

    #[test]
    fn a_list_goes_up_to_column_118() {
        let items = |length: usize| ["a".repeat(length), "b".to_string()];
        let long = "a".repeat(88);
        assert_eq!(folded(&items(88)), format!("{long},\n        b"));
        let fits = |length| !folded(&[String::new(), "b".repeat(length)]).contains('\n');
        assert!(fits(118 - 30) && !fits(118 - 29));
    }
}

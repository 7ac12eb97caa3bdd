# SPDX-License-Identifier: MIT OR Apache-2.0
"""The printed force loop in cocotb: written its words and given slots of samples, it gives the drive words of the model.

The words of frames are loop_bench.v's to compare. Run by `make -C rtl/verilog test`; the vectors are rtl/verilog/vectors/loop_*.csv.
"""

import collections
import csv
from pathlib import Path

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, RisingEdge

VECTORS = Path(__file__).resolve().parent.parent / "vectors"
CLOCKS_PER_SAMPLE = 25  # rtl/verilog/loop.toml, until loop_events.csv says otherwise
LATENCY = 10000  # clocks, more than from a slot's last strobe to its frame's last word
CHANNELS = ["i1", "i2", "i3", "i4", "i5", "i6", "v_sense", "v_haptic"]
DRIVE = ["drive_pad", "drive", "drive_low", "drive_high", "silence_fault", "sensor_fault", "force_fault"]
# A word that is written by address: the ports of write, address and word.
TABLES = {
    "position_table": ("write", "address", "word"),
    "curve_word": ("curve_write", "curve_address", "curve_word"),
    "target_word": ("target_write", "target_pad", "target_word"),
    "wall_surface": ("wall_write", "wall_pad", "wall_surface"),
}
PULSES = ["clear", "clear_faults", "alive", "tick", "drives_clear"]
ZERO = ["strobe", "code", "wall_right", "wall_restart", "extremes_read", "enable"] + PULSES
CONSTANTS = ["capacitance_gain", "force_gain", "contact_capacitance", "full_drive", "proportional", "correction", "rail", "slew", "force_cap"]
WALLS = ["wall_stiffness", "wall_most", "wall_factory"]


def rows(name):
    with open(VECTORS / f"loop_{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


class Loop:
    """The loop's pins; inputs change at falling edges, so that each is there before the rising edge that takes it."""

    def __init__(self, dut, expected):
        self.dut = dut
        self.expected = expected
        self.driven = 0
        self.asked = 0
        self.clocks = CLOCKS_PER_SAMPLE
        for pin in ZERO + CONSTANTS + WALLS + [port for ports in TABLES.values() for port in ports]:
            getattr(dut, pin).value = 0

    async def reset(self):
        self.dut.reset.value = 1
        await RisingEdge(self.dut.clock)
        await FallingEdge(self.dut.clock)
        self.dut.reset.value = 0

    async def tick(self):
        # The loop names the channel whose code it wants in the next clock.
        self.asked = int(self.dut.channel.value)
        await FallingEdge(self.dut.clock)
        if self.dut.drive_valid.value == 1:
            self.compare([int(getattr(self.dut, port).value) for port in DRIVE])

    def compare(self, got):
        number, self.driven = self.driven, self.driven + 1
        assert number < len(self.expected), f"more than the expected {number} drive words: {got}"
        wanted = self.expected[number]
        assert got == wanted, f"drive word {number}: got {got}, expected {wanted} ({', '.join(DRIVE)})"

    async def pulse(self, *pins):
        for pin in pins:
            getattr(self.dut, pin).value = 1
        await self.tick()
        for pin in pins:
            getattr(self.dut, pin).value = 0

    async def write(self, name, address, code):
        if name in TABLES:
            write, place, word = TABLES[name]
            getattr(self.dut, place).value, getattr(self.dut, word).value = int(address), code
            await self.pulse(write)
        elif name in PULSES:
            await self.pulse(name)
        elif name == "clear_and_strobe":
            await self.pulse("clear", "strobe")
        elif name == "clocks":
            self.clocks = code
        else:
            getattr(self.dut, name).value = code

    async def sample(self, codes):
        self.dut.strobe.value = 1
        for _ in range(self.clocks):
            self.dut.code.value = codes[self.asked]
            await self.tick()
            self.dut.strobe.value = 0


@cocotb.test()
async def slots_give_the_drive_words_of_the_model(dut):
    cocotb.start_soon(Clock(dut.clock, 40, unit="ns").start())
    expected = [[int(code) for code in row.values()] for row in rows("drives")]
    loop = Loop(dut, expected)
    await loop.reset()
    for row in rows("codes"):
        await loop.write(row["name"], row["address"], int(row["code"]))
    written = collections.defaultdict(list)
    for row in rows("events"):
        written[int(row["sample"])].append((row["name"], row["address"], int(row["code"])))
    for number, row in enumerate(rows("samples")):
        for name, address, code in written[number]:
            await loop.write(name, address, code)
        await loop.sample([int(row[name]) for name in CHANNELS])
    for _ in range(LATENCY):  # the last slot's estimate
        await loop.tick()
    assert loop.driven == len(expected), f"got {loop.driven} drive words, expected {len(expected)}"

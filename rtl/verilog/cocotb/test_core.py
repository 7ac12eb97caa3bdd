# SPDX-License-Identifier: MIT OR Apache-2.0
"""The printed core of the small profile in cocotb: given slots of samples, it sends the frames that the model sent.

The other outputs are bench.v's to compare (`make -C rtl/verilog sim`). Run by `make -C rtl/verilog test`. The vectors in rtl/verilog/vectors are the model's own.
"""

import collections
import csv
from pathlib import Path

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, RisingEdge

VECTORS = Path(__file__).resolve().parent.parent / "vectors"
CLOCKS_PER_SAMPLE = 24  # model/src/profile/small.toml, until calibration.csv says otherwise
CHANNELS = ["i1", "i2", "i3", "i4", "i5", "i6", "v_sense", "v_haptic"]
FLAGS = ["clipped", "saturated", "invalid", "lost", "lifted"]
INPUTS = ["strobe", "clear", "code", "write", "address", "word"]
CONSTANTS = ["capacitance_gain", "force_gain", "contact_capacitance"]


def rows(name):
    with open(VECTORS / name, newline="") as file:
        return list(csv.DictReader(file))


class Core:
    """The core's pins; inputs change at falling edges, so that each is there before the rising edge that takes it."""

    def __init__(self, dut, expected):
        self.dut = dut
        self.expected = expected
        self.words = 0
        self.asked = 0
        self.clocks = CLOCKS_PER_SAMPLE
        for pin in INPUTS + CONSTANTS:
            getattr(dut, pin).value = 0

    async def reset(self):
        self.dut.reset.value = 1
        await RisingEdge(self.dut.clock)
        await FallingEdge(self.dut.clock)
        self.dut.reset.value = 0

    async def tick(self):
        # The core names the channel whose code it wants in the next clock.
        self.asked = int(self.dut.channel.value)
        await FallingEdge(self.dut.clock)
        if self.dut.valid.value == 1:
            word = [int(self.dut.pad.value), int(self.dut.index.value), self.dut.frame.value.to_signed()]
            self.compare(word + [int(getattr(self.dut, flag).value) for flag in FLAGS])

    def compare(self, got):
        number, self.words = self.words, self.words + 1
        assert number < len(self.expected), f"more than the expected {number} words: {got}"
        wanted = self.expected[number]
        assert got == wanted, f"word {number}: got {got}, expected {wanted} (pad, index, word, {', '.join(FLAGS)})"

    async def pulse(self, pin):
        getattr(self.dut, pin).value = 1
        await self.tick()
        getattr(self.dut, pin).value = 0

    async def calibrate(self, what, code):
        if what.isdigit():
            self.dut.address.value, self.dut.word.value = int(what), code
            await self.pulse("write")
        elif what == "clear":
            await self.pulse("clear")
        elif what == "clocks":
            self.clocks = code
        else:
            getattr(self.dut, what).value = code

    async def sample(self, codes):
        self.dut.strobe.value = 1
        for _ in range(self.clocks):
            self.dut.code.value = codes[self.asked]
            await self.tick()
            self.dut.strobe.value = 0


@cocotb.test()
async def slots_give_the_frames_of_the_model(dut):
    cocotb.start_soon(Clock(dut.clock, 40, unit="ns").start())
    expected = [[int(code) for code in row.values()] for row in rows("frames.csv")]
    core = Core(dut, expected)
    await core.reset()
    written = collections.defaultdict(list)
    for row in rows("calibration.csv"):
        written[int(row["sample"])].append((row["what"], int(row["code"])))
    for number, row in enumerate(rows("samples.csv")):
        for what, code in written[number]:
            await core.calibrate(what, code)
        await core.sample([int(row[name]) for name in CHANNELS])
    dut.strobe.value = 0
    for _ in range(10000):  # the last slot's estimate
        await core.tick()
    assert core.words == len(expected), f"got {core.words} words, expected {len(expected)}"

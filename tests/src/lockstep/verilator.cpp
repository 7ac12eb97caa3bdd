// SPDX-License-Identifier: MIT OR Apache-2.0
// The design as Verilator makes it.
#include "Vtop.h"
#include "verilated.h"

using Top = Vtop;

static Top* begin(int count, char** arguments) {
    Verilated::commandArgs(count, arguments);
    return new Vtop;
}

static inline void level(Top* top, int value) { top->clock = value; }
static inline void reset(Top* top, int value) { top->reset = value; }
static inline void evaluate(Top* top) { top->eval(); }

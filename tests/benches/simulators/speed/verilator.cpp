// SPDX-License-Identifier: MIT OR Apache-2.0
// A design as Verilator makes it.
#include "Vtop.h"
#include "verilated.h"
#include <cstdint>

using Top = Vtop;
#define SET(port, value) top->port = (value)
#define GET(port) (uint64_t)top->port

static inline void evaluate(Top* top) { top->eval(); }

// SPDX-License-Identifier: MIT OR Apache-2.0
// The design as CXXRTL makes it, its assertions on: an address beyond the words of a memory ends the program.
#include "design.cc"

using Top = cxxrtl_design::p_@TOP@;

static Top* begin(int, char**) { return new Top; }

static inline void level(Top* top, int value) { top->p_clock.set<uint64_t>(value); }
static inline void reset(Top* top, int value) { top->p_reset.set<uint64_t>(value); }
static inline void evaluate(Top* top) { top->step(); }

template <size_t BITS> static inline uint64_t bits(const cxxrtl::value<BITS>& port) { return port.template get<uint64_t>(); }
template <size_t BITS> static inline uint64_t bits(const cxxrtl::wire<BITS>& port) { return bits(port.curr); }

// SPDX-License-Identifier: MIT OR Apache-2.0
// A design as CXXRTL makes it.
#include "design.cc"

using Top = cxxrtl_design::@TOP@;
#define SET(port, value) top->p_##port.set<uint64_t>(value)
#define GET(port) code(top->p_##port)

template <size_t BITS> static inline uint64_t code(const cxxrtl::value<BITS>& port) { return port.template get<uint64_t>(); }
template <size_t BITS> static inline uint64_t code(const cxxrtl::wire<BITS>& port) { return code(port.curr); }

static inline void evaluate(Top* top) { top->step(); }

// SPDX-License-Identifier: MIT OR Apache-2.0
// Runs a design on the inputs of a trace and compares every output at every clock. What stands first declares the design for
// one simulator: `Top`, `begin`, `level` of the clock, `reset` and `evaluate`.
@TOP@
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

static const size_t PORTS = @PORTS@;

static inline void give(Top* top, const uint64_t* row) {
@GIVE@}

static inline void differ(size_t clock, const char* name, uint64_t model, uint64_t verilog) {
    if (model == verilog) return;
    std::printf("mismatch %zu %s 0x%llx 0x%llx\n", clock, name, (unsigned long long)model, (unsigned long long)verilog);
    std::exit(0);
}

static inline void compare(Top* top, const uint64_t* row, size_t clock) {
@COMPARE@}

static inline void edge(Top* top) {
    level(top, 1);
    evaluate(top);
    level(top, 0);
}

static std::vector<uint64_t> read(const char* path) {
    std::FILE* file = std::fopen(path, "rb");
    std::fseek(file, 0, SEEK_END);
    std::vector<uint64_t> words(std::ftell(file) / sizeof(uint64_t));
    std::rewind(file);
    if (std::fread(words.data(), sizeof(uint64_t), words.size(), file) != words.size()) std::exit(2);
    return words;
}

int main(int count, char** arguments) {
    Top* top = begin(count, arguments);
    const std::vector<uint64_t> trace = read(arguments[1]);
    const size_t clocks = trace.size() / PORTS;
    reset(top, 1);
    level(top, 0);
    give(top, trace.data());
    for (int clock = 0; clock < 2; clock++) { evaluate(top); edge(top); }
    reset(top, 0);
    for (size_t clock = 0; clock < clocks; clock++) {
        const uint64_t* row = &trace[clock * PORTS];
        give(top, row);
        evaluate(top);
        compare(top, row, clock);
        edge(top);
    }
    std::printf("equal %zu\n", clocks);
    return 0;
}

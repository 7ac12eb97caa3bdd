// SPDX-License-Identifier: MIT OR Apache-2.0
// Runs @TOP@ over a course and takes the time: arguments TABLE SAMPLES PASSES.
#include "Vtop.h"
#include "verilated.h"
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

static const size_t CHANNELS = @CHANNELS@;
static const unsigned CLOCKS_PER_SAMPLE = @CLOCKS_PER_SAMPLE@;

static inline void edge(Vtop* top) {
    top->clock = 1;
    top->eval();
    top->clock = 0;
}

static inline uint64_t added(uint64_t sum, const Vtop* top) {
    sum = sum << @ROTATED@ | sum >> (64 - @ROTATED@);
@SUM@    return sum;
}

template <typename T> static std::vector<T> read(const char* path) {
    std::FILE* file = std::fopen(path, "rb");
    std::fseek(file, 0, SEEK_END);
    std::vector<T> words(std::ftell(file) / sizeof(T));
    std::rewind(file);
    if (std::fread(words.data(), sizeof(T), words.size(), file) != words.size()) std::exit(2);
    return words;
}

static void prepare(Vtop* top, const std::vector<uint64_t>& table) {
@CONSTANTS@    top->reset = 1;
    top->clock = 0;
    for (int clock = 0; clock < 2; clock++) { top->eval(); edge(top); }
    top->reset = 0;
    top->write = 1;
    for (size_t word = 0; word < table.size(); word += 2) {
        top->address = table[word];
        top->word = table[word + 1] & @WORD@;
        top->eval();
        edge(top);
    }
    top->write = 0;
@CONSTANTS@}

static uint64_t timed(Vtop* top, const std::vector<int32_t>& samples, unsigned passes) {
    size_t channel = 0;
    uint64_t sum = 0;
    for (unsigned pass = 0; pass < passes; pass++) {
        for (size_t set = 0; set < samples.size(); set += CHANNELS) {
            for (unsigned clock = 0; clock < CLOCKS_PER_SAMPLE; clock++) {
                top->strobe = clock == 0;
                top->code = samples[set + channel] & @CODE@;
                top->eval();
                channel = top->channel;
                sum = added(sum, top);
                edge(top);
            }
        }
    }
    return sum;
}

int main(int, char** arguments) {
    const auto table = read<uint64_t>(arguments[1]);
    const auto samples = read<int32_t>(arguments[2]);
    Vtop* top = new Vtop;
    prepare(top, table);
    const auto start = std::chrono::steady_clock::now();
    const uint64_t sum = timed(top, samples, std::atoi(arguments[3]));
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    std::printf("%.9f %llu\n", taken.count(), (unsigned long long)sum);
    return 0;
}

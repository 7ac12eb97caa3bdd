// SPDX-License-Identifier: MIT OR Apache-2.0
// Runs a design over a workload and takes the time: arguments TABLE SAMPLES PASSES.
@INCLUDES@
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

static const size_t CHANNELS = @CHANNELS@;
static const unsigned CLOCKS_PER_SAMPLE = @CLOCKS_PER_SAMPLE@;

static inline void edge(Top* top) {
    SET(clock, 1);
    evaluate(top);
    SET(clock, 0);
}

static inline uint64_t added(uint64_t sum, const Top* top) {
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

static void prepare(Top* top, const std::vector<uint64_t>& table) {
@CONSTANTS@    SET(reset, 1);
    SET(clock, 0);
    for (int clock = 0; clock < 2; clock++) { evaluate(top); edge(top); }
    SET(reset, 0);
    SET(write, 1);
    for (size_t word = 0; word < table.size(); word += 2) {
        SET(address, table[word]);
        SET(word, table[word + 1] & @WORD@);
        evaluate(top);
        edge(top);
    }
    SET(write, 0);
@CONSTANTS@}

static uint64_t timed(Top* top, const std::vector<int32_t>& samples, unsigned passes) {
    size_t channel = 0;
    uint64_t sum = 0;
    for (unsigned pass = 0; pass < passes; pass++) {
        for (size_t set = 0; set < samples.size(); set += CHANNELS) {
            for (unsigned clock = 0; clock < CLOCKS_PER_SAMPLE; clock++) {
                SET(strobe, clock == 0);
                SET(code, samples[set + channel] & @CODE@);
                evaluate(top);
                channel = GET(channel);
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
    Top* top = new Top;
    prepare(top, table);
    const auto start = std::chrono::steady_clock::now();
    const uint64_t sum = timed(top, samples, std::atoi(arguments[3]));
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    std::printf("%.9f %llu\n", taken.count(), (unsigned long long)sum);
    return 0;
}

#include "sweep/report/page_template.hpp"

#include "sweep/report/packed_column.hpp"
#include "sweep/report/page_files.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <ostream>

namespace grainsweep::report {
namespace {

// ---- SHA-256 (FIPS 180-4), for the scripts in the content security policy

using State = std::array<std::uint32_t, 8>;

// Fractional parts of the cube roots of the first 64 primes.
constexpr std::array<std::uint32_t, 64> round_constants = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

void take_block(const char* block, State& state) {
    std::array<std::uint32_t, 64> w{};
    for (std::size_t t = 0; t < 16; ++t)
        for (std::size_t byte = 0; byte < 4; ++byte)
            w[t] = w[t] << 8U | static_cast<unsigned char>(block[4 * t + byte]);
    for (std::size_t t = 16; t < 64; ++t) {
        const std::uint32_t s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ w[t - 15] >> 3U;
        const std::uint32_t s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ w[t - 2] >> 10U;
        w[t] = w[t - 16] + s0 + w[t - 7] + s1;
    }
    auto [a, b, c, d, e, f, g, h] = state;
    for (std::size_t t = 0; t < 64; ++t) {
        const std::uint32_t sum1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
        const std::uint32_t one = h + sum1 + ((e & f) ^ (~e & g)) + round_constants[t] + w[t];
        const std::uint32_t sum0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
        const std::uint32_t two = sum0 + ((a & b) ^ (a & c) ^ (b & c));
        h = g, g = f, f = e, e = d + one, d = c, c = b, b = a, a = one + two;
    }
    const State ended = {a, b, c, d, e, f, g, h};
    for (std::size_t k = 0; k < state.size(); ++k) state[k] += ended[k];
}

std::array<std::uint8_t, 32> sha256(std::string_view text) {
    constexpr std::size_t block = 64, length_bytes = 8;
    // Fractional parts of the square roots of the first 8 primes.
    State state = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    const std::uint64_t bits = 8 * std::uint64_t{text.size()};
    while (text.size() >= block) {
        take_block(text.data(), state);
        text.remove_prefix(block);
    }
    std::string last(text);
    last += '\x80';
    while (last.size() % block != block - length_bytes) last += '\0';
    for (int shift = 56; shift >= 0; shift -= 8)
        last += static_cast<char>(bits >> static_cast<unsigned>(shift) & 0xFFU);
    for (std::size_t at = 0; at < last.size(); at += block) take_block(&last[at], state);

    std::array<std::uint8_t, 32> digest{};
    for (std::size_t k = 0; k < digest.size(); ++k)
        digest[k] = static_cast<std::uint8_t>(state[k / 4] >> (24 - 8 * (k % 4)));
    return digest;
}

}  // namespace

void fill(std::ostream& out, std::string_view skeleton,
          const std::vector<std::pair<std::string_view, std::string_view>>& parts) {
    while (true) {
        const auto open = skeleton.find("{{");
        const auto close = skeleton.find("}}", open == std::string_view::npos ? 0 : open);
        if (open == std::string_view::npos || close == std::string_view::npos) break;
        out << skeleton.substr(0, open);
        const auto name = skeleton.substr(open + 2, close - open - 2);
        const auto part = std::ranges::find(parts, name, &std::pair<std::string_view, std::string_view>::first);
        if (part != parts.end()) out << part->second;
        skeleton.remove_prefix(close + 2);
    }
    out << skeleton;
}

std::string write_figures(std::ostream& out, std::string_view library, std::string_view script, std::string_view data,
                          std::string_view films, std::string_view film_script, std::string_view asks) {
    const auto files = page_files();
    const auto program = enclosed(script);
    std::vector<std::string_view> scripts = {library, program};
    if (!film_script.empty()) scripts.push_back(film_script);
    const std::string policy = "default-src 'none'; style-src 'unsafe-inline'; script-src " + script_sources(scripts) +
                               "; img-src data:" + (asks.empty() ? "" : "; connect-src " + std::string(asks));
    fill(out, files.skeleton,
         {{"policy", policy},
          {"style", files.style},
          {"library", library},
          {"films", films},
          {"data", data},
          {"program", program}});
    return policy;
}

std::string enclosed(std::string_view script) {
    return "(function () {\n\"use strict\";\n" + std::string(script) + "\n})();\n";
}

std::string script_sources(const std::vector<std::string_view>& scripts) {
    std::string sources;
    for (const auto script : scripts) {
        const auto digest = sha256(script);
        sources +=
            (sources.empty() ? "'sha256-" : " 'sha256-") + base64(std::string(digest.begin(), digest.end())) + "'";
    }
    return sources;
}

}  // namespace grainsweep::report

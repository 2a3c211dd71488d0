#include "sweep/campaign/case.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace grainsweep::campaign {

namespace {
constexpr std::array<std::string_view, outcomes.size()> outcome_words = {
    "completed", "skipped", "unstable", "rejected", "crashed", "timed_out", "abandoned"};
}

std::string_view to_string(Outcome outcome) {
    return outcome_words[static_cast<std::size_t>(outcome)];
}

std::optional<Outcome> outcome_named(std::string_view word) {
    const auto found = std::ranges::find(outcome_words, word);
    if (found == outcome_words.end()) return std::nullopt;
    return outcomes[static_cast<std::size_t>(found - outcome_words.begin())];
}

std::string shortest(double x) {
    if (x == 0) return "0";
    std::array<char, 32> buffer{};
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), x);
    return {buffer.data(), end};
}

std::string to_text(const Value& value) {
    if (const auto* real = std::get_if<double>(&value)) return shortest(*real);
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
    return std::get<std::string>(value);
}

std::string identity_text(const Value& value) {
    const auto* word = std::get_if<std::string>(&value);
    const auto file = word == nullptr ? std::nullopt : file_word(*word);
    return file ? fmt::format("file:{}", file->hash) : to_text(value);
}

std::string canonical_text(std::string_view scene, int revision, const Inputs& inputs, const Inputs& defaults,
                           std::optional<std::uint64_t> seed) {
    std::string text = fmt::format("scene={}\nrevision={}\n", scene, revision);
    for (const auto& [name, value] : inputs) {
        const auto standard = defaults.find(name);
        if (standard != defaults.end() && standard->second == value) continue;
        text += fmt::format("{}={}\n", name, identity_text(value));
    }
    if (seed) text += fmt::format("seed={}\n", *seed);
    return text;
}

std::string content_hash(std::string_view text) {
    const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::uint64_t case_seed(std::uint64_t campaign_seed, std::string_view canonical_inputs, std::int64_t replicate) {
    const std::string text =
        fmt::format("campaign_seed={}\nreplicate={}\n{}", campaign_seed, replicate, canonical_inputs);
    return XXH3_64bits(text.data(), text.size()) >> 1U;
}

}  // namespace grainsweep::campaign

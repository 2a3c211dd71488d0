#include "sweep/campaign/case.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <utility>

namespace grainsweep::campaign {

namespace {
constexpr std::array<std::string_view, outcomes.size()> outcome_words = {
    "completed", "skipped", "unstable", "rejected", "crashed", "timed_out", "abandoned"};
constexpr std::size_t id_digits = 32;
}  // namespace

std::string_view to_string(Outcome outcome) {
    return outcome_words[static_cast<std::size_t>(outcome)];
}

std::optional<Outcome> outcome_named(std::string_view word) {
    const auto found = std::ranges::find(outcome_words, word);
    if (found == outcome_words.end()) return std::nullopt;
    return outcomes[static_cast<std::size_t>(found - outcome_words.begin())];
}

CaseResult unanswered(const Attempt& attempt, Outcome outcome, std::string reason, double seconds) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    CaseResult result;
    result.attempt = attempt;
    result.outcome = outcome;
    result.message = std::move(reason);
    result.cost.wall_seconds = seconds;
    result.cost.cpu_seconds = unknown;
    result.cost.particle_steps = unknown;
    return result;
}

std::optional<std::string> undeclared(const Observations& observations, std::span<const ObservableSpec> declared) {
    const auto is_declared = [&](const std::string& name, bool scalar) {
        const auto found = std::ranges::find(declared, name, &ObservableSpec::name);
        return found != declared.end() && (found->shape == Shape::scalar) == scalar;
    };
    for (const auto& [name, value] : observations.scalars)
        if (!is_declared(name, true)) return name;
    for (const auto& [name, samples] : observations.series)
        if (!is_declared(name, false)) return name;
    return std::nullopt;
}

std::string shortest(double x) {
    if (x == 0) return "0";
    std::array<char, 32> buffer{};
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), x);
    return {buffer.data(), end};
}

std::string identity_text(const Value& value) {
    const auto* word = std::get_if<std::string>(&value);
    const auto file = word == nullptr ? std::nullopt : file_word(*word);
    return file ? fmt::format("file:{}", file->hash) : to_text(value);
}

std::string begin_canonical(std::string_view scene, int revision) {
    return fmt::format("scene={}\nrevision={}\n", scene, revision);
}

void add_canonical(std::string& text, std::string_view name, const Value& value) {
    text.append(name) += '=';
    const auto* word = std::get_if<std::string>(&value);
    if (word != nullptr && !file_word(*word))
        text += *word;
    else
        text += identity_text(value);
    text += '\n';
}

void add_canonical_seed(std::string& text, std::uint64_t seed) {
    fmt::format_to(std::back_inserter(text), "seed={}\n", seed);
}

std::string canonical_text(std::string_view scene, int revision, const Inputs& inputs, const Inputs& defaults,
                           std::optional<std::uint64_t> seed) {
    std::string text = begin_canonical(scene, revision);
    for (const auto& [name, value] : inputs) {
        const auto standard = defaults.find(name);
        if (standard != defaults.end() && standard->second == value) continue;
        add_canonical(text, name, value);
    }
    if (seed) add_canonical_seed(text, *seed);
    return text;
}

CaseHash content_bits(std::string_view text) {
    const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
    return {hash.high64, hash.low64};
}

std::string content_hash(std::string_view text) {
    return id_of(content_bits(text));
}

CaseId id_of(const CaseHash& hash) {
    constexpr std::string_view digits = "0123456789abcdef";
    CaseId id(id_digits, '0');
    for (std::size_t k = 0; k < id_digits; ++k) {
        const std::uint64_t half = k < id_digits / 2 ? hash.high : hash.low;
        id[k] = digits[half >> (60 - 4 * (k % (id_digits / 2))) & 0xFU];
    }
    return id;
}

CaseHash hash_of(std::string_view id) {
    if (id.size() != id_digits) return content_bits(id);
    std::array<std::uint64_t, 2> halves{};
    for (std::size_t k = 0; k < id_digits; ++k) {
        const char c = id[k];
        const bool letter = c >= 'a' && c <= 'f';
        if (!letter && !(c >= '0' && c <= '9')) return content_bits(id);
        auto& half = halves[k / (id_digits / 2)];
        half = half << 4U | static_cast<std::uint64_t>(letter ? c - 'a' + 10 : c - '0');
    }
    return {halves[0], halves[1]};
}

std::uint64_t case_seed(std::uint64_t campaign_seed, std::string_view canonical_inputs, std::int64_t replicate) {
    const std::string text =
        fmt::format("campaign_seed={}\nreplicate={}\n{}", campaign_seed, replicate, canonical_inputs);
    return XXH3_64bits(text.data(), text.size()) >> 1U;
}

}  // namespace grainsweep::campaign

// The nouns that travel: a case, where it stands in a campaign, what became of it.
#pragma once

#include "solver/scenes/values.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// 32 hexadecimal digits: XXH3 128-bit of the canonical text. Same question, same id.
using CaseId = std::string;

/// One question to a scene. `inputs` is complete (every parameter of the scene).
struct Case {
    CaseId id;
    std::string scene;
    int revision = 1;
    Inputs inputs;
    std::uint64_t seed = 0;  ///< below 2^63, so that SQL shows it as it is

    bool operator==(const Case&) const = default;
};

/// A case as an answer to a design point of a campaign.
struct PlacedCase {
    Case question;
    std::int64_t point = 0;
    std::int64_t sequence = 0;
    std::int64_t replicate = 0;
};

/// A case id in 16 bytes.
struct CaseHash {
    std::uint64_t high = 0, low = 0;
    auto operator<=>(const CaseHash&) const = default;
};
/// Of a text that is no case id its hash, so that different texts differ.
[[nodiscard]] CaseHash hash_of(std::string_view id);
[[nodiscard]] CaseId id_of(const CaseHash& hash);

enum class Outcome : std::uint8_t { completed, skipped, unstable, rejected, crashed, timed_out, abandoned };

inline constexpr std::array outcomes = {Outcome::completed, Outcome::skipped,   Outcome::unstable, Outcome::rejected,
                                        Outcome::crashed,   Outcome::timed_out, Outcome::abandoned};

[[nodiscard]] std::string_view to_string(Outcome outcome);
[[nodiscard]] std::optional<Outcome> outcome_named(std::string_view word);

/// completed, skipped, unstable and rejected settle a case: asking again would give the same answer.
[[nodiscard]] constexpr bool settles(Outcome outcome) {
    return outcome == Outcome::completed || outcome == Outcome::skipped || outcome == Outcome::unstable ||
           outcome == Outcome::rejected;
}

/// One try at a case. Numbers start at 1 and only grow, also across restarts.
struct Attempt {
    CaseId case_id;
    std::int64_t number = 1;
    auto operator<=>(const Attempt&) const = default;
};

/// What computes an attempt, and where. Equal builds are equal machine code; with equal instruction paths they give
/// equal bits.
struct Computer {
    std::string version, commit;  ///< of the program; "-modified" marks sources with changes of their own
    std::string build;            ///< id of the executable, hexadecimal
    std::string instruction_path, processor, host;
    auto operator<=>(const Computer&) const = default;
};

/// What the operating system and a program say of an attempt that a program answered.
struct ProgramFacts {
    std::string version;                      ///< as the campaign asked for it; empty: it did not
    double peak_memory = 0;                   ///< bytes resident at once; NaN: not known
    std::optional<std::int64_t> exit_status;  ///< negative: the signal that ended it; none: it was still running
    bool operator==(const ProgramFacts&) const = default;
};

struct CaseResult {
    Attempt attempt;
    Outcome outcome = Outcome::completed;
    std::string message;  ///< why, where it is not completed
    Observations observations;
    Cost cost;
    std::optional<ProgramFacts> program = {};  ///< none: the scene is of the solver
};

/// Time of an attempt that brought no answer, as the main program measures it; its cost is unknown.
[[nodiscard]] CaseResult unanswered(const Attempt& attempt, Outcome outcome, std::string reason, double seconds);
/// An observable that is not among those declared, or has another shape there.
[[nodiscard]] std::optional<std::string> undeclared(const Observations& observations,
                                                    std::span<const ObservableSpec> declared);

/// scene, revision, every input that differs from its default, seed: name=value, sorted, doubles in
/// shortest round-trip form, -0 as 0, a file by the hash of its contents.  `defaults` are the scene's.
[[nodiscard]] std::string canonical_text(std::string_view scene, int revision, const Inputs& inputs,
                                         const Inputs& defaults, std::optional<std::uint64_t> seed);
/// Its parts, for a text that is put together: the beginning, one input, the end.
[[nodiscard]] std::string begin_canonical(std::string_view scene, int revision);
void add_canonical(std::string& text, std::string_view name, const Value& value);
void add_canonical_seed(std::string& text, std::uint64_t seed);
/// XXH3 128-bit of the text.
[[nodiscard]] CaseHash content_bits(std::string_view text);
/// The same as 32 hexadecimal digits.
[[nodiscard]] std::string content_hash(std::string_view text);
/// Hash of (campaign seed, canonical inputs without seed, replicate), below 2^63.
[[nodiscard]] std::uint64_t case_seed(std::uint64_t campaign_seed, std::string_view canonical_inputs,
                                      std::int64_t replicate);
/// A number as the canonical text shows it.
[[nodiscard]] std::string shortest(double x);
/// A value in text, words unquoted.
[[nodiscard]] std::string to_text(const Value& value);
/// A value as the canonical text shows it: to_text, but a file without its path.
[[nodiscard]] std::string identity_text(const Value& value);

}  // namespace grainsweep::campaign

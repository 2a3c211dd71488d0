// Types used everywhere: a case, its place in a campaign, and its result.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/designs/factor.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// Id of a case: 32 hexadecimal digits, XXH3 128-bit of the canonical text. Equal cases have equal ids.
using CaseId = std::string;

/// Case: inputs and seed of a scene. `inputs` is complete (every parameter of the scene).
struct Case {
    CaseId id;
    std::string scene;
    int revision = 1;
    Inputs inputs;
    std::uint64_t seed = 0;  ///< below 2^63, so that SQL shows it unchanged

    bool operator==(const Case&) const = default;
};

/// Case at a place of a campaign's design.
struct PlacedCase {
    Case question;
    std::int64_t point = 0;
    std::int64_t sequence = 0;
    std::int64_t replicate = 0;
};

/// Case id in 16 bytes.
struct CaseHash {
    std::uint64_t high = 0, low = 0;
    auto operator<=>(const CaseHash&) const = default;
};
/// Returns the bytes of a case id; for any other text its hash, so that different texts differ.
[[nodiscard]] CaseHash hash_of(std::string_view id);
[[nodiscard]] CaseId id_of(const CaseHash& hash);

enum class Outcome : std::uint8_t { completed, skipped, unstable, rejected, crashed, timed_out, abandoned };

inline constexpr std::array outcomes = {Outcome::completed, Outcome::skipped,   Outcome::unstable, Outcome::rejected,
                                        Outcome::crashed,   Outcome::timed_out, Outcome::abandoned};

[[nodiscard]] std::string_view to_string(Outcome outcome);
[[nodiscard]] std::optional<Outcome> outcome_named(std::string_view word);

/// Returns whether an outcome settles a case: completed, skipped, unstable and rejected would repeat in another run.
[[nodiscard]] constexpr bool settles(Outcome outcome) {
    return outcome == Outcome::completed || outcome == Outcome::skipped || outcome == Outcome::unstable ||
           outcome == Outcome::rejected;
}

/// Attempt at a case. Numbers start at 1 and increase, also in later runs.
struct Attempt {
    CaseId case_id;
    std::int64_t number = 1;
    auto operator<=>(const Attempt&) const = default;
};

/// Program and machine of an attempt. Equal builds have equal machine code; with equal instruction paths they give
/// equal bits.
struct Computer {
    std::string version, commit;  ///< of the program; "-modified" marks modified sources
    std::string build;            ///< id of the executable, hexadecimal
    std::string instruction_path, processor, host;
    auto operator<=>(const Computer&) const = default;
};

/// Facts about an attempt of a program, from the operating system and the program.
struct ProgramFacts {
    std::string version;                      ///< output of the campaign's version command; empty: none
    double peak_memory = 0;                   ///< largest resident memory, bytes; NaN: unknown
    std::optional<std::int64_t> exit_status;  ///< negative: the signal that ended it; empty: it was still running
    bool operator==(const ProgramFacts&) const = default;
};

/// Origin of a result that was computed elsewhere (`grainsweep import`).
struct ImportedLine {
    std::string file;       ///< name, without its folder
    std::string hash;       ///< of the file's contents
    std::int64_t line = 0;  ///< in the file; its header is line 1
    bool operator==(const ImportedLine&) const = default;
};

struct CaseResult {
    Attempt attempt;
    Outcome outcome = Outcome::completed;
    std::string message;  ///< reason, if it is not completed
    Observations observations;
    Cost cost;
    std::optional<ProgramFacts> program = {};   ///< empty: the scene is of the solver
    std::optional<ImportedLine> imported = {};  ///< empty: computed by a run
};

/// Returns the result of an attempt without an answer. `seconds`: measured by the main program; the cost is unknown.
[[nodiscard]] CaseResult unanswered(const Attempt& attempt, Outcome outcome, std::string reason, double seconds);
/// Returns the name of an observable that is not declared, or declared with another shape.
[[nodiscard]] std::optional<std::string> undeclared(const Observations& observations,
                                                    std::span<const ObservableSpec> declared);

/// Returns the canonical text: scene, revision, every input that differs from its default, seed; as name=value, sorted,
/// doubles in shortest round-trip form, -0 as 0, a file by the hash of its contents. `defaults`: of the scene.
[[nodiscard]] std::string canonical_text(std::string_view scene, int revision, const Inputs& inputs,
                                         const Inputs& defaults, std::optional<std::uint64_t> seed);
/// Return parts of the canonical text: the beginning, one input, the end.
[[nodiscard]] std::string begin_canonical(std::string_view scene, int revision);
void add_canonical(std::string& text, std::string_view name, const Value& value);
void add_canonical_seed(std::string& text, std::uint64_t seed);
/// Returns XXH3 128-bit of the text.
[[nodiscard]] CaseHash content_bits(std::string_view text);
/// Returns the same as 32 hexadecimal digits.
[[nodiscard]] std::string content_hash(std::string_view text);
/// Returns the hash of (campaign seed, canonical inputs without seed, replicate), below 2^63.
[[nodiscard]] std::uint64_t case_seed(std::uint64_t campaign_seed, std::string_view canonical_inputs,
                                      std::int64_t replicate);
/// Returns a number as in the canonical text.
[[nodiscard]] std::string shortest(double x);
using designs::to_text;
/// Returns a value as in the canonical text: to_text(), but a file without its path.
[[nodiscard]] std::string identity_text(const Value& value);

}  // namespace grainsweep::campaign

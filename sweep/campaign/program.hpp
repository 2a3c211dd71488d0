// Program as a scene: the section "program" of a campaign file, and the scene for plans, databases and reports. Its
// name is "program:" and a hash of everything that changes an answer: command, contents of files and templates, names
// of parameters, observables, protocol, environment and version. The hash does not include units, meanings, cores,
// processes, accuracy settings, limits, kept files, and the places of files.
#pragma once

#include "solver/scenes/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::campaign {

/// Word in a campaign file, and prefix of the names of all such scenes.
inline constexpr std::string_view program_word = "program";
inline constexpr std::string_view program_prefix = "program:";
[[nodiscard]] inline bool is_program(std::string_view scene) {
    return scene.starts_with(program_prefix);
}

/// File in the folder of every case.
struct ProgramFile {
    std::string name;          ///< path in the folder, "mesh/drum.stl"
    std::string hash;          ///< content_hash of its contents
    bool is_template = false;  ///< {{ name }} is replaced
    bool executable = false;
    bool counts = true;               ///< its contents are part of the cases' identity
    std::string contents = {};        ///< if they are in memory
    std::filesystem::path path = {};  ///< otherwise the file with them; empty: none
};

/// Source: number or list at a JSON pointer (RFC 6901); `over`: pointer to the list of places; empty: none.
struct FromJson {
    std::string file, path, over;
};
/// Source: one row of a column, or all rows against another column.
struct FromCsv {
    std::string file, column;
    std::int64_t row = -1;  ///< from 0; negative: from the end; -1 is the last
    std::string over;       ///< empty: one row
    std::string separator = "comma";
};
/// Source: first group of a regular expression (ECMAScript) in the last matching line of standard output.
struct FromOutput {
    std::string pattern;
};
/// Source: value by its name in the reply of a program that stays alive.
struct FromReply {};

struct ProgramObservable {
    std::string name, unit, meaning;
    Shape shape = Shape::scalar;
    bool optional = false;  ///< a completed case may have no value
    Interval bounds;        ///< of every value
    std::variant<FromReply, FromJson, FromCsv, FromOutput> from;
};

struct ProgramParameter {
    std::string name, unit, meaning;
    std::variant<Interval, Words> bounds;
    bool whole = false;
    std::optional<Value> standard = {};  ///< value where the `when` of its factor is false; empty: 0, or no word
    [[nodiscard]] bool is_word() const { return bounds.index() == 1; }
};

/// Accuracy setting: values of the parameters that decide error and cost.
struct ProgramSetting {
    std::string name;
    Inputs inputs;
    std::optional<double> cost_seconds;  ///< of a case on one core; empty: as the program's
};

struct Program {
    enum class Protocol { files, lines };
    enum class Keep { failed, all, none };

    std::vector<std::string> command;
    std::vector<ProgramFile> files;  ///< sorted by name
    std::vector<ProgramParameter> parameters;
    std::vector<ProgramObservable> observables;
    std::vector<std::string> version_command;  ///< empty: none
    std::string version_match;
    std::string version;  ///< output of the version command
    Protocol protocol = Protocol::files;
    std::map<std::string, std::string> environment;

    std::int64_t cores = 1;              ///< of a process; {threads}
    std::int64_t processes = 1;          ///< that the command starts, such as those of MPI; {processes}
    std::optional<std::int64_t> memory;  ///< bytes of address space
    std::int64_t disk = 1'000'000'000;   ///< most bytes that a case may write into its folder
    Keep keep = Keep::failed;
    double cost_seconds = 1;
    double tolerance = 0;  ///< relative, for a repeated case
    /// Settings that a campaign may choose, `reference` among them; from the campaign file, no part of the definition.
    std::vector<ProgramSetting> accuracy = {};

    /// Returns the cores that a case uses.
    [[nodiscard]] std::int64_t cores_of_a_case() const { return processes * cores; }
};

/// Returns why a file of this name, from a campaign file or an untrusted database, would not lie in the folder of its
/// case; empty: it would.
[[nodiscard]] std::string_view flaw_of_file_name(std::string_view name);
/// Returns "program:" and 32 hexadecimal digits.
[[nodiscard]] std::string program_scene_name(const Program& program);
/// Convert a program, without the contents of its files, to JSON and back. Throws std::invalid_argument for another
/// text.
[[nodiscard]] std::string program_text(const Program& program);
[[nodiscard]] Program program_in(std::string_view text);
/// Returns the part of an observable that changes an answer, as JSON.
[[nodiscard]] std::string observable_text(const ProgramObservable& observable);
/// Returns a value as text for commands, templates and environment: a whole number below 1e15 without exponent; with a
/// `format` ("%.3e"; placeholders.hpp) in this format.
[[nodiscard]] std::string program_value(const Value& value, std::string_view format = {});
/// Returns a prime of 31 bits above 10 000, for programs that demand one as a seed.
[[nodiscard]] std::uint64_t prime_of(std::uint64_t seed);
/// Returns {"case", "seed", "threads", "inputs"} as one line of JSON without its line end.
[[nodiscard]] std::string program_question(std::string_view case_id, std::uint64_t seed, std::int64_t threads,
                                           const Inputs& inputs);

/// Registers the program's scene in this process; the same program gives the same scene again.
SharedScene enter_program(std::shared_ptr<const Program> program);
/// Returns the registered program of a scene; nullptr if there is none.
[[nodiscard]] std::shared_ptr<const Program> known_program(std::string_view scene);
/// Returns why a completed case of a scene can lack a value of a scalar; empty: unknown.
[[nodiscard]] std::string why_absent(std::string_view scene, std::string_view observable);
/// Returns the words that "scene" of a campaign file may have.
[[nodiscard]] std::vector<std::string> scene_words();
/// Returns a description of "program" in one line.
[[nodiscard]] std::string_view program_summary();

}  // namespace grainsweep::campaign

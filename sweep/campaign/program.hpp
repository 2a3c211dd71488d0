// A program as a scene: what the section "program" of a campaign file says, as text and as the scene that plans,
// archives and reports see. Its name is "program:" and the hash of what changes an answer: command, contents of files
// and templates, names of parameters, observables, protocol, environment and version. Units, meanings, cores, limits
// and what is kept of a case are no part of it, nor where the files lie.
#pragma once

#include "solver/scenes/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::campaign {

/// The word of a campaign file, and how the names of all such scenes begin.
inline constexpr std::string_view program_word = "program";
inline constexpr std::string_view program_prefix = "program:";
[[nodiscard]] inline bool is_program(std::string_view scene) {
    return scene.starts_with(program_prefix);
}

/// A file that lies in the folder of every case.
struct ProgramFile {
    std::string name;          ///< within the folder, "mesh/drum.stl"
    std::string hash;          ///< content_hash of its contents
    bool is_template = false;  ///< {{ name }} in it is replaced
    bool executable = false;
    std::string contents;        ///< as far as they are in memory
    std::filesystem::path path;  ///< else where they lie; empty: nowhere
};

/// A number or list at a JSON pointer (RFC 6901); `over`: that of the list of places, empty: none.
struct FromJson {
    std::string file, path, over;
};
/// Of a column one row, or all of them over another column.
struct FromCsv {
    std::string file, column;
    std::int64_t row = -1;  ///< from 0; negative: from the end, -1 is the last
    std::string over;       ///< empty: one row
    std::string separator = "comma";
};
/// The first group of a regular expression (ECMAScript) in the last line of standard output that has it.
struct FromOutput {
    std::string pattern;
};
/// By its name from the reply of a program that stays alive.
struct FromReply {};

struct ProgramObservable {
    std::string name, unit, meaning;
    Shape shape = Shape::scalar;
    Interval bounds;  ///< of every value
    std::variant<FromReply, FromJson, FromCsv, FromOutput> from;
};

struct ProgramParameter {
    std::string name, unit, meaning;
    std::variant<Interval, Words> bounds;
    [[nodiscard]] bool is_word() const { return bounds.index() == 1; }
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
    std::string version;  ///< what it said
    Protocol protocol = Protocol::files;
    std::map<std::string, std::string> environment;

    std::int64_t cores = 1;
    std::optional<std::int64_t> memory;  ///< bytes of address space
    std::int64_t disk = 1'000'000'000;   ///< bytes that a case may write into its folder
    Keep keep = Keep::failed;
    double cost_seconds = 1;
    double tolerance = 0;  ///< relative, of a repeated case
};

/// "program:" and 32 hexadecimal digits.
[[nodiscard]] std::string program_scene_name(const Program& program);
/// All of it but the contents of its files, as JSON; and back. Throws std::invalid_argument for another text.
[[nodiscard]] std::string program_text(const Program& program);
[[nodiscard]] Program program_in(std::string_view text);
/// A value as commands, templates and environment show it: a whole number below 1e15 without exponent.
[[nodiscard]] std::string program_value(const Value& value);
/// {"case", "seed", "threads", "inputs"} as one line of JSON without its end.
[[nodiscard]] std::string program_question(std::string_view case_id, std::uint64_t seed, std::int64_t threads,
                                           const Inputs& inputs);

/// Makes the program's scene known to this process, for its lifetime: the same program again gives the same scene.
const SceneInfo& enter_program(std::shared_ptr<const Program> program);
/// nullptr where no such program was entered.
[[nodiscard]] std::shared_ptr<const Program> known_program(std::string_view scene);
/// Why a completed case of a scene can be without a value of a scalar; empty: not known.
[[nodiscard]] std::string why_absent(std::string_view scene, std::string_view observable);
/// The words that "scene" of a campaign file may be.
[[nodiscard]] std::vector<std::string> scene_words();
/// What "program" is, in one line.
[[nodiscard]] std::string_view program_summary();

}  // namespace grainsweep::campaign

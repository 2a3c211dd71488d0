// Plain values that campaigns and scenes exchange.
//
// A scene declares its parameters (ParameterSpec) and its observables (ObservableSpec). A case is a map from parameter
// names to values (Inputs). All values are in SI units unless a unit is named.
#pragma once

#include "solver/field.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep {

/// Value of a parameter: a real number, a count, or a word.
using Value = std::variant<double, std::int64_t, std::string>;

/// Inputs of a case: parameter name -> value, sorted by name, SI.
using Inputs = std::map<std::string, Value, std::less<>>;

/// Allowed words of a parameter. With `file_allowed`, any other word is the name of a file beside the campaign file;
/// its contents (not its name) are part of the question.
struct Words {
    std::vector<std::string> allowed;
    bool file_allowed = false;
    /// Check of a file's contents, which throws std::invalid_argument with a sentence if they are invalid; may be
    /// empty.
    std::function<void(std::string_view contents)> check_file = {};
};

/// File as the value of a parameter, in the form "file:<hash of its contents>:<absolute path>". Only the hash
/// identifies it: the same contents in another place are the same question.
struct FileWord {
    std::string_view hash;  ///< 32 hexadecimal digits
    std::string_view path;
};

/// Returns the parts of a word that is a file; empty for any other word.
[[nodiscard]] inline std::optional<FileWord> file_word(std::string_view word) {
    constexpr std::string_view prefix = "file:";
    constexpr std::size_t digits = 32;
    if (!word.starts_with(prefix) || word.size() <= prefix.size() + digits) return std::nullopt;
    if (word[prefix.size() + digits] != ':') return std::nullopt;
    return FileWord{word.substr(prefix.size(), digits), word.substr(prefix.size() + digits + 1)};
}

/// Contents of the files that inputs name: parameter name -> contents. The caller of a scene reads the files; the scene
/// opens none.
using Files = std::map<std::string, std::string, std::less<>>;

/// Condition under which a parameter has an effect: `other` can be zero, non-zero, one of `words`, or a file. A
/// campaign is refused if it sets a parameter that has no effect in any of its cases.
struct Relevance {
    enum class Condition { zero, nonzero, is_word, is_file };
    std::string other;
    Condition condition = Condition::nonzero;
    std::vector<std::string> words;
};

/// Input of a scene. The type of `default_value` is the type of the parameter.
struct ParameterSpec {
    std::string name;
    std::string unit;  ///< "1" for a pure number, "" for a word
    std::string meaning;
    Value default_value;
    std::variant<Interval, Words> bounds;
    std::vector<Relevance> relevant_if;  ///< all must hold
};

enum class Shape { scalar, series, profile };

/// Observable of a scene. A series has a time per value; a profile has a bin coordinate per value, and a time if it is
/// measured more than once.
struct ObservableSpec {
    std::string name;
    std::string unit;
    std::string meaning;
    Shape shape = Shape::scalar;
    std::string over = {};    ///< coordinate with unit: of a series the time, of a profile the bin
    std::string absent = {};  ///< of a scalar: why a completed case can lack a value; empty: never
};

/// Entry of a series or profile; unused members are NaN.
struct Sample {
    double time = std::numeric_limits<double>::quiet_NaN();
    double bin = std::numeric_limits<double>::quiet_NaN();
    double value = std::numeric_limits<double>::quiet_NaN();
};

/// Answer of a case. A scalar that is undefined for the case is absent or NaN.
struct Observations {
    std::map<std::string, double, std::less<>> scalars;
    std::map<std::string, std::vector<Sample>, std::less<>> series;  ///< series and profiles
};

/// Wall in a picture, at its place at that moment: triangles, lines, or both.
struct WallSurface {
    std::string name;                                    ///< letters, digits and underscores; unique in the picture
    std::vector<std::array<double, 3>> corners;          ///< in the picture's unit of length
    std::vector<std::array<std::int32_t, 3>> triangles;  ///< of corners
    std::vector<std::array<std::int32_t, 2>> edges;      ///< lines between corners
};

/// Contacts in a picture, as lines from the centre of a first particle: to the centre of a second one, through the
/// nearest periodic image, or to the place of the contact on a wall.
struct ContactLines {
    std::vector<std::array<std::array<double, 3>, 2>> ends;  ///< in the picture's unit of length
    std::map<std::string, std::vector<double>, std::less<>> scalars;
    std::map<std::string, std::vector<std::array<double, 3>>, std::less<>> vectors;
    std::map<std::string, std::string, std::less<>> units;  ///< of columns; absent: a pure number
    std::vector<std::string> walls;                         ///< names of the walls that the column "wall" numbers
};

/// Quantities of a fluid in the cells of a rectilinear grid, x fastest.
struct FlowField {
    std::string name;                          ///< as for a wall
    std::array<std::vector<double>, 3> faces;  ///< faces of the cells of each axis, including both ends; ascending
    std::map<std::string, std::vector<double>, std::less<>> scalars;
    std::map<std::string, std::vector<std::array<double, 3>>, std::less<>> vectors;

    [[nodiscard]] std::size_t cells() const {
        std::size_t product = 1;
        for (const auto& axis : faces) product *= axis.empty() ? 0 : axis.size() - 1;
        return product;
    }
};

/// Picture of a scene at a moment: named columns of its particles, and their surroundings.
struct Snapshot {
    std::vector<std::array<double, 3>> positions;  ///< one per particle
    std::map<std::string, std::vector<double>, std::less<>> scalars;
    std::map<std::string, std::vector<std::array<double, 3>>, std::less<>> vectors;
    std::vector<WallSurface> walls;
    std::vector<FlowField> fields;
    std::optional<ContactLines> contacts;                   ///< empty: the scene has none; none at the moment: no lines
    std::map<std::string, std::string, std::less<>> units;  ///< of columns and quantities; absent: a pure number
    std::string length_unit = "m", time_unit = "s";
    std::array<double, 3> periods{};  ///< periods along the axes; 0: not periodic
};

/// Computing time of a case. It is no part of the answer and is never compared.
struct Cost {
    double wall_seconds = 0;
    double cpu_seconds = 0;
    double particle_steps = 0;
    std::map<std::string, double, std::less<>> phases;  ///< seconds by phase name
    /// Mean number of threads during the computation; NaN: not computed, or computed by another program.
    double threads = std::numeric_limits<double>::quiet_NaN();
};

/// Warning about a questionable combination of inputs, each within its bounds: the case can be computed, but its answer
/// has little meaning.
struct Warning {
    std::string kind;      ///< same for all cases with the same problem: "gap above the layer"
    std::string sentence;  ///< with this case's numbers
};

/// Answer known without simulation, with the proof in words.
struct ProvenAnswer {
    std::string reason;
    Observations observations;
};

}  // namespace grainsweep

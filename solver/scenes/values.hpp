// Plain values that campaigns and scenes exchange; standard library only.
//
// A scene declares what it takes (ParameterSpec) and what it measures (ObservableSpec); a case is a map
// from parameter names to values (Inputs). Everything is in SI units unless a unit is named.
#pragma once

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

/// A parameter's value: a real number, a count, or a word.
using Value = std::variant<double, std::int64_t, std::string>;

/// Inputs of a case: parameter name -> value, sorted by name, SI.
using Inputs = std::map<std::string, Value, std::less<>>;

/// Allowed numbers: low <= x <= high, an end excluded where it is open.
struct Interval {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_open = false;
    bool high_open = false;

    [[nodiscard]] bool contains(double x) const {
        return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
    }
};

/// Allowed words of a parameter whose values are words. With `file_allowed`, any other word names a file
/// beside the campaign file, and its contents (not its name) are part of the question.
struct Words {
    std::vector<std::string> allowed;
    bool file_allowed = false;
    /// Throws std::invalid_argument with a sentence where the contents of a file are none of this kind; may be empty.
    std::function<void(std::string_view contents)> check_file = {};
};

/// A file given where a word may name one travels as the value "file:<hash of its contents>:<absolute path>".
/// Only the hash is identity: the same contents elsewhere are the same question.
struct FileWord {
    std::string_view hash;  ///< 32 hexadecimal digits
    std::string_view path;
};

/// The parts of a word that is a file; none for any other word.
[[nodiscard]] inline std::optional<FileWord> file_word(std::string_view word) {
    constexpr std::string_view prefix = "file:";
    constexpr std::size_t digits = 32;
    if (!word.starts_with(prefix) || word.size() <= prefix.size() + digits) return std::nullopt;
    if (word[prefix.size() + digits] != ':') return std::nullopt;
    return FileWord{word.substr(prefix.size(), digits), word.substr(prefix.size() + digits + 1)};
}

/// What stands in the files that inputs name: parameter name -> contents. A scene opens no file; its caller
/// reads them.
using Files = std::map<std::string, std::string, std::less<>>;

/// When a parameter matters: only if `other` can be (is_zero / non-zero / one of `words` / a file).
/// A campaign that gives a parameter without effect on any of its cases is refused.
struct Relevance {
    enum class Condition { zero, nonzero, is_word, is_file };
    std::string other;
    Condition condition = Condition::nonzero;
    std::vector<std::string> words;
};

/// One input of a scene. The type of `default_value` is the type of the parameter.
struct ParameterSpec {
    std::string name;
    std::string unit;  ///< "1" for a pure number, "" for a word
    std::string meaning;
    Value default_value;
    std::variant<Interval, Words> bounds;
    std::vector<Relevance> relevant_if;  ///< all must hold
};

enum class Shape { scalar, series, profile };

/// One thing a scene measures. A series has a time per value, a profile a bin coordinate per value
/// (and a time where it is measured more than once).
struct ObservableSpec {
    std::string name;
    std::string unit;
    std::string meaning;
    Shape shape = Shape::scalar;
    std::string over = {};    ///< what it runs along, with its unit: of a series the time, of a profile the bin
    std::string absent = {};  ///< of a scalar: why a completed case can be without a value; empty: none is
};

/// One entry of a series or profile; what does not apply is NaN.
struct Sample {
    double time = std::numeric_limits<double>::quiet_NaN();
    double bin = std::numeric_limits<double>::quiet_NaN();
    double value = std::numeric_limits<double>::quiet_NaN();
};

/// What a case answered. A scalar that is undefined for the case is absent or NaN, never invented.
struct Observations {
    std::map<std::string, double, std::less<>> scalars;
    std::map<std::string, std::vector<Sample>, std::less<>> series;  ///< series and profiles
};

/// A wall in a picture, where it stands at that moment: triangles, lines, or both.
struct WallSurface {
    std::string name;                                    ///< letters, digits and underscores, its own in the picture
    std::vector<std::array<double, 3>> corners;          ///< in the picture's unit of length
    std::vector<std::array<std::int32_t, 3>> triangles;  ///< of corners
    std::vector<std::array<std::int32_t, 2>> edges;      ///< lines between corners
};

/// Quantities of a fluid in the cells of a rectilinear grid, x fastest.
struct FlowField {
    std::string name;                          ///< as of a wall
    std::array<std::vector<double>, 3> faces;  ///< between the cells of each axis, both ends among them; ascending
    std::map<std::string, std::vector<double>, std::less<>> scalars;
    std::map<std::string, std::vector<std::array<double, 3>>, std::less<>> vectors;

    [[nodiscard]] std::size_t cells() const {
        std::size_t product = 1;
        for (const auto& axis : faces) product *= axis.empty() ? 0 : axis.size() - 1;
        return product;
    }
};

/// What a scene shows at a moment: named columns of its particles, and what surrounds them.
struct Snapshot {
    std::vector<std::array<double, 3>> positions;  ///< one per particle
    std::map<std::string, std::vector<double>, std::less<>> scalars;
    std::map<std::string, std::vector<std::array<double, 3>>, std::less<>> vectors;
    std::vector<WallSurface> walls;
    std::vector<FlowField> fields;
    std::map<std::string, std::string, std::less<>> units;  ///< of columns and quantities; absent: a pure number
    std::string length_unit = "m", time_unit = "s";
    std::array<double, 3> periods{};  ///< lengths after which the picture repeats itself along an axis; 0: never
};

/// Where the time went. Not part of the answer, never compared.
struct Cost {
    double wall_seconds = 0;
    double cpu_seconds = 0;
    double particle_steps = 0;
    std::map<std::string, double, std::less<>> phases;  ///< seconds by phase name
    /// That computed it, a mean over the time it was advanced; NaN: it was not, or by none of ours.
    double threads = std::numeric_limits<double>::quiet_NaN();
};

/// Inputs that make nonsense of one another although each is within its bounds: the case can be computed, and its
/// answer says little.
struct Warning {
    std::string kind;      ///< one for all cases with the same trouble: "gap above the layer"
    std::string sentence;  ///< with this case's numbers
};

/// An answer known without simulation, with the proof in words.
struct ProvenAnswer {
    std::string reason;
    Observations observations;
};

}  // namespace grainsweep

// A design: the points of the unit cube [0, 1]^d (or the listed rows) of a campaign.
//
// Point numbers are for ever: sample(request with more points) begins with the same points whenever
// `extends` is true, so a campaign grows without renumbering.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/designs/curve_place.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::designs {

/// A table of physical values, one row a point, one column a factor.
using Rows = std::vector<std::vector<Value>>;

using OptionValue = std::variant<std::int64_t, std::string, std::vector<std::int64_t>, Rows, double>;

/// What a design takes beside its kind: the campaign reader checks against this, `grainsweep designs`
/// and the JSON schema print it.
struct OptionSpec {
    /// counts: one whole number, or one per factor; number: a real one; factor: the name of one that varies between two
    /// values; observable: name of a scalar of the scene.
    enum class Kind { count, word, counts, rows, number, factor, observable };
    std::string name;
    std::string meaning;
    Kind kind = Kind::count;
    std::optional<OptionValue> default_value = {};  ///< none: required
    std::int64_t minimum = 1;                       ///< of a count
    std::int64_t maximum = 1'000'000'000'000;
    std::vector<std::string_view> words = {};  ///< of a word
    /// Says how much of the design is asked, not which design it is: the same campaign may ask for more of it where
    /// the design extends.
    bool extent = false;
    Interval bounds = {};  ///< of a number
};

/// What a design may know of a factor.
struct FactorRange {
    std::string name;
    /// The value at u in [0, 1] of a continuous factor; empty where it has levels.
    std::function<double(double u)> value_at;
    /// It follows a distribution without ends: no point may have the coordinate 0 or 1.
    bool endless = false;

    /// What figures of the factor go over: all of it, or the central 99.8 % of what has no ends; logarithmically where
    /// its middle is the geometric mean of the ends.
    struct Shown {
        double low = 0, high = 0;
        bool log = false;
    };
    [[nodiscard]] Shown shown() const;
};

struct PointSet;

struct DesignRequest {
    std::vector<std::size_t> levels;  ///< per factor: number of its levels, 0 where it is continuous
    std::map<std::string, OptionValue, std::less<>> options;  ///< complete: defaults filled in
    std::uint64_t seed = 1;                                   ///< the campaign's
    std::vector<std::size_t> groups = {};   ///< number of each factor's group, from 0; empty: each its own
    std::vector<FactorRange> factors = {};  ///< names, and values for designs that grow
    /// Factors that several experiments calibrate together; empty: those that vary between two values.
    std::vector<FactorRange> shared = {};
    /// What is known of the points asked so far, by observable and number: none where a point is not settled, NaN where
    /// it is without an answer. Looked at by designs that grow only.
    std::map<std::string, std::vector<std::optional<double>>, std::less<>> answers = {};
    /// The points that follow from the answers, where they are known already: not formed again.
    std::shared_ptr<const PointSet> grown = {};

    [[nodiscard]] std::size_t dimensions() const { return levels.size(); }
    /// Groups of factors that move together.
    [[nodiscard]] std::size_t group_count() const;
    /// Group of factor j.
    [[nodiscard]] std::size_t group(std::size_t j) const { return groups.empty() ? j : groups[j]; }
    [[nodiscard]] std::int64_t count(std::string_view option) const;
    [[nodiscard]] double number(std::string_view option) const;
    [[nodiscard]] const std::string& word(std::string_view option) const;
};

/// Points in order of their number. Either coordinates in the unit cube (row-major, points x dimensions) or listed
/// physical rows. Point p belongs to sequence p mod sequences. The campaign states its replicates, unless the columns
/// `part` and `repeat` do.
struct PointSet {
    std::size_t dimensions = 0;
    std::size_t sequences = 1;
    std::vector<double> coordinates;
    Rows rows = {};
    std::vector<std::uint32_t> part = {};    ///< what takes the place of a point's sequence
    std::vector<std::uint32_t> repeat = {};  ///< the one replicate of each point
    /// Of a design that grows: why it ends without the result it looks for; empty: it goes on, or has it.
    std::string without_result = {};

    [[nodiscard]] std::size_t size() const {
        return rows.empty() ? (dimensions == 0 ? 0 : coordinates.size() / dimensions) : rows.size();
    }
    [[nodiscard]] std::span<const double> point(std::size_t p) const {
        return std::span(coordinates).subspan(p * dimensions, dimensions);
    }
};

/// What the first points of a design are, up to any one.
enum class Beginning {
    sample,  ///< a sample of the ranges: statistics settle along the design and can be judged
    listed,  ///< what the user put first: judged where the campaign gives a rule, without errors
    corner,  ///< a part that says nothing of the whole: only the whole design is a sample
};

/// What a design is made for, and how the influence of its factors is found.
enum class Purpose { statistics, saltelli, morris };

/// What others must know of a kind of design; nothing else compares names.
struct DesignInfo {
    std::string name;
    std::string summary;  ///< what it is good for, and what it is not, with figures
    std::vector<OptionSpec> options;
    bool extends = false;  ///< more of it begins with the same points
    /// The sequences of its points, where there are several, are independent repetitions of each other: the
    /// convergence rule 'replicates' may compare them. (Elsewhere a sequence names a point's part in a block.)
    bool independent_sequences = false;
    bool independent_points = false;  ///< each is drawn without regard to the others
    /// The points that come next depend on the answers to those before (request.answers): sample() gives all that
    /// follow from what is known.
    bool grows = false;
    bool calibrates = false;  ///< looks for the settings that agree with what was measured, its option "targets"
    bool brackets = false;    ///< looks for where an answer passes a threshold, its option "threshold"
    /// The observables whose answers these are, or places along their curves (curve_place.hpp).
    std::function<std::vector<std::string>(const DesignRequest&)> rests_on = {};
    Beginning beginning = Beginning::sample;
    Purpose purpose = Purpose::statistics;
    /// How many points the request numbers, without forming them: the size of sample(request). Throws as that does.
    std::function<std::int64_t(const DesignRequest&)> size;
    /// Number of points that belong together, one after the other, with this number of groups of factors; 1 where each
    /// stands by itself.
    std::function<std::size_t(std::size_t groups)> block = [](std::size_t) { return std::size_t{1}; };
    /// Throws std::invalid_argument with one sentence where options are impossible together.
    std::function<PointSet(const DesignRequest&)> sample;
};

/// Those that a campaign may name under "design".
[[nodiscard]] std::span<const DesignInfo> design_catalogue();
/// One of these, or a design that follows from another section of the campaign file.
[[nodiscard]] const DesignInfo* find_design(std::string_view name);
/// The same for a name that is known to exist. Throws std::logic_error for any other.
[[nodiscard]] const DesignInfo& design_named(std::string_view name);
/// Sequences of the request's design that repeat one another independently, 1 where none do.
[[nodiscard]] std::int64_t independent_sequences(std::string_view design, const DesignRequest& request);

}  // namespace grainsweep::designs

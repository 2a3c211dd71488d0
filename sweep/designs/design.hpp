// Design: the points of the unit cube [0, 1]^d, or the listed rows, of a campaign.
//
// Point numbers are permanent: if `extends` is true, sample(request with more points) begins with the same points, so a
// campaign can be extended without renumbering.
#pragma once

#include "solver/field.hpp"
#include "solver/scenes/values.hpp"
#include "sweep/designs/curve_place.hpp"
#include "sweep/designs/factor.hpp"

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

/// Table of physical values, one row per point, one column per factor.
using Rows = std::vector<std::vector<Value>>;

using OptionValue = std::variant<std::int64_t, std::string, std::vector<std::int64_t>, Rows, double>;

/// Option of a design: its key in the campaign file. The kind `value` stands for one whole number or one per factor, an
/// array for rows of values.
struct OptionSpec : Field {
    /// Names that a text must be: of factors with a range, or of scalars of the scene.
    enum class Names { any, factors, observables };
    /// Whether the option is the extent of the design, not a part of its identity; a campaign may increase it if the
    /// design is extensible.
    bool extent = false;
    Names names = Names::any;
    /// The identity of a campaign states the option only where it differs from its default: campaigns that are older
    /// than the option stay the same.
    bool silent_by_default = false;

    /// Returns the default; empty: the option is required, or the user may give a file instead.
    [[nodiscard]] std::optional<OptionValue> default_value() const;
};

struct PointSet;

/// Answers that belong to no point of the design, because they were computed elsewhere.
struct FurtherAnswers {
    std::vector<Factor> factors;                                      ///< of the campaign that they were imported into
    std::vector<double> coordinates;                                  ///< in the unit cube, points x factors
    std::map<std::string, std::vector<double>, std::less<>> answers;  ///< by key as in the request; NaN: none
};

struct DesignRequest {
    std::vector<std::size_t> levels;                          ///< per factor: number of its levels; 0: continuous
    std::map<std::string, OptionValue, std::less<>> options;  ///< complete: defaults filled in
    std::uint64_t seed = 1;                                   ///< seed of the campaign
    std::vector<std::size_t> groups = {};  ///< number of each factor's group, from 0; empty: no groups
    std::vector<Factor> factors = {};      ///< names, and values for designs that grow
    /// Factors that several experiments calibrate together; empty: the factors with a range.
    std::vector<Factor> shared = {};
    /// Answers of the points so far, by observable and number; empty: the point is not settled; NaN: no answer. Used
    /// only by growing designs.
    std::map<std::string, std::vector<std::optional<double>>, std::less<>> answers = {};
    std::vector<FurtherAnswers> further = {};  ///< used only by designs that calibrate
    /// Whether the campaign's `where` clause accepts a point of the unit cube; empty: every point, or unknown. Used
    /// only by growing designs.
    std::function<bool(std::span<const double> u)> admits = {};
    /// Points that follow from the answers, if they have already been computed.
    std::shared_ptr<const PointSet> grown = {};

    [[nodiscard]] std::size_t dimensions() const { return levels.size(); }
    /// Returns the number of groups of factors that change together.
    [[nodiscard]] std::size_t group_count() const;
    /// Returns the group of factor j.
    [[nodiscard]] std::size_t group(std::size_t j) const { return groups.empty() ? j : groups[j]; }
    [[nodiscard]] std::int64_t count(std::string_view option) const;
    [[nodiscard]] double number(std::string_view option) const;
    [[nodiscard]] const std::string& word(std::string_view option) const;
};

/// Points in order of their number: either coordinates in the unit cube (row-major, points x dimensions) or listed
/// physical rows. Point p belongs to sequence p mod sequences. The campaign defines the replicates, unless the columns
/// `part` and `repeat` do.
struct PointSet {
    std::size_t dimensions = 0;
    std::size_t sequences = 1;
    std::vector<double> coordinates;
    Rows rows = {};
    std::vector<std::uint32_t> part = {};    ///< replaces the sequence of a point
    std::vector<std::uint32_t> repeat = {};  ///< number of the only replicate of each point
    /// For a growing design: why it ends without a result; empty: it continues, or has a result.
    std::string without_result = {};

    [[nodiscard]] std::size_t size() const {
        return rows.empty() ? (dimensions == 0 ? 0 : coordinates.size() / dimensions) : rows.size();
    }
    [[nodiscard]] std::span<const double> point(std::size_t p) const {
        return std::span(coordinates).subspan(p * dimensions, dimensions);
    }
};

/// Meaning of a prefix of a design.
enum class Beginning {
    sample,  ///< a sample of the ranges: statistics converge along the design and can be judged
    listed,  ///< rows in the user's order: judged if the campaign has a rule, without errors
    corner,  ///< not representative: only the whole design is a sample
};

/// Purpose of a design, which determines the method for the influence of its factors.
enum class Purpose { statistics, saltelli, morris };

/// Traits of a kind of design; no other code compares names.
struct DesignInfo {
    std::string name;
    std::string summary;                             ///< suitable and unsuitable uses, with numbers
    std::vector<std::string_view> other_names = {};  ///< in other programs, for suggestions
    std::vector<OptionSpec> options;
    bool extends = false;  ///< a larger design begins with the same points
    /// Whether its sequences are independent replicates of one another, so that the convergence rule 'replicates' may
    /// compare them. (In other designs a sequence is the role of a point in its block.)
    bool independent_sequences = false;
    bool independent_points = false;  ///< each point is drawn independently
    /// Whether later points depend on earlier answers (request.answers); sample() returns all points that follow from
    /// the known answers.
    bool grows = false;
    bool calibrates = false;  ///< searches for settings that agree with the measurements in its option "targets"
    bool brackets = false;    ///< searches for the threshold crossing of an answer, its option "threshold"
    /// Observables of these answers, or places along their curves (curve_place.hpp).
    std::function<std::vector<std::string>(const DesignRequest&)> rests_on = {};
    Beginning beginning = Beginning::sample;
    Purpose purpose = Purpose::statistics;
    /// Number of points of sample(request), without computing them. Throws like sample().
    std::function<std::int64_t(const DesignRequest&)> size;
    /// Number of consecutive points in a block, for this number of groups of factors; 1: no blocks.
    std::function<std::size_t(std::size_t groups)> block = [](std::size_t) { return std::size_t{1}; };
    /// Points of a request. Throws std::invalid_argument with one sentence if the combination of options is impossible.
    std::function<PointSet(const DesignRequest&)> sample;
};

/// Returns the designs that a campaign may name under "design".
[[nodiscard]] std::span<const DesignInfo> design_catalogue();
/// Returns one of these, or a design from another section of the campaign file; nullptr: none of this name.
[[nodiscard]] const DesignInfo* find_design(std::string_view name);
/// Returns the design of an existing name. Throws std::logic_error for any other name.
[[nodiscard]] const DesignInfo& design_named(std::string_view name);
/// Adds the defaults of options that are missing.
void add_defaults(const DesignInfo& design, std::map<std::string, OptionValue, std::less<>>& options);
/// Returns the number of independent sequences of the request's design; 1 if there are none.
[[nodiscard]] std::int64_t independent_sequences(std::string_view design, const DesignRequest& request);

}  // namespace grainsweep::designs

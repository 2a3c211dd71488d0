// Factor: what a campaign varies, from its file to its figures.
#pragma once

#include "solver/scenes/values.hpp"
#include "stats/distribution.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace grainsweep::designs {

enum class Scale { linear, log };

/// Range: u in [0, 1] -> low + u (high - low), or low (high/low)^u, with the same bits on every platform.
struct Between {
    double low = 0;
    double high = 1;
    Scale scale = Scale::linear;
    bool operator==(const Between&) const = default;
};

/// Levels: u -> level floor(k u), the last one at u = 1.
struct Levels {
    std::vector<Value> values;
    bool operator==(const Levels&) const = default;
};

struct Factor {
    std::string name;
    std::variant<Between, Levels, stats::Distribution> range;
    std::optional<double> step = {};  ///< for a range: its values are multiples of this (step.hpp)
    bool share = false;               ///< for a range: it and the other shares add to one (campaign/simplex.hpp)
    std::string group = {};           ///< factors of a group change together in saltelli and morris; empty: its own
                                      ///< group
    std::string when = {};            ///< SQL condition; where it is false the factor has its default; empty: always
                                      ///< true
    std::string unit = {};            ///< of its parameter; empty: words, or a scene that this program does not have
    bool operator==(const Factor&) const = default;

    // Return the range in its form; null: it has another one.
    [[nodiscard]] const Between* between() const { return std::get_if<Between>(&range); }
    [[nodiscard]] const Levels* levels() const { return std::get_if<Levels>(&range); }
    [[nodiscard]] const stats::Distribution* distribution() const { return std::get_if<stats::Distribution>(&range); }
    [[nodiscard]] bool continuous() const { return levels() == nullptr; }
    /// Returns whether its distribution has no ends, so that no point may have the coordinate 0 or 1.
    [[nodiscard]] bool endless() const { return distribution() != nullptr && !distribution()->has_ends(); }
    /// Returns whether the range is divided logarithmically.
    [[nodiscard]] bool log() const;
    /// Returns the ends of the range (stats::Distribution::range), or the smallest and the largest level; of words 0
    /// and 0.
    [[nodiscard]] std::pair<double, double> ends() const;

    /// Returns the value at the coordinate u in [0, 1], not yet in the type of its parameter.
    [[nodiscard]] Value value(double u) const;
    /// Returns the value of a range or distribution at u.
    [[nodiscard]] double number(double u) const { return std::get<double>(value(u)); }
    /// Returns the coordinate of a number in a range; for a distribution, the cumulative probability.
    [[nodiscard]] double place(double number) const;
    /// Returns the value at u as text that reads back as the same value.
    [[nodiscard]] std::string text(double u) const;

    /// Returns the levels as text, in the order of the campaign file; empty: a range.
    [[nodiscard]] std::vector<std::string> level_texts() const;
    /// Returns the levels as numbers; empty: a range, or one of them is a word.
    [[nodiscard]] std::vector<double> level_numbers() const;
    /// Returns whether it has levels that are not all numbers.
    [[nodiscard]] bool has_words() const { return !continuous() && level_numbers().empty(); }
    /// Returns the number of multiples of the step in a linear range, if it has a step.
    [[nodiscard]] std::optional<std::size_t> multiples() const;

    /// Returns the number of equal parts of [0, 1] that have one value each: levels, or few multiples of a step; 0: no
    /// parts.
    [[nodiscard]] std::size_t parts() const;
    /// Return the index of the part at u, the coordinate of its middle, and that of a part by index; without parts the
    /// first two are 0 and u.
    [[nodiscard]] std::size_t part(double u) const;
    [[nodiscard]] double middle(double u) const;
    [[nodiscard]] double middle_of(std::size_t part) const;
    /// Returns the value at u as a number; for words the index of the level.
    [[nodiscard]] double number_or_index(double u) const;

    /// Range of the factor in figures: the full range, or the central 99.8 % of a distribution without ends;
    /// logarithmic if its middle is the geometric mean of the ends; of levels the smallest and the largest.
    struct Shown {
        double low = 0, high = 0;
        bool log = false;
    };
    [[nodiscard]] Shown shown() const;
};

/// Returns a value as text, words unquoted.
[[nodiscard]] std::string to_text(const Value& value);

// Values of a factor at multiples of a step, counted from 0: a gap in steps of 0.5 mm, a whole number of blades.
//
// m_1 ... m_2: multiples within the range. The range is widened to [(m_1 - 1/2) step, (m_2 + 1/2) step], and every
// value of the widened range is rounded to the nearest multiple. So each multiple has a complete cell, also the first
// and the last, and no value lies outside the range. In a linear range all multiples are equally likely. In a
// logarithmic range each has the probability of its cell, proportional to log((m + 1/2)/(m - 1/2)).
//
// The values of a distribution are rounded to the nearest multiple, so each multiple has the probability of its cell.
// The first and the last inside its ends have what lies beyond them, too.

/// Numbers of the first and last multiple of a step within [low, high]; last < first: there is none.
struct Multiples {
    std::int64_t first = 0, last = -1;
    [[nodiscard]] std::int64_t count() const { return last - first + 1; }
};

/// Largest number of multiples.
inline constexpr std::int64_t most_multiples = 1'000'000'000;

/// Returns number * step as the double nearest to the decimal product: 3 * 0.1 is 0.3.
[[nodiscard]] double multiple_of(double step, std::int64_t number);
/// Finds the multiples within a range. Needs step > 0 and at most `most_multiples` steps from 0 to either end.
[[nodiscard]] Multiples multiples_in(double step, double low, double high);
/// Returns whether x is a multiple, to the last bit.
[[nodiscard]] bool is_multiple(double step, double x);
/// Returns the multiple at the coordinate u in [0, 1] of a range that has at least one.
[[nodiscard]] double stepped(const Between& range, double step, double u);
[[nodiscard]] double stepped(const stats::Distribution& distribution, double step, double u);

}  // namespace grainsweep::designs

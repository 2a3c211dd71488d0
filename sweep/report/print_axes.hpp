// Axes of figures for print, from names, units and ranges of a campaign, with one engineering prefix per axis.
#pragma once

#include "sweep/plot/plot.hpp"
#include "sweep/study/features.hpp"
#include "sweep/study/responses.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::report {

/// Returns a unit for print: J/m3 as J/m³, L^2/alpha as L²/α; empty for a pure number.
[[nodiscard]] std::string printed_unit(std::string_view unit);

/// Quantity, whose numbers are shown multiplied by `factor`, with `title`.
struct Quantity {
    std::string title;
    double factor = 1;

    [[nodiscard]] double of(double x) const { return factor * x; }
    [[nodiscard]] std::vector<double> of(std::span<const double> numbers) const;
};
/// Returns the quantity with the prefix that brings `largest` between 1 and 1,000: 0.0036 m is shown as 3.6 mm. Units
/// without prefixes get a power of ten if numbers are 10,000 or more, or all below 0.01. Underscores of the name become
/// spaces.
[[nodiscard]] Quantity quantity_of(std::string_view name, std::string_view unit, double largest);

/// Returns a number with its unit and an engineering prefix: 0.0036 m as "3.6 mm". Four digits.
[[nodiscard]] std::string quantity_text(double value, std::string_view unit);

/// Variable of a campaign for an axis: factor, response or number of the point.
struct Variable {
    std::string name, unit;
    std::vector<std::string> levels;  ///< empty: numbers
    double low = 0, high = 0;         ///< range of numbers
    bool log = false;
    std::vector<double> values;  ///< one per row

    [[nodiscard]] Quantity quantity() const;
    /// Returns the levels for display: numbers in the unit of the title.
    [[nodiscard]] std::vector<std::string> shown_levels() const;
    /// Returns the axis. `margin`: room beyond both ends, as a share of the length.
    [[nodiscard]] plot::Axis axis(double margin = 0.02) const;
    /// Returns a number as on the axis; for levels the index.
    [[nodiscard]] double shown(double x) const { return levels.empty() ? quantity().of(x) : x; }
    /// Returns the levels as entries of a legend, the first one with the title, in the colours of categories.
    [[nodiscard]] std::vector<plot::Key> keys(plot::Key::Kind kind) const;
    /// Returns the value of a row as on the axis; cases of one level are spread sideways by a fixed sequence.
    [[nodiscard]] double place(std::size_t row) const;
};
[[nodiscard]] Variable variable_of(const study::FactorColumn& factor);
/// A response has a logarithmic axis if it spans decades.
[[nodiscard]] Variable variable_of(const study::ResponseColumn& response);
/// Returns the variable of a factor of a response model, without rows.
[[nodiscard]] Variable variable_of(const study::ModelFactor& factor);

/// Smallest and largest finite number; 0 and 1 if there is none. A single number gets some room.
struct NumberRange {
    double low = 0, high = 1;
};
[[nodiscard]] NumberRange finite_range(std::span<const double> numbers);
/// Returns the quantity with the prefix for the number of the range that is farthest from 0.
[[nodiscard]] Quantity quantity_of(std::string_view name, std::string_view unit, const NumberRange& range);
/// Returns whether all numbers are positive and the largest is more than a hundred times the smallest.
[[nodiscard]] bool spans_decades(const NumberRange& range);
/// Returns an axis of the range, widened by a share of its length.
[[nodiscard]] plot::Axis number_axis(const Quantity& quantity, const NumberRange& range, bool log = false,
                                     double margin = 0.05);

}  // namespace grainsweep::report

// Factors that use columns of one sample: their coordinates together choose a row of the sample.
#pragma once

#include "stats/distribution.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::campaign {

/// Returns the column of a distribution in a sample with several columns; null if there is no such sample.
[[nodiscard]] inline const stats::SampleColumn* column_of(const stats::Distribution* distribution) {
    const auto* column = distribution == nullptr ? nullptr : std::get_if<stats::SampleColumn>(&distribution->form());
    return column == nullptr || column->sample->columns() == 1 ? nullptr : column;
}

/// Returns the value of factor j at the point u of `count` factors, from the row of its sample at this point. Empty if
/// the factor uses no column of a sample, or another column of this sample is no factor. `column(k)`: column of factor
/// k, may be null.
template <class Column>
[[nodiscard]] std::optional<double> joint_value(std::size_t count, std::size_t j, std::span<const double> u,
                                                const Column& column) {
    const stats::SampleColumn* own = column(j);
    if (own == nullptr) return std::nullopt;
    std::vector<double> place(own->sample->columns());
    std::size_t found = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const stats::SampleColumn* other = column(k);
        if (other == nullptr || other->sample != own->sample) continue;
        place[other->column] = u[k];
        ++found;
    }
    if (found < place.size()) return std::nullopt;
    return own->sample->column(own->column)[own->sample->row_at(place)];
}

}  // namespace grainsweep::campaign

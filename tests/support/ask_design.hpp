// Asks a design of the catalogue as a campaign would: defaults filled in, then what the test sets.
#pragma once

#include "sweep/designs/design.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace grainsweep::tests {

using Options = std::map<std::string, designs::OptionValue, std::less<>>;

inline designs::PointSet ask_design(const std::string& kind, std::vector<std::size_t> levels, const Options& options,
                                    std::uint64_t seed = 1) {
    const designs::DesignInfo* info = designs::find_design(kind);
    if (info == nullptr) throw std::runtime_error("no design " + kind);
    designs::DesignRequest request{.levels = std::move(levels), .options = options, .seed = seed};
    designs::add_defaults(*info, request.options);
    return info->sample(request);
}

/// The same over `dimensions` continuous factors.
inline designs::PointSet ask_design(const std::string& kind, std::size_t dimensions, const Options& options,
                                    std::uint64_t seed = 1) {
    return ask_design(kind, std::vector<std::size_t>(dimensions, 0), options, seed);
}

}  // namespace grainsweep::tests

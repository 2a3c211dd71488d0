#include "sweep/study/influence_of_blocks.hpp"

#include "sweep/campaign/stored_request.hpp"
#include "sweep/study/error_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace grainsweep::study {
namespace {

constexpr double no_figure = std::numeric_limits<double>::quiet_NaN();

/// Factors of a group.
std::vector<std::size_t> members_of(const Responses& responses, std::size_t group) {
    std::vector<std::size_t> members;
    for (std::size_t j = 0; j < responses.groups.size(); ++j)
        if (responses.groups[j] == group) members.push_back(j);
    return members;
}

/// Points of block designs, one row per design point from 0: coordinates, and the mean of its replicates. NaN if the
/// point was filtered out, failed or is missing.
struct Grid {
    std::vector<double> coordinates, values;
    std::vector<bool> there;  ///< of every point, whether it has a row
};

/// Where values do not tell the coordinates of a point, because of steps, shares or conditions, the design does.
void take_coordinates_of_design(Grid& grid, const Responses& responses) {
    const auto design = responses.design().sample(campaign::request_of(responses.campaign)).coordinates;
    for (std::size_t i = 0; i < std::min(grid.coordinates.size(), design.size()); ++i)
        if (grid.there[i / responses.factors.size()]) grid.coordinates[i] = design[i];
}

Grid grid_of(const Responses& responses, const ResponseColumn& response) {
    const std::size_t d = responses.factors.size();
    const auto repeated = responses.settled_repeats();
    const auto points = static_cast<std::size_t>(responses.settled_points);  // the last ones may be filtered out
    Grid grid{std::vector<double>(points * d, no_figure), std::vector<double>(points, no_figure),
              std::vector<bool>(points, false)};
    std::vector<double> sums(points), counts(points);
    const auto place_row = [&](std::size_t point, std::size_t row) {
        grid.there[point] = true;
        for (std::size_t j = 0; j < d; ++j) grid.coordinates[point * d + j] = responses.factors[j].coordinate(row);
        if (!std::isfinite(response.values[row])) return;
        sums[point] += response.values[row];
        counts[point] += 1;
    };
    for (std::size_t row = 0; row < responses.settled; ++row)
        place_row(static_cast<std::size_t>(responses.points[row]), row);
    for (const auto& place : repeated) place_row(static_cast<std::size_t>(place.point), place.row);
    for (std::size_t p = 0; p < points; ++p)
        if (counts[p] > 0) grid.values[p] = sums[p] / counts[p];
    if (responses.folds) take_coordinates_of_design(grid, responses);
    return grid;
}

}  // namespace

std::vector<FactorInfluence> add_saltelli(Influence& influence, const Responses& responses,
                                          const ResponseColumn& response) {
    const auto grid = grid_of(responses, response);
    const auto indices = stats::saltelli_indices(grid.values, responses.group_names.size());
    std::vector<FactorInfluence> groups(responses.group_names.size());
    for (std::size_t g = 0; g < groups.size(); ++g) {
        groups[g].first = groups[g].first_saltelli = indices.first[g];
        groups[g].total = indices.total[g];
    }
    influence.used = indices.count;
    influence.excluded = indices.excluded;
    influence.notes.push_back(fmt::format("total indices from {} base rows; {} left out for want of a value",
                                          indices.count, indices.excluded));
    const auto least = std::ranges::min_element(indices.total, {}, &stats::SensitivityIndex::value);
    if (influence.split.pure.freedom == 0 && least != indices.total.end() && std::isfinite(least->value))
        influence.notes.push_back(
            fmt::format("every total index holds the scatter of single runs: its share is at most the smallest, {}",
                        index_text(*least)));
    return groups;
}

std::vector<FactorInfluence> add_morris(Influence& influence, const Responses& responses,
                                        const ResponseColumn& response) {
    const std::size_t d = responses.factors.size();
    const std::size_t length = responses.group_names.size() + 1;
    std::vector<FactorInfluence> groups(responses.group_names.size());
    const auto grid = grid_of(responses, response);
    Grid whole;  // trajectories all of whose points exist: `where` may have filtered some out
    std::int64_t broken = 0;
    for (std::size_t t = 0; (t + 1) * length <= grid.values.size(); ++t) {
        const auto first = grid.coordinates.begin() + static_cast<std::ptrdiff_t>(t * length * d);
        const auto last = first + static_cast<std::ptrdiff_t>(length * d);
        const auto there = grid.there.begin() + static_cast<std::ptrdiff_t>(t * length);
        if (!std::all_of(there, there + static_cast<std::ptrdiff_t>(length), [](bool point) { return point; })) {
            ++broken;
            continue;
        }
        whole.coordinates.insert(whole.coordinates.end(), first, last);
        const auto y = grid.values.begin() + static_cast<std::ptrdiff_t>(t * length);
        whole.values.insert(whole.values.end(), y, y + static_cast<std::ptrdiff_t>(length));
    }
    if (broken > 0) influence.notes.push_back(fmt::format("{} trajectories are incomplete and left out", broken));
    try {
        const auto effects = stats::elementary_effects(whole.coordinates, d, whole.values, responses.groups);
        for (std::size_t g = 0; g < groups.size(); ++g) groups[g].effects = effects[g];
        for (std::size_t j = 0; j < d; ++j)  // a trend has a sign
            if (members_of(responses, responses.groups[j]).size() == 1)
                influence.factors[j].effects = effects[responses.groups[j]];
        const auto fewest = std::ranges::min_element(effects, {}, &stats::ElementaryEffects::count);
        if (fewest != effects.end()) {
            influence.used = fewest->count;
            influence.excluded = fewest->excluded;
        }
    } catch (const std::invalid_argument& error) {  // two grid levels of a factor with levels may be the same level
        influence.notes.push_back(fmt::format("no elementary effects: {}", error.what()));
    }
    return groups;
}

void join_groups(Influence& influence, const Responses& responses, std::vector<FactorInfluence> groups) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const auto members = members_of(responses, g);
        if (members.size() == 1) {
            auto& alone = influence.factors[members.front()];
            alone.first_saltelli = groups[g].first_saltelli;
            alone.total = groups[g].total;
            alone.effects = groups[g].effects;
            groups[g] = std::move(alone);
            continue;
        }
        groups[g].factor = responses.group_names[g];
        for (const auto j : members) groups[g].members.push_back(responses.factors[j].name);
        influence.notes.push_back(fmt::format("{} are moved together, as '{}': their figures are those of the group{}",
                                              fmt::join(groups[g].members, ", "), groups[g].factor,
                                              groups[g].effects ? ", and an effect has no sign" : ""));
    }
    influence.factors = std::move(groups);
}

void withdraw_errors_of_repeated_cases(Influence& influence, const Responses& responses) {
    const auto repeated = responses.settled_repeats().size();
    if (repeated <= responses.settled) return;
    for (auto& factor : influence.factors) {
        factor.first_saltelli.half_width = factor.total.half_width = no_figure;
        if (factor.effects) factor.effects->mu_star_half_width = no_figure;
    }
    influence.notes.push_back(fmt::format("the {} places of the design are {} different cases: errors are unknown",
                                          repeated + responses.settled, responses.settled));
}

}  // namespace grainsweep::study

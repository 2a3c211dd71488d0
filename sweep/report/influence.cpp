#include "sweep/report/influence.hpp"

#include "stats/random.hpp"
#include "sweep/schedule/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace grainsweep::report {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t groups = 8;

/// One row per design point from 0 on: coordinates and the mean over its repeats; NaN where the point was filtered
/// out, failed or is not there. What designs made of blocks need.
struct Grid {
    std::vector<double> coordinates, values;
};

Grid grid_of(const Responses& responses, const ResponseColumn& response) {
    const std::size_t d = responses.factors.size();
    const auto points =
        responses.settled == 0 ? 0 : static_cast<std::size_t>(responses.points[responses.settled - 1] + 1);
    Grid grid{std::vector<double>(points * d, none), std::vector<double>(points, none)};
    std::vector<double> sums(points), counts(points);
    for (std::size_t row = 0; row < responses.settled; ++row) {
        const auto point = static_cast<std::size_t>(responses.points[row]);
        for (std::size_t j = 0; j < d; ++j) grid.coordinates[point * d + j] = responses.factors[j].coordinate(row);
        if (!std::isfinite(response.values[row])) continue;
        sums[point] += response.values[row];
        counts[point] += 1;
    }
    for (std::size_t p = 0; p < points; ++p)
        if (counts[p] > 0) grid.values[p] = sums[p] / counts[p];
    return grid;
}

/// Parts of the sample to leave out in turn: independent sequences, else stretches of whole blocks, else (a list
/// has no order) parts drawn at random.
std::vector<std::size_t> groups_of(const Responses& responses) {
    const auto sequences = schedule::independent_sequences(responses.campaign.design,
                                                           static_cast<std::size_t>(responses.campaign.sequences));
    const auto block =
        static_cast<std::int64_t>(responses.campaign.design == "saltelli" ? responses.factors.size() + 2 : 1);
    const std::int64_t blocks = responses.settled_points / block + 1;
    std::vector<std::size_t> labels(responses.settled);
    for (std::size_t row = 0; row < labels.size(); ++row) {
        const std::int64_t point = responses.points[row];
        if (sequences >= 4) {
            labels[row] = static_cast<std::size_t>(point) % sequences;
        } else if (responses.campaign.design == "list") {
            labels[row] = static_cast<std::size_t>(stats::bits_at(1, 0, static_cast<std::uint64_t>(point)) % groups);
        } else {
            labels[row] = static_cast<std::size_t>(point / block) * groups / static_cast<std::size_t>(blocks);
        }
    }
    return labels;
}

/// A level is a bin of its own, and so is a coordinate of a lattice; else so many bins that each has 16 cases.
std::size_t bins_for(const FactorColumn& factor, bool lattice, std::size_t settled, std::int64_t cases) {
    if (lattice || !factor.continuous()) {
        const auto judged = std::span(factor.values).first(settled);
        return std::max<std::size_t>(2, std::set<double>(judged.begin(), judged.end()).size());
    }
    return std::clamp<std::size_t>(static_cast<std::size_t>(cases) / 16, 4, 16);
}

void add_given_data(Influence& influence, const Responses& responses, const ResponseColumn& response) {
    const bool lattice = responses.campaign.design == "lattice";
    const auto values = responses.judged(response);
    const auto cases = std::ranges::count_if(values, [](double x) { return std::isfinite(x); });
    const auto labels = groups_of(responses);
    std::size_t most_bins = 0;
    for (std::size_t j = 0; j < responses.factors.size(); ++j) {
        const auto& factor = responses.factors[j];
        auto& found = influence.factors[j];
        found.bins = bins_for(factor, lattice, responses.settled, cases);
        const auto coordinates = std::span(factor.values).first(responses.settled);
        const auto indices = stats::first_order_indices(coordinates, 1, values, labels, found.bins);
        found.first = indices.first[0];
        // Lines of a lattice are no sample of it: leaving some out tells nothing about the error.
        if (lattice) found.first.half_width = none;
        influence.used = indices.count;
        influence.excluded = indices.excluded;
        most_bins = std::max(most_bins, found.bins);
    }
    if (lattice) {
        influence.notes.emplace_back("a lattice gives its indices without errors: compare campaigns of growing levels");
    } else if (influence.used > 0) {
        const double floor = static_cast<double>(most_bins - 1) / static_cast<double>(influence.used);
        influence.notes.push_back(
            fmt::format("with {} cases in {} bins an index below about {:.2g} cannot be told from zero", influence.used,
                        most_bins, floor));
    }
}

void add_saltelli(Influence& influence, const Responses& responses, const ResponseColumn& response) {
    const auto grid = grid_of(responses, response);
    const auto indices = stats::saltelli_indices(grid.values, responses.factors.size());
    for (std::size_t j = 0; j < responses.factors.size(); ++j) {
        influence.factors[j].first_saltelli = indices.first[j];
        influence.factors[j].total = indices.total[j];
    }
    influence.used = indices.count;
    influence.excluded = indices.excluded;
    influence.notes.push_back(fmt::format("total indices from {} base rows; {} left out for want of a value",
                                          indices.count, indices.excluded));
}

void add_morris(Influence& influence, const Responses& responses, const ResponseColumn& response) {
    const std::size_t d = responses.factors.size();
    const std::size_t length = d + 1;
    const auto grid = grid_of(responses, response);
    Grid whole;  // trajectories all of whose points exist: `where` may have filtered some out
    std::int64_t broken = 0;
    for (std::size_t t = 0; (t + 1) * length <= grid.values.size(); ++t) {
        const auto first = grid.coordinates.begin() + static_cast<std::ptrdiff_t>(t * length * d);
        const auto last = first + static_cast<std::ptrdiff_t>(length * d);
        if (std::any_of(first, last, [](double x) { return std::isnan(x); })) {
            ++broken;
            continue;
        }
        whole.coordinates.insert(whole.coordinates.end(), first, last);
        const auto y = grid.values.begin() + static_cast<std::ptrdiff_t>(t * length);
        whole.values.insert(whole.values.end(), y, y + static_cast<std::ptrdiff_t>(length));
    }
    if (broken > 0) influence.notes.push_back(fmt::format("{} trajectories are incomplete and left out", broken));
    try {
        const auto effects = stats::elementary_effects(whole.coordinates, d, whole.values);
        for (std::size_t j = 0; j < d; ++j) influence.factors[j].effects = effects[j];
        const auto fewest = std::ranges::min_element(effects, {}, &stats::ElementaryEffects::count);
        if (fewest != effects.end()) {
            influence.used = fewest->count;
            influence.excluded = fewest->excluded;
        }
    } catch (const std::invalid_argument& error) {  // two grid levels of a factor with levels may be the same level
        influence.notes.push_back(fmt::format("no elementary effects: {}", error.what()));
    }
}

}  // namespace

Influence influence_of(const Responses& responses, const ResponseColumn& response) {
    Influence influence;
    const auto& design = responses.campaign.design;
    for (const auto& factor : responses.factors) influence.factors.push_back({factor.name, 0, {}, {}, {}, {}});
    if (design == "morris") {
        influence.method = Influence::Method::morris;
        add_morris(influence, responses, response);
        return influence;
    }
    add_given_data(influence, responses, response);
    if (design == "saltelli") {
        influence.method = Influence::Method::saltelli;
        add_saltelli(influence, responses, response);
    }
    if (influence.excluded > 0 && design != "saltelli")
        influence.notes.push_back(fmt::format("{} cases without a value are left out", influence.excluded));
    return influence;
}

}  // namespace grainsweep::report

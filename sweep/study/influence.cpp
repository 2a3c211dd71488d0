#include "sweep/study/influence.hpp"

#include "solver/plain_text.hpp"
#include "stats/confidence.hpp"
#include "stats/moments.hpp"
#include "stats/spread.hpp"
#include "stats/trend.hpp"
#include "sweep/campaign/stored_identity.hpp"
#include "sweep/study/effects.hpp"
#include "sweep/study/error_text.hpp"
#include "sweep/study/sample_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

namespace grainsweep::study {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// ---- designs whose points form blocks: total indices of saltelli, elementary effects of morris
//
// One entry per group of factors that change together; a single factor is a group of one.

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
    Grid grid{std::vector<double>(points * d, not_a_number), std::vector<double>(points, not_a_number),
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

/// Returns total and first-order indices of the groups. Adds notes to `influence`.
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
    const auto repeats = responses.campaign.stored.replicates;
    const double spread = stats::summarise(grid.values).sd;
    if (const double scatter = influence.split.pure.variance; scatter > 0 && spread > 0)
        influence.notes.push_back(fmt::format(
            "total indices are of means over {} replicates, and every one holds their scatter, about {:.2g}", repeats,
            scatter / static_cast<double>(repeats) / (spread * spread)));
    return groups;
}

/// Returns elementary effects of the groups. Sets effects and trends of single factors in `influence`.
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
        const auto least = std::ranges::min_element(effects, {}, &stats::ElementaryEffects::mu_star);
        if (least != effects.end() && least->mu_star > 0)
            influence.notes.push_back(
                fmt::format("every mu* holds the scatter of runs, and no more of it than the smallest, {}: a factor "
                            "without effect has the mu* of the scatter, and a mu near 0",
                            with_error(least->mu_star, least->mu_star_half_width)));
    } catch (const std::invalid_argument& error) {  // two grid levels of a factor with levels may be the same level
        influence.notes.push_back(fmt::format("no elementary effects: {}", error.what()));
    }
    return groups;
}

/// Replaces factors by their groups. A single factor keeps its other results.
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

/// Removes the errors of block designs if most places repeat an earlier case: the blocks then share runs and are not
/// independent, so their scatter understates the error.
void withdraw_errors_of_repeated_cases(Influence& influence, const Responses& responses) {
    const auto repeated = responses.settled_repeats().size();
    if (repeated <= responses.settled) return;
    for (auto& factor : influence.factors) {
        factor.first_saltelli.half_width = factor.total.half_width = not_a_number;
        if (factor.effects) factor.effects->mu_star_half_width = not_a_number;
    }
    influence.notes.push_back(fmt::format("the {} places of the design are {} different cases: errors are unknown",
                                          repeated + responses.settled, responses.settled));
}

// ---- every design

constexpr double monotone_share = 0.9;
constexpr std::size_t most_pieces = 15, most_coefficients = 160;

/// A level is a bin of its own, and so is a coordinate of a lattice; else so many bins that each has 16 points.
std::size_t bins_for(const FactorColumn& factor, bool lattice, std::size_t settled, std::int64_t points) {
    const auto judged = std::span(factor.values).first(settled);
    const auto different = [&] {
        return std::max<std::size_t>(2, std::set<double>(judged.begin(), judged.end()).size());
    };
    if (lattice || !factor.continuous()) return different();
    constexpr std::size_t most_bins = 16;
    if (factor.step && factor.distribution() == nullptr && different() <= most_bins) return different();
    return std::clamp<std::size_t>(static_cast<std::size_t>(points) / 16, 4, most_bins);
}

/// Removes the contribution of scatter to the bin means from the index of a lattice with replicates, and sets its
/// half-width for normal scatter. A sum of squares S with f degrees of freedom is a (noncentral) chi-squared variable:
/// E[S] = S0 + f sigma^2, V[S] = 2 f sigma^4 + 4 sigma^2 S0. The index is the ratio of one such sum to the total.
void take_out_scatter(FactorInfluence& factor, const stats::VarianceSplit& split, std::span<const double> values) {
    double n = 0, mean = 0, squares = 0;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        n += 1;
        const double before = value - mean;
        mean += before / n;
        squares += before * (value - mean);
    }
    const double variance = split.pure.variance, freedom = static_cast<double>(factor.bins) - 1;
    double& share = factor.first.value;
    share -= freedom * variance / squares;
    const auto variance_of = [&](double degrees, double sum) {
        return 2 * degrees * variance * variance + 4 * variance * std::max(0.0, sum);
    };
    const double own = variance_of(freedom, share * squares);
    const double rest = variance_of(n - 1 - freedom, (1 - share) * squares - (n - 1) * variance);
    const double subtracted = 2 * std::pow(freedom * variance, 2) / static_cast<double>(split.pure.freedom);
    const double total = std::pow(1 - share, 2) * own + share * share * rest + subtracted;
    factor.first.half_width = stats::student_factor(split.pure.freedom) * std::sqrt(total) / squares;
}

/// Variance of a value about the mean of its bin, for want of a better one; of a lattice the scatter of single runs.
double variance_in_bins(const Responses& responses, const stats::PureError& pure, std::span<const EffectBin> bins,
                        std::span<const double> values) {
    if (responses.design().beginning == designs::Beginning::corner) return pure.freedom > 0 ? pure.variance : 0;
    double squares = 0, n = 0;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        squares += value * value;
        n += 1;
    }
    for (const auto& bin : bins) squares -= static_cast<double>(bin.count) * bin.mean * bin.mean;
    const double freedom = n - static_cast<double>(bins.size());
    return freedom > 0 ? std::max(0.0, squares / freedom) : not_a_number;
}

/// Returns the trend. The response bends if its bin means are too far from the best rising and from the best falling
/// curve: the sum of squared distances is beyond three standard deviations of a chi-squared variable.
Trend trend_of(const FactorColumn& factor, const std::vector<double>& levels, const Responses& responses,
               const stats::PureError& pure, std::span<const double> response) {
    double centre = 0, count = 0;
    for (const double value : response)
        if (std::isfinite(value)) centre += (value - centre) / ++count;
    std::vector<double> values(response.begin(), response.end());
    for (double& value : values) value -= centre;
    auto bins = main_effect(factor, values, {});
    if (bins.size() < 2) return Trend::unknown;
    if (!levels.empty())
        std::ranges::sort(bins, {}, [&](const auto& bin) { return levels[static_cast<std::size_t>(bin.at)]; });
    std::vector<double> means, negated, weights;
    double between = 0;
    for (const auto& bin : bins) {
        means.push_back(bin.mean);
        negated.push_back(-bin.mean);
        weights.push_back(static_cast<double>(bin.count));
        between += static_cast<double>(bin.count) * bin.mean * bin.mean;
    }
    const double rising = stats::rising_share(means, weights), falling = stats::rising_share(negated, weights);
    const double scatter = variance_in_bins(responses, pure, bins, values);
    if (std::isnan(rising) || std::isnan(scatter)) return Trend::unknown;
    const double freedom = static_cast<double>(bins.size() - 1);
    const double best = std::max(rising, falling);
    if (best < monotone_share && between * (1 - best) > scatter * (freedom + 3 * std::sqrt(2 * freedom)))
        return Trend::bends;
    return rising > falling ? Trend::rises : Trend::falls;
}

/// Rank correlations, and trends where the factor has an influence that can be told from none.
void add_trends(Influence& influence, const Responses& responses, std::span<const double> values) {
    const auto labels = sample_parts(responses).labels;
    for (std::size_t j = 0; j < responses.factors.size(); ++j) {
        const auto& factor = responses.factors[j];
        auto& found = influence.factors[j];
        const auto levels = factor.seen_numbers();
        if (!factor.continuous() && levels.empty()) continue;
        std::vector<double> x(factor.values.begin(),
                              factor.values.begin() + static_cast<std::ptrdiff_t>(responses.settled));
        if (!factor.continuous())
            for (double& level : x) level = levels[static_cast<std::size_t>(level)];
        auto& rank = found.rank_correlation;
        rank = stats::rank_correlation(x, values, labels);
        if (!responses.ordered_sample()) rank.half_width = not_a_number;
        if (found.effects) {
            const double size = found.effects->mu_star;
            if (size > 0)
                found.trend = std::abs(found.effects->mu) < monotone_share * size ? Trend::bends
                              : found.effects->mu > 0                             ? Trend::rises
                                                                                  : Trend::falls;
            continue;
        }
        // What the scatter of independent points gives the bins of a sample; a lattice has its errors from replicates.
        const auto points = static_cast<double>(std::max<std::int64_t>(1, influence.split.points));
        const double in_bins = responses.design().beginning == designs::Beginning::corner
                                   ? 0
                                   : static_cast<double>(found.bins - 1) / points;
        const double noise =
            std::max({in_bins, std::isfinite(found.first.half_width) ? found.first.half_width : 0, 1e-9});
        const bool seen = found.first.value > noise || std::abs(rank.value) > rank.half_width;
        if (seen) found.trend = trend_of(factor, levels, responses, influence.split.pure, values);
    }
}

/// Returns the values of independent points. In a block of a Saltelli design these are the first two points, because
/// the others repeat their coordinates. Bins of repeated coordinates would include effects of other factors.
std::vector<double> independent_values(const Responses& responses, const ResponseColumn& response) {
    const auto judged = responses.judged(response);
    std::vector<double> values(judged.begin(), judged.end());
    if (responses.design().purpose != designs::Purpose::saltelli) return values;
    const auto block = static_cast<std::int64_t>(responses.design().block(responses.group_names.size()));
    for (std::size_t row = 0; row < values.size(); ++row)
        if (responses.points[row] % block >= 2) values[row] = not_a_number;
    return values;
}

stats::VarianceSplit split_of(const Responses& responses, std::span<const double> values) {
    const auto points = std::span(responses.points).first(responses.settled);
    const bool lattice = responses.design().beginning == designs::Beginning::corner;
    std::set<std::int64_t> known;
    for (std::size_t row = 0; row < values.size(); ++row)
        if (std::isfinite(values[row])) known.insert(points[row]);
    const std::size_t d = responses.factors.size();
    std::vector<std::vector<double>> coordinates(d);
    std::vector<stats::SplitFactor> factors;
    for (std::size_t j = 0; j < d; ++j) {
        const auto& factor = responses.factors[j];
        for (std::size_t row = 0; row < responses.settled; ++row) coordinates[j].push_back(factor.coordinate(row));
        const bool levels = lattice || !factor.continuous();
        factors.push_back(
            {coordinates[j], levels ? 0
                                    : std::clamp<std::size_t>(known.size() / (5 * d), 2,
                                                              std::min(most_pieces, most_coefficients / d))});
    }
    return stats::split_variance(points, factors, values, sample_parts(responses).labels, lattice);
}

/// Of values that depend on other factors a binned index is no first-order index of an independent factor.
void note_dependent_values(Influence& influence, const Responses& responses) {
    const auto note = [&](const char* sentence, auto depends) {
        std::vector<std::string> names;
        for (std::size_t j = 0; j < responses.factors.size(); ++j)
            if (depends(j)) names.push_back(responses.factors[j].name);
        if (!names.empty()) influence.notes.push_back(fmt::format(fmt::runtime(sentence), campaign::listed(names)));
    };
    note(
        "the binned index of {} includes the effect of its condition, because the default stands where that is false; "
        "indices by a response model do not include it",
        [&](std::size_t j) { return !responses.factors[j].when.empty(); });
    const auto together = [&](std::size_t j) { return !responses.factors[j].shares.empty(); };
    if (responses.design().purpose == designs::Purpose::saltelli) {  // shares that add to one have one index there
        note(
            "{} are columns of one sample and depend on each other: first and total indices depend on the order of the "
            "columns; Shapley effects by a response model do not",
            together);
        return;
    }
    note(
        "{} are columns of one sample and depend on each other: the binned index of each includes the effect of the "
        "others, and the indices have no sum; Shapley effects by a response model share the variance",
        together);
    note("{} add to one: the binned index of each includes the effect of the others, and the indices have no sum",
         [&](std::size_t j) { return responses.group_names[responses.groups[j]] == campaign::group_of_shares; });
}

void add_given_data(Influence& influence, const Responses& responses, std::span<const double> values) {
    const bool lattice = responses.design().beginning == designs::Beginning::corner;
    const std::int64_t points = influence.split.points;  // replicates add nothing to how well a sample covers the range
    const auto labels = sample_parts(responses).labels;
    std::size_t bins_at_most = 0;
    for (std::size_t j = 0; j < responses.factors.size(); ++j) {
        const auto& factor = responses.factors[j];
        auto& found = influence.factors[j];
        found.bins = bins_for(factor, lattice, responses.settled, points);
        // Columns of one sample, too, have their values: a coordinate depends on the order of the columns.
        const auto judged = std::span(factor.values).first(responses.settled);
        const auto indices = stats::first_order_indices(judged, 1, values, labels, found.bins);
        found.first = indices.first[0];
        // Lines of a lattice are no sample of it: leaving some out says nothing about the error.
        if (lattice) found.first.half_width = not_a_number;
        if (lattice && influence.split.pure.freedom > 0) take_out_scatter(found, influence.split, values);
        // Cells of unlike numbers of values move the index by more than scatter does.
        if (lattice && indices.excluded > 0) found.first.half_width = not_a_number;
        influence.used = indices.count;
        influence.excluded = indices.excluded;
        bins_at_most = std::max(bins_at_most, found.bins);
    }
    if (lattice && influence.excluded > 0) {
        influence.notes.emplace_back("cases without a value leave a lattice uneven: its indices have no errors");
    } else if (lattice && influence.split.pure.freedom > 0) {
        influence.notes.push_back(fmt::format(
            "errors are those of the scatter of single runs (pure error, {} degrees of freedom), not of the "
            "lattice's steps: compare campaigns of growing levels",
            influence.split.pure.freedom));
    } else if (lattice) {
        influence.notes.emplace_back(
            "a lattice of single runs gives its indices without errors: compare campaigns of growing levels");
    } else if (std::ranges::any_of(influence.factors, [](const auto& f) { return std::isfinite(f.first.value); })) {
        const double floor = static_cast<double>(bins_at_most - 1) / static_cast<double>(points);
        influence.notes.push_back(
            fmt::format("with {} points in {} bins an index below about {:.2g} is indistinguishable from zero", points,
                        bins_at_most, floor));
    }
    note_dependent_values(influence, responses);
}

}  // namespace

std::string_view to_string(Trend trend) {
    switch (trend) {
        case Trend::unknown:
            return "";
        case Trend::rises:
            return "rises";
        case Trend::falls:
            return "falls";
        case Trend::bends:
            return "bends";
    }
    return "";
}

namespace {

std::string share_text(const stats::SensitivityIndex& share) {
    const bool told = !(share.value <= share.half_width) && share.value > 0;
    return told ? index_text(share) : fmt::format("indistinguishable from zero ({})", index_text(share));
}

}  // namespace

std::string unexplained_text(const Influence& influence) {
    const auto& split = influence.split;
    if (!std::isfinite(split.unexplained.value)) {
        return std::isfinite(split.pure.variance)
                   ? fmt::format(
                         "single runs scatter with a standard deviation of {:.3g} (pure error, {} degrees of freedom)",
                         std::sqrt(split.pure.variance), split.pure.freedom)
                   : "";
    }
    if (split.unexplained.value < 1e-9 && !(split.scatter.value > 0))
        return "main effects together explain all of the variance of single runs";
    const auto text = fmt::format("main effects together explain {} of the variance of single runs; unexplained {}",
                                  index_text(split.main_effects), index_text(split.unexplained));
    if (std::isfinite(split.scatter.value)) {
        return fmt::format(
            "{}: interactions {}, scatter of single runs {} (standard deviation {:.3g}, pure error of {} degrees of "
            "freedom)",
            text, share_text(split.interactions), share_text(split.scatter), std::sqrt(split.pure.variance),
            split.pure.freedom);
    }
    return text + ": interactions and scatter of single runs, which replicates would tell apart";
}

Influence influence_of(const Responses& responses, const ResponseColumn& response) {
    Influence influence;
    const auto& design = responses.design();
    const auto values = independent_values(responses, response);
    for (const auto& factor : responses.factors) influence.factors.emplace_back().factor = factor.name;
    if (design.purpose == designs::Purpose::morris) {
        influence.method = Influence::Method::morris;
        influence.split.pure = stats::pure_error(std::span(responses.points).first(responses.settled), values);
        const auto groups = add_morris(influence, responses, response);
        add_trends(influence, responses, values);
        join_groups(influence, responses, groups);
        withdraw_errors_of_repeated_cases(influence, responses);
        return influence;
    }
    if (design.grows) {
        influence.notes.push_back(
            fmt::format("a {} places its points by results: shares of the variance over the ranges are those of the "
                        "response model alone",
                        responses.campaign.design));
        add_trends(influence, responses, values);
        return influence;
    }
    if (const auto reason = stats::reason_against_powers(values, 2); !reason.empty()) {
        influence.notes.push_back("no shares of the variance: " + reason);
        add_trends(influence, responses, values);
        return influence;
    }
    influence.split = split_of(responses, values);
    add_given_data(influence, responses, values);
    add_trends(influence, responses, values);
    if (design.purpose == designs::Purpose::saltelli) {
        influence.method = Influence::Method::saltelli;
        join_groups(influence, responses, add_saltelli(influence, responses, response));
        withdraw_errors_of_repeated_cases(influence, responses);
    }
    if (influence.excluded > 0 && design.purpose != designs::Purpose::saltelli)
        influence.notes.push_back(fmt::format("{} cases without a value are left out", influence.excluded));
    return influence;
}

}  // namespace grainsweep::study

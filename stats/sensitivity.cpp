#include "stats/sensitivity.hpp"

#include "stats/confidence.hpp"
#include "stats/moments.hpp"
#include "stats/undefined.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace grainsweep::stats {
namespace {

constexpr std::size_t batches_of_sample = 8;
constexpr std::size_t no_index = std::numeric_limits<std::size_t>::max();

double square(double x) {
    return x * x;
}

/// One row as a factor's bins see it.
struct Entry {
    double x;
    double y;
    std::size_t group;
};

struct Bins {
    std::vector<std::size_t> ends;
    bool per_value;
};

/// Bins over entries sorted by x: one per value where they are few, else of equal counts.
Bins bins_of(std::span<const Entry> sorted, std::size_t bins) {
    std::vector<std::size_t> ends;
    for (std::size_t i = 1; i <= sorted.size() && ends.size() <= bins; ++i)
        if (i == sorted.size() || sorted[i].x != sorted[i - 1].x) ends.push_back(i);
    if (ends.size() <= bins) return {ends, true};
    ends.resize(bins);
    const std::size_t larger = sorted.size() % bins;
    for (std::size_t k = 0; k < bins; ++k) ends[k] = (k + 1) * (sorted.size() / bins) + std::min(k + 1, larger);
    return {ends, false};
}

/// Shares of the variance: of the bin means, and of what varies within the bins.
struct BinnedIndex {
    double between = undefined, within = undefined;
    [[nodiscard]] double value() const { return between + within; }
};

BinnedIndex binned_index(std::span<const Entry> sorted, std::size_t bins) {
    if (sorted.size() < 2 * bins) return {};
    Moments moments;
    for (const Entry& entry : sorted) moments.add(entry.y);
    const Summary summary = moments.summary();
    if (!(summary.sd > 0)) return {};
    const auto [ends, per_value] = bins_of(sorted, bins);
    double between = 0, steps = 0, before = 0;
    std::size_t first = 0;
    for (const std::size_t end : ends) {
        double mean = 0;
        for (std::size_t i = first; i < end; ++i) mean += sorted[i].y - summary.mean;
        mean /= static_cast<double>(end - first);
        between += static_cast<double>(end - first) * square(mean);
        if (first > 0) steps += square(mean - before);
        before = mean;
        first = end;
    }
    const double variance = square(summary.sd);
    return {between / static_cast<double>(sorted.size()) / variance,
            per_value ? 0 : steps / (12 * static_cast<double>(ends.size() - 1)) / variance};
}

/// What bins of half the size see more than scatter gives them: an effect that turns within the bins.
double missed_by_bins(std::span<const Entry> sorted, const BinnedIndex& all, std::size_t bins) {
    const double by_scatter = static_cast<double>(bins) / static_cast<double>(sorted.size());
    const double finer = binned_index(sorted, 2 * bins).value();
    return std::isnan(finer) ? undefined : std::max(0.0, finer - all.value() - by_scatter);
}

/// Value, and half-width with what scatter in the bins may have added (the bias that the jackknife estimates) and with
/// what the bins may have missed.
SensitivityIndex binned_with_error(std::span<const Entry> sorted, const BinnedIndex& all, std::size_t groups,
                                   std::size_t bins) {
    std::vector<double> leave_one_out;
    std::vector<Entry> others;
    double bias = 0;
    for (std::size_t g = 0; g < groups; ++g) {
        others.clear();
        std::ranges::copy_if(sorted, std::back_inserter(others), [&](const Entry& entry) { return entry.group != g; });
        leave_one_out.push_back(binned_index(others, bins).value());
        bias += (leave_one_out.back() - all.value()) * static_cast<double>(groups - 1) / static_cast<double>(groups);
    }
    return {all.value(),
            std::hypot(jackknife_half_width(leave_one_out), all.within, missed_by_bins(sorted, all, bins)) +
                std::max(0.0, bias)};
}

/// Base rows of a Saltelli design whose d + 2 values are all there.
struct RadialRows {
    std::size_t dimensions;
    std::vector<std::span<const double>> rows;
    [[nodiscard]] std::size_t stretch_of(std::size_t k) const { return k * batches_of_sample / rows.size(); }
};

struct RadialEstimates {
    std::vector<double> first, first_jansen, total;
};

RadialEstimates radial_estimates(const RadialRows& base, std::size_t left_out) {
    const std::size_t d = base.dimensions;
    RadialEstimates sums{std::vector<double>(d), std::vector<double>(d), std::vector<double>(d)};
    Moments moments;
    double n = 0;
    for (std::size_t k = 0; k < base.rows.size(); ++k) {
        if (left_out != no_index && base.stretch_of(k) == left_out) continue;
        const auto row = base.rows[k];
        const double a = row[0];
        const double b = row[1];
        moments.add(a);
        moments.add(b);
        n += 1;
        for (std::size_t j = 0; j < d; ++j) {
            const double mixed = row[2 + j];
            sums.first[j] += b * (mixed - a);
            sums.first_jansen[j] += square(b - mixed);
            sums.total[j] += square(a - mixed);
        }
    }
    const double sd = moments.summary().sd;
    const double variance = sd > 0 ? square(sd) : undefined;
    for (std::size_t j = 0; j < d; ++j) {
        sums.first[j] /= n * variance;
        sums.first_jansen[j] = 1 - 0.5 * sums.first_jansen[j] / (n * variance);
        sums.total[j] *= 0.5 / (n * variance);
    }
    return sums;
}

}  // namespace

GivenDataIndices first_order_indices(std::span<const double> points, std::size_t dimensions,
                                     std::span<const double> values, std::span<const std::size_t> groups,
                                     std::size_t bins) {
    assert(points.size() == values.size() * dimensions);
    assert(groups.empty() || groups.size() == values.size());
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (std::isfinite(values[i])) used.push_back(i);

    GivenDataIndices indices;
    indices.count = static_cast<std::int64_t>(used.size());
    indices.excluded = static_cast<std::int64_t>(values.size() - used.size());
    const std::size_t group_count = groups.empty() ? batches_of_sample : *std::ranges::max_element(groups) + 1;
    std::vector<Entry> entries(used.size());
    for (std::size_t j = 0; j < dimensions; ++j) {
        for (std::size_t i = 0; i < used.size(); ++i)
            entries[i] = {.x = points[used[i] * dimensions + j],
                          .y = values[used[i]],
                          .group = groups.empty() ? i * batches_of_sample / used.size() : groups[used[i]]};
        std::ranges::stable_sort(entries, {}, &Entry::x);
        const BinnedIndex all = binned_index(entries, bins);
        indices.first.push_back(binned_with_error(entries, all, group_count, bins));
        indices.within_bins.push_back(all.within);
    }
    return indices;
}

SaltelliIndices saltelli_indices(std::span<const double> values, std::size_t dimensions) {
    const std::size_t block = dimensions + 2;
    RadialRows base{.dimensions = dimensions, .rows = {}};
    SaltelliIndices indices;
    for (std::size_t start = 0; start + block <= values.size(); start += block) {
        const auto row = values.subspan(start, block);
        if (std::ranges::all_of(row, [](double y) { return std::isfinite(y); }))
            base.rows.push_back(row);
        else
            ++indices.excluded;
    }
    indices.count = static_cast<std::int64_t>(base.rows.size());
    const RadialEstimates all = radial_estimates(base, no_index);
    std::vector<RadialEstimates> parts;
    if (base.rows.size() >= 2 * batches_of_sample)
        for (std::size_t g = 0; g < batches_of_sample; ++g) parts.push_back(radial_estimates(base, g));
    const auto with_error = [&](std::vector<double> RadialEstimates::*kind) {
        std::vector<SensitivityIndex> list;
        for (std::size_t j = 0; j < dimensions; ++j) {
            std::vector<double> leave_one_out;
            for (const auto& part : parts) leave_one_out.push_back((part.*kind)[j]);
            list.push_back({.value = (all.*kind)[j], .half_width = jackknife_half_width(leave_one_out)});
        }
        return list;
    };
    indices.first = with_error(&RadialEstimates::first);
    indices.first_jansen = with_error(&RadialEstimates::first_jansen);
    indices.total = with_error(&RadialEstimates::total);
    return indices;
}

namespace {

/// The group in which two points differ, and the mean size of the moves of its factors; signed where it has one factor.
struct Move {
    std::size_t group = no_index;
    double size = 0;
};

/// Which factors are in which group.
struct Groups {
    std::vector<std::size_t> of, sizes;

    Groups(std::size_t dimensions, std::span<const std::size_t> given) : of(given.begin(), given.end()) {
        if (of.empty()) {
            of.resize(dimensions);
            std::iota(of.begin(), of.end(), std::size_t{0});
        }
        sizes.resize(*std::ranges::max_element(of) + 1);
        for (const auto group : of) ++sizes[group];
    }
};

Move move_between(std::span<const double> before, std::span<const double> after, const Groups& groups,
                  std::size_t step) {
    Move move;
    bool several = false;
    for (std::size_t j = 0; j < before.size(); ++j) {
        if (before[j] == after[j]) continue;
        several = several || (move.group != no_index && move.group != groups.of[j]);
        move.group = groups.of[j];
        const double moved = after[j] - before[j];
        move.size += groups.sizes[move.group] == 1 ? moved : std::abs(moved);
    }
    if (several || move.group == no_index)
        throw std::invalid_argument("between points " + std::to_string(step - 1) + " and " + std::to_string(step) +
                                    " not exactly one factor moves: these are no Morris trajectories");
    move.size /= static_cast<double>(groups.sizes[move.group]);
    return move;
}

ElementaryEffects summary_of(std::span<const double> effects, bool directed) {
    ElementaryEffects summary;
    const auto count = static_cast<double>(effects.size());
    summary.count = static_cast<std::int64_t>(effects.size());
    if (effects.empty()) return summary;
    std::vector<double> magnitudes(effects.size());
    std::ranges::transform(effects, magnitudes.begin(), [](double e) { return std::abs(e); });
    summary.mu_star = std::accumulate(magnitudes.begin(), magnitudes.end(), 0.0) / count;
    summary.mu_star_half_width = student_half_width(magnitudes);
    if (!directed) return summary;
    summary.mu = std::accumulate(effects.begin(), effects.end(), 0.0) / count;
    double squares = 0;
    for (const double effect : effects) squares += square(effect - summary.mu);
    if (count > 1) summary.sigma = std::sqrt(squares / (count - 1));
    return summary;
}

}  // namespace

std::vector<ElementaryEffects> elementary_effects(std::span<const double> points, std::size_t dimensions,
                                                  std::span<const double> values, std::span<const std::size_t> given) {
    assert(points.size() == values.size() * dimensions);
    const Groups groups(dimensions, given);
    const std::size_t length = groups.sizes.size() + 1;
    std::vector<std::vector<double>> effects(groups.sizes.size());
    std::vector<std::int64_t> excluded(groups.sizes.size());
    for (std::size_t p = 0; p + 1 < values.size(); ++p) {
        if ((p + 1) % length == 0) continue;  // the next point begins a trajectory
        const auto move = move_between(points.subspan(p * dimensions, dimensions),
                                       points.subspan((p + 1) * dimensions, dimensions), groups, p + 1);
        const double effect = (values[p + 1] - values[p]) / move.size;
        if (std::isfinite(effect))
            effects[move.group].push_back(effect);
        else
            ++excluded[move.group];
    }
    std::vector<ElementaryEffects> summaries;
    for (std::size_t g = 0; g < effects.size(); ++g) {
        summaries.push_back(summary_of(effects[g], groups.sizes[g] == 1));
        summaries.back().excluded = excluded[g];
    }
    return summaries;
}

}  // namespace grainsweep::stats

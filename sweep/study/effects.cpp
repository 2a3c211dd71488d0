#include "sweep/study/effects.hpp"

#include "stats/confidence.hpp"
#include "sweep/study/sample_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace grainsweep::study {
namespace {

constexpr std::size_t most_bins = 16;
constexpr std::size_t fewest_per_bin = 8;
constexpr std::size_t fewest_parts = 4;

/// One settled case with a response.
struct Entry {
    double factor, response;
    std::size_t part;
};

/// 95 % half-width of the mean of a bin from the parts of the sample that have cases in it.
double error_of_parts(std::span<const Entry> entries) {
    struct Sum {
        double total = 0, count = 0;
    };
    std::map<std::size_t, Sum> parts;
    Sum all;
    for (const auto& entry : entries) {
        Sum& part = parts[entry.part];
        part.total += entry.response;
        part.count += 1;
        all.total += entry.response;
        all.count += 1;
    }
    if (parts.size() < fewest_parts) return std::numeric_limits<double>::quiet_NaN();
    std::vector<double> leave_one_out;
    for (const auto& [label, part] : parts)
        leave_one_out.push_back((all.total - part.total) / (all.count - part.count));
    return stats::jackknife_half_width(leave_one_out);
}

EffectBin bin_of(std::span<const Entry> entries, const EffectErrors& errors) {
    EffectBin bin;
    for (const auto& entry : entries) {
        bin.at += entry.factor;
        bin.mean += entry.response;
    }
    const auto n = static_cast<double>(entries.size());
    bin.at /= n;
    bin.mean /= n;
    bin.count = std::ssize(entries);
    bin.pure_error = errors.pure.half_width(n);
    bin.error = errors.source == EffectErrors::Source::parts        ? error_of_parts(entries)
                : errors.source == EffectErrors::Source::pure_error ? bin.pure_error
                                                                    : std::numeric_limits<double>::quiet_NaN();
    return bin;
}

/// Ends of the runs of equal factor values.
std::vector<std::size_t> ends_of_runs(std::span<const Entry> sorted) {
    std::vector<std::size_t> ends;
    for (std::size_t i = 1; i <= sorted.size(); ++i)
        if (i == sorted.size() || sorted[i].factor != sorted[i - 1].factor) ends.push_back(i);
    return ends;
}

}  // namespace

Histogram histogram_of(std::span<const double> values) {
    Histogram histogram;
    std::vector<double> finite;
    std::ranges::copy_if(values, std::back_inserter(finite), [](double x) { return std::isfinite(x); });
    if (finite.empty()) return histogram;
    const auto [low, high] = std::ranges::minmax(finite);
    histogram.low = low;
    histogram.high = high;
    const double width = high - low;
    const auto rice = static_cast<std::size_t>(std::ceil(2 * std::cbrt(static_cast<double>(finite.size()))));
    const std::size_t bins = width > 0 ? std::clamp<std::size_t>(rice, 5, 40) : 1;
    histogram.counts.resize(bins);
    for (const double x : finite) {
        const double share = width > 0 ? (x - low) / width : 0;
        ++histogram.counts[std::min(bins - 1, static_cast<std::size_t>(share * static_cast<double>(bins)))];
    }
    return histogram;
}

EffectErrors effect_errors(const Responses& responses, const ResponseColumn& response) {
    EffectErrors errors;
    errors.pure = stats::pure_error(std::span(responses.points).first(responses.settled), responses.judged(response));
    auto parts = sample_parts(responses);
    if (responses.ordered_sample()) {
        errors.source = EffectErrors::Source::parts;
        errors.parts = std::move(parts.labels);
        errors.says =
            fmt::format("95 %, from {}; none where a mean is over fewer than {} of them", parts.what, fewest_parts);
    } else if (errors.pure.freedom > 0) {
        errors.source = EffectErrors::Source::pure_error;
        errors.says = fmt::format("95 %, from the scatter of replicates (pure error, {} degrees of freedom)",
                                  errors.pure.freedom);
    } else {
        errors.says =
            fmt::format("none: a {} of single runs gives no error; replicates would", responses.campaign.design);
    }
    return errors;
}

std::vector<EffectBin> main_effect(const FactorColumn& factor, std::span<const double> response,
                                   const EffectErrors& errors) {
    std::vector<Entry> entries;
    for (std::size_t i = 0; i < response.size(); ++i)
        if (std::isfinite(response[i]) && std::isfinite(factor.values[i]))
            entries.push_back({factor.values[i], response[i], errors.parts.empty() ? 0 : errors.parts[i]});
    std::ranges::stable_sort(entries, {}, &Entry::factor);
    auto ends = ends_of_runs(entries);
    if (factor.continuous() && ends.size() > most_bins) {
        const std::size_t bins = std::clamp<std::size_t>(entries.size() / fewest_per_bin, 1, most_bins);
        ends.clear();
        for (std::size_t b = 1; b <= bins; ++b) ends.push_back(entries.size() * b / bins);
    }
    std::vector<EffectBin> effect;
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        effect.push_back(bin_of(std::span(entries).subspan(begin, end - begin), errors));
        begin = end;
    }
    return effect;
}

namespace {

constexpr std::size_t most_distinct = 12;
constexpr double fewest_cells = 3, most_cells = 14, cases_per_cell = 8;

std::vector<double> edges_between(const std::vector<double>& distinct) {
    if (distinct.size() == 1) return {distinct.front() - 0.5, distinct.front() + 0.5};
    std::vector<double> edges(1);
    for (std::size_t k = 1; k < distinct.size(); ++k) edges.push_back((distinct[k - 1] + distinct[k]) / 2);
    edges.front() = 2 * distinct.front() - edges[1];
    edges.push_back(2 * distinct.back() - edges.back());
    return edges;
}

std::vector<double> edges_of(const FactorColumn& factor, const std::vector<std::size_t>& rows) {
    std::vector<double> edges;
    if (!factor.continuous()) {
        for (std::size_t k = 0; k <= factor.seen.size(); ++k) edges.push_back(static_cast<double>(k) - 0.5);
        return edges;
    }
    std::set<double> distinct;
    for (const auto row : rows) distinct.insert(factor.values[row]);
    if (distinct.size() <= most_distinct) return edges_between({distinct.begin(), distinct.end()});
    const auto wanted = std::floor(std::sqrt(static_cast<double>(rows.size()) / cases_per_cell));
    const double count = std::clamp(wanted, fewest_cells, most_cells);
    auto [low, high] = factor.ends();
    if (!(high > low)) low = *distinct.begin(), high = *distinct.rbegin();
    const bool log = factor.log() && low > 0;
    for (double k = 0; k <= count; ++k)
        edges.push_back(log ? low * std::pow(high / low, k / count) : low + (high - low) * k / count);
    return edges;
}

/// Returns the cell of a value; the cells at the ends include values that rounding puts beyond.
std::size_t cell_of(const std::vector<double>& edges, double x) {
    const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, x);
    return static_cast<std::size_t>(above - edges.begin()) - 1;
}

}  // namespace

CellMeans cell_means(const FactorColumn& across, const FactorColumn& up, const ResponseColumn& response) {
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < response.values.size(); ++row)
        if (std::isfinite(response.values[row]) && std::isfinite(across.values[row]) && std::isfinite(up.values[row]))
            rows.push_back(row);
    if (rows.empty()) return {};
    CellMeans cells{edges_of(across, rows), edges_of(up, rows), {}};
    const std::size_t columns = cells.x_edges.size() - 1;
    std::vector<double> counts(columns * (cells.y_edges.size() - 1), 0.0);
    cells.means.assign(counts.size(), 0.0);
    for (const auto row : rows) {
        const auto cell = cell_of(cells.y_edges, up.values[row]) * columns + cell_of(cells.x_edges, across.values[row]);
        counts[cell] += 1;
        cells.means[cell] += (response.values[row] - cells.means[cell]) / counts[cell];
    }
    for (std::size_t k = 0; k < counts.size(); ++k)
        if (counts[k] == 0) cells.means[k] = std::numeric_limits<double>::quiet_NaN();
    return cells;
}

}  // namespace grainsweep::study

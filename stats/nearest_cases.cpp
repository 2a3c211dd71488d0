#include "stats/nearest_cases.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::stats {
namespace {

constexpr std::size_t neighbours = 5;
constexpr double rounding = 1 + 1e-9;  // of a squared distance

/// D_j of the header; 1 where all cases or none failed.
double separation(std::vector<double> of_failed, std::vector<double> of_answered) {
    if (of_failed.empty() || of_answered.empty()) return 1;
    std::ranges::sort(of_failed);
    std::ranges::sort(of_answered);
    double largest = 0;
    for (std::size_t i = 0, k = 0; i < of_failed.size() && k < of_answered.size();) {
        const double x = std::min(of_failed[i], of_answered[k]);
        while (i < of_failed.size() && of_failed[i] <= x) ++i;
        while (k < of_answered.size() && of_answered[k] <= x) ++k;
        largest = std::max(largest, std::abs(static_cast<double>(i) / static_cast<double>(of_failed.size()) -
                                             static_cast<double>(k) / static_cast<double>(of_answered.size())));
    }
    return largest;
}

}  // namespace

double squared_distance(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (std::size_t j = 0; j < a.size(); ++j) sum += (a[j] - b[j]) * (a[j] - b[j]);
    return sum;
}

NearestCases::NearestCases(std::vector<double> rows, std::size_t width, std::vector<bool> failed)
    : rows_(std::move(rows)), failed_(std::move(failed)), any_failed_(std::ranges::count(failed_, true) > 0) {
    for (std::size_t j = 0; j < width; ++j) {
        std::vector<double> of_failed, of_answered;
        for (std::size_t i = 0; i < failed_.size(); ++i)
            (failed_[i] ? of_failed : of_answered).push_back(rows_[i * width + j]);
        const double d = separation(std::move(of_failed), std::move(of_answered));
        weights_.push_back(d * d);
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i] *= weights_[i % width];
}

NearestCases::Near NearestCases::at(std::span<const double> point) const {
    Near near{.cases = std::min(neighbours, failed_.size()), .failed = {}};
    if (!any_failed_) return near;
    const auto width = weights_.size();
    std::vector<double> there(point.begin(), point.end()), distance;
    for (std::size_t j = 0; j < width; ++j) there[j] *= weights_[j];
    const auto row = [&](std::size_t i) { return std::span(rows_).subspan(i * width, width); };
    for (std::size_t i = 0; i < failed_.size(); ++i) distance.push_back(squared_distance(row(i), there));
    auto ordered = distance;
    const auto last = ordered.begin() + static_cast<std::ptrdiff_t>(near.cases - 1);
    std::ranges::nth_element(ordered, last);
    const double reach = *last * rounding, nearest = *std::min_element(ordered.begin(), last + 1) * rounding;
    std::size_t first = 0, first_failed = 0;
    near.cases = 0;
    for (std::size_t i = 0; i < distance.size(); ++i) {
        if (distance[i] > reach) continue;
        ++near.cases;
        if (failed_[i]) near.failed.push_back(i);
        if (distance[i] > nearest) continue;
        ++first;
        if (failed_[i]) ++first_failed;
    }
    near.answers = 2 * first_failed <= first && 2 * near.failed.size() <= near.cases;
    const auto closest = static_cast<std::size_t>(std::ranges::min_element(distance) - distance.begin());
    near.beside = !near.answers || std::ranges::any_of(near.failed, [&](std::size_t i) {
        return distance[i] * rounding < squared_distance(row(i), row(closest));
    });
    return near;
}

}  // namespace grainsweep::stats

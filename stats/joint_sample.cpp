#include "stats/joint_sample.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace grainsweep::stats {
namespace {

/// The largest m with m^columns <= rows.
std::size_t pieces_of(std::size_t rows, std::size_t columns) {
    const auto fits = [&](std::size_t m) {
        std::size_t power = 1;
        for (std::size_t k = 0; k < columns; ++k) {
            if (power > rows / m) return false;
            power *= m;
        }
        return true;
    };
    std::size_t low = 1, high = rows;
    while (low < high) {
        const std::size_t middle = high - (high - low) / 2;
        if (fits(middle))
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

/// Returns the first row of part p, if `rows` rows make m parts.
std::size_t begin_of_part(std::size_t rows, std::size_t parts, std::size_t p) {
    return rows * p / parts;
}

/// The part that holds the share u of the rows.
std::size_t part_at(std::size_t rows, std::size_t parts, double u) {
    const double at = std::clamp(u, 0.0, 1.0) * static_cast<double>(rows);
    auto p = std::min(static_cast<std::size_t>(at * static_cast<double>(parts) / static_cast<double>(rows)), parts - 1);
    while (p + 1 < parts && static_cast<double>(begin_of_part(rows, parts, p + 1)) <= at) ++p;
    while (p > 0 && static_cast<double>(begin_of_part(rows, parts, p)) > at) --p;
    return p;
}

}  // namespace

JointSample::JointSample(std::vector<std::vector<double>> columns) : columns_(std::move(columns)) {
    assert(!columns_.empty() && !columns_.front().empty());
    sorted_ = columns_;
    for (auto& column : sorted_) std::ranges::sort(column);
    order_.resize(rows());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    divide(0, rows(), 0);
    by_value_.resize(rows());
    std::iota(by_value_.begin(), by_value_.end(), std::size_t{0});
    std::ranges::sort(by_value_, [&](std::size_t a, std::size_t b) {
        for (const auto& column : columns_)
            if (column[order_[a]] != column[order_[b]]) return column[order_[a]] < column[order_[b]];
        return a < b;
    });
}

void JointSample::divide(std::size_t begin, std::size_t end, std::size_t column) {
    std::sort(order_.begin() + static_cast<std::ptrdiff_t>(begin), order_.begin() + static_cast<std::ptrdiff_t>(end),
              [&](std::size_t a, std::size_t b) {
                  for (std::size_t k = column; k < columns(); ++k)
                      if (columns_[k][a] != columns_[k][b]) return columns_[k][a] < columns_[k][b];
                  return a < b;
              });
    if (column + 1 == columns()) return;
    const std::size_t count = end - begin, parts = pieces_of(count, columns() - column);
    for (std::size_t p = 0; p < parts; ++p)
        divide(begin + begin_of_part(count, parts, p), begin + begin_of_part(count, parts, p + 1), column + 1);
}

std::size_t JointSample::row_at(std::span<const double> u) const {
    assert(u.size() == columns());
    std::size_t begin = 0, count = rows();
    for (std::size_t k = 0; k < columns(); ++k) {
        const std::size_t parts = pieces_of(count, columns() - k), p = part_at(count, parts, u[k]);
        const std::size_t first = begin_of_part(count, parts, p);
        count = begin_of_part(count, parts, p + 1) - first;
        begin += first;
    }
    return order_[begin];
}

std::optional<std::vector<double>> JointSample::place_of(std::span<const double> values) const {
    assert(values.size() == columns());
    const auto order_of = [&](std::size_t place) {
        for (std::size_t k = 0; k < columns(); ++k)
            if (const double x = columns_[k][order_[place]]; x != values[k]) return x < values[k] ? -1 : 1;
        return 0;
    };
    const auto first = std::ranges::partition_point(by_value_, [&](std::size_t i) { return order_of(i) < 0; });
    const auto last = std::partition_point(first, by_value_.end(), [&](std::size_t i) { return order_of(i) == 0; });
    if (first == last) return std::nullopt;
    const std::size_t place = *(first + (last - first) / 2);
    std::vector<double> middle;
    std::size_t begin = 0, count = rows();
    for (std::size_t k = 0; k < columns(); ++k) {
        const std::size_t parts = pieces_of(count, columns() - k);
        std::size_t p = 0;
        while (p + 1 < parts && begin + begin_of_part(count, parts, p + 1) <= place) ++p;
        const std::size_t from = begin_of_part(count, parts, p), to = begin_of_part(count, parts, p + 1);
        middle.push_back(static_cast<double>(from + to) / (2 * static_cast<double>(count)));
        begin += from;
        count = to - from;
    }
    return middle;
}

double JointSample::quantile(std::size_t column, double u) const {
    const auto& x = sorted_[column];
    const double at = u * static_cast<double>(x.size()) - 0.5;
    if (at <= 0) return x.front();
    const auto below = static_cast<std::size_t>(at);
    if (below + 1 >= x.size()) return x.back();
    return std::clamp(std::lerp(x[below], x[below + 1], at - static_cast<double>(below)), x[below], x[below + 1]);
}

double JointSample::cumulative(std::size_t column, double x) const {
    const auto& values = sorted_[column];
    const auto n = static_cast<double>(values.size());
    const auto [first, last] = std::ranges::equal_range(values, x);
    const auto below = static_cast<double>(first - values.begin()), upto = static_cast<double>(last - values.begin());
    if (first != last) {
        const double from = first == values.begin() ? 0 : below + 0.5, to = last == values.end() ? n : upto - 0.5;
        return (from + to) / (2 * n);
    }
    if (first == values.begin()) return 0;
    if (first == values.end()) return 1;
    const double low = *(first - 1);
    return (below - 0.5 + (x - low) / (*first - low)) / n;
}

}  // namespace grainsweep::stats

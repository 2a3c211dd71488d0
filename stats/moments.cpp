#include "stats/moments.hpp"

#include "stats/undefined.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <vector>

namespace grainsweep::stats {
namespace {

constexpr std::int64_t chunk_length = 1000;

/// A positive sum of powers that has neither overflowed nor lost digits to underflow.
bool sound(double sum) {
    return std::isfinite(sum) && sum >= 1e-290;
}

}  // namespace

std::string_view to_string(Statistic statistic) {
    constexpr std::array<std::string_view, statistics.size()> names = {"mean", "sd", "skewness", "g1", "kurtosis"};
    return names[static_cast<std::size_t>(statistic)];
}

std::optional<Statistic> statistic_named(std::string_view word) {
    const auto found = std::ranges::find(statistics, word, [](Statistic s) { return to_string(s); });
    if (found == statistics.end()) return std::nullopt;
    return *found;
}

double Summary::of(Statistic statistic) const {
    switch (statistic) {
        case Statistic::mean:
            return mean;
        case Statistic::sd:
            return sd;
        case Statistic::skewness:
            return skewness;
        case Statistic::g1:
            return g1;
        case Statistic::kurtosis:
            return kurtosis;
    }
    return undefined;
}

void Moments::Sums::add(double x) {
    const auto before = static_cast<double>(count);
    ++count;
    const auto n = static_cast<double>(count);
    const double delta = x - mean;
    const double step = delta / n;
    const double step2 = step * step;
    const double term = delta * step * before;
    mean += step;
    m4 += term * step2 * (n * n - 3 * n + 3) + 6 * step2 * m2 - 4 * step * m3;
    m3 += term * step * (n - 2) - 3 * step * m2;
    m2 += term;
}

void Moments::Sums::merge(const Sums& other, double shift_difference) {
    if (other.count == 0) return;
    const auto na = static_cast<double>(count);
    const auto nb = static_cast<double>(other.count);
    const double n = na + nb;
    const double delta = (other.mean - mean) + shift_difference;
    const double step = delta / n;
    const double spread = delta * step * na * nb;  // delta^2 na nb / n
    m4 += other.m4 + spread * step * step * (na * na - na * nb + nb * nb) +
          6 * step * step * (na * na * other.m2 + nb * nb * m2) + 4 * step * (na * other.m3 - nb * m3);
    m3 += other.m3 + spread * step * (na - nb) + 3 * step * (na * other.m2 - nb * m2);
    m2 += other.m2 + spread;
    mean += nb * step;
    count += other.count;
}

void Moments::add(double value) {
    if (!std::isfinite(value)) {
        ++excluded_;
        return;
    }
    if (count() == 0) shift_ = value;
    if (value == 0) ++zeros_;
    minimum_ = std::min(minimum_, value);
    maximum_ = std::max(maximum_, value);
    chunk_.add(value - shift_);
    if (chunk_.count == chunk_length) {
        total_.merge(chunk_, 0);
        chunk_ = {};
    }
}

void Moments::add(std::span<const double> values) {
    for (const double value : values) add(value);
}

Moments::Sums Moments::all() const {
    Sums sums = total_;
    sums.merge(chunk_, 0);
    return sums;
}

void Moments::merge(const Moments& other) {
    excluded_ += other.excluded_;
    if (other.count() == 0) return;
    if (count() == 0) shift_ = other.shift_;
    total_ = all();
    chunk_ = {};
    total_.merge(other.all(), other.shift_ - shift_);
    zeros_ += other.zeros_;
    minimum_ = std::min(minimum_, other.minimum_);
    maximum_ = std::max(maximum_, other.maximum_);
}

double Middle::median() const {
    return std::midpoint(low, high);
}

Summary Moments::summary() const {
    return summary(Middle{});
}

Summary Moments::summary(Middle middle) const {
    Summary s;
    const Sums sums = all();
    s.count = sums.count;
    s.excluded = excluded_;
    s.median = middle.median();
    if (s.count == 0) return s;
    const auto n = static_cast<double>(s.count);
    s.minimum = minimum_;
    s.maximum = maximum_;
    s.zero_share = static_cast<double>(zeros_) / n;
    s.mean = sums.mean + shift_;
    s.sd = 0;
    if (minimum_ == maximum_) {
        s.mean = minimum_;
        return s;  // no spread: the shape is undefined
    }
    // m4 and m2 bound m3, so these two show whether anything was lost.
    const bool variance_sound = sound(sums.m2);
    const bool shape_sound = variance_sound && sound(sums.m4) && std::isfinite(sums.m3);
    s.representable = variance_sound && shape_sound && std::isfinite(s.mean);
    if (!std::isfinite(s.mean)) s.mean = undefined;
    s.sd = variance_sound ? std::sqrt(sums.m2 / n) : undefined;
    // Shifted first, then halved: the median itself may not be a double at a large offset.
    const double shifted_median = std::midpoint(middle.low - shift_, middle.high - shift_);
    if (variance_sound) s.skewness = 3 * (sums.mean - shifted_median) / s.sd;
    if (shape_sound) {
        s.g1 = std::sqrt(n) * sums.m3 / (sums.m2 * std::sqrt(sums.m2));
        s.kurtosis = n * (sums.m4 / sums.m2) / sums.m2;
    }
    return s;
}

Middle middle(std::span<const double> values) {
    std::vector<double> finite;
    finite.reserve(values.size());
    std::ranges::copy_if(values, std::back_inserter(finite), [](double x) { return std::isfinite(x); });
    if (finite.empty()) return {};
    const auto upper = finite.begin() + static_cast<std::ptrdiff_t>(finite.size() / 2);
    std::nth_element(finite.begin(), upper, finite.end());
    const double high = *upper;
    return {finite.size() % 2 == 1 ? high : *std::max_element(finite.begin(), upper), high};
}

Summary summarise(std::span<const double> values) {
    Moments moments;
    moments.add(values);
    return moments.summary(middle(values));
}

}  // namespace grainsweep::stats

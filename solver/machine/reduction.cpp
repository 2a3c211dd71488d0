#include "solver/machine/reduction.hpp"

#include "solver/observables/series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace grainsweep::machine {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double last_of(std::span<const Sample> samples) {
    return samples.empty() ? unknown : samples.back().value;
}

double first_of(std::span<const Sample> samples) {
    return samples.empty() ? unknown : samples.front().value;
}

double mean_of(std::span<const Sample> samples) {
    double sum = 0;
    for (const Sample& sample : samples) sum += sample.value;
    return samples.empty() ? unknown : sum / static_cast<double>(samples.size());
}

double deviation_of(std::span<const Sample> samples) {
    const double mean = mean_of(samples);
    double squares = 0;
    for (const Sample& sample : samples) squares += (sample.value - mean) * (sample.value - mean);
    return samples.empty() ? unknown : std::sqrt(squares / static_cast<double>(samples.size()));
}

double least_of(std::span<const Sample> samples) {
    return samples.empty() ? unknown : std::ranges::min_element(samples, {}, &Sample::value)->value;
}

double greatest_of(std::span<const Sample> samples) {
    return samples.empty() ? unknown : std::ranges::max_element(samples, {}, &Sample::value)->value;
}

double greatest_magnitude_of(std::span<const Sample> samples) {
    double greatest = samples.empty() ? unknown : 0;
    for (const Sample& sample : samples) greatest = std::max(greatest, std::abs(sample.value));
    return greatest;
}

/// Least squares over time.
double slope_of(std::span<const Sample> samples) {
    if (samples.size() < 2) return unknown;
    const double n = static_cast<double>(samples.size());
    double t = 0, x = 0;
    for (const Sample& sample : samples) t += sample.time / n, x += sample.value / n;
    double tt = 0, tx = 0;
    for (const Sample& sample : samples) {
        tt += (sample.time - t) * (sample.time - t);
        tx += (sample.time - t) * (sample.value - x);
    }
    return tt > 0 ? tx / tt : unknown;
}

/// By trapezia over time.
double integral_of(std::span<const Sample> samples) {
    double sum = 0;
    for (std::size_t k = 1; k < samples.size(); ++k)
        sum += (samples[k].time - samples[k - 1].time) * (samples[k].value + samples[k - 1].value) / 2;
    return samples.size() < 2 ? unknown : sum;
}

double change_of(std::span<const Sample> samples) {
    return samples.size() < 2 ? unknown : samples.back().value - samples.front().value;
}

/// Standard error of the mean of a correlated series.
double error_of_mean(std::span<const Sample> samples) {
    std::vector<double> values;
    for (const Sample& sample : samples) values.push_back(sample.value);
    return observables::standard_error_of_mean(values);
}

std::vector<double> rates_between(std::span<const Sample> samples) {
    std::vector<double> rates;
    for (std::size_t k = 1; k < samples.size(); ++k)
        rates.push_back((samples[k].value - samples[k - 1].value) / (samples[k].time - samples[k - 1].time));
    return rates;
}

/// From the rates between frames.
double error_of_slope(std::span<const Sample> samples) {
    return observables::standard_error_of_mean(rates_between(samples));
}

double rate_of(std::span<const Sample> samples) {
    return change_of(samples) / (samples.empty() ? unknown : samples.back().time - samples.front().time);
}

/// Where nothing has changed the blocks have no spread, and that says nothing of the error.
double error_of_rate(std::span<const Sample> samples) {
    constexpr std::size_t blocks = 10;
    const auto rates = rates_between(samples);
    const bool changed = std::ranges::any_of(rates, [](double rate) { return rate != 0; });
    return changed ? observables::block_standard_error(rates, blocks) : unknown;
}

double integral_of_intervals(std::span<const FrameInterval> intervals) {
    double sum = 0;
    for (const FrameInterval& interval : intervals) sum += interval.integral;
    return intervals.empty() ? unknown : sum;
}

double mean_of_intervals(std::span<const FrameInterval> intervals) {
    double length = 0;
    for (const FrameInterval& interval : intervals) length += interval.length;
    return integral_of_intervals(intervals) / length;
}

double error_of_mean_of_intervals(std::span<const FrameInterval> intervals) {
    std::vector<double> means;
    for (const FrameInterval& interval : intervals) means.push_back(interval.integral / interval.length);
    return observables::standard_error_of_mean(means);
}

constexpr std::array all_reductions = {
    ReductionInfo{"mean",
                  "mean over the frames (loads of walls: over every step), with a standard error that counts how long "
                  "values stay alike",
                  Shape::scalar,
                  mean_of,
                  error_of_mean,
                  {},
                  false,
                  mean_of_intervals,
                  error_of_mean_of_intervals},
    ReductionInfo{"last", "value at the last frame", Shape::scalar, last_of, nullptr, {}, true},
    ReductionInfo{"first", "value at the first frame", Shape::scalar, first_of},
    ReductionInfo{"sd", "standard deviation over the frames", Shape::scalar, deviation_of},
    ReductionInfo{"min", "least value over the frames", Shape::scalar, least_of},
    ReductionInfo{"max", "largest value over the frames", Shape::scalar, greatest_of},
    ReductionInfo{"largest_magnitude", "largest magnitude over the frames, whichever its sign", Shape::scalar,
                  greatest_magnitude_of},
    ReductionInfo{
        "change", "value at the last frame less that at the first", Shape::scalar, change_of, nullptr, {}, true},
    ReductionInfo{"slope", "least-squares slope over time, with a standard error from the rates between frames",
                  Shape::scalar, slope_of, error_of_slope, "/s"},
    ReductionInfo{"rate",
                  "change divided by its time, with a standard error from ten blocks of the rates between frames",
                  Shape::scalar, rate_of, error_of_rate, "/s"},
    ReductionInfo{"integral",
                  "integral over time, by trapezia; of a force, torque or pressure of walls over every step",
                  Shape::scalar, integral_of, nullptr, " s", false, integral_of_intervals},
    ReductionInfo{"series", "value at every frame", Shape::series},
    ReductionInfo{"rates", "change from frame to frame divided by its time", Shape::series, nullptr, nullptr, "/s"},
    ReductionInfo{"profile", "mean over the frames, bin by bin", Shape::profile},
    ReductionInfo{"last_profile", "at the last frame", Shape::profile, nullptr, nullptr, {}, true},
    ReductionInfo{"profiles",
                  "at every frame, with its time; bins with the value 0 are left out",
                  Shape::profile,
                  nullptr,
                  nullptr,
                  {},
                  false,
                  nullptr,
                  nullptr,
                  true},
};

}  // namespace

std::span<const ReductionInfo> reduction_catalogue() {
    return all_reductions;
}

const ReductionInfo* find_reduction(std::string_view name) {
    const auto found = std::ranges::find(all_reductions, name, &ReductionInfo::name);
    return found == all_reductions.end() ? nullptr : &*found;
}

std::vector<Sample> with_rates(std::span<const Sample> samples) {
    const auto rates = rates_between(samples);
    std::vector<Sample> changes(samples.begin() + (samples.empty() ? 0 : 1), samples.end());
    for (std::size_t k = 0; k < changes.size(); ++k) changes[k].value = rates[k];
    return changes;
}

std::optional<double> crossing_time(std::span<const Sample> samples, double value, bool above) {
    const auto passed = std::ranges::find_if(
        samples, [&](const Sample& sample) { return above ? sample.value > value : sample.value < value; });
    if (passed == samples.end()) return std::nullopt;
    if (passed == samples.begin()) return passed->time;
    const Sample& before = *(passed - 1);
    return before.time + (passed->time - before.time) * (value - before.value) / (passed->value - before.value);
}

std::vector<FrameInterval> ending_at(std::span<const FrameInterval> intervals, std::span<const Sample> samples) {
    std::vector<FrameInterval> counted;
    for (const FrameInterval& interval : intervals) {
        const auto at = std::ranges::lower_bound(samples, interval.end, {}, &Sample::time);
        if (at != samples.end() && at->time == interval.end) counted.push_back(interval);
    }
    return counted;
}

std::vector<Sample> between_shares(std::span<const Sample> samples, double low, double high) {
    std::vector<Sample> counted;
    for (const Sample& sample : samples) {
        const double first = samples.front().value;
        if (sample.value >= low * first && sample.value <= high * first) counted.push_back(sample);
    }
    return counted;
}

std::vector<Sample> while_between(std::span<const Sample> samples, std::span<const Sample> others, double low,
                                  double high) {
    std::vector<Sample> counted;
    for (const Sample& sample : samples) {
        const auto other = std::ranges::lower_bound(others, sample.time, {}, &Sample::time);
        if (other != others.end() && other->time == sample.time && other->value >= low && other->value <= high)
            counted.push_back(sample);
    }
    return counted;
}

}  // namespace grainsweep::machine

#include "sweep/designs/measured_targets.hpp"

#include "solver/plain_text.hpp"
#include "sweep/designs/curve_place.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace grainsweep::designs {

std::size_t MeasuredTarget::count() const {
    return static_cast<std::size_t>(std::lround(value * static_cast<double>(of.value_or(0))));
}

std::string MeasuredTarget::shown_observable() const {
    return of ? "share without " + place_on_curve(observable).observable : observable;
}

std::vector<double> covariance_of(std::span<const MeasuredTarget> targets) {
    const std::size_t m = targets.size();
    std::vector<double> at(m, 0);
    std::map<std::size_t, std::pair<double, double>> ends;  // of each curve
    for (std::size_t k = 0; k < m; ++k) {
        if (targets[k].curve == 0) continue;
        at[k] = place_on_curve(targets[k].observable).at.value_or(0);
        auto& [low, high] = ends.try_emplace(targets[k].curve, at[k], at[k]).first->second;
        low = std::min(low, at[k]);
        high = std::max(high, at[k]);
    }
    std::vector<double> covariance(m * m, 0);
    for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j < m; ++j) {
            const bool together = i != j && targets[i].curve > 0 && targets[i].curve == targets[j].curve;
            if (i == j) covariance[i * m + j] = std::pow(targets[i].error, 2) + std::pow(targets[i].discrepancy, 2);
            if (!together) continue;
            const auto& [low, high] = ends.at(targets[i].curve);
            covariance[i * m + j] =
                targets[i].discrepancy * targets[j].discrepancy * std::exp(-4 * std::abs(at[i] - at[j]) / (high - low));
        }
    return covariance;
}

std::optional<double> miss_of(const MeasuredTarget& target, std::span<const double> answers) {
    double sum = 0, squares = 0, runs = 0;
    for (const double x : answers)
        if (std::isfinite(x)) sum += x, ++runs;
    if (runs < 2) return std::nullopt;
    const double mean = sum / runs;
    if (target.of) {
        const auto measured = static_cast<double>(*target.of);
        const double p = (sum + static_cast<double>(target.count())) / (runs + measured);
        const double variance = p * (1 - p) * (1 / measured + 1 / runs + 4 * target.discrepancy * target.discrepancy);
        return variance > 0 ? (mean - target.value) / std::sqrt(variance) : 0;
    }
    for (const double x : answers)
        if (std::isfinite(x)) squares += (x - mean) * (x - mean);
    const double scatter = squares / (runs - 1);
    return (mean - target.value) /
           std::sqrt(target.error * target.error + target.discrepancy * target.discrepancy + scatter);
}

std::optional<LargestMiss> largest_miss(std::span<const MeasuredTarget> targets,
                                        std::span<const std::vector<double>> answers) {
    struct Measurement {
        std::size_t first = 0;
        double squares = 0, count = 0;
    };
    std::vector<Measurement> measurements;
    for (std::size_t t = 0; t < std::min(targets.size(), answers.size()); ++t) {
        const auto miss = miss_of(targets[t], answers[t]);
        if (!miss) continue;
        const bool goes_on = targets[t].curve > 0 && !measurements.empty() &&
                             targets[measurements.back().first].curve == targets[t].curve;
        auto& one = goes_on ? measurements.back() : measurements.emplace_back(t);
        one.squares += *miss * *miss;
        ++one.count;
    }
    std::optional<LargestMiss> largest;
    for (const auto& one : measurements)
        if (const double size = std::sqrt(one.squares / one.count); !largest || size > largest->size)
            largest = LargestMiss{size, one.first};
    return largest;
}

std::string text_of(const std::vector<MeasuredTarget>& targets) {
    std::string text;
    for (const auto& target : targets) {
        text += (text.empty() ? "" : "; ") + target.observable;
        for (const double x : {target.value, target.error, target.discrepancy}) text += ' ' + shortest_text(x);
        for (const auto& [name, level] : target.level) text += ' ' + name + ':' + std::to_string(level);
        if (target.curve > 0) text += " #" + std::to_string(target.curve);
        if (target.of) text += " *" + std::to_string(*target.of);
        if (!target.experiment.empty()) text += " /" + target.experiment;
    }
    return text;
}

std::vector<MeasuredTarget> targets_in(std::string_view text) {
    std::vector<MeasuredTarget> targets;
    std::istringstream all{std::string(text)};
    for (std::string one; std::getline(all, one, ';');) {
        std::istringstream words(one);
        auto& target = targets.emplace_back();
        std::vector<std::string> numbers(3);
        words >> target.observable >> numbers[0] >> numbers[1] >> numbers[2];
        double* const fields[] = {&target.value, &target.error, &target.discrepancy};
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            const auto number = any_number_in(numbers[k]);
            if (!number) throw std::invalid_argument("a target is no measurement: '" + one + "'");
            *fields[k] = *number;
        }
        for (std::string word; words >> word;) {
            if (word.starts_with('/')) {
                target.experiment = word.substr(1);
                continue;
            }
            const bool curve = word.starts_with('#'), share = word.starts_with('*');
            const auto mark = curve || share ? 0 : word.find(':');
            auto& number = curve ? target.curve : share ? target.of.emplace() : target.level[word.substr(0, mark)];
            const char* const last = word.data() + word.size();
            if (mark == std::string::npos ||
                std::from_chars(word.data() + mark + 1, last, number) != std::from_chars_result{last, std::errc{}})
                throw std::invalid_argument("a target's condition has no level: '" + word + "'");
        }
    }
    return targets;
}

}  // namespace grainsweep::designs

#include "sweep/designs/answering_settings.hpp"

#include "stats/group_test.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace grainsweep::designs {

AnsweringSettings::AnsweringSettings(stats::Rows settings, const std::vector<bool>& failed) {
    const std::size_t d = settings.dimensions;
    if (std::ranges::count(failed, true) == 0) return;
    const std::vector<double> zeros(d, 0), ones(d, 1);
    const auto test = stats::compare_groups(settings, failed, zeros, ones);
    p_value_ = test.p_value;
    if (test.p_value > dependence_level) return;
    for (std::size_t j = 0; j < d; ++j)
        if (test.p_of_feature[j] <= dependence_level) factors_.push_back(j);
    for (std::size_t j = 0; factors_.empty() && j < d; ++j) factors_.push_back(j);
    std::vector<double> answered;
    for (const bool one : failed) answered.push_back(one ? 0 : 1);
    const auto seen = features(settings);
    const auto width = factors_.size();
    auto fit =
        stats::fit_probability({seen, width}, answered, std::span(zeros).first(width), std::span(ones).first(width));
    if (auto* model = std::get_if<stats::ProbabilityModel>(&fit)) model_ = std::move(*model);
}

std::vector<double> AnsweringSettings::features(stats::Rows points) const {
    std::vector<double> rows;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (const std::size_t j : factors_) rows.push_back(points.row(i)[j]);
    return rows;
}

std::vector<double> AnsweringSettings::log_weights(stats::Rows points) const {
    std::vector<double> weights(points.size(), 0);
    if (!model_) return weights;
    const auto rows = features(points);
    constexpr double half_width = 1.96;  // in standard errors
    const auto predicted = model_->with_errors({rows, factors_.size()});
    for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] = predicted[i].mean + half_width * predicted[i].mean_error < 0.5
                         ? -std::numeric_limits<double>::infinity()
                         : std::log(std::min(predicted[i].mean, 1.0));
    return weights;
}

}  // namespace grainsweep::designs

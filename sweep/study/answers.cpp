#include "sweep/study/answers.hpp"

#include "stats/group_test.hpp"
#include "sweep/campaign/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainsweep::study {
namespace {

constexpr std::size_t neighbours = 5;
constexpr double tie = 1 + 1e-9;  // of a squared distance
constexpr double dependence_level = 0.01;

bool finite(std::span<const double> numbers) {
    return std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
}

/// "3 crashed, 1 unstable" of the failed cases at `rows`.
std::string outcomes_text(const ModelCases& cases, std::span<const std::size_t> rows) {
    std::string text;
    for (const auto outcome : campaign::outcomes) {
        const auto n = std::ranges::count(rows, outcome, [&](std::size_t i) { return cases.failed[i].outcome; });
        if (n > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, campaign::to_string(outcome));
    }
    return text;
}

std::vector<std::size_t> all_failed(const ModelCases& cases) {
    std::vector<std::size_t> rows(cases.failed.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    return rows;
}

std::vector<Setting> failed_then_answered(const ModelCases& cases) {
    std::vector<Setting> settings;
    for (const auto& one : cases.failed) settings.push_back(one.setting);
    settings.insert(settings.end(), cases.settings.begin(), cases.settings.end());
    return settings;
}

}  // namespace

Answers::Answers(const ModelCases& cases) : possible_(cases.possible), failed_(cases.failed.size()) {
    if (failed_ == 0) return;
    const auto settings = failed_then_answered(cases);
    if (!cases.features.empty()) {
        features_ = written_features(cases.factors, cases.features);
        rows_ = rows_of(features_, settings);
    }
    if (rows_.empty() || !finite(rows_)) {
        features_ = default_features(cases.factors);
        rows_ = rows_of(features_, settings);
    }
    const auto width = features_.names.size();
    if (width == 0) return;  // no factor varies
    const auto box = box_of(rows_, width);
    for (std::size_t j = 0; j < width; ++j) lengths_.push_back(box.high[j] - box.low[j]);
    std::vector<double> seen, answered;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        if (i < failed_ && possible_ && !possible_(settings[i])) continue;
        const auto row = std::span(rows_).subspan(i * width, width);
        seen.insert(seen.end(), row.begin(), row.end());
        answered.push_back(i < failed_ ? 0 : 1);
    }
    if (answered.empty() || answered.front() == 1) return;  // the check explains all
    auto fit = stats::fit_probability({seen, width}, answered, box.low, box.high);
    if (auto* model = std::get_if<stats::ProbabilityModel>(&fit)) model_ = std::move(*model);
    if (!model_) return;
    for (std::size_t j = 0; j < width; ++j) lengths_[j] *= model_->quality().lengths[j];
}

std::vector<double> Answers::rows(std::span<const Setting> settings) const {
    return rows_of(features_, settings);
}

std::vector<Answers::Answer> Answers::at(std::span<const Setting> settings) const {
    std::vector<Answer> answers(settings.size());
    if (model_) {
        const auto asked = rows(settings);
        const auto predicted = model_->predict({asked, features_.names.size()});
        for (std::size_t i = 0; i < answers.size(); ++i)
            answers[i] = {predicted[i].mean, predicted[i].mean_low(), predicted[i].mean_high()};
    }
    if (possible_)
        for (std::size_t i = 0; i < answers.size(); ++i)
            if (!possible_(settings[i])) answers[i] = {0, 0, 0};
    return answers;
}

std::vector<bool> Answers::expected(std::span<const Setting> settings) const {
    std::vector<bool> likely(settings.size(), true);
    if (model_) {
        const auto asked = rows(settings);
        likely = model_->likely({asked, features_.names.size()});
    }
    if (possible_)
        for (std::size_t i = 0; i < likely.size(); ++i) likely[i] = likely[i] && possible_(settings[i]);
    return likely;
}

Near Answers::near(const Setting& setting) const {
    Near near;
    if (lengths_.empty()) return near;
    const auto width = lengths_.size();
    const auto there = features_.of(setting);
    if (!finite(there)) return near;
    std::vector<double> distance(rows_.size() / width, 0);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const double apart = (rows_[i] - there[i % width]) / lengths_[i % width];
        distance[i / width] += apart * apart;
    }
    auto ordered = distance;
    const auto last = ordered.begin() + static_cast<std::ptrdiff_t>(std::min(neighbours, ordered.size()) - 1);
    std::ranges::nth_element(ordered, last);
    for (std::size_t i = 0; i < distance.size(); ++i) {
        if (distance[i] > *last * tie) continue;
        ++near.cases;
        if (i < failed_) near.failed.push_back(i);
    }
    return near;
}

std::vector<OutcomeTest> Answers::tests(const ModelCases& cases) const {
    std::vector<OutcomeTest> tests;
    const auto width = features_.names.size();
    if (width == 0 || rows_.empty()) return tests;
    const auto box = box_of(rows_, width);
    for (const auto outcome : campaign::outcomes) {
        std::vector<double> seen;
        std::vector<bool> failed;
        for (std::size_t i = 0; i < rows_.size() / width; ++i) {
            if (i < failed_ &&
                (cases.failed[i].outcome != outcome || (possible_ && !possible_(cases.failed[i].setting))))
                continue;
            const auto row = std::span(rows_).subspan(i * width, width);
            if (!finite(row)) continue;
            seen.insert(seen.end(), row.begin(), row.end());
            failed.push_back(i < failed_);
        }
        const auto count = static_cast<std::size_t>(std::ranges::count(failed, true));
        if (count == 0) continue;
        const auto found = stats::compare_groups({seen, width}, failed, box.low, box.high);
        auto& test = tests.emplace_back(OutcomeTest{outcome, count, found.p_value, {}});
        for (std::size_t j = 0; j < width; ++j)
            if (found.p_of_feature[j] <= dependence_level) test.features.push_back(features_.names[j]);
    }
    return tests;
}

bool OutcomeTest::depends() const {
    return p_value <= dependence_level;
}

std::string OutcomeTest::text() const {
    const auto what = fmt::format("{} ({} case{})", campaign::to_string(outcome), cases, cases == 1 ? "" : "s");
    const auto p = p_value < 0.0015 ? std::string("p <= 0.001") : fmt::format("p = {:.2g}", p_value);
    if (!depends())
        return fmt::format(
            "{}: no evidence that the outcome depends on the factors ({}); if it is no property of the "
            "process, --leave-out {} counts without these cases",
            what, p, campaign::to_string(outcome));
    return fmt::format("{}: the outcome depends on {} ({})", what,
                       features.empty() ? std::string("the factors together") : campaign::listed(features), p);
}

std::string near_text(const ModelCases& cases, const Near& near) {
    if (near.failed.empty()) return fmt::format("none of the {} nearest cases failed", near.cases);
    return fmt::format("{} of the {} nearest cases failed ({})", near.failed.size(), near.cases,
                       outcomes_text(cases, near.failed));
}

std::string left_out_text(const ModelCases& cases) {
    std::vector<std::string_view> names;
    for (const auto outcome : cases.left_out) names.push_back(campaign::to_string(outcome));
    return campaign::listed(names);
}

std::string failed_text(const ModelCases& cases) {
    if (cases.failed.empty()) return {};
    return fmt::format("{} of {} cases failed ({})", cases.failed.size(), cases.failed.size() + cases.settings.size(),
                       outcomes_text(cases, all_failed(cases)));
}

}  // namespace grainsweep::study

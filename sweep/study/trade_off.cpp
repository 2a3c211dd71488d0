#include "sweep/study/trade_off.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace grainsweep::study {
namespace {

/// The best of many settings lies beyond the end of its interval more often than one does: half-widths that hold for
/// some twenty settings, which do not depend on each other, at once (3 standard errors).
constexpr double every_end = 1.53;
constexpr double might_hold = 0.01;  // probability below which no end of an interval makes the condition hold

stats::Hypervolume nothing_dominated(const WindowQuestion& question) {
    const auto& goals = question.goals();
    return {{goals[0].reference, goals[1].reference}, {goals[0].sign > 0, goals[1].sign > 0}};
}

std::array<double, 2> means_of(const Judgement& one) {
    return {one.objectives[0].mean, one.objectives[1].mean};
}

/// The means, each objective moved by so many half-widths of its interval to the better side, or with a minus to the
/// worse one.
std::array<double, 2> moved(const WindowQuestion& question, const Judgement& one, std::array<double, 2> by) {
    auto point = means_of(one);
    for (std::size_t k = 0; k < 2; ++k) {
        const auto& p = one.objectives[k];
        if (!(p.mean_error > 0) || by[k] == 0) continue;
        const bool up = by[k] * question.goals()[k].sign > 0;
        point[k] += std::abs(by[k]) * ((up ? p.mean_high() : p.mean_low()) - p.mean);
    }
    return point;
}

/// What the settings that meet the condition dominate, their objectives moved.
double moved_volume(const WindowQuestion& question, std::span<const Judgement> settings, std::array<double, 2> by) {
    auto volume = nothing_dominated(question);
    for (const auto& one : settings)
        if (question.meets(one)) volume.add(moved(question, one, by));
    return volume.value();
}

/// Adds the settings that meet the condition at an end of an interval only.
void add_possible(stats::Hypervolume& volume, const WindowQuestion& question, std::span<const Judgement> searched) {
    std::vector<Setting> possible;
    for (const auto& one : searched)
        if (one.believed && one.probability >= might_hold && !question.meets(one) &&
            volume.expected_gain({.mean = one.objectives[0].mean, .mean_error = 0},
                                 {.mean = one.objectives[1].mean, .mean_error = 0}) > 0)
            possible.push_back(one.setting);
    for (const auto& one : question.judge(possible, "border of the condition", possible.size())) {
        const bool by_mean = std::ranges::any_of(one.at_ends, [&](double p) { return question.meets(p); });
        if (by_mean || question.meets(one.probability * one.answers_high / one.answers)) volume.add(means_of(one));
    }
}

}  // namespace

std::vector<ComputedSetting> computed_settings(const ModelCases& cases, const WindowQuestion& question,
                                               const Goal& objective, const Goal& against) {
    const auto first = question.values_of(objective), second = question.values_of(against);
    std::map<Setting, std::size_t> known;
    std::vector<ComputedSetting> computed;
    for (std::size_t i = 0; i < cases.settings.size(); ++i) {
        if (!std::isfinite(first[i]) || !std::isfinite(second[i])) continue;
        const auto setting = question.space().searched_part(cases.settings[i]);
        if (!setting) continue;
        Setting key = *setting;  // NaN has no order
        std::ranges::replace_if(
            key, [](double x) { return std::isnan(x); }, 0);
        const auto [found, is_new] = known.try_emplace(std::move(key), computed.size());
        if (is_new) computed.push_back({.setting = *setting, .source = cases.sources[i]});
        auto& one = computed[found->second];
        ++one.runs;
        one.objective += (first[i] - one.objective) / static_cast<double>(one.runs);
        one.against += (second[i] - one.against) / static_cast<double>(one.runs);
    }
    return computed;
}

std::vector<Judgement> judge_computed(const WindowQuestion& question, std::span<const ComputedSetting> computed) {
    std::vector<Setting> settings;
    for (const auto& one : computed) settings.push_back(one.setting);
    return question.judge(settings, "computed settings");
}

stats::Hypervolume dominated(const WindowQuestion& question, std::span<const Judgement> computed) {
    auto volume = nothing_dominated(question);
    for (const auto& one : computed)
        if (question.meets(one)) volume.add(means_of(one));
    return volume;
}

FrontVolume front_volume(const WindowQuestion& question, std::span<const Judgement> computed,
                         std::span<const Judgement> searched) {
    FrontVolume front{.value = dominated(question, computed).value()};
    std::vector<Judgement> all(computed.begin(), computed.end());
    all.insert(all.end(), searched.begin(), searched.end());
    auto box = dominated(question, all);
    const double of_box = box.value();
    for (std::size_t k = 0; k < 2; ++k) {
        const double one = k == 0 ? 1 : 0, other = 1 - one;
        const double better = moved_volume(question, computed, {one, other}) - front.value;
        const double worse = front.value - moved_volume(question, computed, {-one, -other});
        front.error = std::hypot(front.error, std::max(better, worse));
    }
    double above = moved_volume(question, all, {every_end, every_end}) - of_box;
    add_possible(box, question, searched);
    above = std::hypot(above, box.value() - of_box);
    front.further = of_box + box.between_points() + above - front.value;
    return front;
}

std::vector<BatchStanding> standings(const ModelCases& cases, const WindowQuestion& question) {
    if (cases.further.empty() || question.goals().empty()) return {};
    const auto& goals = question.goals();
    const auto computed = computed_settings(cases, question, goals.front(), goals.back());
    const auto judged = judge_computed(question, computed);
    std::vector<BatchStanding> all;
    std::vector<Judgement> so_far;
    for (std::size_t source = 0; source <= cases.further.size(); ++source) {
        auto& here = all.emplace_back(source == 0 ? cases.campaign.name : cases.further[source - 1]);
        here.cases = std::ranges::count(cases.sources, source);
        for (std::size_t i = 0; i < computed.size(); ++i) {
            if (computed[i].source != source || !question.meets(judged[i])) continue;
            so_far.push_back(judged[i]);
        }
        if (goals.size() == 2)
            here.volume = front_volume(question, so_far, {});
        else if (!so_far.empty())
            here.best = *std::ranges::max_element(
                so_far, [&](const Judgement& a, const Judgement& b) { return question.better(b, a); });
    }
    return all;
}

}  // namespace grainsweep::study

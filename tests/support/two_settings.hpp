// Known responses at two settings of the numerics, and campaigns that follow the rule of a tolerance over them.
#pragma once

#include "stats/two_levels.hpp"
#include "tests/support/known_responses.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace grainsweep::tests {

/// A cheap setting that is 4 % too high, more where the first factor is high. `common`: correlation of the scatter of
/// two runs with one seed.
struct TwoSettings {
    KnownResponse expensive;
    double common = 0;
    double cost_ratio = 20;

    [[nodiscard]] double cheap(std::span<const double> u) const {
        return expensive.mean(u) * (1.04 + 0.05 * u[0]) + 0.02;
    }
};

/// Values of a campaign, made as they are needed.
class TwoSettingsCampaign {
public:
    TwoSettingsCampaign(const TwoSettings& settings, std::int64_t most, std::uint64_t seed)
        : settings_(settings),
          set_(ask_design("halton", settings.expensive.dimensions, {{"points", most}, {"sequences", std::int64_t{8}}},
                          seed)),
          noise_(seed, 78) {}

    [[nodiscard]] std::vector<double> cheap(std::int64_t n) const {
        std::vector<double> values;
        for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
            values.push_back(settings_.cheap(set_.point(i)) + settings_.expensive.noise * normal_at(noise_, 2 * i));
        return values;
    }
    [[nodiscard]] std::vector<double> expensive(std::int64_t n) const {
        const double own = std::sqrt(1 - settings_.common * settings_.common);
        std::vector<double> values;
        for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
            values.push_back(settings_.expensive.mean(set_.point(i)) +
                             settings_.expensive.noise *
                                 (settings_.common * normal_at(noise_, 2 * i) + own * normal_at(noise_, 2 * i + 1)));
        return values;
    }
    [[nodiscard]] stats::Rows points(std::int64_t n) const {
        const auto width = settings_.expensive.dimensions;
        return {std::span(set_.coordinates).first(static_cast<std::size_t>(n) * width), width};
    }

private:
    const TwoSettings& settings_;
    designs::PointSet set_;
    stats::Stream noise_;
};

struct TwoLevelCourse {
    stats::TwoLevelCheck check;
    bool within = false;
    std::int64_t before_alone = 0;  ///< values of the cheap setting before the expensive one went on alone
};

/// As `run` does it.
inline TwoLevelCourse follow(const TwoSettingsCampaign& campaign, const stats::TwoLevelRule& rule, bool paired) {
    constexpr std::int64_t sequences = 8;
    auto [points, pairs] = stats::first_sizes(sequences, paired);
    bool passed = false;
    std::int64_t before_alone = 0;
    while (true) {
        const auto cheap = paired ? campaign.cheap(points) : campaign.expensive(points);
        const auto expensive = campaign.expensive(pairs);
        const stats::PairedValues values{cheap, expensive, sequences, campaign.points(points)};
        TwoLevelCourse course{stats::two_level_check(rule, values), false, before_alone};
        course.within = passed && course.check.passes;
        if (course.within || course.check.last()) return course;
        passed = course.check.passes;
        points = course.check.next_points;
        pairs = course.check.next_pairs;
        if (!paired || !stats::alone_costs_less(rule, values)) continue;
        before_alone = std::ssize(cheap);
        const auto own = stats::two_level_check(rule, {expensive, {}, sequences, values.points});
        points = std::max(own.next_points, stats::first_sizes(sequences, false).points);
        pairs = 0;
        paired = passed = false;
    }
}

struct TwoLevelCoverage {
    int campaigns = 0, stopped = 0, mean_held = 0, sd_held = 0, within_goal = 0, switched = 0;
    double points = 0, pairs = 0;
    double alone = 0;  ///< cost of the expensive setting alone / cost of the campaigns

    [[nodiscard]] std::string figures(const std::string& name) const {
        return name + ": mean " + std::to_string(mean_held) + ", sd " + std::to_string(sd_held) + ", goal " +
               std::to_string(within_goal) + " of " + std::to_string(campaigns) + "; stopped " +
               std::to_string(stopped) + ", switched " + std::to_string(switched) + ", points " +
               std::to_string(points) + ", pairs " + std::to_string(pairs) + ", alone " + std::to_string(alone);
    }
};

inline TwoLevelCoverage cover(const TwoSettings& settings, std::vector<stats::Statistic> gates, double tolerance,
                              int campaigns) {
    constexpr std::int64_t most = 6400;
    const stats::TwoLevelRule rule{std::move(gates), tolerance, most, settings.cost_ratio};
    const auto truth = true_statistics(settings.expensive, true);
    TwoLevelCoverage all;
    double cost = 0, cost_alone = 0;
    for (int seed = 1; seed <= campaigns; ++seed) {
        const TwoSettingsCampaign campaign(settings, most, static_cast<std::uint64_t>(seed));
        const auto course = follow(campaign, rule, true);
        bool reached = true;
        for (const auto& moment : course.check.moments) {
            const bool mean = moment.statistic == stats::Statistic::mean;
            const double error = std::abs(moment.value - truth[mean ? 0 : 1]);
            (mean ? all.mean_held : all.sd_held) += error <= moment.together ? 1 : 0;
            reached = reached && error <= tolerance * truth[mean ? 0 : 1];
        }
        ++all.campaigns;
        all.stopped += course.within ? 1 : 0;
        all.within_goal += reached ? 1 : 0;
        const bool alone = course.before_alone > 0;
        all.switched += alone ? 1 : 0;
        const auto points = static_cast<double>(alone ? course.before_alone : course.check.points);
        const auto pairs = static_cast<double>(alone ? course.check.points : course.check.pairs);
        all.points += points / campaigns;
        all.pairs += pairs / campaigns;
        cost += points + pairs * settings.cost_ratio;
        cost_alone += static_cast<double>(follow(campaign, rule, false).check.points) * settings.cost_ratio;
    }
    all.alone = cost_alone / cost;
    return all;
}

}  // namespace grainsweep::tests

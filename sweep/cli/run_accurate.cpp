#include "sweep/cli/run_accurate.hpp"

#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/program_campaign.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/study/corrected.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <optional>
#include <ranges>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t pilot_rounds = 2;  // points of each sequence

/// Setting and predicted cost of its cases. Measured time would make the course depend on the machine.
struct CostedSetting {
    std::string name;
    double seconds = 0;
    campaign::CaseHash first_case{};
};

class AccurateRun {
public:
    explicit AccurateRun(const RunRequest& request)
        : request_(request), asked_(read_with_program(request.config)), goal_(*campaign::remarks_in(asked_.text).goal) {
        if (request_.database.empty()) request_.database = asked_.name + ".db";
        sequences_ = designs::independent_sequences(asked_.design, asked_.request);
        most_ = campaign::candidates_of(asked_);
        measure_ = study::name_at(asked_.name, measure());
    }

    RunReport operator()() {
        campaign::asked_in(request_.config, [&] { find_settings(); });
        if (!goal_.setting) goal_.setting = stored_setting();
        if (!goal_.setting && !choose()) return std::move(*ended_);
        forget_earlier_checks();
        while (advance()) {
        }
        ended_->campaign = asked_.name;
        if (!ended_->finished) return std::move(*ended_);
        const store::Store store(request_.database, store::Store::Mode::read);
        const auto records = store.campaigns();
        const auto record = std::ranges::find(records, asked_.name, &store::CampaignRecord::name);
        const auto found = study::corrected_of(store, *record);
        ended_->ending = found->verdict();
        ended_->converged = found->within;
        return std::move(*ended_);
    }

private:
    [[nodiscard]] std::string text_at(const std::string& setting, std::int64_t points, bool keeps_goal) const {
        return campaign::at_setting(asked_.text,
                                    {.name = keeps_goal ? asked_.name : study::name_at(asked_.name, setting),
                                     .setting = setting,
                                     .points = points,
                                     .numerical = asked_.common_random_numbers,
                                     .keeps_goal = keeps_goal});
    }
    /// Those that differ, `reference` last.
    void find_settings() {
        const auto add = [&](const std::string& name) {
            const auto at = parse_with_program(text_at(name, pilot_rounds * sequences_, false), request_.config);
            const auto cases = campaign::unfold(at, store::make_filter(at.where, campaign::filter_names(at)));
            const auto cost = campaign::forecast(at.scene(), cases);
            settings_.push_back({name, cost.total_seconds / static_cast<double>(cost.questions), cases.hash(0)});
        };
        add(measure());
        for (const auto& name : std::views::keys(asked_.scene().accuracy)) {
            if (name == campaign::AccuracyGoal::measure) continue;
            add(name);
            const auto before = std::span(settings_).first(settings_.size() - 1);
            const bool known = std::ranges::count(before, settings_.back().first_case, &CostedSetting::first_case) > 0;
            if (known && name != goal_.setting) settings_.pop_back();
        }
        std::ranges::rotate(settings_, settings_.begin() + 1);
    }
    /// That of an earlier run.
    [[nodiscard]] std::optional<std::string> stored_setting() const {
        if (!fs::exists(request_.database)) return std::nullopt;
        const store::Store store(request_.database, store::Store::Mode::read);
        for (const auto& record : store.campaigns())
            if (record.name == asked_.name)
                if (const auto goal = campaign::remarks_in(record.text).goal) return goal->setting;
        return std::nullopt;
    }
    /// Runs the pilot. False: it did not end.
    bool choose() {
        const std::int64_t points = pilot_rounds * sequences_;
        for (const auto& setting : settings_)
            if (!compute(text_at(setting.name, points, false))) return false;
        const store::Store store(request_.database, store::Store::Mode::read);
        std::vector<std::vector<double>> values;
        const auto factors = study::first_factors(store, measure_, points);
        stats::Pilot pilot{{}, static_cast<std::size_t>(sequences_), factors.view()};
        for (const auto& setting : settings_)
            values.push_back(
                study::first_values(store, study::name_at(asked_.name, setting.name), goal_.observable, points).values);
        for (std::size_t k = 0; k < settings_.size(); ++k) pilot.levels.push_back({values[k], settings_[k].seconds});
        goal_.setting = settings_[stats::cheapest_level(rule(), pilot)].name;
        say(fmt::format("most cases run at {}", *goal_.setting));
        return true;
    }
    /// Their tolerance may have been another. The checks are judged again from stored values.
    void forget_earlier_checks() const {
        if (!fs::exists(request_.database)) return;
        auto store = open_store();
        store.group([&] {
            for (const auto& record : store.campaigns())
                if (record.name == asked_.name || record.name == measure_) store.forget_checks(record.name);
        });
        store.remember_file();
    }
    /// Runs the cases of the next check and judges them. False: there is no more to do, or they did not end.
    bool advance() {
        if (points_ == 0) {
            const auto first = stats::first_sizes(sequences_, goal_.setting != campaign::AccuracyGoal::measure);
            points_ = std::min(first.points, most_);
            pairs_ = first.pairs;
        }
        if (pairs_ > 0 && !compute(text_at(measure(), pairs_, false))) return false;
        const auto& judged = alone_ ? measure_ : asked_.name;
        if (!compute(alone_ ? text_at(measure(), points_, false) : text_at(*goal_.setting, points_, true)))
            return false;
        auto store = open_store();
        const auto first = study::first_values(store, judged, goal_.observable, points_);
        std::vector<double> expensive;
        if (pairs_ > 0) expensive = study::first_values(store, measure_, goal_.observable, pairs_).values;
        const auto factors = study::first_factors(store, judged, points_);
        const stats::PairedValues values{first.values, expensive, static_cast<std::size_t>(sequences_), factors.view()};
        const auto check = stats::two_level_check(rule(), values);
        const bool within = passed_ && check.passes;
        store.group([&] { store.record(judged, study::row_of(check, goal_, first.without_value, within)); });
        store.remember_file();
        if (within || check.last()) return false;
        passed_ = check.passes;
        if (pairs_ > 0 && stats::alone_costs_less(rule(), values))
            go_on_alone(values);
        else
            go_on(check.next_points, check.next_pairs);
        return true;
    }
    void go_on(std::int64_t points, std::int64_t pairs) {
        points_ = points;
        pairs_ = pairs;
        say(fmt::format("next check at {} cases and {} pairs", points_, pairs_));
    }
    /// With `reference`, of which the pairs so far are the first cases.
    void go_on_alone(const stats::PairedValues& values) {
        alone_ = true;
        passed_ = false;
        const auto own = stats::two_level_check(rule(), {values.expensive, {}, values.sequences, values.points});
        say(fmt::format("{} alone costs less than further pairs", measure()));
        go_on(std::min(most_, std::max(own.next_points, stats::first_sizes(sequences_, false).points)), 0);
    }
    [[nodiscard]] store::Store open_store() const {
        return {request_.database, store::Store::Mode::create,
                request_.network_disk ? store::Store::Disk::network : store::Store::Disk::found_out};
    }
    [[nodiscard]] static std::string measure() { return std::string(campaign::AccuracyGoal::measure); }
    [[nodiscard]] stats::TwoLevelRule rule() const {
        return {study::gates_of(goal_), goal_.tolerance, most_, goal_.setting ? cost_ratio() : 1};
    }
    [[nodiscard]] double cost_ratio() const {
        const auto chosen = std::ranges::find(settings_, *goal_.setting, &CostedSetting::name);
        const bool known = chosen != settings_.end() && chosen->seconds > 0 && settings_.back().seconds > 0;
        return known ? settings_.back().seconds / chosen->seconds : 1;
    }
    /// Runs a campaign to its end. False: it did not come there.
    bool compute(std::string text) {
        RunRequest one = request_;
        one.text = std::move(text);
        one.goes_on = ended_.has_value();
        if (request_.max_cases) one.max_cases = *request_.max_cases - settled_;
        auto report = run_part(one);
        settled_ += report.settled;
        if (report.finished && request_.max_cases && settled_ >= *request_.max_cases) {
            report.finished = false;
            report.ending = "stopped; run again to resume";
            report.exit_code = std::max(report.exit_code, 1);
        }
        if (ended_ && report.finished) report.exit_code = std::max(report.exit_code, ended_->exit_code);
        ended_ = std::move(report);
        return ended_->finished;
    }
    void say(const std::string& text) const {
        if (!request_.quiet) std::cerr << fmt::format("{}: {}\n", asked_.name, text);
    }

    RunRequest request_;
    campaign::Campaign asked_;
    campaign::AccuracyGoal goal_;
    std::int64_t sequences_ = 1, most_ = 0, points_ = 0, pairs_ = 0, settled_ = 0;
    std::vector<CostedSetting> settings_;
    std::string measure_;  ///< campaign of `reference` beside the campaign of the goal
    bool passed_ = false;  ///< the check before
    bool alone_ = false;   ///< the pairs were given up for `reference` alone
    std::optional<RunReport> ended_;
};

}  // namespace

RunReport run_accurate(const RunRequest& request) {
    return AccurateRun(request)();
}

}  // namespace grainsweep::cli

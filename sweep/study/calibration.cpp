#include "sweep/study/calibration.hpp"

#include "solver/scenes/scene.hpp"
#include "stats/calibration.hpp"
#include "sweep/campaign/experiments.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/stored_identity.hpp"
#include "sweep/designs/calibration_layout.hpp"
#include "sweep/schedule/growth.hpp"
#include "sweep/study/responses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace grainsweep::study {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double uniform_sd = 0.28867513459481287;             // of the uniform distribution over [0, 1]
constexpr double determined_below = 0.25, partly_below = 0.5;  // shares of the prior's sd
constexpr double strongly_coupled = 0.8;                       // correlation
constexpr double out_of_reach = 3;                             // standard deviations beyond every case
constexpr double settled_chains = 1.05;

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double sd_of(const std::vector<double>& values) {
    if (values.size() < 2) return none;
    if (std::ranges::count(values, values.front()) == std::ssize(values)) return 0;  // without rounding of the mean
    const double mean = mean_of(values);
    double squares = 0;
    for (const double x : values) squares += (x - mean) * (x - mean);
    return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double quantile(std::vector<double> values, double share) {
    std::ranges::sort(values);
    const double at = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const auto above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], at - static_cast<double>(below));
}

/// Returns the posterior probability of each part of a factor, with its value as text.
std::vector<LevelProbability> probabilities_of(const designs::Factor& range, std::span<const double> coordinates) {
    std::vector<LevelProbability> found;
    for (std::size_t k = 0; k < range.parts(); ++k) found.push_back({range.text(range.middle_of(k))});
    if (found.empty()) return found;
    for (const double u : coordinates) found[range.part(u)].probability += 1 / static_cast<double>(coordinates.size());
    return found;
}

/// Returns the width of the posterior divided by the prior's: 0 for a value that is certain, 1 for values that are as
/// likely as before. For words it is the probability of all but the likeliest word, divided by the prior's.
double share_of_prior(const FactorPosterior& one, const std::vector<double>& coordinates, double width) {
    if (one.levels.empty()) return width / uniform_sd;
    const auto parts = static_cast<double>(one.levels.size());
    if (!one.factor.has_words()) return sd_of(coordinates) / (uniform_sd * std::sqrt(1 - 1 / (parts * parts)));
    const double likeliest = std::ranges::max(one.levels, {}, &LevelProbability::probability).probability;
    return (1 - likeliest) / (1 - 1 / parts);
}

FactorPosterior posterior_of(const designs::Calibration& found, std::size_t j) {
    const auto rows = found.posterior->rows();
    const auto& factor = found.factors[j];
    std::vector<double> coordinates, values;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        coordinates.push_back(rows.row(i)[j]);
        values.push_back(factor.number_or_index(coordinates.back()));
    }
    FactorPosterior one{factor, mean_of(values), sd_of(values), quantile(values, 0.05), quantile(values, 0.95)};
    if (factor.has_words()) one.mean = one.sd = one.low = one.high = none;
    one.levels = probabilities_of(factor, coordinates);
    one.share_of_range = share_of_prior(one, coordinates, found.shape->sd[j]);
    using enum Determination;
    one.determination = one.share_of_range <= determined_below ? determined
                        : one.share_of_range <= partly_below   ? partly
                                                               : not_determined;
    const std::size_t d = found.factors.size();
    double strongest = strongly_coupled;
    for (std::size_t k = 0; k < d; ++k) {
        const bool none_of_words = k != j && !factor.has_words() && !found.factors[k].has_words();
        const double coupling = none_of_words ? std::abs(found.shape->correlation[j * d + k]) : 0;
        if (coupling < strongest) continue;
        strongest = coupling;
        one.ridge_with = found.factors[k].name;
    }
    return one;
}

std::string condition_text(const designs::MeasuredTarget& target, const std::vector<designs::Factor>& factors) {
    std::string text;
    for (const auto& [name, level] : target.level) {
        const auto stated = std::ranges::find(factors, name, &designs::Factor::name);
        const std::string value = stated == factors.end() ? "?" : stated->level_texts().at(level);
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, value);
    }
    return text;
}

std::vector<double> posterior_means(const stats::ResponseModel& model, stats::Rows points) {
    return model.means(points);
}
std::vector<double> posterior_means(const stats::ProbabilityModel& model, stats::Rows points) {
    return model.probabilities(points);
}

TargetCheck check_of(const designs::Calibration& found, std::size_t t) {
    const auto& target = found.targets[t];
    TargetCheck check{target.shown_observable(),
                      "",
                      "",
                      target.experiment,
                      target.value,
                      target.error,
                      target.discrepancy,
                      none,
                      none,
                      none,
                      none,
                      0,
                      std::nullopt,
                      0,
                      {}};
    if (!found.waves.empty()) {
        check.refusal = found.waves.back().refusals[t];
        check.beyond = found.beyond[t];
    }
    if (found.posterior && found.models[t]) {
        const auto inputs = found.inputs(found.posterior->rows());
        const auto means =
            std::visit([&](const auto& model) { return posterior_means(model, inputs.rows()); }, *found.models[t]);
        check.predicted = mean_of(means);
        check.predicted_error = sd_of(means);
    }
    if (t < found.check.size()) {
        std::vector<double> answers;
        std::ranges::copy_if(found.check[t], std::back_inserter(answers), [](double x) { return std::isfinite(x); });
        check.runs = answers.size();
        if (!answers.empty()) check.checked = mean_of(answers);
        check.checked_sd = sd_of(answers);
        check.z = designs::miss_of(target, answers);
    }
    return check;
}

/// The places that the curves of a target cover under its condition; none where it is a scalar, or there is no curve.
std::optional<std::pair<double, double>> covered_by(const store::Store& store, const std::string& campaign,
                                                    const designs::CalibrationLayout& layout, std::size_t t,
                                                    const designs::CurvePlace& place) {
    if (!place.at) return std::nullopt;
    std::optional<std::pair<double, double>> covered;
    for (const auto& curve : store.curve_extents(campaign, place.observable)) {
        if (static_cast<std::size_t>(curve.point) % layout.conditions_of[t] != layout.condition_of[t]) continue;
        if (!covered) covered = {curve.first, curve.last};
        covered = {std::min(covered->first, curve.first), std::max(covered->second, curve.last)};
    }
    return covered;
}

/// Returns how many points, from the first on, agree with the settings that were run: all, unless another version of
/// the program chose them.
std::size_t followed_points(const designs::Calibration& found, const Responses& run) {
    constexpr double rounding = 1e-9;  // of the range
    const std::size_t d = found.points.dimensions;
    std::size_t followed = found.points.size();
    for (std::size_t row = 0; row < run.rows(); ++row) {
        const auto point = static_cast<std::size_t>(run.points[row]);
        if (point >= followed) continue;
        for (std::size_t j = 0; j < d; ++j) {
            const auto known = std::ranges::find(found.factors, run.factors[j].name, &designs::Factor::name);
            if (known == found.factors.end()) continue;
            const double u = found.points.point(point)[j];
            const bool by_index = !known->continuous();
            const double value = by_index ? static_cast<double>(known->part(u)) : known->number(u);
            const double width = by_index ? 1 : std::abs(known->number(1) - known->number(0));
            if (std::abs(run.factors[j].values[row] - value) > rounding * width) followed = point;
        }
    }
    return followed;
}

/// Returns whether failures depend on the factors, in a sentence; empty: no setting failed.
std::string failures_text(const designs::Calibration& found) {
    const auto& answering = found.answering;
    if (found.waves.back().failed == 0 || !answering.p_value()) return {};
    const auto count =
        fmt::format("{} of {} settings have no answer to some target", found.waves.back().failed,
                    found.settings.size() / found.factors.size() - found.further - found.waves.back().excluded);
    const auto p = fmt::format("p = {:.2g}", *answering.p_value());
    if (!answering.decides())
        return fmt::format("{}; there is no evidence that this depends on the factors ({}): it carries no information",
                           count, p);
    std::string names;
    for (const auto j : answering.factors())
        names += fmt::format("{}{}", names.empty() ? "" : ", ", found.factors[j].name);
    return fmt::format(
        "{}; this depends on {} ({}): settings count with their probability of an answer, and not where "
        "its 95 % interval lies below 1/2",
        count, names, p);
}

/// Returns whether each target can be met, and not all of them together.
bool contradict(const CalibrationReport& report) {
    return report.targets.size() > 1 &&
           std::ranges::all_of(report.targets, [](const auto& target) { return target.beyond <= out_of_reach; });
}

/// Returns notes for users who quote the posterior.
std::vector<std::string> notes_of(const CalibrationReport& report) {
    std::vector<std::string> notes;
    if (report.found.further > 0)
        notes.push_back(fmt::format("{} settings that were computed elsewhere are in the models, and in no wave",
                                    report.found.further));
    const auto& found = report.found;
    for (const auto& target : report.targets) {
        if (!target.refusal.empty() && !std::isinf(target.beyond))
            notes.push_back(
                fmt::format("{} has no response model and decides nothing: {}", target.name(), target.refusal));
        if (std::isinf(target.beyond))
            notes.push_back(fmt::format("{}: no case has an answer to it{}", target.name(),
                                        target.covered ? fmt::format("; its curves cover {:.6g} to {:.6g}",
                                                                     target.covered->first, target.covered->second)
                                                       : ""));
        else if (target.beyond > out_of_reach)
            notes.push_back(
                fmt::format("{}: no case came near the measured {:.5g}; it lies {:.1f} standard deviations beyond "
                            "all of them: the ranges, or the model, do not reach what was measured",
                            target.name(), target.value, target.beyond));
    }
    if (!found.waves.empty()) {
        const auto& last = found.waves.back();
        if (last.excluded > 0)
            notes.push_back(fmt::format("{} settings are excluded by the campaign's `where`: no case was run there",
                                        last.excluded));
        if (const auto text = failures_text(found); !text.empty()) notes.push_back(text);
        if (last.kept == 0 && found.least_implausibility > 3)
            notes.push_back(fmt::format(
                "{}no setting is within 3 standard deviations of {}, the nearest is {:.1f} off. A larger discrepancy, "
                "or another model, is needed",
                contradict(report) ? "the targets contradict each other: " : "",
                report.targets.size() > 1 ? "all measurements" : "the measurement", found.least_implausibility));
    }
    if (!found.posterior) return notes;
    for (std::size_t j = 0; j < report.factors.size(); ++j) {
        const auto& factor = report.factors[j];
        if (factor.determination != Determination::not_determined) continue;
        if (factor.factor.has_words()) {
            const auto& likeliest = std::ranges::max(factor.levels, {}, &LevelProbability::probability);
            notes.push_back(
                fmt::format("{} is not determined by these targets: its likeliest level, {}, has the "
                            "probability {:.2f}",
                            factor.factor.name, likeliest.level, likeliest.probability));
        } else {
            notes.push_back(
                fmt::format("{} is not determined by these targets: its posterior is {:.0f} % as wide as its range",
                            factor.factor.name, 100 * factor.share_of_range));
        }
    }
    const std::size_t d = report.factors.size();
    for (std::size_t i = 0; i < d; ++i)
        for (std::size_t j = i + 1; j < d; ++j) {
            const double r = found.shape->correlation[i * d + j];
            if (std::abs(r) < strongly_coupled || found.factors[i].has_words() || found.factors[j].has_words())
                continue;
            notes.push_back(
                fmt::format("{} and {} are determined together, not each: along a ridge of equal fit one {} as the "
                            "other rises (correlation {:.2f})",
                            found.factors[i].name, found.factors[j].name, r < 0 ? "falls" : "rises", r));
        }
    if (!(found.posterior->scale_reduction < settled_chains))
        notes.push_back(
            fmt::format("the chains of the posterior have not settled (scale reduction {:.2f}): its widths are rough",
                        found.posterior->scale_reduction));
    for (const auto& target : report.targets)
        if (std::abs(target.z.value_or(0)) > designs::largest_miss_allowed)
            notes.push_back(
                fmt::format("{}: fresh runs at settings drawn from the posterior miss the measurement by {:.1f} "
                            "standard deviations",
                            target.name(), std::abs(*target.z)));
    return notes;
}

/// Returns the factors of one determination as a list; empty: there is none.
std::string listed(const CalibrationReport& report, Determination which) {
    std::string text;
    for (const auto& factor : report.factors) {
        if (factor.determination != which) continue;
        text += fmt::format("{}{}", text.empty() ? "" : ", ", factor.factor.name);
        if (which == Determination::partly)
            text += fmt::format(" ({:.2f} of its range's width)", factor.share_of_range);
        if (!factor.ridge_with.empty()) text += " along a ridge with " + factor.ridge_with;
    }
    return text;
}

/// Returns why the fresh runs are no check; empty: they are.
std::string unchecked(const CalibrationReport& report) {
    const std::size_t requested = report.found.checked.size() / report.found.factors.size();
    std::size_t alive = requested;
    for (const auto& target : report.targets) alive = std::min(alive, target.runs);
    const std::size_t needed = std::max(fewest_checks, (requested + 1) / 2);
    if (alive >= needed) return {};
    return fmt::format("{} of {} fresh runs {} an answer, and {} are needed", alive, requested,
                       alive == 1 ? "has" : "have", needed);
}

std::optional<Verdict> calibration_verdict(const CalibrationReport& report) {
    const auto& found = report.found;
    if (!found.waves_end || !found.posterior || !found.checks_known) return std::nullopt;
    const auto miss = designs::largest_miss(found.targets, found.check);
    if (miss && miss->size > designs::largest_miss_allowed)
        return Verdict{fmt::format("not reproduced: {} by {:.1f} sd", report.targets[miss->target].name(), miss->size),
                       false};
    std::string sentence;
    const auto add = [&](std::string_view what, const std::string& which) {
        if (!which.empty()) sentence += fmt::format("{}{}: {}", sentence.empty() ? "" : "; ", what, which);
    };
    add("not determined", listed(report, Determination::not_determined));
    add("partly determined", listed(report, Determination::partly));
    if (!(found.posterior->scale_reduction < settled_chains))
        add("not settled",
            fmt::format("chains of the posterior, scale reduction {:.2f}", found.posterior->scale_reduction));
    add("not checked", unchecked(report));
    return Verdict{sentence.empty() ? "calibrated" : sentence};
}

/// The campaigns of the experiments by name; of a calibration without, this one by the empty name.
std::map<std::string, store::CampaignRecord> records_of(const store::Store& store,
                                                        const store::CampaignRecord& record) {
    std::map<std::string, store::CampaignRecord> records;
    const auto names = campaign::experiments_of(record);
    if (names.empty()) records.emplace("", record);
    for (const auto& other : names.empty() ? std::vector<store::CampaignRecord>{} : store.campaigns())
        for (const auto& name : names)
            if (other.name == campaign::name_beside(record, name)) records.emplace(name, other);
    return records;
}

}  // namespace

Marginal marginal_of(const designs::Calibration& found, std::size_t j) {
    constexpr std::size_t bins = 24, prior_points = 2400;
    const auto& factor = found.factors[j];
    const std::size_t parts = factor.parts();
    Marginal marginal;
    const auto [low, high, log] = factor.shown();
    const auto edge = [&](std::size_t k) {
        const double share = static_cast<double>(k) / static_cast<double>(bins);
        return log ? low * std::pow(high / low, share) : std::lerp(low, high, share);
    };
    const double half_step = parts > 1 ? (high - low) / static_cast<double>(2 * (parts - 1)) : 0;
    for (std::size_t k = 0; k < (parts > 0 ? parts : bins); ++k) {
        const double here =
            factor.continuous() && parts > 0 ? factor.number(factor.middle_of(k)) : static_cast<double>(k);
        const double half = factor.continuous() ? half_step : 0.5;
        marginal.from.push_back(parts > 0 ? here - half : edge(k));
        marginal.to.push_back(parts > 0 ? here + half : edge(k + 1));
    }
    const auto shares = [&](std::size_t count, auto coordinate) {
        std::vector<double> share(marginal.from.size(), 0);
        for (std::size_t i = 0; i < count; ++i) {
            const double u = coordinate(i);
            const auto bin = parts > 0
                                 ? factor.part(u)
                                 : static_cast<std::size_t>(std::ranges::upper_bound(marginal.to, factor.number(u)) -
                                                            marginal.to.begin());
            share[std::min(bin, share.size() - 1)] += 1 / static_cast<double>(count);
        }
        return share;
    };
    const auto rows = found.posterior->rows();
    marginal.prior = shares(prior_points, [](std::size_t i) { return (static_cast<double>(i) + 0.5) / prior_points; });
    marginal.posterior = shares(rows.size(), [&](std::size_t i) { return rows.row(i)[j]; });
    return marginal;
}

std::string_view FactorPosterior::word() const {
    using enum Determination;
    return determination == determined ? "determined" : determination == partly ? "partly" : "not determined";
}

std::string TargetCheck::name() const {
    return fmt::format("{}{}{}{}{}", experiment, experiment.empty() ? "" : " ", observable,
                       condition.empty() ? "" : " at ", condition);
}

std::optional<CalibrationReport> calibration_report(const store::Store& store, const store::CampaignRecord& record) {
    const auto* design = designs::find_design(record.design);
    if (design == nullptr || !design->calibrates) return std::nullopt;
    auto request = campaign::request_of(record);
    schedule::learn_answers(request, store, record);
    CalibrationReport report{designs::calibration_of(request), {}, {}, {}, {}};
    const auto followed = followed_points(report.found, read_responses(store, record));
    const bool by_another_program = followed < report.found.points.size();
    if (by_another_program) {  // answers of other points say nothing of these
        for (auto& [observable, answers] : request.answers) answers.resize(std::min(answers.size(), followed));
        report.found = designs::calibration_of(request);
    }
    const auto records = records_of(store, record);
    if (report.found.posterior)
        for (std::size_t j = 0; j < report.found.factors.size(); ++j) {
            auto& factor = report.factors.emplace_back(posterior_of(report.found, j)).factor;
            for (const auto& [name, one] : records)
                if (const auto scene = find_scene(one.scene))
                    if (const auto* parameter = scene->find_parameter(factor.name)) factor.unit = parameter->unit;
        }
    const auto layout = designs::calibration_layout(request, report.found.targets);
    for (std::size_t t = 0; t < report.found.targets.size(); ++t) {
        const auto& target = report.found.targets[t];
        auto& check = report.targets.emplace_back(check_of(report.found, t));
        const auto one = records.find(check.experiment);
        if (one == records.end()) continue;  // not run yet
        check.condition = condition_text(target, one->second.factors);
        const auto place = designs::place_on_curve(target.observable);
        if (std::isinf(check.beyond)) check.covered = covered_by(store, one->second.name, layout, t, place);
        const auto scene = find_scene(one->second.scene);
        const auto* measured = scene == nullptr ? nullptr : scene->find_observable(place.observable);
        if (measured != nullptr) check.unit = target.of ? "1" : measured->unit;
    }
    report.verdict = calibration_verdict(report);
    report.notes = notes_of(report);
    if (by_another_program)
        report.notes.push_back(fmt::format(
            "from point {} on its settings were chosen by another version of grainsweep, and this one would choose "
            "others: only the waves before are shown. Under another name it is calibrated anew, with what is finished",
            followed));
    return report;
}

}  // namespace grainsweep::study

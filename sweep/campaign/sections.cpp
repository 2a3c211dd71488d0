// "accuracy", "convergence", "model", "limits" and "execution".
#include "sweep/campaign/sections.hpp"

#include "stats/levels.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/relevance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace grainsweep::campaign {

std::string read_scalar(const Cursor& place, const SceneInfo& scene) {
    std::vector<std::string> scalars;
    for (const auto& observable : scene.observables) {
        if (observable.shape == Shape::scalar) scalars.push_back(observable.name);
    }
    const auto* named = place.json().is_string() ? scene.find_observable(place.json().get<std::string>()) : nullptr;
    if (named != nullptr && named->shape != Shape::scalar) {
        place.refuse(fmt::format("is a {}; statistics need a scalar observable: {}",
                                 named->shape == Shape::series ? "series" : "profile", in_words(scalars)));
    }
    return place.word(scalars);
}

std::vector<std::string> read_gates(const Section& section, const std::vector<std::string>& standard) {
    auto gates = section.words("gates", standard);
    if (gates.empty()) section.at("gates").refuse("at least one statistic must be judged");
    for (std::size_t k = 0; k < gates.size(); ++k) {
        if (gates[k].find(':') != std::string::npos) {
            const auto level = stats::level_named(gates[k]);
            if (!level)
                section.at("gates")[k].refuse(
                    "must be a quantile with a probability between 0 and 1, such as \"quantile:0.9\", or \"above:\" or "
                    "\"below:\" with a number");
            gates[k] = stats::to_string(*level);
        }
        const auto earlier = std::span(gates).first(k);
        if (std::ranges::find(earlier, gates[k]) != earlier.end())
            section.at("gates")[k].refuse("this statistic is there twice");
    }
    return gates;
}

namespace {

void check_rule(const Section& section, const Convergence& convergence, const Campaign& campaign) {
    const std::string path = path_of(section.place().path(), "rule");
    const std::string got = fmt::format("\"{}\"{}", convergence.rule, section.find("rule") ? "" : " by default");
    const std::int64_t sequences = designs::independent_sequences(campaign.design, campaign.request);
    if (!convergence.traits().of_sequences) {
        if (designs::design_named(campaign.design).beginning != designs::Beginning::corner) return;
        throw input_error(path, got,
                          fmt::format("the points of a {0} come in no useful order, so blocks of them mean nothing; "
                                      "compare campaigns of that design or take a halton design",
                                      campaign.design));
    }
    if (sequences < stats::fewest_sequences) {
        throw input_error(path, got,
                          fmt::format("this rule needs a halton or sobol design with \"scramble\": \"random\" and "
                                      "\"sequences\" of at least {} (8 is good); any_change and all_change need none",
                                      stats::fewest_sequences));
    }
    if (section.find("block") && convergence.block < least_block(convergence.traits(), sequences)) {
        throw input_error(path_of(section.place().path(), "block"), std::to_string(convergence.block),
                          fmt::format("must give each of the {} sequences at least 4 points", sequences));
    }
}

std::int64_t block_by_default(const Convergence& convergence, const Campaign& campaign) {
    const std::int64_t sequences = designs::independent_sequences(campaign.design, campaign.request);
    std::int64_t points = 0;
    try {
        points = candidates_of(campaign);
    } catch (const std::invalid_argument&) {  // the error is reported when the design is unfolded
    }
    return default_block(points, sequences, least_block(convergence.traits(), sequences));
}

/// Reads a number; 0 in a file means that it is not given.
template <class Number>
std::optional<Number> unless_zero(Number number) {
    return number == 0 ? std::nullopt : std::optional(number);
}

/// Seconds that are a limit.
std::optional<double> read_time_limit(const Section& section, std::string_view key, std::optional<double> standard,
                                      double shortest) {
    const double seconds = section.number(key, standard.value_or(0));
    if (seconds > 0 && seconds < shortest)
        section.at(key).refuse(fmt::format("must be at least {} s, or 0 for no limit", shortest));
    return unless_zero(seconds);
}

/// Points of a sequence at the first check.
constexpr std::int64_t fewest_rounds = 4;

AccuracyGoal read_goal(const Cursor& place, const SceneInfo& scene, const std::vector<std::string>& offered) {
    const Section section(place, accuracy_keys);
    if (!scene.accuracy.contains(AccuracyGoal::measure))
        place.refuse(
            fmt::format("scene '{}' has no setting '{}' to compare with", scene.shown(), AccuracyGoal::measure));
    if (const auto program = known_program(scene.name))
        for (const auto& setting : program->accuracy)
            if (!setting.cost_seconds)
                place.refuse(
                    fmt::format("a goal needs \"cost_seconds\" in program.accuracy.{}: about how long a case "
                                "takes, s; `grainsweep accuracy` measures it",
                                setting.name));
    AccuracyGoal goal;
    goal.observable = read_scalar(section.at("observable"), scene);
    goal.gates = read_gates(section, goal.gates);
    goal.tolerance = section.number("tolerance", goal.tolerance);
    if (const auto setting = section.find("setting")) goal.setting = setting->word(offered);
    return goal;
}

/// Refuses a goal where the campaign itself decides all that the settings differ in: they would agree whatever their
/// error.
void refuse_decided_settings(const Cursor& place, const AccuracyGoal& goal, const Campaign& campaign) {
    const auto& settings = campaign.scene().accuracy;
    const Inputs& measure = settings.find(AccuracyGoal::measure)->second;
    const Inputs stated = fixed_as_stated(campaign.space);
    std::string decided;
    for (const auto& [setting, inputs] : settings) {
        if (setting == AccuracyGoal::measure || (goal.setting && setting != *goal.setting)) continue;
        for (const auto& [name, value] : inputs) {
            if (const auto at = measure.find(name); at != measure.end() && at->second == value) continue;
            if (is_left_open(campaign.space, stated, name)) return;
            decided = name;
        }
    }
    if (!decided.empty())
        place.refuse(
            fmt::format("the campaign fixes or varies '{}', and with it all that the accuracy settings differ "
                        "in: they would agree whatever their error",
                        decided));
}

/// Whether two points may be one case.
bool may_repeat(const Factor& factor) {
    const auto* distribution = std::get_if<stats::Distribution>(&factor.range);
    return factor.step || !factor.when.empty() ||
           (distribution != nullptr && std::holds_alternative<stats::SampleColumn>(distribution->form()));
}

}  // namespace

std::optional<AccuracyGoal> read_accuracy(const Cursor& place, Campaign& campaign) {
    const auto& scene = campaign.scene();
    std::vector<std::string> offered;
    for (const auto& [name, inputs] : scene.accuracy) offered.push_back(name);
    if (offered.empty()) place.refuse(fmt::format("scene '{}' offers no accuracy settings; leave it out", scene.name));
    if (!place.json().is_object()) {
        campaign.accuracy = place.word(offered);
        return std::nullopt;
    }
    auto goal = read_goal(place, scene, offered);
    refuse_decided_settings(place, goal, campaign);
    // The parameters of a program's setting have no default.
    const bool has_no_default = is_program(scene.name);
    campaign.accuracy = goal.setting.value_or(has_no_default ? std::string(AccuracyGoal::measure) : "");
    std::set<std::string> common(campaign.common_random_numbers.begin(), campaign.common_random_numbers.end());
    for (const auto& [setting, inputs] : scene.accuracy)
        for (const auto& [name, value] : inputs) common.insert(name);
    campaign.common_random_numbers.assign(common.begin(), common.end());
    return goal;
}

void check_accuracy(const Cursor& place, const Campaign& campaign) {
    if (campaign.convergence)
        throw input_error("$.convergence", "",
                          "beside an \"accuracy\" with a tolerance it has no effect: leave one of them out");
    if (campaign.replicates != 1)
        throw input_error("$.replicates", std::to_string(campaign.replicates),
                          "an \"accuracy\" with a tolerance needs one run of each point: leave it out");
    const std::int64_t sequences = designs::independent_sequences(campaign.design, campaign.request);
    if (sequences < stats::fewest_sequences || candidates_of(campaign) < fewest_rounds * sequences)
        throw input_error("$.design", campaign.design,
                          fmt::format("an \"accuracy\" with a tolerance needs a halton or sobol design with "
                                      "\"scramble\": \"random\", \"sequences\" of at least {} (8 is good) and at "
                                      "least {} points for each",
                                      stats::fewest_sequences, fewest_rounds));
    const auto& factors = campaign.space.factors;
    for (const auto& factor : factors)
        if (may_repeat(factor))
            throw input_error("$.factors", factor.name,
                              "an \"accuracy\" with a tolerance needs different cases at all points: give the "
                              "factor a range without 'step', 'whole' or 'when'");
    if (std::ranges::all_of(factors, [](const Factor& f) { return std::holds_alternative<Levels>(f.range); }))
        place.refuse("it needs a factor with a range: factors with levels alone repeat their cases");
}

Convergence read_convergence(const Cursor& place, const Campaign& campaign) {
    const Section section(place, convergence_keys);
    Convergence convergence;
    convergence.observable = read_scalar(section.at("observable"), campaign.scene());
    convergence.rule = section.word("rule", convergence.rule);
    convergence.tolerance = section.number("tolerance", convergence.tolerance);
    convergence.block = section.whole("block", convergence.block);
    convergence.stop = section.flag("stop", convergence.stop);
    convergence.gates = read_gates(section, convergence.gates);
    check_rule(section, convergence, campaign);
    for (std::size_t k = 0; k < convergence.gates.size(); ++k) {
        if (convergence.traits().of_model && convergence.gates[k] == "skewness")
            section.at("gates")[k].refuse(
                "Pearson's skewness is made of a median, which has no model-assisted estimate: take g1, or the rule "
                "\"replicates\"");
        if (convergence.traits().of_model && convergence.gates[k].find(':') != std::string::npos)
            section.at("gates")[k].refuse("the rule \"assisted\" judges moments: take the rule \"replicates\"");
    }
    if (!section.find("block")) convergence.block = block_by_default(convergence, campaign);
    return convergence;
}

std::vector<std::string> read_features(const Cursor& place) {
    const Section section(place, model_keys);
    auto features = section.words("features", {});
    const auto list = section.at("features");
    if (features.empty()) list.refuse("a model needs at least one feature; leave it out for those by default");
    if (features.size() > most_features) list.refuse(fmt::format("at most {} features are learned", most_features));
    for (std::size_t k = 0; k < features.size(); ++k) {
        if (features[k].find_first_not_of(" \t\r\n") == std::string::npos) list[k].refuse("an expression is expected");
        if (std::ranges::find(std::span(features).first(k), features[k]) != std::span(features).first(k).end())
            list[k].refuse("this feature is there twice");
    }
    return features;
}

Limits read_limits(const Cursor& place) {
    const Section section(place, limits_keys);
    Limits limits;
    limits.wall_seconds = read_time_limit(section, "wall_seconds", limits.wall_seconds, shortest_limit);
    limits.attempts = section.whole("attempts", limits.attempts);
    return limits;
}

Execution read_execution(const Cursor& place) {
    const Section section(place, execution_keys);
    Execution execution;
    execution.workers = unless_zero(section.whole("workers", 0));
    execution.launcher = section.words("launcher", {});
    execution.hosts = unless_zero(section.whole("hosts", 0));
    execution.workers_per_host = unless_zero(section.whole("workers_per_host", 0));
    if (execution.hosts && section.find("workers"))
        section.at("workers").refuse("with 'hosts' it has no effect: take 'workers_per_host'");
    if (!execution.hosts && section.find("workers_per_host"))
        section.at("workers_per_host").refuse("without 'hosts' it has no effect: take 'workers'");
    execution.threads = unless_zero(section.whole_or_word("threads", 0, 0));
    execution.walltime = read_time_limit(section, "walltime", execution.walltime, shortest_limit);
    execution.start_seconds = read_time_limit(section, "start_seconds", execution.start_seconds, shortest_limit);
    execution.silence_seconds =
        read_time_limit(section, "silence_seconds", execution.silence_seconds, shortest_silence);
    return execution;
}

}  // namespace grainsweep::campaign

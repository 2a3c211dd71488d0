#include "sweep/campaign/forecast.hpp"

#include "sweep/campaign/file_contents.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/program_warnings.hpp"
#include "sweep/designs/calibration_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

namespace grainsweep::campaign {

namespace {

/// Files that inputs name. They are read again if the names change.
class NamedFiles {
public:
    /// Throws std::invalid_argument if a file cannot be read.
    const Files& of(const Inputs& inputs) {
        Inputs words;
        for (const auto& [name, value] : inputs) {
            const auto* word = std::get_if<std::string>(&value);
            if (word != nullptr && file_word(*word)) words.emplace(name, *word);
        }
        if (words == words_) return files_;
        auto files = files_named(words);
        if (const auto* why = std::get_if<std::string>(&files)) throw std::invalid_argument(*why);
        files_ = std::get<Files>(std::move(files));
        words_ = std::move(words);
        return files_;
    }

private:
    Inputs words_;
    Files files_;
};

void add_cautions(Forecast& total, const SceneInfo& scene, const Inputs& inputs, const Files& files,
                  std::int64_t point) {
    for (auto& warning : scene.warnings(inputs, files)) {
        auto found = std::ranges::find(total.cautions, warning.kind, &Caution::kind);
        if (found == total.cautions.end()) {
            total.cautions.push_back({std::move(warning.kind), std::move(warning.sentence), point, 0});
            found = total.cautions.end() - 1;
        }
        ++found->questions;
    }
}

}  // namespace

namespace {

Prediction predict(const SceneInfo& scene, const Inputs& inputs, const Files& files) {
    Prediction prediction;
    try {
        prediction.proven = scene.proven_answer && scene.proven_answer(inputs);
        if (!prediction.proven && scene.estimate_cost) prediction.cost = scene.estimate_cost(inputs, files);
    } catch (const std::invalid_argument& error) {  // one case among many: its outcome will be `rejected`
        prediction.impossible = error.what();
    }
    return prediction;
}

}  // namespace

Prediction predict(const SceneInfo& scene, const Inputs& inputs) {
    NamedFiles named;
    const Files& files = named.of(inputs);
    Prediction prediction = predict(scene, inputs, files);
    if (prediction.impossible.empty() && scene.warnings) prediction.warnings = scene.warnings(inputs, files);
    return prediction;
}

std::function<bool(const Inputs&)> acceptance(const SceneInfo& scene) {
    return [&scene, named = std::make_shared<NamedFiles>()](const Inputs& inputs) {
        try {
            return predict(scene, inputs, named->of(inputs)).impossible.empty();
        } catch (const std::invalid_argument&) {
            return false;
        }
    };
}

void require_memory(const std::string& which, double bytes, double room) {
    if (!(bytes > room)) return;
    throw input_error("$", "",
                      fmt::format("{} needs about {:.3g} GB of memory, and this machine gives a process {:.3g} GB: "
                                  "make the case smaller or take a larger machine",
                                  which, 1e-9 * bytes, 1e-9 * room));
}

Forecast forecast(const SceneInfo& scene, const Cases& cases, double room) {
    Forecast total;
    total.places = static_cast<std::int64_t>(cases.size());
    total.seconds.resize(cases.size());
    Inputs inputs;
    NamedFiles named;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (!cases.is_first(i)) {
            total.seconds[i] = total.seconds[cases.first(i)];
            continue;
        }
        ++total.questions;
        cases.inputs(i, inputs);
        const std::int64_t point = cases.place(i).point;
        const Files& files = named.of(inputs);
        Prediction one = predict(scene, inputs, files);
        if (one.impossible.empty() && scene.warnings) add_cautions(total, scene, inputs, files, point);
        if (!one.impossible.empty() && total.impossible++ == 0) {
            total.first_reason = std::move(one.impossible);
            total.first_point = point;
        }
        if (one.proven) ++total.proven;
        total.total_seconds += one.cost.seconds;
        total.longest_seconds = std::max(total.longest_seconds, one.cost.seconds);
        total.seconds[i] = one.cost.seconds;
        if (one.cost.bytes > total.largest_bytes) {
            total.largest_bytes = one.cost.bytes;
            total.largest_point = point;
        }
    }
    if (total.questions > 0 && total.impossible == total.questions)
        throw input_error("$", "", "no case of this campaign can be computed: " + total.first_reason);
    require_memory(fmt::format("the case of point {}", total.largest_point), total.largest_bytes, room);
    return total;
}

std::optional<LongestCourse> longest_course(const Campaign& campaign, const Forecast& forecast) {
    const auto* design = designs::find_design(campaign.design);
    if (design == nullptr || !design->calibrates) return std::nullopt;
    const auto& request = campaign.request;
    const auto waves = request.count("waves"), points = request.count("points_per_wave");
    const auto checks = request.count("checks") * (request.shared.empty() ? 1 : waves);
    const double first_waves = static_cast<double>(waves) + static_cast<double>(checks) / static_cast<double>(points);
    return LongestCourse{waves, points, checks, first_waves * forecast.total_seconds};
}

namespace {

std::vector<std::string> calibration_warnings(const Campaign& campaign) {
    std::vector<std::string> warnings;
    const auto* design = designs::find_design(campaign.design);
    if (design == nullptr || !design->calibrates) return warnings;
    for (const auto& target : designs::targets_in(campaign.request.word("targets")))
        if (target.discrepancy == 0 && target.experiment == designs::experiment_of(campaign.request))
            warnings.push_back(fmt::format(
                "the discrepancy of {0} is 0: where the simulation is not exactly the experiment, the posterior "
                "will be too narrow, about a wrong setting",
                target.shown_observable()));
    std::ranges::sort(warnings);
    const auto twice = std::ranges::unique(warnings);
    warnings.erase(twice.begin(), twice.end());
    return warnings;
}

/// Warns of factors that may be counts. A program accepts any number, and only its author knows whether 1 to 10 are
/// counts.
void warn_of_counts(const Campaign& campaign, std::vector<std::string>& warnings) {
    if (!is_program(campaign.scene().name)) return;
    for (const auto& factor : campaign.space.factors) {
        const auto* range = std::get_if<Between>(&factor.range);
        const auto& unit = campaign.scene().find_parameter(factor.name)->unit;
        if (range == nullptr || factor.step || !unit.empty() || range->scale == Scale::log) continue;
        const bool whole = range->low == std::floor(range->low) && range->high == std::floor(range->high);
        if (whole && range->high - range->low >= 2)
            warnings.push_back(fmt::format(
                "{0} takes every real number from {1} to {2}; a whole number is varied by \"levels\" and declared by "
                "\"whole\": true in program.parameters.{0}, another quantity by its \"unit\" (\"1\" for a pure number)",
                factor.name, range->low, range->high));
    }
}

/// Returns a text with the number of different runs, if several places of the design are the same case; else empty.
std::string repeated_cases(const Campaign& campaign, const Forecast& forecast) {
    if (forecast.questions == forecast.places) return {};
    const auto* design = designs::find_design(campaign.design);
    if (design == nullptr || design->grows || design->purpose == designs::Purpose::morris) return {};
    const auto has_levels = [](const Factor& factor) { return std::holds_alternative<Levels>(factor.range); };
    std::string advice = "'replicates' repeats every point with other seeds";
    if (design->beginning == designs::Beginning::sample && std::ranges::all_of(campaign.space.factors, has_levels))
        advice = "a lattice with 'replicates' runs every combination of the levels several times, with other seeds";
    if (repeats_weigh(campaign.space.factors))
        return fmt::format(
            "the {} cases of the design are {} different ones: each is one run, and weighs as many points as ask it in "
            "the moments",
            forecast.places, forecast.questions);
    return fmt::format("the {} cases of the design are {} different ones, and each counts once in every statistic: {}",
                       forecast.places, forecast.questions, advice);
}

}  // namespace

std::vector<std::string> warnings_of(const Campaign& campaign, const Forecast& forecast) {
    std::vector<std::string> warnings;
    if (!campaign.powder_lacks.empty()) warnings.push_back(campaign.powder_lacks);
    for (const auto& caution : forecast.cautions) {
        warnings.push_back(fmt::format("{}: {} of {} cases, first at point {}: {}", caution.kind, caution.questions,
                                       forecast.questions, caution.first_point, caution.sentence));
    }
    if (auto repeated = repeated_cases(campaign, forecast); !repeated.empty()) warnings.push_back(std::move(repeated));
    for (auto& sentence : calibration_warnings(campaign)) warnings.push_back(std::move(sentence));
    if (campaign.execution.threads && is_program(campaign.scene().name))
        warnings.emplace_back(
            "execution.threads has no effect on a program: program.cores says how many cores a case of it takes");
    warn_of_counts(campaign, warnings);
    for (auto& sentence : program_warnings(campaign)) warnings.push_back(std::move(sentence));
    if (auto never = never_converges(campaign); !never.empty()) warnings.push_back(std::move(never));
    return warnings;
}

}  // namespace grainsweep::campaign

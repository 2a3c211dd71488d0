#include "sweep/cli/asked_case.hpp"

#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/relevance.hpp"
#include "sweep/campaign/simplex.hpp"
#include "sweep/cli/program_campaign.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/study/features.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <set>
#include <span>
#include <utility>
#include <variant>

namespace grainsweep::cli {
namespace {

using campaign::Campaign;

/// Replaces values of the file by NAME=VALUE, under the rules of the file.
void apply(const std::vector<std::string>& settings, Campaign& campaign, const std::filesystem::path& folder) {
    const auto& scene = campaign.scene();
    std::vector<std::string> names;
    for (const auto& parameter : scene.parameters) names.push_back(parameter.name);
    std::set<std::string> set;
    for (const auto& setting : settings) {
        const auto equals = setting.find('=');
        const std::string name = setting.substr(0, equals);
        const std::string where = "--set " + name;
        if (equals == std::string::npos) throw campaign::input_error("--set", setting, "must be NAME=VALUE");
        const auto* parameter = scene.find_parameter(name);
        if (parameter == nullptr) {
            throw campaign::input_error(where, "",
                                        fmt::format("scene '{}' has no parameter of this name", scene.shown()),
                                        campaign::nearest_word(name, names));
        }
        if (!set.insert(name).second) throw campaign::input_error(where, "", "this parameter is set twice");
        const Value value = campaign::parse_value(*parameter, setting.substr(equals + 1), folder, where);
        campaign::hold(campaign.space, name, value, campaign.accuracy);
    }
    for (const auto& name : set) {
        if (const auto reason = campaign::no_effect(campaign.space, *scene.find_parameter(name))) {
            throw campaign::input_error("--set " + name, "", *reason);
        }
    }
}

/// Factors that are not set: the middle of their range, the first of their levels; shares are equal above their lows.
Inputs middle_of(const campaign::ParameterSpace& space) {
    auto left = static_cast<double>(std::ranges::count_if(space.factors, &campaign::Factor::share));
    std::vector<double> u;
    for (const auto& factor : space.factors) {
        u.push_back(std::holds_alternative<campaign::Levels>(factor.range) ? 0.0 : 0.5);
        if (!factor.share) continue;
        left -= 1;
        u.back() = 1 - std::pow(left / (left + 1), left);  // where the stick breaks into a part and `left` equal ones
    }
    return space.at(std::span<const double>(u));
}

/// Some shares without the others would not add to one.
void check_shares(const campaign::ParameterSpace& declared, const campaign::ParameterSpace& held) {
    std::vector<std::string> names;
    std::vector<double> set;
    for (const auto& factor : declared.factors) {
        if (!factor.share) continue;
        names.push_back(factor.name);
        if (const auto value = held.fixed.find(factor.name); value != held.fixed.end())
            set.push_back(std::get<double>(value->second));
    }
    if (set.empty()) return;
    if (set.size() < names.size())
        throw campaign::input_error("--set", "",
                                    fmt::format("{} add to one: set all of them or none", campaign::listed(names)));
    if (!campaign::add_to_one(set))
        throw campaign::input_error("--set", "", fmt::format("{} do not add to one", campaign::listed(names)));
}

/// A campaign file; or a machine, which is a campaign without factors.
Campaign campaign_of(const std::string& config) {
    if (auto machine = campaign::machine_if_any(config)) {
        Campaign campaign;
        campaign.name = machine->name;
        campaign.space.scene = campaign::enter_machine(std::move(machine));
        return campaign;
    }
    Campaign campaign = read_with_program(config);
    campaign::asked_in(config, [&] { campaign::check_design(campaign); });
    campaign::asked_in(config, [&] { study::check_features(campaign); });
    return campaign;
}

}  // namespace

AskedCase asked_case(const std::string& config, const std::vector<std::string>& settings,
                     std::optional<std::uint64_t> given_seed) {
    Campaign campaign = campaign_of(config);
    const auto declared = campaign.space;
    apply(settings, campaign, std::filesystem::path(config).parent_path());
    check_shares(declared, campaign.space);
    const Inputs inputs = middle_of(campaign.space);
    campaign::asked_in(config, [&] { campaign::check_expressions(campaign.space, inputs); });
    const auto filter = campaign::asked_in(
        config, [&] { return store::make_filter(campaign.where, campaign::filter_names(campaign)); });
    if (!filter(inputs))
        std::cerr << "grainsweep: the campaign excludes this point by its 'where': " << campaign.where << '\n';
    if (!campaign.powder_lacks.empty()) std::cerr << "warning: " << campaign.powder_lacks << '\n';
    const std::uint64_t seed = given_seed ? *given_seed : campaign::case_seed(campaign, inputs, 0);
    AskedCase asked{campaign::make_case(campaign.scene(), inputs, seed), campaign.limits.wall_seconds, {}, {}};
    for (const auto& factor : declared.factors) asked.shown_inputs.push_back(factor.name);
    for (const auto& setting : settings) {
        const auto name = setting.substr(0, setting.find('='));
        if (std::ranges::find(asked.shown_inputs, name) == asked.shown_inputs.end()) asked.shown_inputs.push_back(name);
    }
    if (!declared.factors.empty()) asked.campaign = campaign.name;
    return asked;
}

}  // namespace grainsweep::cli

#include "sweep/campaign/stored_text.hpp"

#include "sweep/campaign/json_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <variant>

namespace grainsweep::campaign {

namespace {

constexpr std::uint64_t most_of_a_seed = std::uint64_t{1} << 53U;

/// Returns a document without checking its keys, because a later version may have other keys.
Json document_in(std::string_view text) {
    return Json::parse(text, nullptr, false);
}

std::string notes_in(const Json& document) {
    const auto found = document.find("notes");
    if (found == document.end()) return {};
    if (found->is_string()) return found->get<std::string>();
    std::string all;
    if (found->is_array())
        for (const auto& line : *found)
            if (line.is_string()) all += (all.empty() ? "" : "\n") + line.get<std::string>();
    return all;
}

std::vector<std::string> features_in(const Json& document) {
    std::vector<std::string> features;
    const auto model = document.find("model");
    if (model == document.end() || !model->is_object()) return features;
    const auto list = model->find("features");
    if (list == model->end() || !list->is_array()) return features;
    for (const auto& feature : *list)
        if (feature.is_string()) features.push_back(feature.get<std::string>());
    return features;
}

std::vector<std::string> noise_in(const Json& document) {
    std::vector<std::string> names;
    const auto factors = document.find("factors");
    if (factors == document.end() || !factors->is_array()) return names;
    for (const auto& factor : *factors)
        if (factor.is_object() && factor.value("role", Json()) == "noise" && factor.value("name", Json()).is_string())
            names.push_back(factor["name"].get<std::string>());
    return names;
}

std::optional<AccuracyGoal> goal_in(const Json& document) {
    const auto found = document.find("accuracy");
    if (found == document.end() || !found->is_object() || !found->contains("observable")) return std::nullopt;
    AccuracyGoal goal;
    goal.observable = (*found)["observable"].get<std::string>();
    goal.gates = found->value("gates", goal.gates);
    goal.tolerance = found->value("tolerance", goal.tolerance);
    if (found->contains("setting")) goal.setting = (*found)["setting"].get<std::string>();
    return goal;
}

/// A calibration's conditions as factors with levels, in the order in which its reader meets them.
void append_conditions(Json& factors, const Json& calibration) {
    const auto targets = calibration.find("targets");
    if (!factors.is_array() || targets == calibration.end() || !targets->is_array()) return;
    const std::size_t calibrated = factors.size();
    for (const auto& target : *targets) {
        const auto inputs = target.find("inputs");
        if (inputs == target.end() || !inputs->is_object()) continue;
        for (const auto& [name, value] : inputs->items()) {
            auto factor = std::find_if(factors.begin() + static_cast<std::ptrdiff_t>(calibrated), factors.end(),
                                       [&](const Json& other) { return other["name"] == name; });
            if (factor == factors.end())
                factor = factors.insert(factor, Json{{"name", name}, {"levels", Json::array()}});
            auto& levels = (*factor)["levels"];
            if (std::find(levels.begin(), levels.end(), value) == levels.end()) levels.push_back(value);
        }
    }
}

}  // namespace

Remarks remarks_in(std::string_view campaign_file) {
    const Json document = document_in(campaign_file);
    if (!document.is_object()) return {};
    Remarks remarks{notes_in(document), std::nullopt,      features_in(document),
                    noise_in(document), goal_in(document), std::nullopt};
    const auto limits = document.find("limits");
    if (limits == document.end() || !limits->is_object()) return remarks;
    const auto attempts = limits->find("attempts");
    if (attempts != limits->end() && attempts->is_number()) remarks.attempts = attempts->get<std::int64_t>();
    const auto seconds = limits->find("wall_seconds");
    if (seconds != limits->end() && seconds->is_number() && *seconds > 0) remarks.wall_seconds = seconds->get<double>();
    return remarks;
}

std::vector<std::string> observables_as_written(std::string_view campaign_file) {
    const auto document = nlohmann::ordered_json::parse(campaign_file, nullptr, false);
    std::vector<std::string> names;
    if (!document.is_object() || !document.contains("program") || !document["program"].is_object()) return names;
    const auto observables = document["program"].find("observables");
    if (observables == document["program"].end() || !observables->is_object()) return names;
    for (const auto& [name, place] : observables->items()) names.push_back(name);
    return names;
}

namespace {

nlohmann::ordered_json list_design(std::span<const std::vector<Value>> rows) {
    Json list = Json::array();
    for (const auto& row : rows) {
        Json values = Json::array();
        for (const auto& value : row) std::visit([&](const auto& plain) { values.push_back(plain); }, value);
        list.push_back(std::move(values));
    }
    return {{"kind", "list"}, {"rows", list}};
}

/// Returns the start of both files below: the parts that they share with their campaign.
nlohmann::ordered_json begun(const Json& document, std::string_view name, std::string_view notes) {
    nlohmann::ordered_json text;
    text["notes"] = notes;
    text["campaign"] = name;
    for (const char* key : {"scene", "program", "machine", "powder", "factors", "simplex", "fixed", "where", "accuracy",
                            "common_random_numbers", "model", "limits", "execution"})
        if (const auto found = document.find(key); found != document.end()) text[key] = *found;
    // Of a goal the setting alone: it needs a design of its own.
    if (const auto goal = goal_in(document)) text.erase("accuracy");
    if (const auto goal = goal_in(document); goal && goal->setting) text["accuracy"] = *goal->setting;
    return text;
}

Json document_of_campaign(std::string_view campaign_file) {
    Json document = document_in(campaign_file);
    if (!document.is_object()) throw std::invalid_argument("further points: the text is no campaign file");
    return document;
}

/// Parameters that change no seed in the file, and these.
std::vector<std::string> common_with(const Json& document, std::span<const std::string> numerical) {
    std::vector<std::string> common = document.value("common_random_numbers", std::vector<std::string>());
    for (const auto& name : numerical)
        if (std::ranges::count(common, name) == 0) common.push_back(name);
    return common;
}

}  // namespace

std::string further_points(std::string_view campaign_file, std::string_view name, std::string_view notes,
                           std::span<const std::vector<Value>> rows, std::uint64_t number) {
    const Json document = document_of_campaign(campaign_file);
    auto text = begun(document, name, notes);
    if (const auto calibration = document.find("calibration");
        calibration != document.end() && calibration->is_object()) {
        Json factors = document.value("factors", Json::array());
        append_conditions(factors, *calibration);
        text["factors"] = std::move(factors);
    }
    const std::uint64_t seed = document.contains("seed") ? document["seed"].get<std::uint64_t>() : 1;
    text["seed"] = seed > most_of_a_seed - number ? number : seed + number;
    text["design"] = list_design(rows);
    return text.dump(2) + '\n';
}

std::string with_other_numerics(std::string_view campaign_file, const OtherNumerics& numerics,
                                std::span<const std::vector<Value>> rows) {
    const Json document = document_of_campaign(campaign_file);
    auto text = begun(document, numerics.name, numerics.notes);
    text["accuracy"] = numerics.accuracy;
    for (const auto& [name, value] : numerics.fixed)
        std::visit([&](const auto& plain) { text["fixed"][name] = plain; }, value);
    text["common_random_numbers"] = common_with(document, numerics.numerical);
    if (document.contains("seed")) text["seed"] = document["seed"];
    text["design"] = list_design(rows);
    return text.dump(2) + '\n';
}

std::string at_setting(std::string_view campaign_file, const AtSetting& at) {
    const Json document = document_of_campaign(campaign_file);
    auto text = nlohmann::ordered_json::parse(campaign_file);
    text["campaign"] = at.name;
    if (at.keeps_goal)
        text["accuracy"]["setting"] = at.setting;
    else
        text["accuracy"] = at.setting;
    text["common_random_numbers"] = common_with(document, at.numerical);
    text["design"]["points"] = at.points;
    return text.dump(2) + '\n';
}

std::string text_of_experiment(std::string_view campaign_file, const Identity& campaign) {
    const auto* experiment = word_of(campaign, "experiment");
    Json document = document_in(campaign_file);
    const auto place = Json::json_pointer("/calibration/experiments");
    if (experiment == nullptr || !document.is_object() || !document.contains(place)) return std::string(campaign_file);
    const auto& name = *experiment;
    const Json own = document[place].value(name, Json::object());
    for (const char* key : {"scene", "machine", "program"})
        if (own.contains(key)) document[key] = own[key];
    if (!own.contains("scene")) document["scene"] = own.contains("machine") ? "machine" : "program";
    Json factors = Json::array(), fixed = own.value("fixed", Json::object()), targets = Json::array();
    for (const auto& factor : document["factors"])
        if (std::ranges::count(campaign.factors, factor["name"].get<std::string>(), &Factor::name) > 0)
            factors.push_back(factor);
    const Json shared = document.value("fixed", Json::object());
    for (const auto& [parameter, value] : shared.items())
        if (!fixed.contains(parameter) && campaign.fixed.contains(parameter)) fixed[parameter] = value;
    for (const auto& target : document["calibration"]["targets"])
        if (target.value("of", "") == name) targets.push_back(target);
    document["factors"] = factors;
    document["fixed"] = fixed;
    document["calibration"] = {{"targets", targets}};
    return document.dump();
}

std::optional<std::string> phases_text(const PhaseSeconds& phases) {
    if (phases.empty()) return std::nullopt;
    std::string text;
    for (const auto& [name, seconds] : phases) {
        if (!std::isfinite(seconds)) continue;
        text += (text.empty() ? "" : ",") + Json(name).dump() + ':' + shortest(seconds);
    }
    return "{" + text + "}";
}

std::optional<PhaseSeconds> phases_in(std::string_view text) {
    const Json document = document_in(text);
    if (!document.is_object()) return std::nullopt;
    PhaseSeconds phases;
    for (const auto& [name, seconds] : document.items()) {
        if (!seconds.is_number()) return std::nullopt;
        phases.emplace(name, seconds.get<double>());
    }
    return phases;
}

}  // namespace grainsweep::campaign

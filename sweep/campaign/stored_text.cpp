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

/// A document without a check of keys: a later reader may know other ones.
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
    Remarks remarks{notes_in(document), std::nullopt, features_in(document), noise_in(document)};
    const auto limits = document.find("limits");
    if (limits == document.end() || !limits->is_object()) return remarks;
    const auto attempts = limits->find("attempts");
    if (attempts != limits->end() && attempts->is_number()) remarks.attempts = attempts->get<std::int64_t>();
    return remarks;
}

std::string further_points(std::string_view campaign_file, std::string_view name, std::string_view notes,
                           std::span<const std::vector<Value>> rows, std::uint64_t number) {
    const Json document = document_in(campaign_file);
    if (!document.is_object()) throw std::invalid_argument("further points: the text is no campaign file");
    Json list = Json::array();
    for (const auto& row : rows) {
        Json values = Json::array();
        for (const auto& value : row) std::visit([&](const auto& plain) { values.push_back(plain); }, value);
        list.push_back(std::move(values));
    }
    nlohmann::ordered_json text;
    text["notes"] = notes;
    text["campaign"] = name;
    for (const char* key :
         {"scene", "program", "factors", "fixed", "where", "accuracy", "model", "limits", "execution"})
        if (const auto found = document.find(key); found != document.end()) text[key] = *found;
    if (const auto calibration = document.find("calibration");
        calibration != document.end() && calibration->is_object()) {
        Json factors = document.value("factors", Json::array());
        append_conditions(factors, *calibration);
        text["factors"] = std::move(factors);
    }
    const std::uint64_t seed = document.contains("seed") ? document["seed"].get<std::uint64_t>() : 1;
    text["seed"] = seed > most_of_a_seed - number ? number : seed + number;
    text["design"] = {{"kind", "list"}, {"rows", list}};
    return text.dump(2) + '\n';
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

#include "sweep/campaign/stored_text.hpp"

#include "sweep/campaign/json_text.hpp"

#include <cmath>

namespace grainsweep::campaign {

namespace {

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

}  // namespace

Remarks remarks_in(std::string_view campaign_file) {
    const Json document = document_in(campaign_file);
    if (!document.is_object()) return {};
    Remarks remarks{notes_in(document), std::nullopt};
    const auto limits = document.find("limits");
    if (limits == document.end() || !limits->is_object()) return remarks;
    const auto attempts = limits->find("attempts");
    if (attempts != limits->end() && attempts->is_number()) remarks.attempts = attempts->get<std::int64_t>();
    return remarks;
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

#include "sweep/campaign/experiments.hpp"

#include "sweep/campaign/plain_name.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/campaign/stored_identity.hpp"
#include "sweep/designs/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <stdexcept>

namespace grainsweep::campaign {
namespace {

constexpr auto scene_keys = std::to_array<std::string_view>({"scene", "machine", "program"});

/// One experiment as a campaign file of its own, with the places of its parts in the whole file.
struct Experiment {
    std::string name;
    Json document;
    std::vector<std::size_t> factors, targets;  ///< numbers in the whole file

    [[nodiscard]] std::string path() const { return path_of("$.calibration.experiments", name); }

    /// A sentence about the file of the experiment as one about the whole file.
    [[nodiscard]] std::string in_whole(std::string sentence, const Json& own) const {
        const auto moved = [&](const std::string& from, const std::string& to) {
            const bool here = sentence.starts_with(from) &&
                              std::string_view(":.[").find(sentence[from.size()]) != std::string_view::npos;
            if (here) sentence.replace(0, from.size(), to);
            return here;
        };
        for (const auto key : scene_keys)
            if (moved(path_of("$", key), path_of(path(), key))) return sentence;
        if (const auto fixed = own.find("fixed"); fixed != own.end() && fixed->is_object())
            for (const auto& [parameter, value] : fixed->items())
                if (moved(path_of("$.fixed", parameter), path_of(path() + ".fixed", parameter))) return sentence;
        for (std::size_t j = 0; j < factors.size(); ++j)
            if (moved(path_of("$.factors", j), path_of("$.factors", factors[j])))
                return "in " + path() + ", " + sentence;
        for (std::size_t t = 0; t < targets.size(); ++t)
            if (moved(path_of("$.calibration.targets", t), path_of("$.calibration.targets", targets[t])))
                return sentence;
        if (moved("$.calibration.discrepancy", path_of("$.calibration.discrepancy", name))) return sentence;
        if (sentence.starts_with("$:")) sentence.replace(0, 1, path());
        return sentence;
    }
};

/// The targets of an experiment without their "of".
Json targets_of(const Cursor& calibration, const std::vector<std::string>& names, Experiment& experiment) {
    Json own = Json::array();
    const auto all = Section(calibration, calibration_keys).at("targets").elements();
    for (std::size_t t = 0; t < all.size(); ++t) {
        const Section target(all[t], target_keys);
        const auto of = target.find("of");
        if (!of)
            throw input_error(
                all[t].path(), "",
                fmt::format("key 'of' is missing: in which experiment it was measured, {}", in_words(names)));
        if (of->word(names) != experiment.name) continue;
        experiment.targets.push_back(t);
        own.push_back(all[t].json());
        own.back().erase("of");
    }
    if (own.empty()) throw input_error(experiment.path(), "", "no target is measured in this experiment; leave it out");
    return own;
}

/// Keeps of a list or object what the experiment's scene has, but for a program, which takes whatever it is given.
void keep_known(const Json& file, const Json& own, const SceneInfo& scene, Experiment& experiment) {
    Json factors = Json::array(), fixed = own.value("fixed", Json::object());
    const auto known = [&](const Json& name) {
        return name.is_string() && scene.find_parameter(name.get_ref<const std::string&>()) != nullptr;
    };
    const auto& all = file.at("factors");
    for (std::size_t j = 0; j < all.size(); ++j) {
        if (all[j].is_object() && all[j].contains("name") && !known(all[j]["name"])) continue;
        factors.push_back(all[j]);
        experiment.factors.push_back(j);
    }
    if (const auto shared = file.find("fixed"); shared != file.end() && fixed.is_object())
        for (const auto& [name, value] : shared->items())
            if (known(name) && !fixed.contains(name)) fixed[name] = value;
    if (factors.empty())
        throw input_error(experiment.path(), "", "has none of the factors: its measurements determine nothing");
    experiment.document["factors"] = std::move(factors);
    experiment.document["fixed"] = std::move(fixed);
}

/// Refuses a factor or a fixed value that no experiment has.
void require_known(const Cursor& place, const Json& name, const std::vector<Campaign>& campaigns) {
    if (!name.is_string()) place.refuse("must be the name of a parameter");
    std::vector<std::string> known;
    for (const auto& campaign : campaigns)
        for (const auto& parameter : campaign.scene().parameters) known.push_back(parameter.name);
    const auto& word = name.get_ref<const std::string&>();
    if (std::ranges::find(known, word) == known.end())
        throw input_error(place.path(), word, "no experiment has this parameter", nearest_word(word, known));
}

Experiment experiment_file(const Json& file, const Cursor& place, const std::string& name,
                           const std::vector<std::string>& names, const std::filesystem::path& folder) {
    Experiment experiment{name, file, {}, {}};
    auto& document = experiment.document;
    const Section own(place, experiment_keys);
    const Cursor calibration(file.at("calibration"), "$.calibration");
    if (document["campaign"].is_string()) document["campaign"] = document["campaign"].get<std::string>() + "_" + name;
    for (const auto key : scene_keys) {
        if (const auto given = own.find(key)) document[std::string(key)] = given->json();
        if (key != "scene" && !own.find("scene") && own.find(key)) document["scene"] = key;
    }
    if (!document.contains("scene"))
        throw input_error(place.path(), "", "an experiment has a \"scene\", a \"machine\" or a \"program\"");
    if (const auto fixed = own.find("fixed")) {
        if (!fixed->json().is_object()) fixed->refuse("must be an object of parameter names and values");
        document["fixed"] = document.value("fixed", Json::object());
        document["fixed"].update(fixed->json());
    }
    auto& section = document["calibration"];
    section.erase("experiments");
    section["targets"] = targets_of(calibration, names, experiment);
    const auto& discrepancy = file.at("calibration").value("discrepancy", Json::object());
    const bool stated = discrepancy.is_object() && discrepancy.contains(name);
    const bool only_shares = std::ranges::all_of(
        section["targets"], [](const Json& target) { return target.is_object() && target.contains("without_value"); });
    if (!stated && !only_shares)
        throw input_error("$.calibration.discrepancy", "",
                          fmt::format("'{}' is missing: an object of the discrepancies in this experiment", name));
    if (stated)
        section["discrepancy"] = discrepancy[name];
    else
        section.erase("discrepancy");
    try {
        const auto scene = read_scene(Section(Cursor(document, "$"), campaign_keys), folder);
        keep_known(file, place.json(), *scene, experiment);
    } catch (const InputError& wrong) {
        throw InputError(experiment.in_whole(wrong.what(), place.json()));
    }
    return experiment;
}

/// Gives every campaign the targets and the factors of all.
void join(std::vector<Campaign>& campaigns, const std::vector<std::string>& names, const Json& factors) {
    std::vector<designs::MeasuredTarget> targets;
    std::size_t curves = 0;
    for (std::size_t i = 0; i < campaigns.size(); ++i) {
        const std::size_t before = curves;
        for (auto& target : designs::targets_in(campaigns[i].request.word("targets"))) {
            if (target.curve > 0) target.curve += before;
            curves = std::max(curves, target.curve);
            target.experiment = names[i];
            targets.push_back(std::move(target));
        }
    }
    std::vector<Factor> together;
    for (const auto& factor : factors)
        for (const auto& campaign : campaigns) {
            const auto found =
                std::ranges::find(campaign.space.factors, factor["name"].get<std::string>(), &Factor::name);
            if (found == campaign.space.factors.end()) continue;
            together.push_back(*found);
            break;
        }
    for (std::size_t i = 0; i < campaigns.size(); ++i) {
        auto& request = campaigns[i].request;
        request.options["targets"] = designs::text_of(targets);
        request.options["experiment"] = names[i];
        request.options["together"] = factors_line(together);
        request.shared = together;
    }
}

}  // namespace

std::vector<std::string> experiment_names(const Json& document) {
    if (!document.is_object() || !document.contains("calibration")) return {};
    const Cursor calibration(document.at("calibration"), "$.calibration");
    if (!calibration.json().is_object() || !calibration.json().contains("experiments")) return {};
    const Cursor experiments = calibration["experiments"];
    std::vector<std::string> names;
    for (const auto& [name, place] : experiments.members("must be an object of names and experiments")) {
        if (name.empty() || !std::ranges::all_of(name, is_name_sign))
            place.refuse("the name of an experiment has letters, digits and '_'");
        names.push_back(name);
    }
    if (names.empty()) experiments.refuse("must have at least one experiment");
    return names;
}

std::vector<Campaign> read_experiments(const Json& document, const std::filesystem::path& folder) {
    const Section top(Cursor(document, "$"), campaign_keys);
    for (const char* key : {"scene", "machine", "program", "where", "design"})
        if (const auto given = top.find(key))
            throw input_error(given->path(), "", "with several experiments it has no place here");
    const auto names = experiment_names(document);
    const Cursor experiments = top.at("calibration")["experiments"];
    const Cursor factors = top.at("factors");
    (void)factors.elements();
    if (const auto fixed = top.find("fixed"); fixed && !fixed->json().is_object())
        fixed->refuse("must be an object of parameter names and values");
    std::vector<Campaign> campaigns;
    for (const auto& name : names) {
        const Cursor place = experiments[name];
        const auto file = experiment_file(document, place, name, names, folder);
        try {
            campaigns.push_back(campaign_in(file.document, folder));
        } catch (const InputError& wrong) {
            throw InputError(file.in_whole(wrong.what(), place.json()));
        }
    }
    for (const auto& factor : factors.elements()) require_known(factor["name"], factor["name"].json(), campaigns);
    if (const auto fixed = top.find("fixed"))
        for (const auto& [name, place] : fixed->members({})) require_known(place, name, campaigns);
    join(campaigns, names, document.at("factors"));
    for (const auto& campaign : campaigns) check_growing(top.at("calibration"), campaign);
    return campaigns;
}

std::string name_in_file(const Identity& identity) {
    const auto* own = word_of(identity, "experiment");
    return own == nullptr ? identity.name : identity.name.substr(0, identity.name.size() - own->size() - 1);
}

std::string name_beside(const Identity& identity, std::string_view experiment) {
    return fmt::format("{}_{}", name_in_file(identity), experiment);
}

std::vector<std::string> experiments_of(const Identity& identity) {
    std::vector<std::string> names;
    const auto* targets = word_of(identity, "targets");
    if (word_of(identity, "experiment") == nullptr || targets == nullptr) return names;
    for (const auto& target : designs::targets_in(*targets))
        if (std::ranges::find(names, target.experiment) == names.end()) names.push_back(target.experiment);
    return names;
}

bool shows_findings(const Identity& identity) {
    const auto names = experiments_of(identity);
    return names.empty() || identity.name == name_beside(identity, names.front());
}

}  // namespace grainsweep::campaign

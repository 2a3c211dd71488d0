#include "sweep/campaign/reader.hpp"

#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/keys.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/plain_name.hpp"
#include "sweep/campaign/powder.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/program_section.hpp"
#include "sweep/campaign/relevance.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <system_error>

namespace grainsweep::campaign {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_text = 64ULL << 20U;

std::string read_name(const Cursor& place) {
    const auto name = place.text();
    if (!is_plain_name(name) || name.size() > longest_campaign_name) {
        place.refuse(
            fmt::format("a name is letters, digits and _, not a digit first, at most {}: it names a view in SQL",
                        longest_campaign_name));
    }
    // SQL folds the case of names, so do we.
    const std::string folded = small_letters(name);
    if (std::ranges::find(reserved_names, folded) != reserved_names.end() || folded.starts_with("sqlite_")) {
        place.refuse("the database has a table or view of this name; take another",
                     folded.starts_with("sqlite_") ? "my_" + name : name + "_1");
    }
    return name;
}

std::vector<std::string> json_files_beside(const fs::path& file) {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(file.has_parent_path() ? file.parent_path() : ".", none))
        if (entry.path().extension() == ".json") names.push_back(entry.path().filename().string());
    return names;
}

/// "machine": the name of a file, or the object itself, whose files lie beside the campaign file.
std::shared_ptr<const Machine> machine_of(const Section& top, const fs::path& folder) {
    const auto place = top.find("machine");
    if (!place)
        throw input_error("$", "",
                          "key 'machine' is missing: with \"scene\": \"machine\" a machine file or its object");
    if (!place->json().is_string()) return make_machine(place->json(), place->path(), beside(folder));
    const fs::path file = folder / place->text();
    std::error_code none;
    if (!fs::is_regular_file(file, none)) {
        if (auto installed = installed_machine(place->text())) return installed;
        std::vector<std::string> others = installed_machines();
        std::ranges::move(json_files_beside(file), std::back_inserter(others));
        place->refuse(
            "there is no such machine file beside the campaign file, and no machine of this name is installed",
            nearest_word(file.filename().string(), others));
    }
    return read_machine(file);
}

constexpr std::size_t longest_file_name = 1024;
constexpr std::size_t largest_kept = 512ULL << 20U;  // a value of SQLite holds 10^9 bytes
/// Keys below which no text is the name of a file that the campaign keeps.
constexpr auto elsewhere = std::to_array<std::string_view>(
    {notes_key, schema_key, "campaign", "scene", "program", "machine", "execution", "model", "where", "accuracy",
     "convergence", "name", "kind", "observable", "factor", "of", "common_random_numbers"});

std::vector<CampaignFile> file_at(const std::string& place, const std::string& name, const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > largest_kept) return {};
    const std::string contents = files::whole_file(path, error);
    if (error) throw input_error(place, name, fmt::format("the file cannot be read: {}", error.message()));
    return {{place, name, content_hash(contents), fs::absolute(path)}};
}

void collect_files(const Json& value, const std::string& place, const fs::path& folder, std::set<std::string>& seen,
                   std::vector<CampaignFile>& files) {
    if (value.is_array())
        for (std::size_t k = 0; k < value.size(); ++k) collect_files(value[k], path_of(place, k), folder, seen, files);
    if (value.is_object())
        for (const auto& [key, inner] : value.items())
            if (std::ranges::find(elsewhere, key) == elsewhere.end())
                collect_files(inner, path_of(place, key), folder, seen, files);
    if (!value.is_string()) return;
    const auto& name = value.get_ref<const std::string&>();
    if (name.empty() || name.size() > longest_file_name || !seen.insert(name).second) return;
    for (auto& file : file_at(place, name, folder / name)) files.push_back(std::move(file));
}

/// Returns every file in `folder` that a text of the campaign file names: lists, curves, tools, packings, sizes. Files
/// of programs and machines are stored separately; notes do not name files.
std::vector<CampaignFile> files_beside(const Json& document, const fs::path& folder) {
    std::vector<CampaignFile> files;
    std::set<std::string> seen;
    collect_files(document, "$", folder, seen, files);
    return files;
}

/// Adds the powder file, the files that it names, and its sizes.
void add_powder_files(const std::string& place, const Powder& powder, Campaign& campaign) {
    const auto add = [&](const char* key, const fs::path& path) {
        const auto name = path.lexically_relative(powder.file.parent_path()).string();
        for (auto& file : file_at(place + key, name, path)) campaign.files.push_back(std::move(file));
    };
    if (!powder.posterior.empty()) add(".posterior", powder.posterior);
    if (powder.sizes && !powder.sizes->file.empty()) add(".sizes.file", powder.sizes->file);
    if (powder.sizes && powder.sizes->file.empty()) {
        if (!powder.sizes->source.empty()) add(".sizes.file", powder.sizes->source);
        campaign.files.push_back({place + ".sizes", powder.sizes_name(), content_hash(powder.sizes->csv), {}});
    }
}

/// Reads "powder": parameters from a powder file. Values of the campaign itself have priority.
void use_powder(const Cursor& place, const fs::path& folder, Campaign& campaign) {
    if (is_program(campaign.scene().name))
        place.refuse("a program has no powder of this kind; name the file in its \"files\"");
    const Powder powder = powder_beside(place, folder);
    const PowderUse use = apply_powder(powder, campaign.space);
    if (use.set.empty() && use.overridden.empty())
        place.refuse(
            fmt::format("scene '{}' has no parameter that powder '{}' gives", campaign.scene().shown(), powder.name));
    campaign.powder = fmt::format("{} ({}) {}", powder.name, powder.file.filename().string(), use.sentence());
    campaign.powder_lacks = use.lacks;
    add_powder_files(place.path(), powder, campaign);
}

std::vector<std::string> read_common(const Section& top, const SceneInfo& scene) {
    auto names = top.words("common_random_numbers", {});
    for (std::size_t k = 0; k < names.size(); ++k) {
        const auto place = top.at("common_random_numbers")[k];
        (void)read_parameter(place, scene);
        if (std::ranges::count(names, names[k]) > 1) place.refuse("this parameter is there twice");
    }
    std::ranges::sort(names);
    return names;
}

/// A parameter that is given but can matter to no case is a misunderstanding.
void check_relevance(const Section& top, const ParameterSpace& space, std::size_t declared, const Inputs& given) {
    for (std::size_t j = 0; j < space.factors.size(); ++j) {
        const auto* parameter = space.scene->find_parameter(space.factors[j].name);
        if (const auto reason = no_effect(space, *parameter)) {
            throw input_error(j < declared ? path_of(top.at("factors").path(), j) : "$.calibration.targets", "",
                              *reason);
        }
    }
    for (const auto& [name, value] : given) {
        const auto* parameter = space.scene->find_parameter(name);
        if (const auto reason = no_effect(space, *parameter)) top.at("fixed")[name].refuse(*reason);
    }
}

std::string read_text(const fs::path& file) {
    std::error_code error;
    const std::string shown_name = file.string();
    if (!fs::exists(file, error)) {
        throw input_error(shown_name, "", "there is no such campaign file",
                          nearest_word(file.filename().string(), json_files_beside(file)));
    }
    if (fs::is_directory(file, error)) throw input_error(shown_name, "", "is a folder, not a campaign file");
    std::string text = files::whole_file(file, error, largest_text);
    if (error == std::errc::file_too_large)
        throw input_error(shown_name, "", "a campaign file has at most 64 MiB; give long lists as a CSV file");
    if (error) throw input_error(shown_name, "", fmt::format("the file cannot be read: {}", error.message()));
    return text;
}

}  // namespace

SharedScene read_scene(const Section& top, const fs::path& folder) {
    const Cursor place = top.at("scene");
    const auto known = scene_words();
    const auto& json = place.json();
    if (!json.is_string() || std::ranges::find(known, json.get_ref<const std::string&>()) == known.end())
        place.refuse("must be a scene or a machine that 'grainsweep scenes' lists",
                     json.is_string() ? nearest_word(json.get_ref<const std::string&>(), known) : std::string());
    const auto word = json.get<std::string>();
    if (word == program_word) return enter_program(read_program(top, folder));
    if (word == machine_word) return enter_machine(machine_of(top, folder));
    if (const auto machine = top.find("machine"))
        throw input_error(machine->path(), "", fmt::format("belongs to \"scene\": \"machine\", and this is {}", word));
    if (const auto program = top.find("program"))
        throw input_error(program->path(), "", fmt::format("belongs to \"scene\": \"program\", and this is {}", word));
    return scene_named(word);
}

Campaign campaign_in(const Json& document, const fs::path& folder) {
    const Section top(Cursor(document, "$"), campaign_keys);
    if (!top.find("scene")) throw input_error("$", "", "key 'scene' is missing: the experiment every case runs");
    Campaign campaign;
    campaign.name = read_name(top.at("campaign"));
    campaign.space.scene = read_scene(top, folder);
    campaign.seed = static_cast<std::uint64_t>(top.whole("seed", 1));
    campaign.replicates = top.whole("replicates", 1);
    if (const auto where = top.find("where")) campaign.where = where->text();

    campaign.common_random_numbers = read_common(top, campaign.scene());
    auto& space = campaign.space;
    space.factors = read_factors(top.at("factors"), *space.scene, folder);
    const auto simplex = top.find("simplex");
    if (simplex) read_simplex(*simplex, space);
    if (const auto fixed = top.find("fixed")) read_fixed(*fixed, space, folder);
    const std::size_t declared = space.factors.size();
    const auto calibration = top.find("calibration");
    if (calibration.has_value() == top.find("design").has_value()) {
        throw input_error("$", calibration ? "both" : "",
                          calibration ? "a campaign has either a \"design\" or a \"calibration\""
                                      : "key 'design' is missing: which points of the factor space are asked (or "
                                        "'calibration': what was measured)");
    }
    if (calibration) read_calibration(*calibration, campaign, folder);
    const Inputs given = fixed_as_stated(space);
    campaign.files = files_beside(document, folder);
    if (const auto powder = top.find("powder")) use_powder(*powder, folder, campaign);
    const auto accuracy = top.find("accuracy");
    const auto goal = accuracy ? read_accuracy(*accuracy, campaign) : std::nullopt;
    if (!accuracy && is_program(campaign.scene().name) && campaign.scene().accuracy.contains(AccuracyGoal::measure))
        campaign.accuracy = AccuracyGoal::measure;  // the parameters of a setting have no default
    resolve_accuracy(space, campaign.accuracy);
    check_relevance(top, space, declared, given);

    if (!calibration) read_design(top.at("design"), campaign, folder);
    if (const auto convergence = top.find("convergence")) {
        campaign.convergence = read_convergence(*convergence, campaign);
    }
    check_groups(top.at("factors"), campaign);
    if (simplex) check_simplex(*simplex, campaign);
    check_unfit(campaign);
    if (goal) check_accuracy(*accuracy, campaign);
    if (const auto model = top.find("model")) campaign.features = read_features(*model);
    if (const auto limits = top.find("limits")) campaign.limits = read_limits(*limits);
    if (const auto execution = top.find("execution")) campaign.execution = read_execution(*execution);
    return campaign;
}

Powder powder_beside(const Cursor& place, const fs::path& folder) {
    const fs::path file = folder / place.text();
    std::error_code none;
    if (!fs::is_regular_file(file, none))
        place.refuse("there is no such powder file beside the campaign file",
                     nearest_word(file.filename().string(), json_files_beside(file)));
    return read_powder(file);
}

Campaign parse_campaign(std::string_view text, const fs::path& folder, std::string_view experiment) {
    if (text.size() > largest_text) throw input_error("", "", "a campaign file has at most 64 MiB");
    const Json document = parse_json(text);
    if (is_machine_document(document))
        throw input_error("$", "",
                          "this is a machine file; a campaign file names it, with \"scene\": \"machine\" and "
                          "\"machine\": the name of this file");
    const auto names = experiment_names(document);
    const auto found = std::ranges::find(names, experiment);
    if (found == names.end() && !names.empty())
        throw input_error("$.calibration.experiments", "",
                          "the commands plan, run and calibrate take several experiments; this one takes one");
    auto campaign =
        names.empty() ? campaign_in(document, folder)
                      : std::move(read_experiments(document, folder)[static_cast<std::size_t>(found - names.begin())]);
    campaign.text = text;
    return campaign;
}

Campaign read_campaign(const fs::path& file, std::string_view experiment) {
    const std::string text = read_text(file);
    return asked_in(file, [&] { return parse_campaign(text, file.parent_path(), experiment); });
}

std::vector<std::string> read_experiment_names(const fs::path& file) {
    const std::string text = read_text(file);
    return asked_in(file, [&] { return experiment_names(parse_json(text)); });
}

bool states_goal(const fs::path& file) {
    const std::string text = read_text(file);
    const Json document = asked_in(file, [&] { return parse_json(text); });
    const auto accuracy = document.find("accuracy");
    return document.is_object() && accuracy != document.end() && accuracy->is_object();
}

}  // namespace grainsweep::campaign

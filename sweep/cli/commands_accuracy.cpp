// accuracy: error of a campaign's answers against their cost. Computes the same points of a campaign at every setting
// of the numerics, and with every single numerical input of a cheaper setting beside the most accurate one.
//
// Each is a campaign, NAME_fast, NAME_reference_precision_mixed, ..., in a separate database. The same command
// continues after an interruption, and more points extend the campaigns.
#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/relevance.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/figure_file.hpp"
#include "sweep/cli/program_campaign.hpp"
#include "sweep/cli/progress.hpp"
#include "sweep/cli/run_campaign.hpp"
#include "sweep/cli/run_ending.hpp"
#include "sweep/cli/written_campaign.hpp"
#include "sweep/report/accuracy.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/study/accuracy.hpp"
#include "sweep/workers/end_requests.hpp"
#include "sweep/workers/memory_room.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

using campaign::Campaign;

/// Numerics of one campaign.
struct Numerics {
    std::string name;  ///< of its campaign
    std::string says;
    std::string text;    ///< its campaign file
    bool moved = false;  ///< one input differs from the setting that it names
};

struct AccuracyRequest {
    std::filesystem::path config, database;
    std::string against = "reference";
    std::int64_t points = 32;
    std::optional<std::int64_t> workers;
    bool quiet = false;
    std::vector<std::string> observables;
    double tolerance = 0.01;
    FigureFile file;
};

struct AccuracyEnd {
    std::string campaign;
    std::vector<study::NumericsCost> costs;  ///< the last is `against`
    int exit_code = 0;                       ///< 0, or the exit code of an interrupted run
};

/// "0.35" -> "0p35": fit to be a part of a campaign's name.
std::string name_part(const std::string& text) {
    std::string part;
    for (const char c : text) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        part += plain ? c : c == '.' ? 'p' : c == '-' ? 'm' : '_';
    }
    return part;
}

/// Returns the factors of the design's first points within the `where` clause, one row each.
std::vector<std::vector<Value>> first_points(const Campaign& campaign, std::int64_t count) {
    const auto cases = campaign::unfold(campaign, store::make_filter(campaign.where, campaign::filter_names(campaign)));
    std::vector<std::vector<Value>> rows;
    std::optional<std::uint32_t> last;
    for (std::size_t i = 0; i < cases.size() && std::cmp_less(rows.size(), count); ++i) {
        if (last == cases.place(i).point) continue;
        last = cases.place(i).point;
        const auto inputs = cases.question(i).inputs;
        auto& row = rows.emplace_back();
        for (const auto& factor : campaign.space.factors) row.push_back(inputs.at(factor.name));
    }
    return rows;
}

/// Returns the fixed inputs of the file without those of its accuracy setting.
Inputs fixed_by_file(const Campaign& campaign) {
    Inputs stated = campaign.space.fixed;
    const auto setting = campaign.scene().accuracy.find(campaign.accuracy);
    if (setting == campaign.scene().accuracy.end()) return stated;
    for (const auto& [name, value] : setting->second)
        if (const auto held = stated.find(name); held != stated.end() && held->second == value) stated.erase(held);
    return stated;
}

std::string value_words(const Value& value) {
    return campaign::identity_text(value);
}

bool is_setting(const SceneInfo& scene, const Inputs& inputs) {
    return std::ranges::any_of(scene.accuracy, [&](const auto& setting) { return setting.second == inputs; });
}

/// One numerical input beside `against`.
struct Move {
    std::string name;
    Value value;
};

/// Returns the moves: each input of the other settings alone, except moves that result in one of the settings; then a
/// tenth of the stiffness, and ten times the stiffness.
std::vector<Move> moves_of(const Campaign& campaign, const std::string& against) {
    const auto& scene = campaign.scene();
    const auto& measure = scene.accuracy.find(against)->second;
    const Inputs stated = fixed_by_file(campaign);
    std::vector<Move> moves;
    std::set<std::pair<std::string, std::string>> known;
    for (const auto& [setting, inputs] : scene.accuracy)
        for (const auto& [name, value] : inputs) {
            Inputs moved = measure;
            moved.insert_or_assign(name, value);
            if (is_setting(scene, moved) || !campaign::is_left_open(campaign.space, stated, name)) continue;
            if (known.emplace(name, value_words(value)).second) moves.push_back({name, value});
        }
    const auto* stiffness = scene.find_parameter(scene.stiffness);
    if (stiffness == nullptr || !campaign::is_left_open(campaign.space, {}, scene.stiffness)) return moves;
    const auto held = campaign.space.fixed.find(scene.stiffness);
    const double value = std::get<double>(held == campaign.space.fixed.end() ? stiffness->default_value : held->second);
    for (const double moved : {value / 10, value * 10})
        if (std::get<Interval>(stiffness->bounds).contains(moved)) moves.push_back({scene.stiffness, moved});
    return moves;
}

/// The settings of the campaign's scene, then single inputs, then `against`. Throws InputError for a scene without
/// settings, a setting that it has not, and a campaign whose points follow from answers.
std::vector<Numerics> numerics_of(const Campaign& campaign, const std::string& against, std::int64_t points) {
    const auto& scene = campaign.scene();
    std::vector<std::string> offered;
    for (const auto& [name, inputs] : scene.accuracy) offered.push_back(name);
    if (offered.empty())
        throw campaign::input_error("CONFIG", campaign.name,
                                    fmt::format("scene '{}' has no accuracy settings", shown_scene(scene.name)));
    const auto reference = scene.accuracy.find(against);
    if (reference == scene.accuracy.end())
        throw campaign::input_error("--against", against, fmt::format("must be one of {}", campaign::listed(offered)),
                                    campaign::nearest_word(against, offered));
    if (designs::design_named(campaign.design).grows)
        throw campaign::input_error("CONFIG", campaign.design,
                                    "the points of this design depend on results; give a design that does not");
    const auto rows = first_points(campaign, points);
    std::set<std::string> numerical;
    if (!scene.stiffness.empty()) numerical.insert(scene.stiffness);
    for (const auto& [level, inputs] : scene.accuracy)
        for (const auto& [name, value] : inputs) numerical.insert(name);
    const std::vector<std::string> common(numerical.begin(), numerical.end());
    std::vector<Numerics> all;
    const auto add = [&](const std::string& name, const std::string& says, const std::string& accuracy, Inputs fixed) {
        const bool moved = !fixed.empty();
        const campaign::OtherNumerics other{name, fmt::format("{} at {}, by grainsweep accuracy.", campaign.name, says),
                                            accuracy, std::move(fixed), common};
        all.push_back({name, says, campaign::with_other_numerics(campaign.text, other, rows), moved});
    };
    // The setting that a program names as its reference would be shown twice; what the file decides is no difference.
    const Inputs stated = fixed_by_file(campaign);
    std::vector<std::string> decided;
    const auto differs = [&](const std::string& level) {
        bool free = false;
        for (const auto& [name, value] : scene.accuracy.find(level)->second) {
            const auto at = reference->second.find(name);
            if (at != reference->second.end() && at->second == value) continue;
            if (campaign::is_left_open(campaign.space, stated, name))
                free = true;
            else if (std::ranges::count(decided, name) == 0)
                decided.push_back(name);
        }
        return free;
    };
    for (const auto& level : offered)
        if (level != against && differs(level)) add(fmt::format("{}_{}", campaign.name, level), level, level, {});
    if (all.empty() && !decided.empty())
        throw campaign::input_error(
            "CONFIG", campaign.name,
            fmt::format("its settings differ in {} alone, which the file itself decides: they would agree whatever "
                        "their error",
                        campaign::listed(decided)));
    if (!decided.empty())
        std::cerr << fmt::format("note: {} is the same at all settings, as the file or the scene decides it\n",
                                 campaign::listed(decided));
    for (const auto& [name, value] : moves_of(campaign, against))
        add(fmt::format("{}_{}_{}_{}", campaign.name, against, name, name_part(value_words(value))),
            fmt::format("{} with {} = {}", against, name, value_words(value)), against, {{name, value}});
    add(fmt::format("{}_{}", campaign.name, against), against, against, {});
    return all;
}

AccuracyEnd run_accuracy(const AccuracyRequest& run) {
    const Campaign campaign = read_with_program(run.config);
    const auto numerics =
        campaign::asked_in(run.config, [&] { return numerics_of(campaign, run.against, run.points); });
    AccuracyEnd end;
    end.campaign = campaign.name;
    const auto database = run.database.empty() ? std::filesystem::path(campaign.name + "_accuracy.db") : run.database;
    const auto folder = std::filesystem::absolute(run.config).parent_path();
    std::vector<study::NumericsCampaign> campaigns;
    for (const auto& one : numerics) {
        if (!run.quiet) std::cerr << fmt::format("{}: {}\n", one.name, one.says);
        const WrittenCampaign file(folder, one.name, one.text, "accuracy");
        RunRequest request;
        request.config = file.path();
        request.database = database;
        request.workers = run.workers;
        request.quiet = run.quiet;
        request.goes_on = !campaigns.empty();
        const auto report = run_part(request);
        campaigns.push_back({one.name, one.says, one.moved});
        if (is_end_of_all(report.exit_code)) {
            end.exit_code = report.exit_code;
            return end;
        }
    }
    const store::Store store(database, store::Store::Mode::read);
    end.costs = study::accuracy_of(store, campaigns);
    return end;
}

/// The named observables, or the first one.
std::vector<std::string> drawn_observables(const AccuracyRequest& request, const AccuracyEnd& end) {
    if (!request.observables.empty() || end.costs.back().biases.empty()) return request.observables;
    return {end.costs.back().biases.front().observable};
}

int accuracy(const AccuracyRequest& request, report::Format format) {
    if (!(request.tolerance > 0 && request.tolerance < 1))
        throw campaign::input_error("--tolerance", fmt::format("{}", request.tolerance),
                                    "must be a number above 0 and below 1");
    const auto database = request.database.string();
    if (!request.file.output.empty()) (void)width_in_mm(request.file), (void)figure_type(request.file, database);
    workers::answer_end_requests();
    const auto end = run_accuracy(request);
    if (end.costs.empty()) {
        std::cerr << "interrupted; run it again to resume\n";
        return end.exit_code;
    }
    const auto document = report::accuracy_document(end.campaign, end.costs, request.observables, request.tolerance);
    if (!request.file.output.empty()) {
        const auto figure = report::accuracy_figure(end.costs, drawn_observables(request, end), request.tolerance);
        if (figure.panels.empty())
            throw campaign::input_error("-o", request.file.output,
                                        "there is nothing to draw: errors are shown relative to the mean, which is "
                                        "0 or missing; name another with --observable");
        write_figure(request.file, figure, database);
    }
    report::write(std::cout, document, format);
    return end.exit_code;
}

void declare_accuracy(Parser& parser, AccuracyRequest& request) {
    parser.add_option("CONFIG", request.config, "campaign file");
    parser
        .add_option("--points N", request.points, "points of the campaign's design that are computed at each setting")
        ->check(whole_number(2, 100'000))
        ->capture_default_str();
    parser.add_option("--against NAME", request.against, "the setting whose answers are the measure")
        ->capture_default_str();
    parser.add_option("--observable NAME", request.observables, "scalar to be judged, may be repeated; default: all")
        ->allow_extra_args(false);
    parser.add_option("--tolerance X", request.tolerance, "largest error, relative to the mean")->capture_default_str();
    parser.add_option("--db FILE", request.database, "database; default: NAME_accuracy.db in the current folder");
    parser.add_option("-j N", request.workers, "worker processes; 0: all cores; default: execution.workers")
        ->check(whole_number(0, 4096));
    parser.add_flag("--quiet", request.quiet, "print no progress");
    declare_figure_file(parser, request.file);
}

}  // namespace

std::vector<Command> accuracy_commands() {
    return {command<AccuracyRequest>("accuracy",
                                     "measures error against cost of each accuracy setting and numerical input",
                                     declare_accuracy, accuracy)};
}

}  // namespace grainsweep::cli

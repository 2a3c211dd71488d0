#include "sweep/cli/run_experiments.hpp"

#include "sweep/campaign/experiments.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/run_accurate.hpp"
#include "sweep/files/aside_file.hpp"
#include "sweep/study/calibration_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <string>
#include <vector>

namespace grainsweep::cli {
namespace {

/// The campaigns of all experiments in turn.
RunReport run_in_turn(const RunRequest& request, const std::vector<std::string>& names) {
    RunRequest one = request;
    std::map<std::string, std::int64_t> points;
    std::int64_t settled = 0;
    for (bool news = true; news; one.goes_on = true) {
        news = false;
        std::optional<RunReport> first;
        int code = 0;
        for (const auto& name : names) {
            one.experiment = name;
            if (request.max_cases) one.max_cases = *request.max_cases - settled;
            auto report = run_part(one);
            settled += report.settled;
            code = std::max(code, report.exit_code);
            const bool spent = request.max_cases && settled >= *request.max_cases;
            news = news || points[name] != report.points;
            points[name] = report.points;
            if (!first) first = report;
            if (!report.finished || spent) {
                first->exit_code = spent && report.finished ? 1 : report.exit_code;
                first->ending = report.finished ? "stopped; run again to resume" : report.ending;
                first->finished = false;
                return *first;
            }
        }
        first->exit_code = code;
        if (!news) return *first;
    }
    return {};
}

void write_beside(const std::filesystem::path& database, const std::string& name, const std::string& text) {
    files::AsideFile file(database.parent_path() / name);
    file.write(text);
    file.take_place();
}

/// For a calibration that has ended: writes the posterior, writes a powder if requested, and adds the verdict.
void conclude(RunReport& report, bool powder) {
    const store::Store archive(report.database, store::Store::Mode::read);
    const auto records = archive.campaigns();
    const auto record = std::ranges::find(records, report.campaign, &store::CampaignRecord::name);
    const auto found = study::calibration_report(archive, *record);
    if (!found || !found->found.posterior) return;
    const auto name = campaign::name_in_file(*record), draws = name + "_posterior.csv";
    write_beside(report.database, draws, study::posterior_csv(found->found));
    if (powder) {
        const auto text = study::powder_json(*found, name, draws);
        if (text.empty())
            throw campaign::wrong_question("--powder", "", "none of the factors is a property of a powder");
        write_beside(report.database, name + "_powder.json", text);
    }
    if (!found->verdict) return;
    report.ending = fmt::format("{}; {}", found->verdict->sentence, report.ending);
    if (!found->verdict->reproduced && report.exit_code == 0) report.exit_code = 1;
}

}  // namespace

RunReport run_file(const RunRequest& request) {
    if (request.spool.empty() && campaign::states_goal(request.config)) return run_accurate(request);
    const auto names =
        request.spool.empty() ? campaign::read_experiment_names(request.config) : std::vector<std::string>{};
    auto asked = request;
    if (!names.empty() && request.database.empty())
        asked.database =
            campaign::name_in_file(campaign::identity_of(campaign::read_campaign(request.config, names.front()))) +
            ".db";
    auto report = names.empty() ? run_campaign(asked) : run_in_turn(asked, names);
    if (report.finished) conclude(report, request.powder);
    return report;
}

}  // namespace grainsweep::cli

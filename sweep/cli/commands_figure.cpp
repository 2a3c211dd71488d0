// figure: one figure of the report as a file for print.
#include "sweep/campaign/input_error.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/figure_file.hpp"
#include "sweep/report/document.hpp"
#include "sweep/report/figures.hpp"
#include "sweep/report/file_size.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/catalogues.hpp"

#include <fmt/format.h>

#include <iostream>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::cli {
namespace {

using report::Document;
using report::Format;
using store::Store;
using store::Table;

struct FigureRequest {
    std::string database, name;
    FigureFile file;
    std::string campaign, observable, across, up, colour, axis, across_axis;
    bool lines = false;
};

/// Whether an axis is logarithmic; nothing: as the figure has it.
std::optional<bool> log_axis(const std::string& option, const std::string& word) {
    if (word.empty()) return std::nullopt;
    if (word != "log" && word != "linear")
        throw campaign::input_error(option, fmt::format("'{}'", word), "must be log or linear");
    return word == "log";
}

/// The one that is named, or the only one.
store::CampaignRecord campaign_of_figure(const Store& store, const std::string& name) {
    auto records = study::find_campaigns(store, name);
    if (records.size() > 1)
        throw campaign::input_error("--campaign", "",
                                    fmt::format("the database has several campaigns; name one of {}",
                                                campaign::listed(campaign::names_of(records))));
    return std::move(records.front());
}

int list_figures(const report::FigureSubject& subject, Format format) {
    Document shown{.rows = {report::columns_of(report::results::listed_figure), {}}};
    Table& table = shown.rows;
    for (const auto& info : report::figures_for(subject))
        table.rows.push_back(
            {info.name, info.panels.empty() ? Table::Cell{} : campaign::listed(info.panels), info.shows});
    if (table.rows.empty())
        throw campaign::input_error(
            "", "", fmt::format("campaign '{}' has no result to draw yet", subject.responses.campaign.name));
    shown.value = report::to_json(table);
    shown.say(fmt::format("figures of {}, {}", subject.responses.campaign.name, subject.response.name)).show(table);
    report::write(std::cout, shown, format);
    return 0;
}

int figure(const FigureRequest& request, Format format) {
    const double width = width_in_mm(request.file);
    const auto log = log_axis("--axis", request.axis), across_log = log_axis("--across-axis", request.across_axis);
    const auto& output = request.file.output;
    if (!request.name.empty()) (void)figure_type(request.file, request.database);
    if (request.name.empty() && !output.empty())
        throw campaign::input_error("-o", fmt::format("'{}'", output),
                                    "name a figure; grainsweep figure DB lists them");
    const Store store(request.database, Store::Mode::read);
    const auto responses = study::read_responses(store, campaign_of_figure(store, request.campaign));
    const report::FigureSubject subject{store,
                                        responses,
                                        responses.observable(request.observable),
                                        request.across,
                                        request.up,
                                        request.colour,
                                        log,
                                        across_log,
                                        request.lines};
    if (request.name.empty()) return list_figures(subject, format);
    const auto bytes = write_figure(request.file, report::figure_named(subject, request.name), request.database);
    Document shown{
        .rows = {report::columns_of(report::results::figure_file), {{output, static_cast<std::int64_t>(bytes)}}}};
    shown.value = report::to_json(shown.rows, 0);
    shown.say(fmt::format("{} ({:.4g} mm wide, {})", output, width, report::size_text(bytes)));
    report::write(std::cout, shown, format);
    return 0;
}

void declare_figure(Parser& parser, FigureRequest& request) {
    parser.add_option("DB", request.database, "the database");
    parser.add_option("[NAME]", request.name,
                      "the figure, or NAME:PANEL for one panel of it; without it the figures are listed");
    declare_figure_file(parser, request.file);
    parser.add_option("--campaign NAME", request.campaign, "name of a campaign; default: the only one");
    parser.add_option("--observable NAME", request.observable,
                      "scalar observable; default: that of the convergence rule, else the scene's first");
    parser.add_option("--across NAME", request.across, "of cases and map: the variable along the horizontal axis");
    parser.add_option("--up NAME", request.up, "of cases and map: the variable along the vertical axis");
    parser.add_option("--axis KIND", request.axis,
                      "axis of the observable, log or linear; default: log where all values are positive and the "
                      "largest is more than a hundred times the smallest");
    parser.add_option("--across-axis KIND", request.across_axis,
                      "of cases: axis of the variable along the horizontal one, log or linear");
    parser.add_flag("--lines", request.lines,
                    "of cases: means over a factor with 95 % errors, joined; a line per level of --colour");
    parser.add_option("--colour NAME", request.colour, "of cases and curves: the variable that colours them");
}

}  // namespace

std::vector<Command> figure_commands() {
    return {command<FigureRequest>("figure", "writes one figure of the report as PDF, SVG or PNG for print",
                                   declare_figure, figure)};
}

}  // namespace grainsweep::cli

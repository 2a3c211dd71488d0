// figure: one figure of the report as a file for print.
#include "sweep/campaign/quantity.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/page_file.hpp"
#include "sweep/report/document.hpp"
#include "sweep/report/figures.hpp"
#include "sweep/report/file_size.hpp"

#include <fmt/format.h>

#include <iostream>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace grainsweep::cli {
namespace {

using plot::FileType;
using report::Document;
using report::Format;
using store::Store;
using store::Table;

struct FigureRequest {
    std::string database, name, output, width = "85mm";
    std::string campaign, observable, across, up, colour;
};

/// The one that is named, or the only one.
store::CampaignRecord campaign_of_figure(const Store& store, const std::string& name) {
    auto records = study::find_campaigns(store, name);
    if (records.size() > 1)
        throw campaign::wrong_question("--campaign", "",
                                       fmt::format("the database has several campaigns; name one of {}",
                                                   campaign::listed(campaign::names_of(records))));
    return std::move(records.front());
}

double width_in_mm(const std::string& text) {
    constexpr double narrowest = 40, widest = 400;
    const std::string rule =
        fmt::format("must be a length from {:.0f} to {:.0f} mm, such as 85mm or 17cm", narrowest, widest);
    const auto refuse = [&](const std::string& why) {
        throw campaign::wrong_question("--width", fmt::format("'{}'", text), why);
    };
    if (text.find_first_not_of("0123456789.+-eE ") == std::string::npos) refuse(rule);  // a bare number has no unit
    const auto metres = campaign::in_si(text, "m");
    if (std::holds_alternative<std::string>(metres)) refuse(rule);
    const double mm = 1000 * std::get<double>(metres);
    if (!(mm >= narrowest && mm <= widest)) refuse(rule);
    return mm;
}

FileType type_of_output(const FigureRequest& request) {
    if (request.output.empty()) throw campaign::wrong_question("-o", "", "name a file that ends in .pdf, .svg or .png");
    const auto type = plot::file_type(request.output);
    if (!type)
        throw campaign::wrong_question("-o", fmt::format("'{}'", request.output), "must end in .pdf, .svg or .png");
    static constexpr FileKind pdf{"PDF file", "%pdf-"}, svg{"SVG file", "<?xml"}, png{"PNG file", "\x89png"};
    check_page_file("-o", request.output, request.database,
                    *type == FileType::pdf   ? pdf
                    : *type == FileType::svg ? svg
                                             : png);
    return *type;
}

int list_figures(const report::FigureSubject& subject, Format format) {
    Document shown{.rows = {{"figure", "panels", "shows"}, {}}};
    Table& table = shown.rows;
    for (const auto& info : report::figures_for(subject))
        table.rows.push_back(
            {info.name, info.panels.empty() ? Table::Cell{} : campaign::listed(info.panels), info.shows});
    if (table.rows.empty())
        throw campaign::wrong_question(
            "", "", fmt::format("campaign '{}' has no result to draw yet", subject.responses.campaign.name));
    shown.value = report::to_json(table);
    shown.say(fmt::format("figures of {}, {}", subject.responses.campaign.name, subject.response.name)).show(table);
    report::write(std::cout, shown, format);
    return 0;
}

int figure(const FigureRequest& request, Format format) {
    const double width = width_in_mm(request.width);
    std::optional<FileType> type;
    if (!request.name.empty()) type = type_of_output(request);
    if (request.name.empty() && !request.output.empty())
        throw campaign::wrong_question("-o", fmt::format("'{}'", request.output),
                                       "name a figure; grainsweep figure DB lists them");
    const Store store(request.database, Store::Mode::read);
    const auto responses = study::read_responses(store, campaign_of_figure(store, request.campaign));
    const report::FigureSubject subject{store,          responses,  responses.observable(request.observable),
                                        request.across, request.up, request.colour};
    if (!type) return list_figures(subject, format);
    const auto bytes = plot::drawn(report::figure_named(subject, request.name), width, *type);
    write_page_file(request.output, bytes);
    Document shown{.rows = {{"figure", "bytes"}, {{request.output, static_cast<std::int64_t>(bytes.size())}}}};
    shown.value = report::to_json(shown.rows, 0);
    shown.say(fmt::format("{} ({:.4g} mm wide, {})", request.output, width, report::size_text(bytes.size())));
    report::write(std::cout, shown, format);
    return 0;
}

void declare_figure(Parser& parser, FigureRequest& request) {
    parser.add_option("DB", request.database, "the database");
    parser.add_option("[NAME]", request.name,
                      "the figure, or NAME:PANEL for one panel of it; without it the figures are listed");
    parser.add_option("-o,--output FILE", request.output, "file to write; ends in .pdf, .svg or .png");
    parser.add_option("--width LENGTH", request.width, "width of the figure; default: 85mm, a column of most journals");
    parser.add_option("--campaign NAME", request.campaign, "name of a campaign; default: the only one");
    parser.add_option("--observable NAME", request.observable,
                      "scalar observable; default: that of the convergence rule, else the scene's first");
    parser.add_option("--across NAME", request.across, "of cases and map: the variable along the horizontal axis");
    parser.add_option("--up NAME", request.up, "of cases and map: the variable along the vertical axis");
    parser.add_option("--colour NAME", request.colour, "of cases and curves: the variable that colours them");
}

}  // namespace

std::vector<Command> figure_commands() {
    return {command<FigureRequest>("figure", "writes one figure of the report as PDF, SVG or PNG for print",
                                   declare_figure, figure)};
}

}  // namespace grainsweep::cli

// import: results of cases that were computed elsewhere.
#include "sweep/campaign/input_error.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/import_results.hpp"
#include "sweep/report/document.hpp"
#include "sweep/report/next_command.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/runs.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <iostream>
#include <string>

namespace grainsweep::cli {
namespace {

using report::Document;
using report::Format;

struct ImportArguments : ImportRequest {
    std::string decimal;
};

std::string said(const ImportReport& report, const std::string& file) {
    const auto all = report.placed + report.others;
    std::string text = fmt::format("{}: {} case{} imported into '{}'", file, all, all == 1 ? "" : "s", report.campaign);
    if (report.placed > 0 || report.others > 0) text += fmt::format(": {} of its design", report.placed);
    if (report.others > 0)
        text +=
            fmt::format(", {} beside it in '{}', which models use and moments do not", report.others, report.beside);
    if (report.known > 0) text += fmt::format("; {} were there before", report.known);
    if (report.unanswered > 0) text += fmt::format("; {} lines without an answer are left out", report.unanswered);
    return text;
}

int import_file(ImportArguments& request, Format format) {
    if (!request.decimal.empty() && request.decimal != "comma" && request.decimal != "point")
        throw campaign::input_error("--decimal", request.decimal, "must be comma or point",
                                    campaign::nearest_word(request.decimal, std::array{"comma", "point"}));
    request.results.decimal_comma = request.decimal == "comma";
    request.results.folder = request.config.parent_path();
    const auto report = import_results(request);
    const auto count = [](std::size_t n) { return static_cast<std::int64_t>(n); };
    Document shown{
        .rows = {report::columns_of(report::results::import),
                 {{report.campaign, report.database.string(), count(report.placed + report.others),
                   count(report.placed), count(report.others), count(report.known), count(report.unanswered)}}}};
    shown.value = report::to_json(shown.rows, 0);
    const auto file = report::shell_word(report.database.string());
    shown.say(said(report, request.results.file.filename().string()));
    shown.say(fmt::format(
        "\ndatabase {}\nnext: {}", report.database.string(),
        report::next_command(fmt::format("run {} --db {}", report::shell_word(request.config.string()), file))));
    shown.say("      " + report::next_command(fmt::format("sensitivity {}", file)));
    report::write(std::cout, shown, format);
    return 0;
}

void declare_import(Parser& parser, ImportArguments& request) {
    parser.add_option("FILE.csv", request.results.file,
                      "table with a line for each case; its header names the columns");
    parser.add_option("CONFIG", request.config, "campaign file whose cases they are");
    parser.add_option("[DB]", request.database, "database; default: NAME.db in the current folder");
    parser.add_option("--experiment NAME", request.experiment,
                      "experiment of the lines, for a calibration with several");
    parser.add_option("--accuracy WORD", request.accuracy,
                      "setting of the numerics of the lines, for a campaign with an error goal");
    parser.add_option("--decimal WORD", request.decimal, "comma: numbers have decimal commas; default: point");
    parser.add_option("--ignore COLUMN", request.results.ignored, "column that is not read; may be repeated")
        ->allow_extra_args(false);
    parser.add_flag("--partial", request.results.partial,
                    "accept a file that lacks columns of some scalar observables");
    parser.add_flag("--network-disk", request.network_disk,
                    "allow a database on a network file system; only one node may write it at a time");
}

}  // namespace

std::vector<Command> import_commands() {
    return {command<ImportArguments>("import", "stores results that were computed elsewhere, with their origin",
                                     declare_import, import_file)};
}

}  // namespace grainsweep::cli

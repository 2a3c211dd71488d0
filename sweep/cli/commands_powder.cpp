// powder: imports measured sizes; shows the meaning of a powder file.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/powder.hpp"
#include "sweep/campaign/powder_export.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/page_file.hpp"
#include "sweep/files/whole_file.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/catalogues.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <optional>
#include <system_error>
#include <utility>

namespace grainsweep::cli {
namespace {

using report::Format;
using report::Json;
using report::Result;
namespace results = report::results;

constexpr std::size_t largest_export = 16ULL << 20U;

struct PowderRequest {
    std::string action, file, output;
    std::string sizes, shares, unit, as, by, edge, smallest, largest, sample;
};

std::optional<std::string> stated(const std::string& word) {
    return word.empty() ? std::nullopt : std::optional(word);
}

int import_export(const PowderRequest& request, Format format) {
    check_converted_file(request.output, request.file, "export", {"table of sizes", "diameter,"});
    std::error_code error;
    const std::string bytes = files::whole_file(request.file, error, largest_export);
    if (error) throw campaign::input_error("EXPORT", request.file, fmt::format("cannot be read: {}", error.message()));
    const auto imported = campaign::asked_in(request.file, [&] {
        return campaign::import_sizes(
            bytes, {stated(request.sizes), stated(request.shares), stated(request.unit), stated(request.as),
                    stated(request.by), stated(request.edge), stated(request.smallest), stated(request.largest),
                    stated(request.sample)});
    });
    write_page_file(request.output, imported.csv);

    store::Table table{{"of the export", "taken"}, {}};
    for (const auto& [what, taken] : imported.facts) table.rows.push_back({what, taken});
    if (format == Format::csv) {
        report::write(std::cout, table, format);
    } else if (format == Format::json) {
        Json taken = Json::object();
        for (const auto& [what, found] : imported.facts) taken.add(what, found);
        report::write(std::cout, Result<results::powder_import>{{"output", request.output},
                                                                {"sentence", imported.sentence},
                                                                {"taken", taken},
                                                                {"notes", imported.notes},
                                                                {"warnings", imported.warnings}});
    } else {
        report::write(std::cout, table, format);
        for (const auto& note : imported.notes) std::cout << fmt::format("note: {}\n", note);
        std::cout << fmt::format("\n{}: {}\n", request.output, imported.sentence);
        for (const auto& warning : imported.warnings) std::cout << fmt::format("warning: {}\n", warning);
    }
    return 0;
}

/// Options of the import have no meaning for a powder file.
void refuse_import_options(const PowderRequest& request) {
    for (const auto& [option, word] :
         {std::pair{"-o", &request.output}, std::pair{"--unit", &request.unit}, std::pair{"--as", &request.as},
          std::pair{"--by", &request.by}, std::pair{"--edge", &request.edge}, std::pair{"--sizes", &request.sizes},
          std::pair{"--shares", &request.shares}, std::pair{"--smallest", &request.smallest},
          std::pair{"--largest", &request.largest}, std::pair{"--sample", &request.sample}})
        if (!word->empty()) throw campaign::input_error(option, *word, "belongs to powder import");
}

std::string micrometres(double metres) {
    return fmt::format("{:.4g} um", 1e6 * metres);
}

/// A bar for each class of sizes: its share of the volume (#) and of the number (.).
void plot_sizes(const campaign::PowderSizes& sizes) {
    constexpr int classes = 16;
    constexpr int width = 28;
    const auto all = campaign::size_classes(sizes, classes);
    double highest = 0;
    for (const auto& one : all) highest = std::max({highest, one.volume, one.number});
    const auto bar = [&](double share, char sign) {
        return std::string(static_cast<std::size_t>(std::lround(width * share / highest)), sign);
    };
    std::cout << fmt::format("\n{:>12}  {:<{}}  {}\n", "sizes up to", "volume", width + 8, "number");
    for (const auto& one : all)
        std::cout << fmt::format("{:>12}  {:5.1f} % {:<{}}  {:5.1f} % {}\n", micrometres(one.to), 100 * one.volume,
                                 bar(one.volume, '#'), width, 100 * one.number, bar(one.number, '.'));
}

int show_powder(const PowderRequest& request, Format format) {
    refuse_import_options(request);
    const auto powder = campaign::read_powder(request.file);
    const auto numbers = campaign::numbers_of(powder);
    store::Table table{{"quantity", "unit", "value"}, {}};
    using Numbers = Result<results::powder_numbers>;
    Numbers values;
    const auto row = [&](Numbers::Key what, double value) {
        table.rows.push_back({std::string(what.field->name), std::string(what.field->unit), value});
        values.add(what, value);
    };
    if (powder.sizes) {
        const auto& sizes = *powder.sizes;
        row("d10 by volume", sizes.d10), row("d50 by volume", sizes.d50), row("d90 by volume", sizes.d90);
        row("d10 by number", sizes.number_d10), row("d50 by number", sizes.number_d50);
        row("d90 by number", sizes.number_d90);
        row("smallest", sizes.smallest), row("largest", sizes.largest);
        row("mass cut off below", sizes.cut_below), row("mass cut off above", sizes.cut_above);
    }
    if (powder.unit()) row("diameter that stands for it", *powder.unit());
    row("bond number", numbers.bond_number);
    row("Rayleigh time of the smallest", numbers.rayleigh_time);
    row("time step at 1 m/s", numbers.time_step);
    row("core time of 1,000 particles for 1 s", numbers.seconds);
    const std::string lacks = campaign::lacks_of(powder);
    if (format == Format::json) {
        report::write(std::cout,
                      Result<results::powder>{{"powder", powder.name}, {"values", values}, {"lacks", lacks}});
        return 0;
    }
    if (format == Format::text) std::cout << fmt::format("powder {} ({})\n\n", powder.name, request.file);
    report::write(std::cout, table, format);
    if (format == Format::text && powder.sizes) plot_sizes(*powder.sizes);
    if (format == Format::text && !lacks.empty())
        std::cout << fmt::format("\nwarning: it has no {}; a scene takes its own, and so do the numbers above\n",
                                 lacks);
    return 0;
}

int powder(const PowderRequest& request, Format format) {
    constexpr std::array<std::string_view, 2> actions = {"import", "show"};
    if (request.action == "import") return import_export(request, format);
    if (request.action == "show") return show_powder(request, format);
    throw campaign::input_error("ACTION", request.action, "must be 'import' or 'show'",
                                campaign::nearest_word(request.action, actions));
}

}  // namespace

std::vector<Command> powder_commands() {
    const auto arguments = [](Parser& parser, PowderRequest& request) {
        parser.add_option("ACTION", request.action,
                          "import: an instrument's export becomes a file of sizes; show: what a powder file means");
        parser.add_option("FILE", request.file,
                          "the export of a laser diffraction instrument or of sieves, text or .xlsx; the powder file");
        parser.add_option("-o,--output FILE.csv", request.output,
                          "file of sizes to write, for size_file or a powder file");
        parser.add_option(
            "--unit UNIT", request.unit,
            "unit of the sizes, where the export does not state it; also phi, and sieves by number: astm, "
            "tyler, british");
        parser.add_option(
            "--as KIND", request.as,
            "what the shares are: passing (below a size), retained (above it, summed) or each (of a class)");
        parser.add_option("--by BASIS", request.by, "what they are shares of: volume, mass, area or number");
        parser.add_option("--edge EDGE", request.edge,
                          "what a class's size is: its lower or upper edge, or its middle");
        parser.add_option("--sizes COLUMN", request.sizes, "column of the sizes, by header or number from 1");
        parser.add_option("--shares COLUMN", request.shares, "column of the shares");
        parser.add_option("--sample NAME", request.sample,
                          "of several samples, tables or sheets: number, name or a part of it");
        parser.add_option("--smallest SIZE", request.smallest, "lower end of what lies below the first size: \"5 um\"");
        parser.add_option("--largest SIZE", request.largest, "upper end of what lies above the last size");
    };
    return {command<PowderRequest>("powder",
                                   "imports measured particle sizes; shows sizes, numbers and cost of a powder file",
                                   arguments, powder)};
}

}  // namespace grainsweep::cli

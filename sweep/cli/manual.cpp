#include "sweep/cli/manual.hpp"

#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/keys.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/program_keys.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/designs/design.hpp"

#include "solver/scenes/scene.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::cli {

namespace {

/// Text as troff reads it: no character of it is a request, a dash is one that can be copied.
std::string plain(std::string_view text) {
    std::string out;
    bool line_start = true;
    for (const char c : text) {
        if (line_start && (c == '.' || c == '\'')) out += "\\&";
        line_start = c == '\n';
        if (c == '\\') {
            out += "\\e";
        } else if (c == '-') {
            out += "\\-";
        } else if (c == '\'') {
            out += "\\(aq";
        } else if (c == '^') {
            out += "\\(ha";
        } else if (c == '~') {
            out += "\\(ti";
        } else if (c == '`') {
            out += "\\(ga";
        } else {
            out += c;
        }
    }
    return out;
}

std::string bold(std::string_view text) {
    return "\\fB" + plain(text) + "\\fR";
}
std::string italic(std::string_view text) {
    return "\\fI" + plain(text) + "\\fR";
}

std::string section(std::string_view title) {
    return fmt::format(".SH {}\n", title);
}
/// A tagged paragraph; both are troff already.
std::string item(const std::string& tag, const std::string& text) {
    return ".TP\n" + tag + "\n" + text + "\n";
}
std::string example(std::string_view lines) {
    return ".nf\n.RS\n" + plain(lines) + "\n.RE\n.fi\n";
}

std::string tag_of(const ArgumentInfo& argument) {
    if (!argument.place.empty()) return italic(argument.place);
    std::string tag;
    for (const auto& name : argument.names) tag += (tag.empty() ? "" : ", ") + bold(name);
    return argument.value.empty() ? tag : tag + " " + italic(argument.value);
}

std::string usage_of(const CommandInfo& command) {
    std::string usage = bold(command.name);
    for (const auto& argument : command.arguments) {
        if (argument.place.empty()) continue;
        usage += argument.required ? " " + italic(argument.place) : " [" + italic(argument.place) + "]";
    }
    return usage + " [" + italic("options") + "]";
}

bool everywhere(const ArgumentInfo& argument) {
    const auto& names = argument.names;
    return !names.empty() && (names.back() == "--help" || names.back() == "--format" || names.back() == "--wide");
}

std::string commands_section(std::span<const CommandInfo> commands) {
    std::string text = section("COMMANDS");
    for (const auto& command : commands) {
        text += fmt::format(".SS {}\n{}.\n", usage_of(command), plain(command.summary));
        for (const auto& argument : command.arguments)
            if (!everywhere(argument)) text += item(tag_of(argument), plain(argument.help) + ".");
    }
    text += ".SS Options of every command\n";
    for (const auto& argument : commands.front().arguments)
        if (everywhere(argument)) text += item(tag_of(argument), plain(argument.help) + ".");
    return text;
}

std::string keys_section() {
    std::string text = section("CAMPAIGN FILE");
    text += plain(
                "One JSON object, in SI units where a number has no unit. Any object may have \"notes\", a text or a "
                "list of texts. grainsweep schema "
                "prints the JSON Schema.") +
            "\n";
    const auto add = [&text](std::string_view title, std::span<const Field> keys) {
        text += fmt::format(".SS {}\n", title);
        for (const auto& key : keys) {
            std::string meaning(key.meaning);
            if (key.required) meaning += " (required)";
            if (!key.standard.empty()) meaning += fmt::format(" (default {})", key.standard);
            text += item(bold(std::string(key.name)), plain(meaning) + ".");
        }
    };
    add("The campaign", campaign::campaign_keys());
    add("A factor", campaign::factor_keys());
    add("Convergence", campaign::convergence_keys());
    add("A calibration", campaign::calibration_keys());
    add("An experiment of a calibration", campaign::experiment_keys());
    add("A target of a calibration", campaign::target_keys());
    add("Program", campaign::program_keys());
    add("Limits", campaign::limits_keys());
    add("Execution", campaign::execution_keys());
    return text;
}

std::string catalogue_sections() {
    std::string text = section("SCENES");
    for (const auto& scene : campaign::named_scenes()) text += item(bold(scene->shown()), plain(scene->summary) + ".");
    text += item(bold(std::string(campaign::program_word)), plain(std::string(campaign::program_summary()) + "."));
    text += section("DESIGNS");
    for (const auto& design : designs::design_catalogue()) text += item(bold(design.name), plain(design.summary));
    return text;
}

using Entries = std::vector<std::pair<std::string_view, std::string_view>>;

std::string entries_section(std::string_view title, const Entries& entries) {
    std::string text = section(title);
    for (const auto& [tag, meaning] : entries) text += item(bold(tag), plain(meaning));
    return text;
}

const Entries& exit_codes() {
    static const Entries codes = {
        {"0", "Success. run: every case is completed or skipped, or the campaign converged."},
        {"1",
         "run: finished, but cases failed or are left. solve, replay: no result, or a different one. converge --check: "
         "not converged."},
        {"2", "Invalid arguments or campaign file. Nothing was written."},
        {"3", "The disk is full, or the database is damaged or in use. Stored results are intact."},
        {"75", "Out of time, or ended by TERM or USR1. Run again to resume."},
        {"130", "Interrupted by Ctrl-C. Run again to resume."},
    };
    return codes;
}

const Entries& files() {
    static const Entries entries = {
        {"NAME.db",
         "The database of campaign NAME, in SQLite's format: one file after every command. While a run "
         "writes it, NAME.db-wal and NAME.db-shm belong to it."},
        {"NAME.artefacts",
         "Folder beside the database with shared starting states and checkpoints. It may be removed while no "
         "run is active."},
        {"NAME.html", "The page that report writes."},
    };
    return entries;
}

const Entries& functions_of_query() {
    static const Entries entries = {
        {"sd(x), stddev_pop(x), var_pop(x)", "Standard deviation and variance, dividing by N."},
        {"stddev(x), stddev_samp(x), variance(x), var_samp(x)", "The same, dividing by N - 1."},
        {"median(x), quantile(x, p), percentile(x, P)", "p from 0 to 1, P from 0 to 100; linear between values."},
        {"above(x, t), below(x, t)", "Share of the values beyond t."},
        {"quantile_error(x, p, sequence), above_error(x, t, sequence), below_error(x, t, sequence)",
         "95 % half-widths of these, over the independent sequences of the design; a view of a campaign has the column "
         "sequence. NULL: too few values."},
        {"corr(x, y), covar_pop(x, y), covar_samp(x, y)", "Pearson's correlation, covariances."},
        {"pearson_skewness(x), g1(x), kurtosis(x)",
         "3 (mean - median) / sd, the moment skewness, the kurtosis (3 for a "
         "normal distribution)."},
    };
    return entries;
}

}  // namespace

std::string manual_page(std::span<const CommandInfo> commands) {
    std::string text = fmt::format(".TH GRAINSWEEP 1 \"\" \"grainsweep {}\" \"User Commands\"\n.ad l\n.nh\n",
                                   plain(program_version()));
    text += section("NAME") + "grainsweep \\- parameter sweeps of granular processes\n";
    text += section("SYNOPSIS");
    for (const auto& command : commands)
        text += (&command == &commands.front() ? "" : ".br\n") + bold("grainsweep") + " " + usage_of(command) + "\n";
    text += section("DESCRIPTION");
    text +=
        "Describe a granular process, its factors and a design in one JSON file. grainsweep generates the points, runs "
        "every case in worker processes and stores the results in one SQLite database. Statistics, sensitivities and "
        "reports are computed from the database. Run a campaign again to resume it.\n";
    text += commands_section(commands);
    text += keys_section();
    text += catalogue_sections();
    text += entries_section("FUNCTIONS OF QUERY", functions_of_query());
    text += section("OUTPUT");
    text += plain(
                "Text is wrapped to the terminal, else to COLUMNS, else to 100 columns. Columns that do not fit are "
                "named below the table; --wide shows all of them. Numbers in csv and json read back as the same "
                "double. Whole numbers beyond 2^53, such as seeds, are text: \"5577006791947779410\" in json, "
                "5_577_006_791_947_779_410 in csv; --seed reads both.") +
            "\n";
    text += entries_section("EXIT STATUS", exit_codes());
    text += entries_section("ENVIRONMENT", {{"COLUMNS", "Width of text where standard output is not a terminal."}});
    text += entries_section("FILES", files());
    text += section("EXAMPLES");
    text += example(
        "grainsweep plan configs/quickstart.json\ngrainsweep run configs/quickstart.json\n"
        "grainsweep query quickstart.db \"SELECT avg(mfr), stddev(mfr) FROM quickstart\"\n"
        "grainsweep report quickstart.db");
    text += section("SEE ALSO") + ".BR sqlite3 (1)\n";
    return text;
}

}  // namespace grainsweep::cli

#include "tests/documents/command_tables.hpp"

#include "tests/documents/page.hpp"
#include "tests/documents/table_rows.hpp"

#include <fmt/format.h>

#include <regex>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::tests {
namespace {

/// Entries of a section of --help, in its order: what they are called and what they mean.
std::vector<std::pair<std::string, std::string>> entries_of_help(std::vector<std::string> command,
                                                                 std::string_view section) {
    static const std::regex entry(R"(^  (\S+(?: \S+)*)(?: {2,}(.*))?$)"), more(R"(^ {20,}(\S.*)$)");
    command.emplace_back("--help");
    std::istringstream help(answer_of(command));
    std::vector<std::pair<std::string, std::string>> entries;
    bool inside = false;
    for (std::string line; std::getline(help, line);) {
        if (!line.starts_with(' ')) inside = line == section;
        std::smatch match;
        if (inside && std::regex_match(line, match, more))
            entries.back().second += (entries.back().second.empty() ? "" : " ") + match[1].str();
        else if (inside && std::regex_match(line, match, entry))
            entries.emplace_back(match[1], match[2]);
    }
    return entries;
}

}  // namespace

std::string commands_table() {
    std::string table = head({"command", "does"});
    for (const auto& [name, summary] : entries_of_help({}, "Subcommands:"))
        table += row({fmt::format("[`{0}`](#{0})", name), summary});
    return table;
}

std::string command_table(const std::string& command) {
    std::string table = head({"argument", "meaning"});
    for (auto [name, meaning] : entries_of_help({command}, "Positionals:"))
        table += row({"`" + name.substr(0, name.find(' ')) + "`", meaning});
    for (const auto& [name, meaning] : entries_of_help({command}, "Options:"))
        if (name != "-h,--help" && name != "--format FORMAT" && name != "--wide")
            table += row({"`" + name.substr(0, name.find(" REQUIRED")) + "`", meaning});
    if (table == head({"argument", "meaning"})) table = "No arguments.\n";
    for (const auto& [example, ignored] : entries_of_help({command}, "Example:"))
        table += "\nExample: `" + example + "`\n";
    return table;
}

std::string manual_table(const std::string& section) {
    static const std::regex mark(R"(\\f[BR]|\\&)"), dash(R"(\\-)"), quote(R"(\\\(aq)");
    std::istringstream manual(answer_of({"manual"}));
    std::string table = head({section == "EXIT STATUS" ? "code" : "function", "meaning"});
    std::string tag;
    bool inside = false, tagged = false;
    for (std::string line; std::getline(manual, line);) {
        if (line.starts_with(".SH ")) inside = line == ".SH " + section;
        if (!inside || line.starts_with(".SH ")) continue;
        const std::string text =
            std::regex_replace(std::regex_replace(std::regex_replace(line, mark, ""), dash, "-"), quote, "'");
        if (line == ".TP")
            tagged = false;
        else if (!tagged)
            tag = text, tagged = true;
        else
            table += row({code(tag), text});
    }
    return table;
}

}  // namespace grainsweep::tests

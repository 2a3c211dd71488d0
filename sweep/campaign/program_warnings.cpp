#include "sweep/campaign/program_warnings.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/formula.hpp"
#include "sweep/campaign/placeholders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>

namespace grainsweep::campaign {
namespace {

/// Parameters whose values differ between cases or settings, in the order of their names.
std::set<std::string> varied(const Campaign& campaign, const Program& program) {
    std::set<std::string> names;
    for (const auto& factor : campaign.space.factors) names.insert(factor.name);
    for (const auto& setting : program.accuracy)
        for (const auto& [name, value] : setting.inputs) names.insert(name);
    for (const auto& expression : campaign.space.expressions) names.insert(expression.name);
    return names;
}

/// Whether a parameter decides others.
bool decides(const Campaign& campaign, const std::string& name) {
    const auto& space = campaign.space;
    return std::ranges::any_of(
               space.expressions,
               [&](const auto& expression) { return std::ranges::count(expression.formula.names(), name) > 0; }) ||
           std::ranges::any_of(space.factors, [&](const Factor& factor) {
               return !names_in(factor.when, [&](std::string_view word) { return word == name; }).empty();
           });
}

/// Returns the braces of another place that surround the name, in a part of a sentence; empty: there are none.
std::string wrong_braces(const Program& program, const std::string& name) {
    for (std::size_t k = 0; k < program.command.size(); ++k)
        for (const char* form : {"{{{{{}}}}}", "{{{{ {} }}}}", "{{ {} }}"}) {
            const auto braces = fmt::format(fmt::runtime(form), name);
            if (program.command[k].find(braces) != std::string::npos)
                return fmt::format("; command[{}] has {}, and a value comes for {{{}}}", k, braces, name);
        }
    for (const auto& file : program.files)
        for (const char* form : {"{{{}}}", "{{{{{}}}}}", "{{{{ {} }}}}"}) {
            const auto braces = fmt::format(fmt::runtime(form), name);
            if (file.contents.find(braces) == std::string::npos) continue;
            if (file.is_template)
                return fmt::format("; {} has {}, and a value comes for {{{{ {} }}}}", file.name, braces, name);
            if (braces.starts_with("{{"))
                return fmt::format("; {} has {}, and is under \"files\", not \"templates\"", file.name, braces);
        }
    return {};
}

/// Returns a warning for each file that the command names by an absolute path and that is no installed program.
std::vector<std::string> uncounted_files(const Program& program) {
    namespace fs = std::filesystem;
    constexpr std::uintmax_t largest = 64ULL << 20U;  // that "files" takes
    constexpr std::array<std::string_view, 4> installed = {"/usr/", "/opt/", "/bin/", "/lib"};
    std::vector<std::string> warnings;
    for (std::size_t k = 0; k < program.command.size(); ++k) {
        const auto& word = program.command[k];
        const auto is_below = [&](std::string_view folder) { return word.starts_with(folder); };
        std::error_code error;
        if (!word.starts_with('/') || std::ranges::any_of(installed, is_below) || !fs::is_regular_file(word, error) ||
            fs::file_size(word, error) > largest)
            continue;
        const auto is_script = [&] {
            std::array<char, 2> begin{};
            std::ifstream(word).read(begin.data(), begin.size());
            return begin[0] == '#' && begin[1] == '!';
        };
        if (k > 0 || is_script())
            warnings.push_back(
                fmt::format("command[{}] names a file whose contents are no part of a case, so that its "
                            "changes are not noticed: list it under \"files\"",
                            k));
    }
    return warnings;
}

}  // namespace

std::vector<PlacedName> placed_names(const Program& program) {
    std::vector<PlacedName> placed;
    const auto note = [&](const std::string& place) {
        return [&placed, place](std::string_view name, std::string_view format) {
            placed.push_back({std::string(name), std::string(format), place});
            return std::optional<std::string>(std::string());
        };
    };
    for (std::size_t k = 0; k < program.command.size(); ++k)
        (void)filled_command(program.command[k], note(fmt::format("command[{}]", k)));
    for (const auto& [variable, text] : program.environment)
        (void)filled_command(text, note("environment." + variable));
    for (const auto& file : program.files) {
        if (!file.is_template) continue;
        try {
            (void)filled_template(file.contents, note(file.name));
        } catch (const std::invalid_argument&) {  // of a stranger's database; the campaign reader refuses it
        }
    }
    return placed;
}

std::vector<Warning> format_warnings(const std::vector<PlacedName>& placed, const Inputs& inputs) {
    constexpr double largest_change = 0.01;
    std::vector<Warning> warnings;
    for (const auto& [name, format, place] : placed) {
        const auto input = inputs.find(name);
        if (format.empty() || input == inputs.end()) continue;
        const Value real = coerced(input->second, Value{0.0});
        const auto* number = std::get_if<double>(&real);
        if (number == nullptr || !NumberFormat::parse(format)) continue;
        const auto text = program_value(input->second, format);
        auto digits = trimmed(text);
        if (digits.starts_with('+')) digits.remove_prefix(1);
        const auto read = number_in(digits);
        if (!read || std::abs(*read - *number) <= largest_change * std::abs(*number)) continue;
        auto kind = fmt::format("format of {} in {}", name, place);
        if (std::ranges::find(warnings, kind, &Warning::kind) != warnings.end()) continue;
        warnings.push_back({std::move(kind), fmt::format("{} makes {} of {}: the program gets another number", format,
                                                         digits, to_text(input->second))});
    }
    return warnings;
}

std::vector<std::string> program_warnings(const Campaign& campaign) {
    const auto program = known_program(campaign.scene().name);
    if (program == nullptr) return {};
    auto warnings = uncounted_files(*program);
    if (program->protocol == Program::Protocol::lines) return warnings;
    const auto placed = placed_names(*program);
    const auto stands = [&](const std::string& name) {
        return std::ranges::find(placed, name, &PlacedName::name) != placed.end();
    };
    const auto names = varied(campaign, *program);
    const bool reads_all = std::ranges::any_of(
        program->files, [](const ProgramFile& file) { return file.contents.find("inputs.json") != std::string::npos; });
    const bool some_stand = std::ranges::any_of(names, stands);
    if (campaign.replicates > 1 && some_stand && !reads_all && !stands("seed") && !stands("seed31") &&
        !stands("seed_prime") && !stands("case"))
        warnings.push_back(
            fmt::format("the {} replicates of a point differ in their seed, which stands in no placeholder: {{seed}}, "
                        "{{seed31}} or "
                        "{{seed_prime}}",
                        campaign.replicates));
    for (const auto& name : names) {
        if (stands(name) || decides(campaign, name)) continue;
        const auto braces = wrong_braces(*program, name);
        if (braces.empty() && (reads_all || !some_stand)) continue;
        warnings.push_back(
            fmt::format("{} stands in no placeholder of command, environment or templates: the program "
                        "finds its value in inputs.json alone{}",
                        name, braces));
    }
    return warnings;
}

}  // namespace grainsweep::campaign

#include "sweep/campaign/program_section.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/placeholders.hpp"
#include "sweep/campaign/program_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <ranges>
#include <regex>
#include <stdexcept>
#include <utility>

namespace grainsweep::campaign {
namespace {

constexpr std::size_t most_arguments = 1000;

/// Bytes in "4 GB".
std::int64_t read_bytes(const Cursor& place) {
    static const std::regex form(R"(([0-9]+(?:\.[0-9]+)?) *([kKMGT]?)(i?)B)");
    constexpr double least = 1e6, most = 1e15;
    const auto text = place.text();
    std::smatch parts;
    if (text.size() > 40 || !std::regex_match(text, parts, form))
        place.refuse("must be a number and a unit: \"4 GB\", \"500 MiB\"");
    const double step = parts[3].length() > 0 ? 1024 : 1000;
    const auto power =
        parts[2].length() == 0 ? 0 : std::string("kMGT").find(parts[2] == "K" ? "k" : parts[2].str()) + 1;
    const double bytes = number_in(parts[1].str()).value_or(0) * std::pow(step, static_cast<double>(power));
    if (!(bytes >= least && bytes <= most)) place.refuse("must be from 1 MB to 1000 TB");
    return static_cast<std::int64_t>(bytes);
}

void check_arguments(const Cursor& place, const std::vector<std::string>& words) {
    if (words.empty()) place.refuse("needs a program and its arguments");
    if (words.size() > most_arguments) place.refuse(fmt::format("at most {} arguments", most_arguments));
}

void read_version(const Section& section, Program& program) {
    const auto place = section.find("version");
    if (!place) return;
    const Section version(*place, program_version_keys);
    program.version_command = version.words("command", {});
    check_arguments(version.at("command"), program.version_command);
    program.version_match = read_output_pattern(version.at("match"), "version");
}

/// Every name in braces means something.
class Names {
public:
    explicit Names(const Program& program) : lines_(program.protocol == Program::Protocol::lines) {
        known_ = {"threads", "processes"};
        if (lines_) return;
        known_.insert(known_.end(), {"seed", "seed31", "seed_prime", "case"});
        for (const auto& parameter : program.parameters) known_.push_back(parameter.name);
        parameters_ = program.parameters;
    }
    void check(const Cursor& place, const std::string& text) const {
        (void)filled_command(text, [&](auto name, auto format) { return look_up(place, name, format); });
    }
    void check_template(const Cursor& place, const std::string& text) const {
        try {
            (void)filled_template(text, [&](auto name, auto format) { return look_up(place, name, format); });
        } catch (const std::invalid_argument& error) {
            place.refuse(error.what());
        }
    }

private:
    std::optional<std::string> look_up(const Cursor& place, std::string_view name, std::string_view format) const {
        const bool is_known = std::ranges::find(known_, name) != known_.end();
        const auto form = NumberFormat::parse(format);
        if (!format.empty() && !form && !is_known) return std::nullopt;  // braces of the command's own
        if (!is_known)
            throw input_error(place.path(), name,
                              fmt::format("is neither a factor nor a fixed value{}; it may be {}",
                                          lines_ ? " that is known when the program starts" : "", in_words(known_)),
                              nearest_word(name, known_));
        if (!format.empty()) check_format(place, name, format, form);
        return std::string();
    }
    void check_format(const Cursor& place, std::string_view name, std::string_view format,
                      const std::optional<NumberFormat>& form) const {
        const auto refuse = [&](std::string_view why) {
            throw input_error(place.path(), fmt::format("{{{}:{}}}", name, format), why);
        };
        if (!form) refuse("is no format of a number: %.3e, %8.4f, %g, %d");
        const auto parameter = std::ranges::find(parameters_, name, &ProgramParameter::name);
        if (parameter == parameters_.end()) {
            if (name == "case") refuse("'case' is a word, and a format is for numbers");
        } else if (parameter->is_word()) {
            refuse(fmt::format("the values of '{}' are words, and a format is for numbers", name));
        } else if (form->is_whole() && !parameter->whole) {
            refuse(fmt::format("%d is for whole numbers: declare \"whole\": true in program.parameters.{}", name));
        }
    }

    bool lines_;
    std::vector<std::string> known_;
    std::vector<ProgramParameter> parameters_;
};

void check_names(const Section& section, const Program& program) {
    const Names names(program);
    for (std::size_t k = 0; k < program.command.size(); ++k) names.check(section.at("command")[k], program.command[k]);
    for (const auto& [variable, text] : program.environment) names.check(section.at("environment")[variable], text);
    const auto templates = section.find("templates");
    if (!templates) return;
    if (program.protocol == Program::Protocol::lines && !templates->elements().empty())
        templates->refuse("with the protocol \"lines\" no file belongs to a case; give what it needs under \"files\"");
    for (const auto& place : templates->elements()) {
        const auto file = std::ranges::find(program.files, place.json().get<std::string>(), &ProgramFile::name);
        names.check_template(place, file->contents);
    }
}

void read_environment(const Section& section, Program& program) {
    const auto all = section.find("environment");
    if (!all) return;
    if (!all->json().is_object()) all->refuse("must be an object of variables and texts");
    for (const auto& [name, value] : all->json().items()) {
        const Cursor here(value, path_of(all->path(), name));
        if (!is_plain_name(name)) here.refuse("the name of a variable is letters, digits and _, not a digit first");
        if (!value.is_string()) here.refuse("must be a text");
        program.environment[name] = value.get<std::string>();
    }
}

/// A path in the command leads to one of the files of the case, which are there under their names alone.
void check_command_word(const Section& section, const Program& program) {
    const Cursor place = section.at("command")[std::size_t{0}];
    std::string word = program.command.front();
    if (word.starts_with('/') || word.find('/') == std::string::npos || word.find('{') != std::string::npos) return;
    if (word.starts_with("./")) word = word.substr(2);
    std::vector<std::string> known;
    for (const auto& file : program.files) known.push_back("./" + file.name);
    const auto file = std::ranges::find(program.files, word, &ProgramFile::name);
    if (file == program.files.end())
        place.refuse("a program is found by the search path, by an absolute path or among \"files\"",
                     nearest_word(word, known));
    if (!file->executable) place.refuse("this file is not executable; chmod +x it, or name what runs it first");
}

}  // namespace

std::shared_ptr<const Program> read_program(const Section& top, const std::filesystem::path& folder) {
    const auto place = top.find("program");
    if (!place)
        throw input_error(top.place().path(), "",
                          "key 'program' is missing: the command that answers a case (grainsweep scenes program)");
    const Section section(*place, program_keys);
    auto program = std::make_shared<Program>();
    program->command = section.words("command", {});
    check_arguments(section.at("command"), program->command);
    program->protocol =
        section.word("protocol", "files") == "lines" ? Program::Protocol::lines : Program::Protocol::files;
    program->parameters = read_program_parameters(top, section);
    read_program_accuracy(section, *program);
    read_program_observables(section, *program);
    std::vector<std::string> measured;
    for (const auto& observable : program->observables) {
        const Cursor named = section.at("observables")[observable.name];
        check_program_name(named, observable.name);
        check_name_in_sql(named, observable.name, measured);
        measured.push_back(observable.name);
    }
    read_version(section, *program);
    read_environment(section, *program);
    read_program_files(section, folder, *program);
    check_names(section, *program);
    check_command_word(section, *program);
    program->cores = section.whole("cores", program->cores);
    program->processes = section.whole("processes", program->processes);
    if (const auto processes = section.find("processes");
        processes && std::ranges::count(program->parameters, "processes", &ProgramParameter::name) > 0)
        processes->refuse("a parameter has this name: {processes} would have two meanings");
    if (const auto memory = section.find("memory")) program->memory = read_bytes(*memory);
    if (const auto disk = section.find("disk")) program->disk = read_bytes(*disk);
    const auto keep = section.word("keep", "failed");
    program->keep = keep == "all" ? Program::Keep::all : keep == "none" ? Program::Keep::none : Program::Keep::failed;
    const bool lines = program->protocol == Program::Protocol::lines;
    program->cost_seconds = section.number("cost_seconds", lines ? 0.001 : 1.0);
    program->tolerance = section.number("tolerance", 0);
    return program;
}

}  // namespace grainsweep::campaign

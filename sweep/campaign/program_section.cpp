#include "sweep/campaign/program_section.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/placeholders.hpp"
#include "sweep/campaign/program_keys.hpp"
#include "sweep/campaign/wrong_question.hpp"

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

constexpr std::size_t longest_plain_name = 64, longest_level = 4096, most_words = 10'000, most_arguments = 1000;
constexpr std::array<std::string_view, 5> names_of_the_case = {"seed", "seed31", "case", "threads", "notes"};

void check_name(const Cursor& place, const std::string& name) {
    if (!is_plain_name(name) || name.size() > longest_plain_name)
        throw wrong_question(place.path(), name,
                             fmt::format("a name is letters, digits and _, not a digit first, at most {}: it names a "
                                         "column in SQL",
                                         longest_plain_name));
    if (std::ranges::find(names_of_the_case, name) != names_of_the_case.end())
        throw wrong_question(place.path(), name, "is the program's name for something else; take another");
}

/// The view of a campaign has a column per name, and SQL folds the case of names.
void check_case(const Cursor& place, const std::string& name, const auto& others) {
    const auto folded = [](unsigned char c) { return std::tolower(c); };
    for (const std::string& other : others)
        if (other != name && std::ranges::equal(other, name, {}, folded, folded))
            throw wrong_question(place.path(), name,
                                 fmt::format("{} and {} are one name in SQL; rename one", other, name));
}

/// Checks the characters of a factor's word, because it becomes text in commands, templates, ids and tables.
void check_word(const Cursor& place) {
    const auto& word = place.json().get_ref<const std::string&>();
    const bool control =
        std::ranges::any_of(word, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
    if (word.empty() || word.size() > longest_level)
        place.refuse(fmt::format("a word has 1 to {} bytes", longest_level));
    if (control) place.refuse("a word has no control characters");
    if (word.starts_with("file:") || word.find(" | ") != std::string::npos)
        place.refuse("a word does not begin with 'file:' and has no ' | '");
}

/// Whether a factor rounds its range to whole numbers.
bool has_whole_steps(const nlohmann::json& factor) {
    if (factor.value("whole", nlohmann::json()) == true) return true;
    const auto step = factor.value("step", nlohmann::json());
    return step.is_number() && step.get<double>() == std::floor(step.get<double>());
}

/// Parameters that a campaign gives values to, and the words of each.
class Given {
public:
    explicit Given(const Section& top) {
        const Cursor factors = top.at("factors");
        if (factors.json().is_array())
            for (const auto& factor : factors.elements()) add_factor(factor);
        if (const auto fixed = top.find("fixed"); fixed && fixed->json().is_object())
            for (const auto& [name, value] : fixed->members({})) add(name, value);
        if (const auto calibration = top.find("calibration")) add_conditions(*calibration);
    }

    /// Every number given to it is one.
    void require_whole(const std::string& name) const {
        const auto [first, last] = numbers_.equal_range(name);
        for (const auto& place : std::ranges::subrange(first, last) | std::views::values) {
            const auto& value = place.json();
            if (value.is_array())
                place.refuse(
                    fmt::format("'{}' is a whole number: add \"whole\": true, or vary it by \"levels\"", name));
            if (value.is_number() && value.get<double>() != std::floor(value.get<double>()))
                place.refuse(fmt::format("'{}' is a whole number", name));
        }
    }
    [[nodiscard]] std::vector<ProgramParameter> parameters() const {
        std::vector<ProgramParameter> all;
        for (const auto& [name, words] : words_) {
            ProgramParameter parameter{name, {}, {}, Interval{}};
            if (!words.empty()) parameter.bounds = Words{words};
            all.push_back(std::move(parameter));
        }
        return all;
    }

private:
    void check(const Cursor& place, const std::string& name) const {
        check_name(place, name);
        check_case(place, name, std::views::keys(words_));
    }
    void add(const std::string& name, const Cursor& value) {
        check(value, name);
        const auto [known, fresh] = words_.try_emplace(name);
        auto& words = known->second;
        if (!value.json().is_string()) {
            numbers_.emplace(name, value);
            if (!words.empty()) value.refuse("the values of a parameter are all numbers or all words");
            return;
        }
        check_word(value);
        if (!fresh && words.empty()) value.refuse("the values of a parameter are all numbers or all words");
        if (words.size() >= most_words) value.refuse(fmt::format("at most {} words", most_words));
        const auto& word = value.json().get_ref<const std::string&>();
        if (std::ranges::find(words, word) == words.end()) words.push_back(word);
    }
    void add_factor(const Cursor& factor) {
        if (!factor.json().is_object() || !factor.json().contains("name") || !factor["name"].json().is_string()) return;
        const auto name = factor["name"].json().get<std::string>();
        check(factor["name"], name);
        if (factor.json().contains("levels") && factor["levels"].json().is_array()) {
            for (const auto& level : factor["levels"].elements()) add(name, level);
        } else {
            words_.try_emplace(name);
            if (factor.json().contains("between") && !has_whole_steps(factor.json()))
                numbers_.emplace(name, factor["between"]);
        }
    }
    void add_conditions(const Cursor& calibration) {
        if (!calibration.json().is_object() || !calibration.json().contains("targets")) return;
        const Cursor targets = calibration["targets"];
        if (!targets.json().is_array()) return;
        for (const auto& target : targets.elements()) {
            if (!target.json().is_object() || !target.json().contains("inputs")) continue;
            const Cursor inputs = target["inputs"];
            if (!inputs.json().is_object()) continue;
            for (const auto& [name, value] : inputs.members({})) add(name, value);
        }
    }

    std::map<std::string, std::vector<std::string>> words_;  ///< none: numbers
    std::multimap<std::string, Cursor> numbers_;             ///< where numbers stand, and ranges
};

void read_parameter_notes(const Section& section, const Given& given, Program& program) {
    const auto all = section.find("parameters");
    if (!all) return;
    for (const auto& [name, here] : all->members("must be an object of names and what is known of each")) {
        const auto found = std::ranges::find(program.parameters, name, &ProgramParameter::name);
        if (found == program.parameters.end())
            throw wrong_question(here.path(), "", "is neither a factor nor a fixed value",
                                 nearest_word(name, names_of(program.parameters)));
        const Section told(here, program_parameter_keys());
        if (const auto unit = told.find("unit")) found->unit = unit->text();
        if (const auto meaning = told.find("meaning")) found->meaning = meaning->text();
        if (told.flag("whole", false)) {
            if (found->is_word()) told.at("whole").refuse("the values of this parameter are words");
            given.require_whole(name);
        }
        const auto bounds = told.find("bounds");
        if (!bounds) continue;
        if (found->is_word()) {
            Words words;
            for (const auto& element : bounds->elements()) words.allowed.push_back(element.text());
            found->bounds = std::move(words);
        } else {
            found->bounds = read_program_bounds(*bounds);
        }
    }
}

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
    const Section version(*place, program_version_keys());
    program.version_command = version.words("command", {});
    check_arguments(version.at("command"), program.version_command);
    program.version_match = read_output_pattern(version.at("match"), "version");
}

/// Every name in braces means something.
class Names {
public:
    explicit Names(const Program& program) : lines_(program.protocol == Program::Protocol::lines) {
        known_ = {"threads"};
        if (lines_) return;
        known_.insert(known_.end(), {"seed", "seed31", "case"});
        for (const auto& parameter : program.parameters) known_.push_back(parameter.name);
    }
    void check(const Cursor& place, const std::string& text) const {
        (void)filled_command(text, [&](std::string_view name) { return look_up(place, name); });
    }
    void check_template(const Cursor& place, const std::string& text) const {
        try {
            (void)filled_template(text, [&](std::string_view name) { return look_up(place, name); });
        } catch (const std::invalid_argument& error) {
            place.refuse(error.what());
        }
    }

private:
    std::string look_up(const Cursor& place, std::string_view name) const {
        if (std::ranges::find(known_, name) != known_.end()) return {};
        throw wrong_question(place.path(), name,
                             fmt::format("is neither a factor nor a fixed value{}; it may be {}",
                                         lines_ ? " that is known when the program starts" : "", in_words(known_)),
                             nearest_word(name, known_));
    }

    bool lines_;
    std::vector<std::string> known_;
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
        throw wrong_question(top.place().path(), "",
                             "key 'program' is missing: the command that answers a case (grainsweep scenes program)");
    const Section section(*place, program_keys());
    auto program = std::make_shared<Program>();
    program->command = section.words("command", {});
    check_arguments(section.at("command"), program->command);
    program->protocol =
        section.word("protocol", "files") == "lines" ? Program::Protocol::lines : Program::Protocol::files;
    const Given given(top);
    program->parameters = given.parameters();
    read_parameter_notes(section, given, *program);
    read_program_observables(section, *program);
    std::vector<std::string> measured;
    for (const auto& observable : program->observables) {
        const Cursor named = section.at("observables")[observable.name];
        check_name(named, observable.name);
        check_case(named, observable.name, measured);
        measured.push_back(observable.name);
    }
    read_version(section, *program);
    read_environment(section, *program);
    read_program_files(section, folder, *program);
    check_names(section, *program);
    check_command_word(section, *program);
    program->cores = section.whole("cores", program->cores);
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

// A program's definition as JSON, and the hash of the part of it that changes an answer.
#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/placeholders.hpp"
#include "sweep/campaign/program.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <stdexcept>

namespace grainsweep::campaign {
namespace {

using Json = nlohmann::json;

constexpr std::array<std::string_view, 3> shape_words = {"scalar", "series", "profile"};
constexpr std::array<std::string_view, 3> keep_words = {"failed", "all", "none"};

template <class Enum, std::size_t N>
Enum enum_named(const std::array<std::string_view, N>& words, const std::string& word) {
    for (std::size_t k = 0; k < N; ++k)
        if (words[k] == word) return static_cast<Enum>(k);
    throw std::invalid_argument("unknown word '" + word + "' in the definition of a program");
}

Json json_of(const Interval& bounds) {
    const auto end = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
    return Json::array({end(bounds.low), end(bounds.high)});
}

Interval interval_in(const Json& ends) {
    Interval bounds;
    if (!ends.at(0).is_null()) bounds.low = ends[0].get<double>();
    if (!ends.at(1).is_null()) bounds.high = ends[1].get<double>();
    return bounds;
}

Json json_of(const Value& value) {
    return std::visit([](const auto& one) { return Json(one); }, value);
}

Json json_of(const decltype(ProgramObservable::from)& from) {
    if (const auto* json = std::get_if<FromJson>(&from))
        return {{"json", json->file}, {"path", json->path}, {"over", json->over}};
    if (const auto* csv = std::get_if<FromCsv>(&from))
        return {{"csv", csv->file},
                {"column", csv->column},
                {"row", csv->row},
                {"over", csv->over},
                {"separator", csv->separator}};
    if (const auto* output = std::get_if<FromOutput>(&from)) return {{"output", output->pattern}};
    return nullptr;
}

decltype(ProgramObservable::from) source_in(const Json& from) {
    const auto text = [&](const char* key) { return from.at(key).get<std::string>(); };
    if (from.is_null()) return FromReply{};
    if (from.contains("json")) return FromJson{text("json"), text("path"), text("over")};
    if (from.contains("csv"))
        return FromCsv{text("csv"), text("column"), from.at("row").get<std::int64_t>(), text("over"),
                       text("separator")};
    return FromOutput{text("output")};
}

Json answer_json(const ProgramObservable& observable) {
    Json answer = {{"shape", shape_words[static_cast<std::size_t>(observable.shape)]},
                   {"bounds", json_of(observable.bounds)},
                   {"from", json_of(observable.from)}};
    if (observable.optional) answer["optional"] = true;
    return answer;
}

/// Returns the parts of the program that change an answer.
Json answer_json(const Program& program) {
    Json identity = {{"command", program.command},
                     {"protocol", program.protocol == Program::Protocol::files ? "files" : "lines"},
                     {"environment", program.environment},
                     {"version", program.version}};
    identity["files"] = identity["templates"] = identity["parameters"] = identity["observables"] = Json::object();
    for (const auto& file : program.files)
        if (file.counts) identity[file.is_template ? "templates" : "files"][file.name] = file.hash;
    for (const auto& parameter : program.parameters)
        identity["parameters"][parameter.name] = parameter.is_word() ? "word" : "number";
    for (const auto& parameter : program.parameters)
        if (parameter.standard) identity["defaults"][parameter.name] = json_of(*parameter.standard);
    for (const auto& observable : program.observables)
        identity["observables"][observable.name] = answer_json(observable);
    return identity;
}

Json notes_of(const std::string& unit, const std::string& meaning) {
    return {{"unit", unit}, {"meaning", meaning}};
}

Json settings_of(const Program& program) {
    Json settings = {{"cores", program.cores},
                     {"memory", program.memory.value_or(0)},
                     {"disk", program.disk},
                     {"keep", keep_words[static_cast<std::size_t>(program.keep)]},
                     {"cost_seconds", program.cost_seconds},
                     {"tolerance", program.tolerance},
                     {"version_command", program.version_command},
                     {"version_match", program.version_match}};
    if (program.processes != 1) settings["processes"] = program.processes;
    settings["executables"] = settings["order"] = Json::array();
    settings["parameters"] = settings["observables"] = Json::object();
    for (const auto& file : program.files)
        if (file.executable) settings["executables"].push_back(file.name);
    for (const auto& file : program.files)
        if (!file.counts) settings["does_not_count"][file.is_template ? "templates" : "files"][file.name] = file.hash;
    for (const auto& parameter : program.parameters) {
        auto& told = settings["parameters"][parameter.name] = notes_of(parameter.unit, parameter.meaning);
        if (const auto* words = std::get_if<Words>(&parameter.bounds))
            told["words"] = words->allowed;
        else
            told["bounds"] = json_of(std::get<Interval>(parameter.bounds));
        if (parameter.whole) told["whole"] = true;
    }
    for (const auto& observable : program.observables) {
        settings["observables"][observable.name] = notes_of(observable.unit, observable.meaning);
        settings["order"].push_back(observable.name);
    }
    return settings;
}

void read_files(const Json& named, bool templates, const Json& executables, Program& program) {
    for (const auto& [name, hash] : named.items()) {
        ProgramFile file{name, hash.get<std::string>(), templates};
        for (const auto& other : executables) file.executable = file.executable || other == name;
        program.files.push_back(std::move(file));
    }
}

void read_parameters(const Json& answer, const Json& told, Program& program) {
    const auto& types = answer.at("parameters");
    for (const auto& [name, type] : types.items()) {
        const auto& more = told.at(name);
        ProgramParameter parameter{name, more.at("unit").get<std::string>(), more.at("meaning").get<std::string>(), {}};
        if (type == "word")
            parameter.bounds = Words{more.at("words").get<std::vector<std::string>>()};
        else
            parameter.bounds = interval_in(more.at("bounds"));
        parameter.whole = more.value("whole", false);
        if (answer.contains("defaults") && answer.at("defaults").contains(name)) {
            const auto& standard = answer.at("defaults").at(name);
            parameter.standard =
                parameter.is_word() ? Value{standard.get<std::string>()} : Value{standard.get<double>()};
        }
        program.parameters.push_back(std::move(parameter));
    }
}

void read_observables(const Json& measured, const Json& settings, Program& program) {
    for (const auto& word : settings.at("order")) {
        const auto name = word.get<std::string>();
        const auto& one = measured.at(name);
        const auto& told = settings.at("observables").at(name);
        program.observables.push_back({name, told.at("unit").get<std::string>(), told.at("meaning").get<std::string>(),
                                       enum_named<Shape>(shape_words, one.at("shape").get<std::string>()),
                                       one.value("optional", false), interval_in(one.at("bounds")),
                                       source_in(one.at("from"))});
    }
}

void require_within_folder(const std::string& name) {
    if (const auto flaw = flaw_of_file_name(name); !flaw.empty())
        throw std::invalid_argument(fmt::format("it names a file '{}' outside of the case's folder: {}", name, flaw));
}

/// Applies the rules of a campaign file, because the text may come from anybody: its hash is no signature.
void require_harmless(const Program& program) {
    constexpr std::size_t digits = 32;
    if (program.command.empty() || program.command.front().empty()) throw std::invalid_argument("its command is empty");
    for (const auto& file : program.files) {
        require_within_folder(file.name);
        if (file.hash.size() != digits || file.hash.find_first_not_of("0123456789abcdef") != std::string::npos)
            throw std::invalid_argument(fmt::format("'{}' is no hash of a file's contents", file.hash));
    }
    for (const auto& observable : program.observables) {
        if (const auto* json = std::get_if<FromJson>(&observable.from)) require_within_folder(json->file);
        if (const auto* csv = std::get_if<FromCsv>(&observable.from)) require_within_folder(csv->file);
    }
    const bool in_range = program.cores >= 1 && program.processes >= 1 && program.memory.value_or(1) > 0 &&
                          program.disk >= 0 && program.cost_seconds >= 0 && program.tolerance >= 0;
    if (!in_range) throw std::invalid_argument("a number of its settings is out of range");
}

}  // namespace

std::string program_scene_name(const Program& program) {
    return std::string(program_prefix) + content_hash(answer_json(program).dump());
}

std::string observable_text(const ProgramObservable& observable) {
    return answer_json(observable).dump();
}

std::string program_text(const Program& program) {
    return Json{{"answer", answer_json(program)}, {"settings", settings_of(program)}}.dump();
}

Program program_in(std::string_view text) {
    try {
        const Json document = Json::parse(text);
        const auto& answer = document.at("answer");
        const auto& settings = document.at("settings");
        Program program;
        program.command = answer.at("command").get<std::vector<std::string>>();
        program.protocol = answer.at("protocol") == "lines" ? Program::Protocol::lines : Program::Protocol::files;
        program.environment = answer.at("environment").get<std::map<std::string, std::string>>();
        program.version = answer.at("version").get<std::string>();
        read_files(answer.at("files"), false, settings.at("executables"), program);
        read_files(answer.at("templates"), true, settings.at("executables"), program);
        if (const auto others = settings.find("does_not_count"); others != settings.end()) {
            const auto counted = program.files.size();
            for (const char* kind : {"files", "templates"})
                read_files(others->value(kind, Json::object()), std::string_view(kind) == "templates",
                           settings.at("executables"), program);
            for (std::size_t k = counted; k < program.files.size(); ++k) program.files[k].counts = false;
        }
        read_parameters(answer, settings.at("parameters"), program);
        read_observables(answer.at("observables"), settings, program);
        program.cores = settings.at("cores").get<std::int64_t>();
        program.processes = settings.value("processes", std::int64_t{1});
        if (const auto memory = settings.at("memory").get<std::int64_t>(); memory != 0) program.memory = memory;
        program.disk = settings.at("disk").get<std::int64_t>();
        program.keep = enum_named<Program::Keep>(keep_words, settings.at("keep").get<std::string>());
        program.cost_seconds = settings.at("cost_seconds").get<double>();
        program.tolerance = settings.at("tolerance").get<double>();
        program.version_command = settings.at("version_command").get<std::vector<std::string>>();
        program.version_match = settings.at("version_match").get<std::string>();
        require_harmless(program);
        return program;
    } catch (const Json::exception& error) {
        throw std::invalid_argument(fmt::format("no definition of a program: {}", error.what()));
    }
}

std::string program_value(const Value& value, std::string_view format) {
    constexpr double longest_whole = 1e15;
    const Value real = coerced(value, Value{0.0});
    const auto* number = std::get_if<double>(&real);
    if (number == nullptr) return to_text(value);
    if (const auto form = NumberFormat::parse(format)) return (*form)(*number);
    if (*number == std::floor(*number) && std::abs(*number) < longest_whole)
        return std::to_string(static_cast<std::int64_t>(*number));
    return to_text(value);
}

std::uint64_t prime_of(std::uint64_t seed) {
    constexpr std::uint64_t least = 10'007, most = 0x7FFF'FFFF;  // both are primes
    const auto is_prime = [](std::uint64_t n) {
        for (std::uint64_t d = 3; d * d <= n; d += 2)
            if (n % d == 0) return false;
        return n % 2 == 1;
    };
    std::uint64_t n = least + seed % (most - least + 1);
    while (!is_prime(n)) ++n;
    return n;
}

std::string program_question(std::string_view case_id, std::uint64_t seed, std::int64_t threads, const Inputs& inputs) {
    std::string text = fmt::format(R"({{"case":"{}","seed":{},"threads":{},"inputs":{{)", case_id, seed, threads);
    bool first = true;
    for (const auto& [name, value] : inputs) {
        const auto* word = std::get_if<std::string>(&value);
        text += fmt::format("{}\"{}\":{}", first ? "" : ",", name,
                            word != nullptr ? Json(*word).dump(-1, ' ', true) : program_value(value));
        first = false;
    }
    return text += "}}";
}

}  // namespace grainsweep::campaign

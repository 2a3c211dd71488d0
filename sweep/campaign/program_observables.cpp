// "observables" of a program: measured quantities, and the places of their values in the output.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/output_pattern.hpp"
#include "sweep/campaign/program_keys.hpp"
#include "sweep/campaign/program_section.hpp"
#include "sweep/campaign/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

namespace grainsweep::campaign {
namespace {

constexpr std::size_t most_observables = 1000;
constexpr Interval rows{-1e9, 1e9};

/// A value of its own for every kind of source; exactly one is there.
std::string kind_of(const Section& from) {
    std::string kind;
    for (const char* one : {"json", "csv", "output"}) {
        if (!from.find(one)) continue;
        if (!kind.empty())
            throw input_error(from.place().path(), fmt::format("{} and {}", kind, one),
                              "a value is found in one place: \"json\", \"csv\" or \"output\"");
        kind = one;
    }
    if (kind.empty())
        throw input_error(from.place().path(), "", "needs \"json\", \"csv\" or \"output\": where the value is found");
    return kind;
}

void refuse_others(const Section& from, std::string_view kind, std::initializer_list<const char*> allowed) {
    for (const char* key : {"path", "column", "row", "over", "separator"}) {
        const auto there = from.find(key);
        if (there && std::ranges::find(allowed, std::string_view(key)) == allowed.end())
            there->refuse(fmt::format("\"{}\" does not belong to \"{}\"", key, kind));
    }
}

std::string read_pointer(const Cursor& place) {
    const auto path = place.text();
    try {
        (void)Json::json_pointer(path);
    } catch (const Json::exception&) {
        place.refuse("must be a JSON pointer: \"/angle\", \"/results/0/angle\"");
    }
    return path;
}

std::int64_t read_row(const Section& from) {
    const auto place = from.find("row");
    if (!place) return -1;
    if (place->json() == "last") return -1;
    if (place->json() == "first") return 0;
    if (place->json().is_number()) return place->whole(rows);
    place->refuse("must be \"last\", \"first\" or a whole number");
}

std::string required(const Section& from, std::string_view key, std::string_view kind) {
    const auto place = from.find(key);
    if (!place) throw input_error(from.place().path(), "", fmt::format("\"{}\" needs \"{}\"", kind, key));
    return place->text();
}

decltype(ProgramObservable::from) read_from(const Section& from) {
    const auto kind = kind_of(from);
    const auto over = from.find("over");
    if (kind == "json") {
        refuse_others(from, kind, {"path", "over"});
        (void)required(from, "path", kind);
        return FromJson{read_file_name(from.at("json")), read_pointer(from.at("path")),
                        over ? read_pointer(*over) : std::string()};
    }
    if (kind == "csv") {
        refuse_others(from, kind, {"column", "row", "over", "separator"});
        if (over && from.find("row")) from.at("row").refuse("with \"over\" all rows are read");
        return FromCsv{read_file_name(from.at("csv")), required(from, "column", kind), read_row(from),
                       over ? over->text() : std::string(), from.word("separator", "comma")};
    }
    refuse_others(from, kind, {});
    const auto place = from.at("output");
    return FromOutput{read_output_pattern(place, "value")};
}

bool runs_over(const decltype(ProgramObservable::from)& from) {
    if (const auto* json = std::get_if<FromJson>(&from)) return !json->over.empty();
    if (const auto* csv = std::get_if<FromCsv>(&from)) return !csv->over.empty();
    return false;
}

ProgramObservable read_output(const std::string& name, const Section& section, Program::Protocol protocol) {
    ProgramObservable observable;
    observable.name = name;
    if (const auto unit = section.find("unit")) observable.unit = unit->text();
    if (const auto meaning = section.find("meaning")) observable.meaning = meaning->text();
    if (const auto bounds = section.find("bounds")) observable.bounds = read_program_bounds(*bounds, observable.unit);
    observable.optional = section.flag("optional", false);
    const auto from = section.find("from");
    const bool files = protocol == Program::Protocol::files;
    if (files != from.has_value())
        throw input_error(section.place().path(), "",
                          files ? "key 'from' is missing: where its value is found"
                                : "with the protocol \"lines\" a value comes in the reply and has no \"from\"");
    bool over = false;
    if (files) {
        observable.from = read_from(Section(*from, program_from_keys));
        over = runs_over(observable.from);
    }
    const auto shape = section.word("shape", over ? "profile" : "scalar");
    observable.shape = shape == "scalar" ? Shape::scalar : shape == "series" ? Shape::series : Shape::profile;
    if (files && over == (observable.shape == Shape::scalar))
        section.place().refuse(over ? "with \"over\" it is a \"profile\" or a \"series\""
                                    : fmt::format("a {} needs \"over\" in its \"from\"", shape));
    return observable;
}

}  // namespace

std::string read_output_pattern(const Cursor& place, std::string_view what) {
    const auto pattern = place.text();
    try {
        if (output_pattern(pattern).mark_count() < 1)
            place.refuse(fmt::format("needs a group, (...), that is the {}", what));
    } catch (const std::regex_error& error) {
        place.refuse(fmt::format("is no regular expression (ECMAScript without back-references): {}", error.what()));
    }
    return pattern;
}

Interval read_program_bounds(const Cursor& place, const std::string& unit) {
    const auto ends = place.elements();
    if (ends.size() != 2) place.refuse("must be [low, high]");
    const auto end = [&](const Cursor& here, double open) {
        if (here.json().is_null()) return open;
        if (!here.json().is_string()) return here.number();
        const auto number = in_si(here.text(), unit);
        if (const auto* why = std::get_if<std::string>(&number))
            here.refuse(fmt::format("must be null or a number{}{}: {}", unit.empty() ? "" : " in ", unit, *why));
        return std::get<double>(number);
    };
    Interval bounds;
    bounds.low = end(ends[0], bounds.low);
    bounds.high = end(ends[1], bounds.high);
    if (!(bounds.low < bounds.high)) place.refuse("low must be below high");
    return bounds;
}

void read_program_observables(const Section& section, Program& program) {
    const auto all = section.find("observables");
    if (!all) return;
    for (const auto& [name, here] : all->members("must be an object of names and where each value is found")) {
        if (program.observables.size() >= most_observables)
            here.refuse(fmt::format("at most {} observables", most_observables));
        program.observables.push_back(read_output(name, Section(here, program_observable_keys), program.protocol));
    }
}

}  // namespace grainsweep::campaign

#include "tests/documents/machine_tables.hpp"

#include "solver/machine/probe.hpp"
#include "solver/machine/reduction.hpp"
#include "sweep/campaign/field_text.hpp"
#include "sweep/campaign/machine_keys.hpp"
#include "tests/documents/table_rows.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <tuple>

namespace grainsweep::tests {
namespace {

namespace keys = campaign::machine_keys;

using campaign::kind_word;

/// Returns the cells of a field: key, kind, default, meaning.
std::vector<std::string> cells_of(const Type& type, const Field& field) {
    std::string words;
    for (const auto word : field.words) words += (words.empty() ? "`" : ", `") + std::string(word) + "`";
    return {code(std::string(field.name)), std::string(kind_word(field.kind)),
            field.required ? "required" : code(campaign::default_text(type, field)),
            campaign::meaning_text(field) + (words.empty() ? "" : "; one of " + words)};
}

std::string forms_table(std::string_view what, std::span<const Type> types) {
    std::string table = head({std::string(what), "key", "value", "default", "meaning"});
    for (const auto& type : types) {
        const std::string name = code(std::string(type.name));
        table += row({name, "",
                      !type.fields.empty() ? "object"
                      : type.name == "not" ? "region"
                                           : "list",
                      "", std::string(type.meaning)});
        for (const auto& field : type.fields) {
            auto cells = cells_of(type, field);
            cells.insert(cells.begin(), name);
            table += row(cells);
        }
    }
    return table;
}

std::string words_of(machine::Source source) {
    switch (source) {
        case machine::Source::frames:
            return "at frames";
        case machine::Source::loads:
            return "every step in `mean` and `integral`, else at frames";
        case machine::Source::sums:
        case machine::Source::steps:
            return "every step";
        case machine::Source::passages:
            return "every passage";
    }
    throw std::logic_error("a source without words");
}

std::string probes_table() {
    std::string table = head({"probe", "unit", "measures", "counts", "options, the required ones first"});
    for (const auto& probe : machine::probe_catalogue()) {
        std::string required, others;
        for (const auto& option : probe.options) {
            auto& list = option.required ? required : others;
            list += (list.empty() ? "" : " ") + code(std::string(option.name));
        }
        if (!required.empty()) required = "**needs** " + required + (others.empty() ? "" : "; ");
        table += row({code(std::string(probe.name)), std::string(probe.unit),
                      std::string(probe.meaning) + (probe.over.empty() ? "" : "; a profile"), words_of(probe.source),
                      required + others});
    }
    return table;
}

/// One row for an option that means the same in several probes.
std::string options_table() {
    using Meaning = std::tuple<std::string, std::string, std::string, std::string>;
    std::map<Meaning, std::vector<std::string>> rows;
    for (const auto& probe : machine::probe_catalogue())
        for (const auto& option : probe.options)
            rows[{std::string(option.name), std::string(kind_word(option.kind)), std::string(option.unit),
                  std::string(option.meaning)}]
                .push_back(std::string(probe.name));
    std::string table = head({"option", "value", "unit", "meaning", "of"});
    for (const auto& [meaning, probes] : rows) {
        const auto& [name, kind, unit, words] = meaning;
        std::string of;
        for (const auto& probe : probes) of += (of.empty() ? "`" : ", `") + probe + "`";
        table += row({code(name), kind, unit, words, of});
    }
    return table;
}

std::string reductions_table() {
    std::string table = head({"`as`", "unit", "gives", "error", "becomes"});
    for (const auto& reduction : machine::reduction_catalogue()) {
        const std::string unit = reduction.unit.empty()
                                     ? "of the probe"
                                     : "of the probe, times " + std::string(reduction.unit == "/s" ? "1/s" : "s");
        const std::string shape = reduction.shape == Shape::scalar   ? "a scalar"
                                  : reduction.shape == Shape::series ? "a series"
                                                                     : "a profile";
        table += row({code(std::string(reduction.name)), unit, std::string(reduction.meaning),
                      reduction.error != nullptr ? "`NAME_error`" : "none", shape});
    }
    return table;
}

}  // namespace

std::string machine_keys_tables() {
    std::string all;
    for (const Type& type : keys::all()) {
        all += (all.empty() ? "### " : "\n### ") + std::string(type.name) + "\n\n" +
               head({"key", "value", "default", "meaning"});
        for (const auto& field : type.fields) all += row(cells_of(type, field));
    }
    return all;
}

std::string machine_table(std::string_view what) {
    if (what == "shapes") return forms_table("shape", keys::shapes());
    if (what == "regions") return forms_table("region", keys::regions());
    if (what == "probes") return probes_table();
    if (what == "options") return options_table();
    if (what == "reductions") return reductions_table();
    throw std::invalid_argument("no table of machines is called '" + std::string(what) + "'");
}

}  // namespace grainsweep::tests

#include "sweep/campaign/machine_parameters.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/formula.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_reading.hpp"
#include "sweep/campaign/plain_name.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/campaign/sections.hpp"

#include "solver/machine/filling.hpp"
#include "solver/machine/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <regex>
#include <set>
#include <utility>

namespace grainsweep::campaign {
namespace {

constexpr std::size_t longest_machine_name = 64;

/// Units in which machines calculate; the first that fits is the one of a parameter in expressions.
constexpr std::array<std::string_view, 26> si_units = {
    "1",  "m",    "s",     "kg",   "m/s", "rad", "rad/s", "Hz",  "m2",        "m3",   "m/s2", "N",     "N m",
    "Pa", "J/m2", "kg/m3", "kg/s", "1/s", "J",   "W",     "N/m", "kg/(m2 s)", "m3/s", "Pa s", "kg m2", "N m s"};

/// Returns the unit that a machine calculates in for a given one; none: the reason is in `why`. Remembers it, because
/// every case converts every parameter.
std::optional<std::string_view> calculating_unit(const std::string& unit, std::string& why) {
    static std::mutex mutex;
    static std::map<std::string, std::string_view, std::less<>> known;
    static std::map<std::string, std::string, std::less<>> unknown;  // why
    const std::lock_guard lock(mutex);
    if (const auto found = known.find(unit); found != known.end()) return found->second;
    if (const auto found = unknown.find(unit); found != unknown.end()) return why = found->second, std::nullopt;
    const auto fitting = std::ranges::find_if(si_units, [&](auto si) { return is_convertible(unit, si); });
    if (fitting != si_units.end()) return known.emplace(unit, *fitting).first->second;
    const auto refused = in_si("1 " + unit, si_units.front());
    why = std::get<std::string>(refused);
    unknown.emplace(unit, why);
    return std::nullopt;
}

/// A value in SI units. Refuses a unit that is none.
double in_si_units(const Cursor& place, double value, const std::string& unit) {
    if (unit == "1") return value;
    std::string why;
    if (const auto si = calculating_unit(unit, why)) {
        if (*si == unit) return value;
        const auto converted = in_si(fmt::format("{} {}", value, unit), *si);
        if (const auto* number = std::get_if<double>(&converted)) return *number;
        why = std::get<std::string>(converted);
    }
    place.refuse(fmt::format("'{}' is no unit that a machine calculates with: {}", unit, why));
}

std::vector<std::string> words_in(const Section& section) {
    std::vector<std::string> words;
    for (const auto& word : section.at("words").elements()) {
        require_name(word, word.text());
        words.push_back(word.text());
    }
    if (words.empty()) section.at("words").refuse("must name a word");
    return words;
}

ParameterSpec word_parameter(const Section& section, ParameterSpec spec) {
    for (const char* key : {"unit", "counted_in", "bounds", "above", "whole"})
        if (const auto too = section.find(key)) too->refuse("a parameter that is a word has none");
    Words words{words_in(section)};
    spec.unit = "";
    spec.default_value = section.at("default").word(words.allowed);
    spec.bounds = std::move(words);
    return spec;
}

/// A file, or a word: one of several, or the default that stands for none.
ParameterSpec file_parameter(const Section& section, ParameterSpec spec) {
    for (const char* key : {"unit", "counted_in", "bounds", "above", "whole"})
        if (const auto too = section.find(key)) too->refuse("a parameter that is a file has none");
    const auto rows = machine_keys::parameter;
    const auto kind = section.at("file").word(std::ranges::find(rows, std::string_view("file"), &Field::name)->words);
    spec.unit = "";
    const std::string none = section.at("default").text();
    require_name(section.at("default"), none);
    spec.default_value = none;
    Words words{{none}, true};
    if (section.find("words")) {
        words.allowed = words_in(section);
        if (std::ranges::find(words.allowed, none) == words.allowed.end())
            section.at("default").refuse("must be one of the words", nearest_word(none, words.allowed));
    }
    if (kind == "sizes")
        words.check_file = [](std::string_view csv) { (void)particles::SizeTable::read(csv); };
    else if (kind == "packing")  // whatever its edge
        words.check_file = [](std::string_view csv) { machine::require_packing(csv); };
    else
        words.check_file = [](std::string_view stl) { (void)machine::stl_mesh(stl, 1, 0, {}); };
    spec.bounds = std::move(words);
    return spec;
}

/// "only_if": all must hold.
std::vector<Relevance> relevance_of(const Section& section, const std::vector<ParameterSpec>& parameters) {
    std::vector<Relevance> all;
    const auto conditions = section.find("only_if");
    if (!conditions) return all;
    for (const auto& [name, value] : conditions->members("must be an object of conditions by parameter")) {
        const auto other = std::ranges::find(parameters, name, &ParameterSpec::name);
        if (other == parameters.end())
            throw input_error(value.path(), "", "there is no such parameter", nearest_word(name, names_of(parameters)));
        const auto* words = std::get_if<Words>(&other->bounds);
        Relevance one{name, Relevance::Condition::is_word, {}};
        if (words != nullptr && words->file_allowed) {
            WordList known(words->allowed);
            known.push_back("set");
            if (const std::string word = value.word(known); word == "set")
                one.condition = Relevance::Condition::is_file;
            else
                one.words.push_back(word);
        } else if (words != nullptr) {
            if (value.json().is_array())
                for (const auto& word : value.elements()) one.words.push_back(word.word(words->allowed));
            else
                one.words.push_back(value.word(words->allowed));
        } else if (value.json().is_number() && value.json().get<double>() == 0) {
            one.condition = Relevance::Condition::zero;
        } else {
            one.condition = Relevance::Condition::nonzero;
            if (!value.json().is_string() || value.json().get<std::string>() != "set")
                value.refuse("a number is 0 or \"set\"");
        }
        all.push_back(std::move(one));
    }
    return all;
}

ParameterSpec number_parameter(const Section& section, ParameterSpec spec) {
    const auto unit = section.find("unit"), counted = section.find("counted_in");
    if (unit && counted) counted->refuse("beside \"unit\" it says too much");
    if (counted || unit) spec.unit = counted ? counted->text() : unit->text();
    if (std::string why; counted && calculating_unit(spec.unit, why))
        counted->refuse(fmt::format("'{}' is a unit: write \"unit\"", spec.unit));
    if (!counted) (void)in_si_units(unit ? *unit : section.place(), 1, spec.unit);
    auto bounds = std::get<Interval>(spec.bounds);
    const auto own_number = [&](const Cursor& place) {
        return MachineScope().number(place, counted ? "1" : std::string_view(spec.unit));
    };
    if (const auto ends = section.find("bounds")) {
        if (!ends->json().is_array() || ends->json().size() != 2) ends->refuse("must be a list: [low, high]");
        if (const Cursor low = (*ends)[std::size_t{0}]; !low.json().is_null()) bounds.low = own_number(low);
        if (const Cursor high = (*ends)[1]; !high.json().is_null()) bounds.high = own_number(high);
        if (!(bounds.low <= bounds.high)) ends->refuse("the lower bound must not be above the upper one");
    }
    if (const auto above = section.find("above")) {
        if (section.find("bounds") && std::isfinite(bounds.low))
            above->refuse("beside a lower bound in \"bounds\" it says too much");
        bounds.low = own_number(*above);
        bounds.low_open = true;
        if (!(bounds.low < bounds.high)) above->refuse("must lie below the upper bound");
    }
    const Cursor standard = section.at("default");
    const double value = own_number(standard);
    if (!bounds.contains(value))
        standard.refuse(fmt::format("must be a number{}, as its bounds say", in_words(bounds)));
    if (section.flag("whole", false)) {
        if (value != std::floor(value)) standard.refuse("must be a whole number");
        spec.default_value = static_cast<std::int64_t>(value);
    } else {
        spec.default_value = value;
    }
    spec.bounds = bounds;
    return spec;
}

/// Those that every machine has.
void add_common(std::vector<ParameterSpec>& all, bool with_ratio) {
    if (with_ratio)
        all.push_back({std::string(ratio_parameter),
                       "1",
                       "length of filled and fed particles divided by their width: equal spheres in a row; 1: spheres",
                       1.0,
                       Interval{1, longest_row},
                       {}});
    all.push_back(
        {"particles_scale",
         "1",
         "diameters times this: coarser particles, fewer of the same mass or volume; a \"count\" of a filling stays",
         1.0,
         Interval{0.1, 100},
         {}});
    all.push_back({std::string(stiffness_parameter),
                   "1",
                   "Young's moduli and the stiffness of the linear law times this: softer particles take longer steps",
                   1.0,
                   Interval{1e-3, 1e3},
                   {}});
    all.push_back({"time_step", "s", "time step; 0: time_step_fraction of the limits", 0.0, Interval{0, 1e-3}, {}});
    all.push_back({"time_step_fraction",
                   "1",
                   "time step over the shortest Rayleigh time and Hertz contact time, or a quarter of a linear impact",
                   0.2,
                   Interval{0, 1, true, false},
                   {{"time_step", Relevance::Condition::zero, {}}}});
    all.push_back({"precision",
                   "",
                   "arithmetic: 'mixed' vectorised, 'double' the clear reference",
                   std::string("mixed"),
                   Words{{"mixed", "double"}},
                   {}});
}

/// "rpm" of a name in expressions: letters and digits of the unit.
std::string suffix_of(const std::string& unit) {
    std::string suffix;
    for (const char c : unit)
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')) suffix += c;
    return suffix;
}

/// Names that a parameter gives to expressions: its own, NAME_UNIT, NAME_is_WORD.
std::vector<std::string> names_in_expressions(const ParameterSpec& parameter) {
    std::vector<std::string> names{parameter.name};
    if (const auto* words = std::get_if<Words>(&parameter.bounds))
        for (const auto& word : words->allowed) names.push_back(parameter.name + "_is_" + word);
    else if (const auto suffix = suffix_of(parameter.unit); parameter.unit != "1" && !suffix.empty())
        names.push_back(parameter.name + "_" + suffix);
    return names;
}

void refuse_names_twice(const Cursor& place, const std::vector<ParameterSpec>& parameters) {
    std::map<std::string, std::string> owners;
    for (const auto& parameter : parameters)
        for (const auto& name : names_in_expressions(parameter))
            if (const auto [owner, first] = owners.emplace(name, parameter.name); !first)
                throw input_error(
                    path_of(place.path(), place.json().contains(parameter.name) ? parameter.name : owner->second), "",
                    fmt::format("'{}' in expressions would be of '{}' and of '{}'; rename one", name, owner->second,
                                parameter.name));
}

/// Returns the names that expressions may use after the species are read.
std::set<std::string, std::less<>> species_names(const Section& top) {
    std::set<std::string, std::less<>> names;
    const auto species = top.find("species");
    if (species && species->json().is_object())
        for (const auto& [name, value] : species->json().items())
            for (const char* ending : {"_largest", "_smallest", "_volume"}) names.insert(name + ending);
    return names;
}

/// A quantity in SI units, whichever they are.
double any_quantity(const Cursor& place) {
    std::string why;
    if (const auto si = calculating_unit(std::string(unit_of_quantity(place.text())), why)) {
        const auto converted = in_si(place.text(), *si);
        if (const auto* value = std::get_if<double>(&converted)) return *value;
        why = std::get<std::string>(converted);
    }
    place.refuse(why);
}

/// Reads {"opening": a level set}.
double opening_in(const Cursor& place, const MachineScope& scope) {
    if (!place.json().contains("opening") || place.json().size() != 1)
        place.refuse("must be a number, an expression, or {\"opening\": a level set}");
    machine::Region::LevelSet set;
    scope.read(Section(place["opening"], machine::level_set_fields()), machine::level_set_fields(), &set);
    if (const std::string flaw = machine::Region{set}.flaw(); !flaw.empty()) place.refuse(flaw);
    if (set.side == 0 || !(set.shell > 0)) place.refuse("an opening is of one side of a shell: \"side\" 1 or -1");
    return set.opening();
}

/// Reads {"extent": ...}: how far the surface of a file reaches from its origin along a direction; 0 where it is none.
double extent_in(const Cursor& place, const MachineScope& scope) {
    const Section section(place, machine_keys::extent);
    if (!scope.present(section)) return 0;
    const double facets = scope.number(section, "facet_angle", "rad", 0, {0, 0.76});
    const double scale = scope.number(section, "scale", "m", 1, positive_number);
    const auto contents = scope.contents(section.at("stl"));
    const auto fit = section.find("fit");
    try {
        const auto mesh = fit ? machine::fitted_mesh(contents, scale, facets, scope.number(*fit, "m", positive_number))
                              : machine::stl_mesh(contents, scale, facets, {});
        const auto along = scope.direction(section.at("along"));
        double most = -std::numeric_limits<double>::infinity();
        for (const auto& corner : mesh.surface().corners) most = std::max(most, geometry::dot(corner, along));
        return most;
    } catch (const std::invalid_argument& why) {
        section.at("stl").refuse(why.what());
    }
}

/// Reads the value of a definition, all names of which are known.
double let_in(const Cursor& place, const MachineScope& scope) {
    const auto& value = place.json();
    if (value.is_object())
        return value.contains("extent") ? extent_in(place["extent"], scope) : opening_in(place, scope);
    const bool quantity = value.is_string() && value_text(value.get_ref<const std::string&>())->quantity;
    return quantity ? any_quantity(place) : scope.number(place, "1");
}

/// Adds the definitions of "let", except those with a name that is defined later. Refuses a circle.
void evaluate_lets(const Section& top, const std::set<std::string, std::less<>>& to_come, MachineScope& scope) {
    const auto lets = top.find("let");
    if (!lets) return;
    if (!lets->json().is_object()) lets->refuse("must be an object of expressions by name");
    std::set<std::string> open;
    for (const auto& [name, value] : lets->json().items()) {
        const Cursor here = (*lets)[name];
        require_name(here, name);
        if (scope.is_let(name)) continue;
        if (name == "pi" || name == "nan" || scope.knows(name) || to_come.contains(name))
            here.refuse("a parameter or number has this name; take another one");
        open.insert(name);
    }
    std::map<std::string, std::vector<std::string>, std::less<>> used;  // by an expression
    const std::set<std::string, std::less<>> to_be(open.begin(), open.end());
    const auto parse = [&](const std::string& given) {
        const auto known = [&](std::string_view name) {
            return scope.has_number(name) || to_be.contains(name) || to_come.contains(name);
        };
        auto parsed = Formula::of(given, known);
        if (std::holds_alternative<Formula>(parsed)) return parsed;
        auto names = scope.names();
        names.insert(names.end(), to_be.begin(), to_be.end());
        names.insert(names.end(), to_come.begin(), to_come.end());
        return Formula::parse(given, names);
    };
    for (const auto& name : open) {
        const auto& text = lets->json()[name];
        const Json leaves = text.is_object() ? text.flatten() : Json::object();
        for (const auto& [place, leaf] : leaves.items())
            if (const auto parsed = parse(leaf.is_string() ? leaf.get<std::string>() : "0");
                const auto* formula = std::get_if<Formula>(&parsed))
                used[name].insert(used[name].end(), formula->names().begin(), formula->names().end());
        if (!text.is_string()) continue;
        const auto read = value_text(text.get_ref<const std::string&>());
        if (read->quantity) continue;
        const auto parsed = parse(read->given);
        if (const auto* why = std::get_if<std::string>(&parsed))
            (*lets)[name].refuse(
                read->pointed.empty() ? *why : fmt::format("the decimal sign is a point: '{}'", read->pointed));
        used[name] = std::get<Formula>(parsed).names();
    }
    // In rounds: a definition is next once no name in it is open.
    const auto waits = [&](const std::string& name) {
        return std::ranges::any_of(
            used[name], [&](const auto& needed) { return open.contains(needed) || to_come.contains(needed); });
    };
    for (bool defined = true; !open.empty();) {
        if (!std::exchange(defined, false)) {
            if (!to_come.empty()) return;
            (*lets)[*open.begin()].refuse("it depends on itself");
        }
        for (auto next = open.begin(); next != open.end();) {
            if (waits(*next)) {
                ++next;
                continue;
            }
            scope.set_let(*next, let_in((*lets)[*next], scope));
            next = open.erase(next);
            defined = true;
        }
    }
}

/// Returns the words in the texts of a machine, without texts for readers and what only sets or restricts parameters.
std::set<std::string, std::less<>> words_in_texts(const Json& machine) {
    const auto aside = [](std::string_view place) {
        return place == "/name" || place == "/summary" || place.starts_with("/parameters/") ||
               place.starts_with("/accuracy/") || (place.starts_with("/measure/") && place.ends_with("/meaning")) ||
               place.find("/notes") != std::string_view::npos;
    };
    std::set<std::string, std::less<>> words;
    const auto keep = [&](std::string_view word) { return words.emplace(word), false; };
    const Json leaves = machine.flatten();
    for (const auto& [place, leaf] : leaves.items())
        if (leaf.is_string() && !aside(place)) (void)names_in(leaf.get_ref<const std::string&>(), keep);
    return words;
}

}  // namespace

std::vector<std::string> unused_parameters(const Json& machine, const std::vector<ParameterSpec>& parameters) {
    std::vector<ParameterSpec> common;
    add_common(common, takes_ratio(machine));
    const auto named = words_in_texts(machine);
    std::vector<std::string> unused;
    for (const auto& parameter : parameters)
        if (std::ranges::find(common, parameter.name, &ParameterSpec::name) == common.end() &&
            std::ranges::none_of(names_in_expressions(parameter), [&](const auto& one) { return named.contains(one); }))
            unused.push_back(parameter.name);
    return unused;
}

void require_name(const Cursor& place, std::string_view name) {
    if (!is_plain_name(name) || name.size() > longest_machine_name)
        throw input_error(
            place.path(), name,
            fmt::format("a name is letters, digits and _, not a digit first, at most {}", longest_machine_name));
    if (name == notes_key) place.refuse("here are names, and 'notes' is none: put notes into the object around it");
}

bool takes_ratio(const Json& machine) {
    return std::ranges::none_of(std::array{"parameters", "let"}, [&](const char* section) {
        return machine.contains(section) && machine.at(section).is_object() &&
               machine.at(section).contains(ratio_parameter);
    });
}

std::vector<ParameterSpec> read_machine_parameters(const Section& top) {
    std::vector<ParameterSpec> all;
    add_common(all, takes_ratio(top.place().json()));
    const auto place = top.find("parameters");
    if (!place) return all;
    if (!place->json().is_object()) place->refuse("must be an object of parameters by name");
    std::set<std::string> folded;
    for (const auto& [name, value] : place->json().items()) {
        const Cursor here = (*place)[name];
        require_name(here, name);
        if (name == "pi" || name == "nan")
            here.refuse(fmt::format("'{}' is a number in expressions; take another name", name));
        if (!folded.insert(small_letters(name)).second)
            throw input_error(here.path(), "", "two names that differ by case only are one name in SQL; rename one");
        const Section section(here, machine_keys::parameter);
        const auto common = std::ranges::find(all, name, &ParameterSpec::name);
        ParameterSpec spec = common != all.end() ? *common : ParameterSpec{name, "1", name, 0.0, Interval{}, {}};
        if (const auto meaning = section.find("meaning")) spec.meaning = meaning->text();
        if (common != all.end()) {  // another default, other bounds
            for (const char* key : {"unit", "counted_in", "whole", "words", "file"})
                if (section.find(key) || std::holds_alternative<Words>(spec.bounds))
                    throw input_error(here.path(), "", "every machine has a parameter of this name; take another one");
            *common = number_parameter(section, std::move(spec));
            continue;
        }
        all.push_back(section.find("file")    ? file_parameter(section, std::move(spec))
                      : section.find("words") ? word_parameter(section, std::move(spec))
                                              : number_parameter(section, std::move(spec)));
    }
    for (auto& parameter : all)
        if (place->json().contains(parameter.name) && (*place)[parameter.name].json().contains("only_if"))
            parameter.relevant_if = relevance_of(Section((*place)[parameter.name], machine_keys::parameter), all);
    refuse_names_twice(*place, all);
    std::ranges::sort(all, {}, &ParameterSpec::name);
    return all;
}

std::map<std::string, Inputs, std::less<>> read_machine_accuracy(const Section& top,
                                                                 const std::vector<ParameterSpec>& parameters) {
    const auto numerics = [](double fraction, const char* precision) {
        return Inputs{{"time_step_fraction", fraction}, {"precision", std::string(precision)}};
    };
    std::map<std::string, Inputs, std::less<>> all = {{"fast", numerics(0.35, "mixed")},
                                                      {"balanced", numerics(0.2, "mixed")},
                                                      {"fine", numerics(0.05, "mixed")},
                                                      {"reference", numerics(0.05, "double")}};
    const auto place = top.find("accuracy");
    if (!place) return all;
    all.clear();
    const std::vector<std::string> levels = {"balanced", "fast", "fine", "reference", "survey"};
    for (const auto& [level, here] : place->members("must be an object of levels")) {
        if (std::ranges::find(levels, level) == levels.end())
            here.refuse("a level is survey, fast, balanced, fine or reference", nearest_word(level, levels));
        for (const auto& [name, value] : here.members("must be an object of parameters and their values")) {
            const auto found = std::ranges::find(parameters, name, &ParameterSpec::name);
            if (found == parameters.end())
                throw input_error(value.path(), "", "there is no such parameter",
                                  nearest_word(name, names_of(parameters)));
            all[level][name] = read_value(value, *found, {});
        }
    }
    return all;
}

MachineScope machine_scope(const Section& top, const std::vector<ParameterSpec>& parameters, const Inputs& inputs,
                           const std::map<std::string, std::string_view, std::less<>>& files) {
    MachineScope scope;
    for (const auto& [name, contents] : files) scope.set_file(name, contents);
    for (const auto& parameter : parameters) {
        const Value& value = inputs.find(parameter.name)->second;
        if (const auto* words = std::get_if<Words>(&parameter.bounds)) {
            const auto& word = std::get<std::string>(value);
            scope.set_word(parameter.name, word);
            for (const auto& one : words->allowed) scope.set(parameter.name + "_is_" + one, one == word ? 1 : 0);
            continue;
        }
        const auto* whole = std::get_if<std::int64_t>(&value);
        const double number = whole != nullptr ? static_cast<double>(*whole) : std::get<double>(value);
        std::string none;
        const auto unit = calculating_unit(parameter.unit, none);  // none: it is a pure number
        scope.set(parameter.name, unit ? in_si_units(top.place(), number, parameter.unit) : number);
        if (!unit) continue;
        if (parameter.unit != "1") scope.set_unit(parameter.name, std::string(*unit));
        if (const auto suffix = suffix_of(parameter.unit); parameter.unit != "1" && !suffix.empty())
            scope.set(parameter.name + "_" + suffix, number);
    }
    scope.set("nan", std::numeric_limits<double>::quiet_NaN());
    evaluate_lets(top, species_names(top), scope);
    return scope;
}

std::string value_in_expressions(const std::string& unit, double value) {
    std::string why;
    const auto si = unit.empty() || unit == "1" ? std::nullopt : calculating_unit(unit, why);
    if (!si || *si == unit) return {};
    const auto converted = in_si(fmt::format("{} {}", shortest(value), unit), *si);
    const auto* number = std::get_if<double>(&converted);
    if (number == nullptr || *number == value) return {};
    return *si == "1" ? fmt::format("{:.4g}", *number) : fmt::format("{:.4g} {}", *number, *si);
}

std::string with_si_numbers(std::string_view expression) {
    const auto is = [&](std::size_t k, auto... kind) {
        const auto c =
            k < expression.size() ? static_cast<unsigned char>(expression[k]) : static_cast<unsigned char>(' ');
        return ((kind(c) != 0) || ...);
    };
    const auto letter = [](unsigned char c) { return std::isalpha(c) != 0 || c == '_' || c >= 0x80 || c == '%'; };
    const auto digit = [](unsigned char c) { return std::isdigit(c); };
    const auto point = [](unsigned char c) { return c == '.'; };
    std::string plain, none;
    bool united = false;
    if (const auto unit = unit_of_quantity(expression); !unit.empty() && calculating_unit(std::string(unit), none))
        return {};  // one quantity, also of a unit with blanks
    for (std::size_t at = 0; at < expression.size();) {
        const bool inside = at > 0 && (is(at - 1, letter, digit, point));
        double number = 0;
        const auto* const begin = expression.data() + at;
        const auto [end, error] = std::from_chars(begin, expression.data() + expression.size(), number);
        if (inside || !is(at, digit, point) || error != std::errc()) {
            plain += expression[at++];
            continue;
        }
        const auto digits = static_cast<std::size_t>(end - begin);
        std::size_t unit = at + digits;
        while (unit < expression.size() && expression[unit] == ' ') ++unit;
        std::size_t behind = unit;
        if (is(unit, letter))
            while (is(behind, letter, digit) ||
                   (behind > unit && behind < expression.size() && expression[behind] == '/'))
                ++behind;
        const auto slash = expression.substr(unit, behind - unit).rfind('/');  // "5 mm/2" is a quotient
        const bool halved = slash != std::string_view::npos && is(unit + slash + 1, digit);
        const bool alone = behind > unit && !halved && expression.find_first_not_of(" \t+-") == at &&
                           expression.find_first_not_of(" \t", behind) == std::string_view::npos;
        if (alone) return {};
        std::string why, word(expression.substr(unit, behind - unit));
        while (!word.empty() && !calculating_unit(word, why))  // "29 mm/hub": the unit ends before a sign of division
            word.resize(word.rfind('/') == std::string::npos ? 0 : word.rfind('/'));
        if (word.empty()) {
            plain += expression.substr(at, digits);
            at += digits;
            continue;
        }
        const auto si = in_si(fmt::format("{} {}", expression.substr(at, digits), word), *calculating_unit(word, why));
        plain += fmt::format("({})", shortest(std::get<double>(si)));
        united = true;
        at = unit + word.size();
    }
    return united ? plain : std::string();
}

std::string unclear_quotient(std::string_view expression) {
    if (expression.find('/') == std::string_view::npos) return {};
    static const std::regex quotient(R"((^|[^\w.)\]])(\d+(?:\.\d*)?)\s*/\s*(\d+(?:\.\d*)?)\s*([A-Za-z%][\w%]*))");
    std::match_results<std::string_view::const_iterator> found;
    std::string why;
    if (!std::regex_search(expression.begin(), expression.end(), found, quotient)) return {};
    const std::string over = found[2], under = found[3], unit = found[4];
    if (!calculating_unit(unit, why)) return {};
    return fmt::format("'({}/{})*(1 {})' or '{}/({} {})'", over, under, unit, over, under, unit);
}

void add_species_numbers(const Section& top, const machine::Spec& spec, MachineScope& scope) {
    for (const auto& species : spec.species) {
        scope.set(species.name + "_largest", species.widest());
        scope.set(species.name + "_smallest", species.smallest());
        scope.set(species.name + "_volume", species.mean_volume());
    }
    evaluate_lets(top, {}, scope);
}

}  // namespace grainsweep::campaign

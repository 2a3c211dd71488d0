// Parameters of a program: the factors and fixed values of its campaign, and the section "parameters".
#include "sweep/campaign/formula.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/placeholders.hpp"
#include "sweep/campaign/program_keys.hpp"
#include "sweep/campaign/program_section.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/campaign/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace grainsweep::campaign {
namespace {

constexpr std::size_t longest_plain_name = 64, longest_level = 4096, most_levels = 10'000;
constexpr std::array<std::string_view, 5> names_of_the_case = {"seed", "seed31", "case", "threads", "notes"};
constexpr std::string_view one_kind = "the values of a parameter are all numbers or all words";

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
bool has_whole_steps(const Json& factor) {
    if (factor.value("whole", Json()) == true) return true;
    const auto step = factor.value("step", Json());
    return step.is_number() && step.get<double>() == std::floor(step.get<double>());
}

/// Whether a text begins as a number.
bool resembles_number(std::string_view text) {
    return !text.empty() && text.find_first_of("0123456789.") == text.find_first_not_of(" +-");
}

/// What the section "parameters" makes of a parameter; errors of the section are reported later.
struct Told {
    explicit Told(const Json& notes) {
        if (!notes.is_object()) return;
        if (const auto place = notes.find("unit"); place != notes.end() && place->is_string())
            unit = place->get<std::string>();
        const auto bounds = notes.value("bounds", Json());
        const auto is_text = [](const Json& end) { return end.is_string(); };
        const auto begins_with_number = [](const Json& end) {
            return end.is_string() && resembles_number(end.get_ref<const std::string&>());
        };
        words = bounds.is_array() && std::ranges::any_of(bounds, is_text) &&
                (unit.empty() || std::ranges::none_of(bounds, begins_with_number));
        number =
            !words && (!unit.empty() || (bounds.is_array() && !bounds.empty()) || notes.value("whole", Json()) == true);
    }

    std::string unit;
    bool number = false, words = false;
};

/// Parameters that a campaign gives values to, and the places of the values.
class Given {
public:
    Given(const Section& top, const Section& section) {
        if (const auto notes = section.find("parameters"); notes && notes->json().is_object())
            for (const auto& [name, one] : notes->json().items()) told_.emplace(name, one);
        const Cursor factors = top.at("factors");
        if (factors.json().is_array())
            for (const auto& factor : factors.elements()) add_factor(factor);
        if (const auto fixed = top.find("fixed"); fixed && fixed->json().is_object())
            for (const auto& [name, value] : fixed->members({})) add(name, value);
        if (const auto calibration = top.find("calibration")) add_conditions(*calibration);
        if (const auto accuracy = section.find("accuracy")) add_settings(*accuracy);
    }

    [[nodiscard]] std::vector<ProgramParameter> parameters() const {
        std::vector<ProgramParameter> all;
        for (const auto& [name, values] : values_) {
            ProgramParameter parameter{name, {}, {}, Interval{}};
            if (auto words = words_of(name, values); !words.empty()) parameter.bounds = Words{std::move(words)};
            all.push_back(std::move(parameter));
        }
        refuse_expressions_among_words(all);
        return all;
    }
    /// Every number given to it is one.
    void require_whole(const std::string& name, const std::string& unit) const {
        const auto& values = values_.at(name);
        for (const auto& range : values.ranges)
            range.refuse(fmt::format("'{}' is a whole number: add \"whole\": true, or vary it by \"levels\"", name));
        for (const auto& place : values.places) {
            const auto& json = place.json();
            const auto number = json.is_string() ? in_si(json.get<std::string>(), unit)
                                                 : std::variant<double, std::string>(json.get<double>());
            if (const auto* x = std::get_if<double>(&number); x != nullptr && *x != std::floor(*x))
                place.refuse(fmt::format("'{}' is a whole number", name));
        }
    }
    [[nodiscard]] bool is_conditional(const std::string& name) const { return conditional_.contains(name); }

private:
    struct Values {
        bool range = false;          ///< varied over a range
        std::vector<Cursor> ranges;  ///< of real numbers
        std::vector<Cursor> places;  ///< of numbers and texts
    };

    Values& values_of(const Cursor& place, const std::string& name) {
        check_program_name(place, name);
        std::vector<std::string> others;
        for (const auto& [other, values] : values_) others.push_back(other);
        check_name_in_sql(place, name, others);
        return values_[name];
    }
    void add(const std::string& name, const Cursor& value) {
        auto& values = values_of(value, name);
        if (value.json().is_string() || value.json().is_number()) values.places.push_back(value);
    }
    void add_factor(const Cursor& factor) {
        if (!factor.json().is_object() || !factor.json().contains("name") || !factor["name"].json().is_string()) return;
        const auto name = factor["name"].json().get<std::string>();
        if (factor.json().contains("when")) conditional_.insert(name);
        auto& values = values_of(factor["name"], name);
        if (factor.json().contains("levels") && factor["levels"].json().is_array()) {
            for (const auto& level : factor["levels"].elements()) add(name, level);
            return;
        }
        values.range = true;
        for (const auto key : range_keys)
            if (factor.json().contains(key) && !has_whole_steps(factor.json())) values.ranges.push_back(factor[key]);
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

    /// Parameters that accuracy settings give values to.
    void add_settings(const Cursor& accuracy) {
        if (!accuracy.json().is_object()) accuracy.refuse("must be an object of settings and the parameters of each");
        for (const auto& [setting, inputs] : accuracy.members({}))
            if (inputs.json().is_object())
                for (const auto& [name, value] : inputs.members({}))
                    if (name != "cost_seconds") add(name, value);
    }

    [[nodiscard]] Told told_of(const std::string& name) const {
        const auto found = told_.find(name);
        return found == told_.end() ? Told(Json()) : found->second;
    }
    /// Returns the different words of a parameter; none: it is a number.
    [[nodiscard]] std::vector<std::string> words_of(const std::string& name, const Values& values) const {
        const auto told = told_of(name);
        if (told.number) return {};
        const auto is_number = [](const Cursor& place) { return place.json().is_number(); };
        const auto number = std::ranges::find_if(values.places, is_number);
        if (told.words && number != values.places.end())
            number->refuse(fmt::format("{}, and the bounds of '{}' are words", one_kind, name));
        std::vector<std::string> words;
        for (const auto& place : values.places) {
            if (!place.json().is_string()) continue;
            const auto& word = place.json().get_ref<const std::string&>();
            if (values.range || number != values.places.end()) {
                if (resembles_number(word)) continue;  // refused as a number
                place.refuse(one_kind);
            }
            check_word(place);
            if (!told.words) refuse_quantity(place, name, word);
            if (words.size() >= most_levels) place.refuse(fmt::format("at most {} words", most_levels));
            if (std::ranges::find(words, word) == words.end()) words.push_back(word);
        }
        return words;
    }
    static void refuse_quantity(const Cursor& place, const std::string& name, const std::string& word) {
        if (resembles_united_number(word))
            place.refuse(
                fmt::format("is a number with a unit, and '{0}' has no unit: state \"unit\" in "
                            "program.parameters.{0}, or \"bounds\": [\"{1}\"] if it is a word",
                            name, word));
    }
    void refuse_expressions_among_words(const std::vector<ProgramParameter>& all) const {
        std::vector<std::string_view> numbers;
        for (const auto& parameter : all)
            if (!parameter.is_word()) numbers.push_back(parameter.name);
        for (const auto& parameter : all) {
            if (!parameter.is_word() || told_of(parameter.name).words) continue;
            for (const auto& place : values_.at(parameter.name).places) {
                const auto& word = place.json().get_ref<const std::string&>();
                const auto parsed = Formula::parse(word, numbers);
                const auto* formula = std::get_if<Formula>(&parsed);
                if (formula == nullptr || formula->names().empty() || is_plain_name(word)) continue;
                place.refuse(
                    fmt::format("is an expression of other parameters, and '{0}' has no unit: state \"unit\" in "
                                "program.parameters.{0} (\"1\" for a pure number), or \"bounds\": [\"{1}\"] if "
                                "it is a word",
                                parameter.name, word));
            }
        }
    }

    std::map<std::string, Told> told_;
    std::map<std::string, Values> values_;
    std::set<std::string> conditional_;
};

/// Reads the value of a parameter whose factor does not count; empty: the usual one, 0 or no word.
std::optional<Value> read_standard(const Section& told, const ProgramParameter& parameter, const Given& given) {
    const auto place = told.find("default");
    if (!place) return std::nullopt;
    if (!given.is_conditional(parameter.name))
        place->refuse(fmt::format("has no effect: '{}' is no factor with a \"when\", so every case has its value",
                                  parameter.name));
    if (!parameter.is_word()) {
        const auto value = read_value(*place, {parameter.name, parameter.unit, {}, 0.0, Interval{}, {}}, {});
        if (parameter.whole && std::get<double>(value) != std::floor(std::get<double>(value)))
            place->refuse(fmt::format("'{}' is a whole number", parameter.name));
        return value == Value{0.0} ? std::nullopt : std::optional(value);
    }
    (void)place->text();
    check_word(*place);
    return Value{place->text()};
}

void read_notes(const std::string& name, const Cursor& here, const Given& given, ProgramParameter& parameter) {
    const Section told(here, program_parameter_keys);
    if (const auto unit = told.find("unit")) parameter.unit = unit->text();
    if (const auto meaning = told.find("meaning")) parameter.meaning = meaning->text();
    parameter.whole = told.flag("whole", false);
    if (parameter.whole) {
        if (parameter.is_word()) told.at("whole").refuse("the values of this parameter are words");
        given.require_whole(name, parameter.unit);
    }
    if (const auto bounds = told.find("bounds")) {
        if (parameter.is_word()) {
            Words words;
            for (const auto& element : bounds->elements()) words.allowed.push_back(element.text());
            parameter.bounds = std::move(words);
        } else {
            parameter.bounds = read_program_bounds(*bounds, parameter.unit);
        }
    }
    parameter.standard = read_standard(told, parameter, given);
    const auto* range = std::get_if<Interval>(&parameter.bounds);
    if (given.is_conditional(name) && !told.find("default") && range != nullptr && !range->contains(0))
        told.at("bounds").refuse(
            fmt::format("0 lies outside, and '{}' is 0 where its \"when\" is false: state "
                        "\"default\"",
                        name));
}

/// Returns whether two names are one in SQL, where upper case does not count.
bool is_one_name_in_sql(const std::string& a, const std::string& b) {
    return small_letters(a) == small_letters(b);
}

}  // namespace

void check_program_name(const Cursor& place, const std::string& name) {
    if (!is_plain_name(name) || name.size() > longest_plain_name)
        throw input_error(place.path(), name,
                          fmt::format("a name is letters, digits and _, not a digit first, at most {}: it names a "
                                      "column in SQL",
                                      longest_plain_name));
    if (std::ranges::find(names_of_the_case, name) != names_of_the_case.end())
        throw input_error(place.path(), name, "is the program's name for something else; take another");
    const std::array<std::string, 2> truths = {"true", "false"};
    const auto is_name = [&](const std::string& truth) { return is_one_name_in_sql(truth, name); };
    if (std::ranges::any_of(truths, is_name))  // SQLite renames such a column of a view to column9
        throw input_error(place.path(), name, "is a number in SQL, where it cannot name a column; take another");
}

void check_name_in_sql(const Cursor& place, const std::string& name, const std::vector<std::string>& others) {
    for (const std::string& other : others)
        if (other != name && is_one_name_in_sql(other, name))
            throw input_error(place.path(), name,
                              fmt::format("{} and {} are one name in SQL; rename one", other, name));
}

std::vector<ProgramParameter> read_program_parameters(const Section& top, const Section& section) {
    const Given given(top, section);
    auto parameters = given.parameters();
    const auto all = section.find("parameters");
    if (!all) return parameters;
    for (const auto& [name, here] : all->members("must be an object of names and what is known of each")) {
        const auto found = std::ranges::find(parameters, name, &ProgramParameter::name);
        if (found == parameters.end())
            throw input_error(here.path(), "", "is neither a factor nor a fixed value",
                              nearest_word(name, names_of(parameters)));
        read_notes(name, here, given, *found);
    }
    return parameters;
}

}  // namespace grainsweep::campaign

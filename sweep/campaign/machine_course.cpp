// "measure" of a machine.
#include "sweep/campaign/formula.hpp"
#include "sweep/campaign/machine_reading.hpp"

#include "solver/machine/reduction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace grainsweep::campaign {
namespace {

/// Kind of an entry of "measure".
enum class EntryKind { probe, time_of, expression };

EntryKind entry_kind(const Cursor& place) {
    if (place.json().is_string()) return EntryKind::expression;
    if (!place.json().is_object())
        place.refuse("must be an object with a probe, or a text: an expression of other measurements");
    if (place.json().contains("expression")) return EntryKind::expression;
    return place.json().contains("time_of") ? EntryKind::time_of : EntryKind::probe;
}

/// Returns the name of the standard error of a measurement.
std::string error_name(const Cursor& place, const std::string& name) {
    if (!place.json().contains("error")) return name + "_error";
    require_name(place["error"], place["error"].text());
    return place["error"].text();
}

/// The text of an expression, alone or with its unit and meaning.
Cursor expression_of(const Cursor& place) {
    return place.json().is_string() ? place : Section(place, machine_keys::expression).at("expression");
}

/// The probe of an entry: its one key that is none of a measurement's own.
const machine::ProbeInfo& probe_of(const Cursor& place) {
    const machine::ProbeInfo* found = nullptr;
    std::string unknown;
    for (const auto& [key, here] : place.members("must be an object with a probe")) {
        const auto own = machine_keys::measure;
        if (std::ranges::find(own, key, &Field::name) != own.end()) continue;
        const auto* probe = machine::find_probe(key);
        if (probe == nullptr) {
            unknown = key;
        } else if (found != nullptr) {
            place.refuse(fmt::format("has two probes, '{}' and '{}'; a measurement has one", found->name, key));
        } else {
            found = probe;
        }
    }
    if (!unknown.empty()) {
        WordList known = names_of(machine::probe_catalogue());
        for (const Field& key : machine_keys::measure) known.push_back(key.name);
        throw input_error(path_of(place.path(), unknown), "", "there is no such probe", nearest_word(unknown, known));
    }
    if (found == nullptr)
        place.refuse(fmt::format("a measurement needs one of the {} probes, such as 'mass', 'profile' or 'wall_torque'",
                                 machine::probe_catalogue().size()));
    return *found;
}

std::string_view default_reduction(const machine::ProbeInfo& probe) {
    if (probe.over.empty()) return probe.so_far ? "last" : "mean";
    return probe.so_far ? "last_profile" : "profile";
}

const machine::ReductionInfo& reduction_of(const Cursor& place, const machine::ProbeInfo& probe) {
    const bool profile = !probe.over.empty();
    if (!place.json().contains("as")) return *machine::find_reduction(default_reduction(probe));
    std::vector<std::string_view> words;
    for (const auto& reduction : machine::reduction_catalogue())
        if ((reduction.shape == Shape::profile) == profile) words.push_back(reduction.name);
    return *machine::find_reduction(place["as"].word(words));
}

/// Names that "of" may have: of species, then of single particles.
std::vector<std::string> particles_in_words(const MachineReading& reading) {
    auto names = reading.species;
    names.insert(names.end(), reading.named_particles.begin(), reading.named_particles.end());
    return names;
}

machine::OptionValue option_value(const Cursor& place, const Field& option, const MachineReading& reading) {
    switch (option.kind) {
        case Field::Kind::quantity:
            return reading.scope.number(place, option.unit, option.bounds);
        case Field::Kind::vector:
            return reading.scope.vector(place, option.unit);
        case Field::Kind::direction:
            return reading.scope.direction(place);
        case Field::Kind::region:
            return reading.scope.region(place);
        case Field::Kind::species:
            return reading.scope.places_in(place, reading.species, "species");
        case Field::Kind::particles: {
            machine::SelectedParticles selected;
            for (const auto number : reading.scope.places_in(place, particles_in_words(reading), "species or particle"))
                if (number < reading.species.size())
                    selected.species.push_back(number);
                else
                    selected.named.push_back(number - reading.species.size());
            return selected;
        }
        case Field::Kind::walls: {
            std::vector<std::size_t> walls;
            for (const std::size_t named : reading.scope.places_in(place, reading.walls, "wall"))
                for (const std::size_t one : reading.repeats[named]) walls.push_back(one);
            return walls;
        }
        default:
            return reading.scope.word(place, option.words);
    }
}

machine::Options read_options(const Cursor& place, const machine::ProbeInfo& probe, const MachineReading& reading) {
    machine::Options options;
    if (!place.json().is_object()) place.refuse(fmt::format("must be an object with the options of '{}'", probe.name));
    for (const auto& [key, here] : place.members("")) {
        const auto option = std::ranges::find(probe.options, key, &Field::name);
        if (option == probe.options.end()) {
            const WordList known = names_of(probe.options);
            throw input_error(
                here.path(), "",
                fmt::format("'{}' has {}", probe.name, probe.options.empty() ? "no options" : in_words(known)),
                nearest_word(key, known));
        }
        options.set(key, option_value(here, *option, reading));
    }
    for (const Field& option : probe.options)
        if (option.required && !options.has(option.name))
            throw input_error(place.path(), "", fmt::format("key '{}' is missing: {}", option.name, option.meaning));
    if (probe.flaw != nullptr)
        if (const auto flaw = probe.flaw(options); !flaw.empty()) place.refuse(flaw);
    return options;
}

/// Sorts expressions so that each follows the expressions that it needs. Refuses circles. Only a measurement that may
/// be withdrawn needs itself.
void put_in_order(const Cursor& all, std::vector<machine::Derived>& derived) {
    constexpr std::string_view error = "_error";
    std::vector<machine::Derived> sorted;
    const auto waits_for = [&](const machine::Derived& one, std::string_view need) {
        if (need == one.name) return false;
        const std::string_view value = need.ends_with(error) ? need.substr(0, need.size() - error.size()) : need;
        return std::ranges::any_of(
            derived, [&](const auto& other) { return &other != &one && (other.name == need || other.name == value); });
    };
    while (!derived.empty()) {
        const auto ready = std::ranges::find_if(derived, [&](const auto& one) {
            return std::ranges::none_of(one.needs, [&](const auto& need) { return waits_for(one, need); });
        });
        if (ready == derived.end()) all[derived.front().name].refuse("it depends on itself");
        sorted.push_back(std::move(*ready));
        derived.erase(ready);
    }
    derived = std::move(sorted);
}

/// Expression of measurements and of names that are numbers in this case.
machine::Derived derived_of(const std::string& name, const Cursor& text, const std::vector<std::string>& known,
                            const MachineScope& scope) {
    auto parsed = Formula::of(text.text(), [&](std::string_view used) {
        return scope.has_number(used) || std::ranges::find(known, used) != known.end();
    });
    if (!std::holds_alternative<Formula>(parsed)) {  // the sentence finds the nearest name
        auto names = known;
        const auto constants = scope.names();
        names.insert(names.end(), constants.begin(), constants.end());
        parsed = Formula::parse(text.text(), names);
    }
    if (const auto* why = std::get_if<std::string>(&parsed)) text.refuse(*why);
    const auto& formula = std::get<Formula>(parsed);
    machine::Derived derived{name, {}, {}};
    std::map<std::string, double, std::less<>> given;
    for (const auto& used : formula.names()) {
        const bool measured = std::ranges::find(known, used) != known.end();
        if (measured && scope.knows(used))
            text.refuse(fmt::format("'{}' is a parameter or in \"let\", and a measurement; rename one", used));
        if (measured)
            derived.needs.push_back(used);
        else
            given.emplace(used, scope.value(used));
    }
    derived.value = [formula, given](const std::map<std::string, double, std::less<>>& measured) {
        return formula([&](std::string_view used) {
            const auto here = given.find(used);
            return here != given.end() ? here->second : measured.find(used)->second;
        });
    };
    return derived;
}

/// A measurement that is undefined where the condition holds.
machine::Derived withdrawn(machine::Derived condition, std::string error) {
    condition.error = std::move(error);
    auto value = [name = condition.name,
                  holds = std::move(condition.value)](const std::map<std::string, double, std::less<>>& measured) {
        return holds(measured) != 0 ? std::numeric_limits<double>::quiet_NaN() : measured.find(name)->second;
    };
    condition.value = std::move(value);
    condition.needs.push_back(condition.name);
    return condition;
}

}  // namespace

void read_measures(const Section& top, MachineReading& reading) {
    const Cursor all = top.at("measure");
    auto& spec = reading.spec;
    for (const auto& [name, value] : all.json().items()) {
        const Cursor place = all[name];
        if (entry_kind(place) != EntryKind::probe) continue;
        const auto& probe = probe_of(place);
        if (place.json().contains("when") && reading.scope.number(place["when"], "1") == 0) continue;
        machine::Measure measure;
        measure.name = name;
        measure.error = error_name(place, name);
        measure.probe = probe.name;
        measure.options = read_options(place[probe.name], probe, reading);
        measure.reduction = reduction_of(place, probe).name;
        if (place.json().contains("during")) measure.during = reading.phases_in(place["during"]);
        reading.measures.push_back(name);
        spec.measures.push_back(std::move(measure));
    }
    for (auto& measure : spec.measures) read_counting(all[measure.name], reading, measure);
    for (const auto& [name, value] : all.json().items()) {
        const Cursor place = all[name];
        if (entry_kind(place) != EntryKind::time_of) continue;
        const Section section(place, machine_keys::time_of);
        const std::size_t of = measure_named(section.at("time_of"), reading);
        const auto [threshold, above] = threshold_of(section, reading, unit_of_measure(reading, of));
        spec.times.push_back({name, of, threshold, above, {}});
        read_scale(place, reading, spec.times.back().scale);
    }
    // Expressions may use parameters, "let", measurements, and one another.
    std::vector<std::string> known;
    for (const auto& observable : reading.observables)
        if (observable.shape == Shape::scalar) known.push_back(observable.name);
    for (const auto& [name, value] : all.json().items()) {
        const Cursor place = all[name];
        const EntryKind kind = entry_kind(place);
        if (kind == EntryKind::expression) {
            spec.derived.push_back(derived_of(name, expression_of(place), known, reading.scope));
            if (std::ranges::find(spec.derived.back().needs, name) != spec.derived.back().needs.end())
                place.refuse("it depends on itself");
        }
        if (kind == EntryKind::probe && place.json().contains("unless") &&
            std::ranges::find(reading.measures, name) != reading.measures.end())
            spec.derived.push_back(
                withdrawn(derived_of(name, place["unless"], known, reading.scope), error_name(place, name)));
    }
    put_in_order(all, spec.derived);
}

namespace {

/// Returns "unit" or "over" of a measurement's "scale".
std::string scale_text(const Cursor& place, std::string_view key, const std::string& standard) {
    if (!place.json().contains("scale")) return standard;
    const auto given = Section(place["scale"], machine_keys::scale).find(key);
    return given ? given->text() : standard;
}

/// Why a measurement of one value has none.
std::string why_nothing(const Cursor& place) {
    std::string why = "there was nothing to measure";
    if (place.json().contains("unless")) why += ", or " + place["unless"].text();
    return why;
}

/// Adds what every phase with a condition gives. Repeated phases share a name.
void add_phase_observables(const Cursor& phases, bool repeated, std::vector<ObservableSpec>& all) {
    for (const auto& phase : phases.elements()) {
        if (!phase.json().is_object()) continue;
        if (phase.json().contains("phases")) add_phase_observables(phase["phases"], true, all);
        if (!phase.json().contains("until") || !phase.json().contains("name")) continue;
        const std::string name = phase["name"].text();
        all.push_back({name + "_time",
                       "s",
                       fmt::format("how long phase '{}' lasted{}", name, repeated ? ", all repeats together" : ""),
                       Shape::scalar,
                       {},
                       {}});
        all.push_back({name + "_ended",
                       "1",
                       fmt::format("number of the condition that ended phase '{}'{}, from 1; 0: its time", name,
                                   repeated ? " last" : ""),
                       Shape::scalar,
                       {},
                       {}});
    }
}

}  // namespace

std::vector<MainObservable> shown_observables(const Section& top) {
    std::vector<MainObservable> all;
    if (const auto place = top.find("shown"))
        for (const auto& one : place->elements())
            for (const auto& [name, words] : one.members("must be {MEASUREMENT: its meaning in a few words}"))
                all.push_back({name, words.text()});
    return all;
}

std::vector<ObservableSpec> machine_observables(const Section& top) {
    std::vector<ObservableSpec> all;
    const Cursor measures = top.at("measure");
    if (!measures.json().is_object()) measures.refuse("must be an object of measurements by name");
    const auto meaning_of = [](const Cursor& place, std::string_view standard) {
        return place.json().is_object() && place.json().contains("meaning") ? place["meaning"].text()
                                                                            : std::string(standard);
    };
    for (const auto& [name, value] : measures.json().items()) {
        const Cursor place = measures[name];
        require_name(place, name);
        const EntryKind kind = entry_kind(place);
        if (kind == EntryKind::expression)
            all.push_back({name,
                           place.json().is_object() && place.json().contains("unit") ? place["unit"].text() : "SI",
                           meaning_of(place, expression_of(place).text()),
                           Shape::scalar,
                           {},
                           "something in the expression has no value"});
        if (kind == EntryKind::time_of)
            all.push_back({name,
                           scale_text(place, "unit", "s"),
                           meaning_of(place, "first time at which a measurement passes a value"),
                           Shape::scalar,
                           {},
                           "it never passes the value"});
        if (kind != EntryKind::probe) continue;
        const auto& probe = probe_of(place);
        const auto& reduction = reduction_of(place, probe);
        const auto meaning = meaning_of(place, fmt::format("{}: {}", probe.meaning, reduction.meaning));
        const bool each = place.json().contains("repeats") && place["repeats"].text() == "each";
        const Shape shape = each ? Shape::profile : reduction.shape;
        std::string over = each                                ? "number of the repeat"
                           : reduction.shape == Shape::series  ? "time, s"
                           : reduction.shape == Shape::profile ? std::string(probe.over)
                                                               : std::string();
        const bool relative = place.json().contains("relative") && place["relative"].flag();
        std::string unit = relative ? "1" : std::string(probe.unit) + std::string(reduction.unit);
        unit = scale_text(place, "unit", unit), over = scale_text(place, "over", over);
        all.push_back({name, unit, meaning, shape, over, shape == Shape::scalar ? why_nothing(place) : ""});
        if (reduction.error != nullptr && !each)
            all.push_back({error_name(place, name),
                           unit,
                           fmt::format("standard error of {}, which counts how long values stay alike", name),
                           Shape::scalar,
                           {},
                           "fewer than ten frames, or too few independent ones"});
    }
    if (all.empty()) measures.refuse("a machine needs a measurement");
    const auto automatic = [&all](const char* name, const char* meaning, const char* unit = "1") {
        if (std::ranges::find(all, name, &ObservableSpec::name) == all.end())
            all.push_back({name, unit, meaning, Shape::scalar, {}, {}});
    };
    automatic("particles", "particles present at the end");
    automatic("lost", "particles that passed an open face of the domain");
    automatic("max_overlap", "deepest overlap of two particles over the diameter of the smaller one");
    automatic("max_wall_overlap", "deepest overlap of a particle with a wall over its diameter");
    automatic("smallest_step", "shortest time step; steps are halved where loaded contacts demand it", "s");
    if (const auto fills = top.find("fill"))
        for (const auto& fill : fills->elements())
            if (fill.json().is_object() && fill.json().contains("name") && fill.json().contains("packing")) {
                const std::string name = fill["name"].text();
                all.push_back({name + "_particles",
                               "1",
                               "spheres cut from the packing, also those left out",
                               Shape::scalar,
                               {},
                               {}});
                all.push_back({name + "_packing", "1", "spheres of the whole packing", Shape::scalar, {}, {}});
            }
    if (const auto feeds = top.find("feed")) {
        std::set<std::string> feeders;
        for (const auto& feed : feeds->elements()) {
            const bool named = feed.json().is_object() && feed.json().contains("name");
            const std::string name = named ? feed["name"].text() : "feed";
            if (!feeders.insert(name).second)
                throw input_error(feed.path(), "", "several feeds need a \"name\" each", name + "_2");
            all.push_back({name + "_fed", "kg", "mass fed", Shape::scalar, {}, "it is left out here"});
            all.push_back({name + "_waiting",
                           "kg",
                           "mass that found no place and waits",
                           Shape::scalar,
                           {},
                           "it is left out here"});
        }
    }
    add_phase_observables(top.at("phases"), false, all);
    const auto place_of = [&all](const Cursor& place, const std::string& name) {
        const auto found = std::ranges::find(all, name, &ObservableSpec::name);
        if (found == all.end()) place.refuse("there is no such measurement", nearest_word(name, names_of(all)));
        return found;
    };
    if (const auto shown = top.find("shown"))
        for (const auto& one : shown_observables(top)) (void)place_of(*shown, one.name);
    if (const auto main = top.find("main")) {
        const auto found = place_of(*main, main->text());
        std::rotate(all.begin(), found, found + 1);
    }
    std::set<std::string> names;
    for (const auto& observable : all)
        if (!names.insert(observable.name).second)
            throw input_error(path_of(measures.path(), observable.name), "",
                              "every case has an observable of this name anyway; take another one",
                              observable.name + "_2");
    return all;
}

}  // namespace grainsweep::campaign

// "phases" of a machine: their order, groups that repeat, lengths and conditions.
#include "sweep/campaign/machine_reading.hpp"
#include "sweep/campaign/quantity.hpp"

#include "solver/machine/reduction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace grainsweep::campaign {
namespace {

constexpr std::size_t most_phases = 3000;

machine::Known read_known(const Section& section, const MachineReading& reading) {
    machine::Known known;
    reading.scope.read(section, machine_keys::known, &known);
    const Cursor measure = section.at("measure");
    known.measure = measure_named(measure, reading);
    const auto& measured = reading.spec.measures[known.measure];
    const auto* reduction = machine::find_reduction(measured.reduction);
    if (reduction->error == nullptr) measure.refuse("it has no standard error");
    const Cursor error = section.at("error");
    const bool united = error.json().is_string() && !unit_of_quantity(error.text()).empty() && !measured.relative;
    known.error = united
                      ? reading.scope.number(
                            error, std::string(unit_of_measure(reading, known.measure)) + std::string(reduction->unit),
                            no_negative_number) /
                            measured.scale.value
                      : reading.scope.number(error, "1", no_negative_number);
    if (!machine::holds(measured.during, reading.spec.phases.size()))
        measure.refuse("its \"during\" lacks this phase: its error is never known here");
    if (const auto every = section.find("every")) known.every = reading.scope.whole(*every, {1, 1e6});
    return known;
}

machine::Until read_until(const Cursor& place, const MachineReading& reading) {
    const Section section(place, machine_keys::until);
    const auto rest = section.find("at_rest"), empty = section.find("empty"), stops = section.find("flow_stops"),
               quiet = section.find("quiet"), measure = section.find("measure"), known = section.find("known");
    if (std::ranges::count_if(std::array{rest, empty, stops, quiet, measure, known},
                              [](const auto& one) { return one.has_value(); }) != 1)
        place.refuse(
            "a phase lasts until one of \"at_rest\", \"empty\", \"flow_stops\", \"quiet\", \"known\" and \"measure\"");
    if (!measure)
        for (const char* key : {"above", "below"})
            if (const auto end = section.find(key)) end->refuse("it belongs to \"measure\"");
    if (rest) {
        if (!rest->flag()) rest->refuse("must be true");
        if (!(geometry::norm(reading.spec.gravity) > 0)) rest->refuse("without gravity nothing comes to rest");
        return machine::AtRest{};
    }
    if (empty) return machine::Empty{reading.scope.region(*empty)};
    if (machine::FlowStops condition; reading.scope.read(section, "flow_stops", &condition)) return condition;
    if (machine::Quiet condition; reading.scope.read(section, "quiet", &condition)) return condition;
    if (known) return read_known(Section(*known, machine_keys::known), reading);
    const std::size_t number = measure_named(*measure, reading);
    if (reading.spec.measures[number].relative) measure->refuse("a relative value ends no phase");
    const auto [value, above] = threshold_of(section, reading, unit_of_measure(reading, number));
    return machine::Passes{number, value, above};
}

/// Calls visit(section) for every phase, in the order in which they happen; a group repeats its phases.
template <class Visit>
void each_phase(const Cursor& list, MachineReading& reading, const Visit& visit) {
    for (const auto& place : list.elements()) {
        const Section section(place, machine_keys::phase);
        const auto group = section.find("phases"), repeat = section.find("repeat"), as = section.find("as");
        if (!group) {
            for (const auto& other : {repeat, as})
                if (other) other->refuse("it belongs to a group: beside \"phases\"");
            visit(section);
            continue;
        }
        for (const Field& key : machine_keys::phase)
            if (const auto other = section.find(key.name);
                other && key.name != "phases" && key.name != "repeat" && key.name != "as")
                other->refuse("a group of phases has only \"phases\", \"repeat\" and \"as\"");
        if (!repeat) throw input_error(place.path(), "", "key 'repeat' is missing");
        if (reading.scope.whole(*repeat, {0, most_repeats}) == 0)
            repeat->refuse("a group of phases happens at least once");
        if (group->elements().empty()) group->refuse("a group needs a phase");
        for_every_one(section, reading, [&](std::int64_t, std::int64_t) { each_phase(*group, reading, visit); });
    }
}

}  // namespace

machine::Phases MachineReading::phases_in(const Cursor& place) const {
    machine::Phases all;
    for (const std::size_t name : scope.places_in(place, phases, "phase"))
        all.insert(all.end(), copies[name].begin(), copies[name].end());
    std::ranges::sort(all);
    return all;
}

machine::Phases read_during(const Section& section, const MachineReading& reading) {
    const auto place = section.find("during");
    return place ? reading.phases_in(*place) : machine::Phases{};
}

void read_phase_names(const Section& top, MachineReading& reading) {
    const Cursor all = top.at("phases");
    std::vector<std::string> paths;  // of the names
    each_phase(all, reading, [&](const Section& section) {
        const auto given = section.find("name");
        if (!given) throw input_error(section.place().path(), "", "key 'name' is missing: by which others name it");
        const Cursor& name = *given;
        require_name(name, name.text());
        const auto found = std::ranges::find(reading.phases, name.text());
        const auto number = static_cast<std::size_t>(found - reading.phases.begin());
        if (found == reading.phases.end()) {
            reading.phases.push_back(name.text());
            reading.copies.emplace_back();
            paths.push_back(section.place().path());
        } else if (paths[number] != section.place().path()) {
            name.refuse("a phase of this name is there twice");
        }
        if (reading.phase_paths.size() == most_phases)
            all.refuse(fmt::format("a machine has at most {} phases, repeated ones included", most_phases));
        reading.copies[number].push_back(reading.phase_paths.size());
        reading.phase_paths.push_back(section.place().path());
    });
    if (reading.phases.empty()) all.refuse("a machine needs a phase");
}

namespace {

/// "start": a phase, with which it ends, and a seed.
void read_start(const Section& top, MachineReading& reading) {
    const auto place = top.find("start");
    if (!place) return;
    auto& spec = reading.spec;
    const Section section(*place, machine_keys::start);
    const Cursor end = section.at("phase");
    spec.start.phases = reading.copies[reading.scope.place_in(end, reading.phases, "phase")].front() + 1;
    if (spec.start.phases == spec.phases.size()) end.refuse("the start is not measured: a phase must follow it");
    if (const double seed = reading.scope.number(section, "seed", "1", 0, {0, 9.0e15}); seed > 0)
        spec.start.seed = seed;
    const auto within = [&](std::size_t phase) { return phase > 0 && phase < spec.start.phases; };
    bool changes = std::ranges::any_of(spec.removals, within, &machine::Removal::at);
    for (const auto& one : spec.fills)
        if (const auto* fill = std::get_if<machine::Fill>(&one)) changes = changes || within(fill->at);
    for (std::size_t p = 0; p < spec.start.phases; ++p) changes = changes || !spec.phases[p].until.empty();
    for (const auto& feed : spec.feeds)
        for (std::size_t p = 0; p < spec.start.phases; ++p) changes = changes || machine::holds(feed.during, p);
    if (changes) end.refuse("up to its end nothing is fed, filled or removed, and phases last \"for\" a time");
}

}  // namespace

void read_phases(const Section& top, MachineReading& reading) {
    each_phase(top.at("phases"), reading, [&](const Section& section) {
        const Cursor& place = section.place();
        const auto given = section.find("for"), until = section.find("until"), most = section.find("at_most");
        if (given.has_value() == until.has_value() || until.has_value() != most.has_value())
            place.refuse("a phase lasts \"for\" a time, or \"until\" something and \"at_most\" a time");
        machine::Phase phase;
        phase.name = section.at("name").text();
        phase.duration = reading.scope.number(given ? *given : *most, "s", no_negative_number);
        if (const auto frames = section.find("frames")) {
            phase.frames = reading.scope.whole(*frames, {1, 1e6});
            phase.frames_given = true;
        }
        if (until && !until->json().is_array()) phase.until.push_back(read_until(*until, reading));
        if (until && until->json().is_array())
            for (const auto& one : until->elements()) phase.until.push_back(read_until(one, reading));
        if (until && phase.until.empty()) until->refuse("must name a condition");
        reading.scope.read(section, machine_keys::phase, &phase);
        if (phase.every && phase.frames_given) section.at("every").refuse("beside \"frames\" it says too much");
        phase.frames_given = phase.frames_given || phase.every;
        if (phase.expected && !until) section.at("expected").refuse("it belongs to \"until\"");
        if (phase.ends_at_frames && !until) section.at("ends_at_frames").refuse("it belongs to \"until\"");
        if (!phase.ends_at_frames && std::ranges::any_of(phase.until, [](const machine::Until& one) {
                return std::holds_alternative<machine::Known>(one);
            }))
            until->refuse("\"known\" is looked at when it is measured: \"ends_at_frames\": true");
        if (phase.until.size() > 100) until->refuse("a phase has at most 100 conditions");
        reading.spec.phases.push_back(std::move(phase));
    });
    read_start(top, reading);
}

}  // namespace grainsweep::campaign

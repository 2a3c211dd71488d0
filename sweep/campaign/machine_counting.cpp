// Which values of a measurement count, and from when on its times do: "shares", "while" and "since".
#include "sweep/campaign/machine_reading.hpp"

#include "solver/machine/reduction.hpp"

#include <array>

namespace grainsweep::campaign {
namespace {

bool is_profile(const machine::Measure& measure) {
    return !machine::find_probe(measure.probe)->over.empty();
}

void read_shares(const Cursor& place, const MachineReading& reading, machine::Measure& into) {
    if (is_profile(into)) place.refuse("a profile has no first value to be a share of");
    if (!place.json().is_array() || place.json().size() != 2) place.refuse("must be a list of two shares");
    into.shares = {reading.scope.number(place[std::size_t{0}], "1"), reading.scope.number(place[1], "1")};
    if (!(into.shares->first < into.shares->second)) place.refuse("the first share must be the smaller one");
}

void read_while(const Cursor& place, const MachineReading& reading, machine::Measure& into) {
    if (is_profile(into)) place.refuse("a profile is taken at all frames");
    for (const auto& [name, bounds] : place.members("must be an object of bounds by measurement")) {
        const std::size_t other = measure_named(Cursor(Json(name), bounds.path()), reading);
        if (!bounds.json().is_array() || bounds.json().size() != 2) bounds.refuse("must be a list: [low, high]");
        const auto end = [&, &bounds = bounds](std::size_t k, double open) {
            const Cursor given = bounds[k];
            return given.json().is_null() ? open : reading.scope.number(given, unit_of_measure(reading, other));
        };
        into.only.push_back({other, end(0, -endless), end(1, endless)});
        if (!(into.only.back().low < into.only.back().high))
            bounds.refuse("the lower bound must be below the upper one");
    }
}

void read_repeats(const Cursor& place, const MachineReading& reading, machine::Measure& into) {
    using Repeats = machine::Measure::Repeats;
    constexpr std::array<std::string_view, 3> words = {"all", "last", "each"};
    const auto word = reading.scope.word(place, words);
    into.repeats = word == "each" ? Repeats::each : word == "last" ? Repeats::last : Repeats::all;
    if (into.repeats == Repeats::each && machine::find_reduction(into.reduction)->shape != Shape::scalar)
        place.refuse("'each' is of measurements that are one number");
}

}  // namespace

std::pair<double, bool> threshold_of(const Section& section, const MachineReading& reading, std::string_view unit) {
    const auto above = section.find("above"), below = section.find("below");
    if (above.has_value() == below.has_value())
        throw input_error(section.place().path(), "", "it has one of \"above\" and \"below\"");
    return {reading.scope.number(above ? *above : *below, unit), above.has_value()};
}

std::size_t measure_named(const Cursor& place, const MachineReading& reading) {
    const std::size_t number = reading.scope.place_in(place, reading.measures, "measurement with a probe");
    if (!machine::find_probe(reading.spec.measures[number].probe)->over.empty())
        place.refuse("a profile has no single value that could pass another");
    return number;
}

std::string_view unit_of_measure(const MachineReading& reading, std::size_t measure) {
    return machine::find_probe(reading.spec.measures[measure].probe)->unit;
}

void read_scale(const Cursor& place, const MachineReading& reading, machine::Scale& into) {
    if (place.json().contains("scale"))
        reading.scope.read(Section(place["scale"], machine_keys::scale), machine_keys::scale, &into);
}

void read_counting(const Cursor& place, const MachineReading& reading, machine::Measure& into) {
    if (place.json().contains("shares")) read_shares(place["shares"], reading, into);
    if (place.json().contains("while")) read_while(place["while"], reading, into);
    if (place.json().contains("relative")) into.relative = place["relative"].flag();
    if (place.json().contains("repeats")) read_repeats(place["repeats"], reading, into);
    if (place.json().contains("every")) into.every = reading.scope.whole(place["every"], {1, 1e6});
    read_scale(place, reading, into.scale);
    if (!place.json().contains("since")) return;
    const Cursor since = place["since"];
    if (machine::find_reduction(into.reduction)->shape != Shape::series) since.refuse("only a series has times");
    into.since = reading.copies[reading.scope.place_in(since, reading.phases, "phase")].front();
    for (std::size_t p = 0; p < *into.since; ++p)
        if (machine::holds(into.during, p))
            since.refuse("it must be the first phase that is measured, or an earlier one: see \"during\"");
}

}  // namespace grainsweep::campaign

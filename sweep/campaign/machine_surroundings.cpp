// "domain" and "checks" of a machine.
#include "sweep/campaign/machine_reading.hpp"

#include "solver/machine/setup.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace grainsweep::campaign {
namespace {

/// Lets measurements, conditions and removals see particles whose images lie in their regions.
void give_images(const Section& top, machine::Spec& spec) {
    std::vector<machine::Removal> removals = spec.removals;
    machine::each_region(
        spec, [&spec](machine::Region& region) { region = machine::with_images(std::move(region), spec.domain); });
    for (std::size_t k = 0; k < removals.size(); ++k)
        if (removals[k].of != machine::Removal::Of::centre)
            spec.removals[k].in = machine::with_images_for_bodies(std::move(removals[k].in), spec.domain);
    for (const machine::Measure& measure : spec.measures) {
        const auto* probe = machine::find_probe(measure.probe);
        const std::string flaw = probe->flaw != nullptr ? probe->flaw(measure.options) : "";
        if (!flaw.empty())
            top.at("measure")[measure.name][probe->name].refuse(flaw + "; its region is longer than the period");
    }
}

}  // namespace

void read_surroundings(const Section& top, MachineReading& reading) {
    auto& spec = reading.spec;
    const auto& scope = reading.scope;
    const auto place = top.find("domain");
    std::array<std::optional<double>, 3> low, high;
    if (place) {
        const Section section(*place, machine_keys::domain);
        if (const auto sides = section.find("sides")) {
            if (!sides->json().is_array() || sides->json().size() != 3)
                sides->refuse("must be a list of three words: of x, y, z");
            for (std::size_t k = 0; k < 3; ++k)
                spec.domain.periodic[k] =
                    scope.word((*sides)[k], std::array<std::string_view, 2>{"open", "periodic"}) == "periodic";
        }
        if (const auto periods = section.find("periodic")) {
            if (const auto sides = section.find("sides")) sides->refuse("beside \"periodic\" it says too much");
            const auto given = scope.vector(*periods, "1");
            for (std::size_t k = 0; k < 3; ++k) spec.domain.periodic[k] = given[k] != 0;
        }
        const auto read_corner = [&](std::string_view key, std::array<std::optional<double>, 3>& into) {
            const auto corner = section.find(key);
            if (!corner) return;
            if (!corner->json().is_array() || corner->json().size() != 3)
                corner->refuse("must be a list of three numbers: x, y, z");
            for (std::size_t k = 0; k < 3; ++k)
                if (!(*corner)[k].json().is_null()) into[k] = scope.number((*corner)[k], "m");
        };
        read_corner("low", low), read_corner("high", high);
    }
    geometry::Domain around;
    const auto periodic = spec.domain.periodic;
    for (std::size_t k = 0; k < 3; ++k)
        if (periodic[k] && !(low[k] && high[k]))
            place->refuse(
                fmt::format("a domain that is periodic along {} needs its \"low\" and \"high\" there", "xyz"[k]));
    for (std::size_t k = 0; k < 3; ++k)
        if (!(low[k] && high[k])) {
            try {
                around = machine::domain_around(
                    spec, {low[0].has_value() && high[0].has_value(), low[1].has_value() && high[1].has_value(),
                           low[2].has_value() && high[2].has_value()});
            } catch (const std::invalid_argument& why) {
                throw input_error(place ? place->path() : top.place().path(), "", why.what());
            }
            break;
        }
    for (std::size_t k = 0; k < 3; ++k) {
        spec.domain.low[k] = low[k].value_or(around.low[k]);
        spec.domain.high[k] = high[k].value_or(around.high[k]);
        if (!(spec.domain.low[k] < spec.domain.high[k]))
            place->refuse(fmt::format("\"low\" must lie below \"high\" along {}", "xyz"[k]));
    }
    give_images(top, spec);
}

void read_checks(const Section& top, MachineReading& reading) {
    const auto all = top.find("checks");
    if (!all) return;
    for (const auto& place : all->elements()) {
        const Section section(place, machine_keys::check);
        const auto refuse = section.find("refuse"), warn = section.find("warn"), that = section.find("that");
        if (refuse.has_value() == warn.has_value() || warn.has_value() != that.has_value())
            place.refuse("a check has \"refuse\", or \"warn\" and \"that\"");
        const bool holds = reading.scope.present(section);
        const std::string sentence = reading.scope.sentence(refuse ? *refuse : *that);
        if (holds && refuse) throw InputError(sentence + (sentence.ends_with('.') ? "" : "."));
        if (holds) reading.spec.warnings.push_back({warn->text(), sentence});
    }
}

}  // namespace grainsweep::campaign

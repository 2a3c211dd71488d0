// "motion" of a wall.
#include "sweep/campaign/machine_reading.hpp"

#include "solver/machine/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace grainsweep::campaign {
namespace {

using geometry::operator+;
using geometry::operator*;
using machine::Vec3;

/// Returns the distance of the farthest corner of a shape's bounding box, m; infinite if the shape is unbounded.
double arm_of(const geometry::Shape& shape, const Vec3& centre) {
    Vec3 farthest{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto extent = std::visit([k](const auto& s) { return s.extent(k); }, shape);
        farthest[k] = std::max(std::abs(extent.low - centre[k]), std::abs(extent.high - centre[k]));
    }
    return geometry::norm(farthest);
}

/// Completes a flight by what follows from the shape.
void complete(geometry::Flight& flight, const Section& of, const MachineReading& reading,
              const geometry::Shape& shape) {
    const auto& scope = reading.scope;
    const Cursor& place = of.place();
    const auto centre = of.find("centre"), inertia = of.find("inertia");
    const auto solid = machine::solid_of(shape);
    if (!solid && !(centre && inertia))
        place.refuse(!std::holds_alternative<geometry::Mesh>(shape)
                         ? "of this shape it needs \"centre\" and \"inertia\""
                         : "the mesh is not closed: it needs \"centre\" and \"inertia\"");
    if (solid) {
        flight.centre = solid->centre;
        flight.axes = solid->axes;
        flight.inertia = flight.mass / solid->volume * solid->inertia;
    }
    if (centre) flight.centre = scope.vector(*centre, "m");
    if (inertia) {
        flight.axes = geometry::Flight{}.axes;
        flight.inertia = scope.vector(*inertia, "kg m2");
        const Vec3& i = flight.inertia;
        for (std::size_t k = 0; k < 3; ++k)
            if (!(i[k] > 0 && i[k] <= i[(k + 1) % 3] + i[(k + 2) % 3] + 1e-9 * i[k]))
                inertia->refuse("moments of inertia are above 0, and none is more than the sum of the others");
    }
    const Vec3 held = scope.vector(of, "held", "1");
    for (std::size_t k = 0; k < 3; ++k) flight.freedom[k] = held[k] != 0 ? 0 : 1;
    flight.force = flight.force + flight.mass * reading.spec.gravity;
    const double arm = arm_of(shape, flight.centre);
    if (!std::isfinite(arm)) place.refuse("a wall without end cannot move freely");
    flight.fastest_turn = flight.fastest / arm;
}

}  // namespace

namespace {

/// Returns the runs of successive phases among phases in ascending order.
std::vector<machine::WhileIn> runs_of(const machine::Phases& phases) {
    std::vector<machine::WhileIn> runs;
    for (const std::size_t phase : phases)
        if (!runs.empty() && runs.back().last + 1 == phase)
            runs.back().last = phase;
        else
            runs.push_back({phase, phase});
    return runs;
}

}  // namespace

void read_motion(const Cursor& place, const MachineReading& reading, machine::MachineWall& wall) {
    const auto& scope = reading.scope;
    const Section section(place, machine_keys::motion());
    const bool acts = scope.present(section);
    machine::WallMotion motion;
    const auto types = geometry::motion_types();
    const Type* type = named_in(place.json(), types);
    if (type == nullptr) {
        std::string names;
        for (const Type& t : types)
            names += fmt::format("{}\"{}\"", &t == &types.back() ? " and " : names.empty() ? "" : ", ", t.name);
        place.refuse("a motion is one of " + names);
    }
    const Section of(section.at(type->name), type->fields);
    scope.read(of, type->fields, type->make(&motion.motion));
    if (auto* press = std::get_if<geometry::Press>(&motion.motion))
        press->course = read_load(of, "force", "N", scope, press->force);
    if (auto* drive = std::get_if<geometry::Drive>(&motion.motion))
        drive->course = read_load(of, "torque", "N m", scope, drive->moment);
    if (auto* flight = std::get_if<geometry::Flight>(&motion.motion)) complete(*flight, of, reading, wall.shape);

    const auto during = read_during(section, reading);
    const auto from = section.find("from"), to = section.find("to");
    if (!during.empty() && (from || to)) section.at("during").refuse("beside \"from\" or \"to\" it says too much");
    const auto phase_in = [&](const Cursor& end) -> std::optional<std::size_t> {
        if (!end.json().is_string()) return std::nullopt;
        const auto word = end.json().get<std::string>();
        const auto found = std::ranges::find(reading.phases, word);
        if (found != reading.phases.end()) {
            const auto& copies = reading.copies[static_cast<std::size_t>(found - reading.phases.begin())];
            return to && end.path() == to->path() ? copies.back() : copies.front();
        }
        const auto of_name = [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
        };
        if (!is_quantity(word) && std::ranges::all_of(word, of_name) && !scope.knows(word)) {
            const WordList phases(reading.phases);
            end.refuse(fmt::format("must be a time or a phase: {}", in_words(phases)), nearest_word(word, phases));
        }
        return std::nullopt;
    };
    const auto first = from ? phase_in(*from) : std::nullopt, last = to ? phase_in(*to) : std::nullopt;
    std::vector<machine::WhileIn> runs = runs_of(during);
    if (!during.empty()) {
        motion.phases = runs.front();
    } else if (first || last) {
        if ((from && !first) || (to && !last))
            place.refuse("\"from\" and \"to\" of a motion are both phases or both times");
        motion.phases = {first.value_or(0), last.value_or(reading.phase_paths.size())};
        if (motion.phases->last < motion.phases->first)
            place.refuse("the phase of \"to\" comes before that of \"from\"");
    } else {
        std::visit(
            [&](auto& m) {
                if (from) m.start = scope.number(*from, "s", no_negative_number);
                if (to) m.end = scope.number(*to, "s", no_negative_number);
            },
            motion.motion);
    }
    if (const auto flaw = geometry::flaw(motion.motion); !flaw.empty()) place.refuse(flaw);
    if (!acts || geometry::is_still(motion.motion)) return;
    const std::size_t count = std::max<std::size_t>(1, runs.size());
    for (std::size_t k = 0; k < count; ++k) {
        if (!runs.empty()) motion.phases = runs[k];
        std::visit(
            [&](auto& m) {
                if constexpr (requires { m.number; }) m.number = static_cast<double>(wall.motions.size());
            },
            motion.motion);
        wall.motions.push_back(motion);
    }
}

}  // namespace grainsweep::campaign

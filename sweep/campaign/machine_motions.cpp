// "motion" of a wall.
#include "sweep/campaign/machine_reading.hpp"

#include "solver/machine/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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

geometry::Flight read_flight(const Cursor& place, const MachineReading& reading, const geometry::Shape& shape,
                             double number) {
    const auto& scope = reading.scope;
    const Section of(place, machine_keys::free());
    geometry::Flight flight{.mass = scope.number(of.at("mass"), "kg", positive_number), .number = number};
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
    flight.force = scope.vector(of, "force", "N") + flight.mass * reading.spec.gravity;
    flight.moment = scope.vector(of, "torque", "N m");
    flight.fastest = scope.number(of.at("speed_at_most"), "m/s", positive_number);
    const double arm = arm_of(shape, flight.centre);
    if (!std::isfinite(arm)) place.refuse("a wall without end cannot move freely");
    flight.fastest_turn = flight.fastest / arm;
    return flight;
}

}  // namespace

machine::WallMotion read_motion(const Cursor& place, const MachineReading& reading, const machine::MachineWall& wall,
                                bool& present) {
    const auto& scope = reading.scope;
    const Section section(place, machine_keys::motion());
    present = scope.present(section);
    machine::WallMotion motion;
    const auto number = static_cast<double>(wall.motions.size());
    int kinds = 0;
    if (const auto rotate = section.find("rotate")) {
        const Section of(*rotate, machine_keys::rotate());
        motion.motion = geometry::Rotation{.point = scope.vector(of, "through", "m"),
                                           .axis = scope.direction(of.at("axis")),
                                           .speed = scope.number(of.at("speed"), "rad/s")};
        ++kinds;
    }
    if (const auto shift = section.find("shift")) {
        const Section of(*shift, machine_keys::shift());
        motion.motion = geometry::Translation{.velocity = scope.vector(of.at("velocity"), "m/s")};
        ++kinds;
    }
    if (const auto vibrate = section.find("vibrate")) {
        const Section of(*vibrate, machine_keys::vibrate());
        motion.motion = geometry::Vibration{.amplitude = scope.vector(of.at("amplitude"), "m"),
                                            .frequency = scope.number(of.at("frequency"), "Hz", no_negative_number),
                                            .phase = scope.number(of, "phase", "rad", 0)};
        ++kinds;
    }
    if (const auto press = section.find("press")) {
        const Section of(*press, machine_keys::press());
        motion.motion = geometry::Press{.along = scope.direction(of.at("along")),
                                        .force = scope.number(of.at("force"), "N"),
                                        .mass = scope.number(of.at("mass"), "kg", positive_number),
                                        .fastest = scope.number(of.at("speed_at_most"), "m/s", positive_number),
                                        .number = number};
        ++kinds;
    }
    if (const auto drive = section.find("drive")) {
        const Section of(*drive, machine_keys::drive());
        motion.motion = geometry::Drive{.point = scope.vector(of, "through", "m"),
                                        .axis = scope.direction(of.at("axis")),
                                        .moment = scope.number(of.at("torque"), "N m"),
                                        .inertia = scope.number(of.at("inertia"), "kg m2", positive_number),
                                        .fastest = scope.number(of.at("speed_at_most"), "rad/s", positive_number),
                                        .number = number};
        ++kinds;
    }
    if (const auto free = section.find("free")) {
        motion.motion = read_flight(*free, reading, wall.shape, number);
        ++kinds;
    }
    if (kinds != 1)
        place.refuse("a motion is one of \"rotate\", \"shift\", \"vibrate\", \"press\", \"drive\" and \"free\"");

    const auto during = read_during(section, reading);
    const auto from = section.find("from"), to = section.find("to");
    if (!during.empty() && (from || to)) section.at("during").refuse("beside \"from\" or \"to\" it says too much");
    const auto phase_in = [&](const Cursor& end) -> std::optional<std::size_t> {
        if (!end.json().is_string()) return std::nullopt;
        const auto word = end.json().get<std::string>();
        const auto found = std::ranges::find(reading.phases, word);
        if (found != reading.phases.end()) return static_cast<std::size_t>(found - reading.phases.begin());
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
    if (!during.empty()) {
        motion.phases = {*std::ranges::min_element(during), *std::ranges::max_element(during)};
        if (motion.phases->last - motion.phases->first + 1 != during.size())
            section.at("during").refuse("phases of a motion follow one another; give it twice");
    } else if (first || last) {
        if ((from && !first) || (to && !last))
            place.refuse("\"from\" and \"to\" of a motion are both phases or both times");
        motion.phases = {first.value_or(0), last.value_or(reading.phases.size())};
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
    return motion;
}

}  // namespace grainsweep::campaign

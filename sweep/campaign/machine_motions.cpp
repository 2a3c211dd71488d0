// "motion" of a wall.
#include "sweep/campaign/machine_reading.hpp"
#include "sweep/campaign/plain_name.hpp"

#include "solver/machine/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace grainsweep::campaign {
namespace {

using geometry::cross;
using geometry::norm;
using geometry::operator+;
using geometry::operator-;
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

void read_motion(const Cursor& place, MachineReading& reading, machine::MachineWall& wall) {
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
        if (!is_quantity(word) && std::ranges::all_of(word, is_name_sign) && !scope.knows(word)) {
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
    if (!motion.phases)
        reading.timed.emplace_back(place.path(), std::visit([](const auto& m) { return m.start; }, motion.motion));
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

namespace {

/// Returns whether a motion moves the wall along a unit vector.
bool moves_along(const geometry::Motion& motion, const Vec3& way) {
    const auto has_part = [&](const Vec3& a) { return std::abs(geometry::dot(a, way)) > 1e-6 * geometry::norm(a); };
    if (const auto* m = std::get_if<geometry::Translation>(&motion)) return has_part(m->velocity);
    if (const auto* m = std::get_if<geometry::Vibration>(&motion)) return has_part(m->amplitude);
    if (const auto* m = std::get_if<geometry::Press>(&motion)) return has_part(m->along);
    if (const auto* m = std::get_if<geometry::Flight>(&motion))
        for (std::size_t k = 0; k < 3; ++k)
            if (std::abs(m->freedom[k] * way[k]) > 1e-6) return true;
    return false;
}

bool turns_about(const geometry::Motion& motion, const geometry::Drive& drive) {
    const auto same_line = [&](const auto& m) {
        return norm(cross(m.axis, drive.axis)) <= 1e-9 && norm(cross(m.point - drive.point, drive.axis)) <= 1e-9;
    };
    if (const auto* m = std::get_if<geometry::Rotation>(&motion)) return same_line(*m);
    const auto* m = std::get_if<geometry::Drive>(&motion);
    return m != nullptr && same_line(*m);
}

/// Returns why two motions cannot act at the same time; empty: they can.
std::string contradiction(const geometry::Motion& a, const geometry::Motion& b) {
    if (const auto* press = std::get_if<geometry::Press>(&a); press != nullptr && moves_along(b, press->along))
        return std::holds_alternative<geometry::Press>(b)
                   ? "a wall is pressed along one line by one press at a time; add the forces, or press across"
                   : "along the line of a press only its force and the powder move a wall; the other motion must lie "
                     "across it, or act at another time";
    if (const auto* drive = std::get_if<geometry::Drive>(&a); drive != nullptr && turns_about(b, *drive))
        return std::holds_alternative<geometry::Drive>(b)
                   ? "a wall is driven about one axis by one drive; add the torques"
                   : "about the axis of a drive only its torque and the powder turn a wall; a rotation about it must "
                     "act at another time";
    return {};
}

/// Returns whether the shaking of the machine accelerates the mass of a wall that forces move: the engines leave it
/// out.
bool is_shaken(const geometry::Motion& motion, const dem::Shaking& shaking) {
    const Vec3 amplitude = (shaking.frequency > 0 ? 1.0 : 0.0) * shaking.amplitude;
    if (const auto* press = std::get_if<geometry::Press>(&motion))
        return std::abs(geometry::dot(press->along, amplitude)) > 1e-9 * norm(amplitude);
    const auto* body = std::get_if<geometry::Flight>(&motion);
    for (std::size_t k = 0; body != nullptr && k < 3; ++k)
        if (body->freedom[k] * amplitude[k] != 0) return true;
    return false;
}

/// Returns whether two motions act at the same time, however early conditions end the phases.
bool act_together(const machine::WallMotion& a, const machine::WallMotion& b,
                  const std::vector<machine::Phase>& phases) {
    if (a.phases && b.phases) return a.phases->first <= b.phases->last && b.phases->first <= a.phases->last;
    const auto surely = [&](const machine::WallMotion& one) {
        double begin = 0, end = one.phases && one.phases->last >= phases.size() ? endless : 0;
        if (!one.phases) return std::visit([](const auto& m) { return std::pair{m.start, m.end}; }, one.motion);
        for (std::size_t p = 0; p < phases.size(); ++p) {
            if (p < one.phases->first) begin += phases[p].duration;
            if (p <= one.phases->last && phases[p].until.empty()) end += phases[p].duration;
        }
        return std::pair{begin, end};
    };
    const auto first = surely(a), second = surely(b);
    return std::max(first.first, second.first) < std::min(first.second, second.second);
}

}  // namespace

void check_motions(const Section& top, MachineReading& reading) {
    auto& spec = reading.spec;
    double end = 0;
    for (const auto& phase : spec.phases) end += phase.duration;
    for (const auto& [path, start] : reading.timed)
        if (!(start < end))
            spec.warnings.push_back(
                {"a motion that never starts",
                 fmt::format("{}: it starts after {:.4g} s, and all phases end after {:.4g} s", path, start, end)});
    for (std::size_t name = 0; name < reading.walls.size(); ++name)
        for (const std::size_t number : reading.repeats[name]) {
            const auto& motions = spec.walls[number].motions;
            std::string why;
            for (const auto& a : motions)
                for (std::size_t k = 0; geometry::is_free(a.motion) && k < motions.size(); ++k)
                    if (const auto& b = motions[k]; &a != &b && why.empty() && act_together(a, b, spec.phases))
                        why = contradiction(a.motion, b.motion);
            std::vector<geometry::Motion> all;
            for (const auto& one : motions) all.push_back(one.motion);
            if (why.empty() && !spec.walls[number].again) why = geometry::flaw(all);
            if (why.empty() && std::ranges::any_of(all, [&](const auto& m) { return is_shaken(m, spec.shaking); }))
                why =
                    "a pressed or free wall does not feel \"shaking\" along its way; leave \"shaking\" out, and let "
                    "the other walls vibrate";
            if (!why.empty()) throw input_error(top.at("walls")[reading.walls[name]]["motion"].path(), "", why);
        }
}

}  // namespace grainsweep::campaign

// Walls where none may be: one that appears at the beginning of a phase deep in a particle, and a free one that has
// passed through another, because walls do not touch each other.
#include "solver/machine/contact_place.hpp"
#include "solver/machine/run.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <algorithm>
#include <variant>

namespace grainsweep::machine {

using geometry::norm;
using geometry::Pose;
using geometry::operator-;

namespace {

/// Returns the motion of a free body; nullptr: the wall is none.
const geometry::Flight* flight_of(const dem::Wall& wall) {
    for (const auto& motion : wall.motions)
        if (const auto* flight = std::get_if<geometry::Flight>(&motion)) return flight;
    return nullptr;
}

/// Whether the centre of mass of a body of this size has got through a wall, from one place in the wall's frame to
/// another. A way longer than the body is no straight line, which matters for thin walls only.
bool has_passed(const geometry::Shape& wall, const Vec3& from, const Vec3& to, double size) {
    return std::visit(
        [&](const auto& shape) {
            if constexpr (geometry::Thin<decltype(shape)>)
                return norm(to - from) < size && static_cast<bool>(shape.crossed(from, to));
            else if constexpr (geometry::SingleContact<decltype(shape)>)
                return shape.closest(from).distance >= 0 && shape.closest(to).distance < 0;
            else
                return false;
        },
        wall);
}

}  // namespace

void Run::judge_free_walls() {
    if (!has_free_walls_) return;
    std::vector<Pose> before, now;
    for (const WallPlace& place : places_) before.push_back({true, place.rows, place.shift});
    places_.clear();
    for (std::size_t w = 0; w < spec_.walls.size(); ++w) {
        now.push_back(geometry::pose_at(engine_->wall(w).motions, engine_->wall_time()));
        places_.push_back({now.back().rows, now.back().shift});
    }
    if (before.empty()) return;  // the first frame
    for (std::size_t f = 0; f < spec_.walls.size(); ++f) {
        const auto* body = std::get_if<geometry::Mesh>(&engine_->wall(f).shape);
        const auto* flight = flight_of(engine_->wall(f));
        if (body == nullptr || flight == nullptr || !spec_.walls[f].present(phase_)) continue;
        const Vec3 from = before[f].from_body(flight->centre), to = now[f].from_body(flight->centre);
        for (std::size_t w = 0; w < spec_.walls.size(); ++w) {
            if (w == f || !spec_.walls[w].present(phase_)) continue;
            if (!has_passed(engine_->wall(w).shape, before[w].to_body(from), now[w].to_body(to),
                            norm(body->high() - body->low())))
                continue;
            fault_ = "free wall '" + spec_.walls[f].name + "' has passed through wall '" + spec_.walls[w].name +
                     kit::sentence(
                         "' before %.3g s, at (%.3g, %.3g, %.3g) m: walls do not touch each other, so "
                         "let it rest on powder, or guide it by held",
                         time(), to[0], to[1], to[2]);
            return;
        }
    }
}

/// Ends the run if a wall that this phase brings lies in a particle: the overlap would throw the particle out.
void Run::judge_walls_that_appear() {
    const auto appears = [this](const MachineWall& wall) {
        return phase_ > 0 && wall.present(phase_) && (!wall.present(phase_ - 1) || wall.starts_anew(phase_));
    };
    if (std::ranges::none_of(spec_.walls, appears)) return;
    const Frame frame = look(Contacts::present);
    for (const dem::ContactForce& contact : contacts_) {
        if (contact.second >= 0) continue;
        const MachineWall& wall = spec_.walls[static_cast<std::size_t>(-1 - contact.second)];
        const std::size_t i = place_of(frame, contact.first);
        const double share = contact.overlap / (2 * spheres_.radius[i]);
        if (share <= deepest_at_start || !appears(wall)) continue;
        const Vec3& x = spheres_.position[i];
        fault_ = "wall '" + wall.name + "' appears" +
                 kit::sentence(" %.3g diameters deep (limit %.3g) in a particle", share, deepest_at_start) +
                 kit::sentence(" at (%.4g, %.4g, %.4g) m, after %.6g s", x[0], x[1], x[2], time());
        return;
    }
}

}  // namespace grainsweep::machine

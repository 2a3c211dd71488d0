// Places of walls: the distance that a point of a wall has moved along a direction, and the angle by which the wall has
// turned.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;
using geometry::operator-;

/// Returns the first of the walls; nullptr: this case has none of them.
const dem::Wall* wall_of(const std::vector<std::size_t>& numbers, const Frame& frame) {
    return numbers.empty() ? nullptr : &frame.engine.wall(numbers.front());
}

class PositionOfWall final : public machine::Probe {
public:
    explicit PositionOfWall(const Options& options)
        : walls_(options.numbers("wall")), along_(options.vector("along")), of_(options.vector("of", {})) {}
    double look(const Frame& frame) override {
        const dem::Wall* wall = wall_of(walls_, frame);
        if (wall == nullptr) return undefined;
        const auto pose = geometry::pose_at(wall->motions, frame.engine.wall_time());
        return dot(pose.from_body(of_) - of_, along_);
    }

private:
    std::vector<std::size_t> walls_;
    Vec3 along_, of_;
};

class AngleOfWall final : public machine::Probe {
public:
    explicit AngleOfWall(const Options& options) : walls_(options.numbers("wall")), axis_(options.vector("axis")) {}
    double look(const Frame& frame) override {
        const dem::Wall* wall = wall_of(walls_, frame);
        if (wall == nullptr) return undefined;
        const double time = frame.engine.wall_time();
        double angle = 0;
        for (const geometry::Motion& motion : wall->motions) {
            if (const auto* drive = std::get_if<geometry::Drive>(&motion))
                angle += drive->way * dot(drive->axis, axis_);
            if (const auto* flight = std::get_if<geometry::Flight>(&motion)) {
                const auto& [w, x, y, z] = flight->turned;
                angle += 2 * std::atan2((w < 0 ? -1 : 1) * dot(Vec3{x, y, z}, axis_), std::abs(w));
            }
            if (const auto* turn = std::get_if<geometry::Rotation>(&motion))
                angle += turn->speed * std::max(0.0, std::min(time, turn->end) - turn->start) * dot(turn->axis, axis_);
        }
        return angle * 180 / std::numbers::pi;
    }

private:
    std::vector<std::size_t> walls_;
    Vec3 axis_;
};

constexpr Field placed_wall = option("wall", Field::Kind::walls, "", "the wall; of a list the first", true);
constexpr std::array position_of_wall_options = {
    placed_wall, option("along", Field::Kind::direction, "", "the direction", true),
    option("of", Field::Kind::vector, "m", "the point of the wall, where it is at the start; default: the origin")};
constexpr std::array angle_of_wall_options = {placed_wall,
                                              option("axis", Field::Kind::direction, "", "the axis, right hand", true)};

}  // namespace

ProbeInfo wall_angle() {
    return probe_row<AngleOfWall>("wall_angle", "deg",
                                  "angle by which a wall has turned since the start; of a free body within half a turn",
                                  angle_of_wall_options);
}
ProbeInfo wall_position() {
    return probe_row<PositionOfWall>(
        "wall_position", "m", "way of a point of a wall since the start, along a direction", position_of_wall_options);
}

}  // namespace grainsweep::machine::probes

// "follow" of a motion: a wall follows a table of times, or an expression of the time t. It becomes motions of constant
// velocity from time to time, so that the wall is at the stated place at every stated time.
#include "sweep/campaign/machine_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace grainsweep::campaign {
namespace {

using geometry::operator*;
using geometry::operator-;
using machine::Vec3;

constexpr std::size_t most_pieces = 2000;  // a step looks at each of them
constexpr std::size_t most_turns = 200;    // of angles: each turns the next

/// Places or angles at times; angles are along x.
struct Course {
    std::vector<double> times;  ///< s
    std::vector<Vec3> places;   ///< m, or rad
    bool turns = false;
};

Cursor needed_key(const Section& follow, std::string_view key) {
    if (const auto place = follow.find(key)) return *place;
    throw input_error(follow.place().path(), "", fmt::format("key '{}' is missing", key));
}

Course course_of_table(const Section& follow, const MachineScope& scope) {
    Course course;
    const auto times = follow.at("times").elements();
    const auto positions = follow.find("positions"), angles = follow.find("angles");
    if (positions.has_value() == angles.has_value())
        throw input_error(follow.place().path(), "", "beside \"times\" it has \"positions\" or \"angles\"");
    course.turns = angles.has_value();
    const auto places = (angles ? *angles : *positions).elements();
    if (places.size() != times.size() || times.size() < 2)
        (angles ? *angles : *positions)
            .refuse(fmt::format("must have two or more values, as many as \"times\": {}", times.size()));
    for (std::size_t k = 0; k < times.size(); ++k) {
        course.times.push_back(scope.number(times[k], "s", no_negative_number));
        if (k > 0 && !(course.times[k] > course.times[k - 1])) times[k].refuse("times must rise");
        course.places.push_back(angles ? Vec3{scope.number(places[k], "rad"), 0, 0} : scope.vector(places[k], "m"));
    }
    return course;
}

Course course_of_expression(const Section& follow, const MachineScope& outer) {
    const auto position = follow.find("position"), angle = follow.find("angle");
    if (position.has_value() == angle.has_value())
        throw input_error(follow.place().path(), "",
                          "it follows \"times\", or an expression of t: \"position\" or \"angle\"");
    if (outer.knows("t"))
        (angle ? *angle : *position)
            .refuse("'t' is the time here; give the parameter or \"let\" of this name another one");
    const double every = outer.number(needed_key(follow, "every"), "s", positive_number);
    const double until = outer.number(needed_key(follow, "until"), "s", positive_number);
    const double pieces = std::ceil(until / every * (1 - 1e-12));
    const std::size_t most = angle ? most_turns : most_pieces;
    if (!(pieces <= static_cast<double>(most)))
        follow.at("every").refuse(fmt::format("makes {:.4g} pieces, and at most {} are possible", pieces, most));
    Course course;
    course.turns = angle.has_value();
    MachineScope scope = outer;
    for (std::size_t k = 0; k <= static_cast<std::size_t>(pieces); ++k) {
        const double t = std::min(static_cast<double>(k) * every, until);
        scope.set("t", t);
        course.times.push_back(t);
        course.places.push_back(angle ? Vec3{scope.number(*angle, "rad"), 0, 0} : scope.vector(*position, "m"));
    }
    return course;
}

}  // namespace

std::vector<machine::WallMotion> read_follow(const Section& motion, const MachineReading& reading) {
    const auto& scope = reading.scope;
    if (!scope.present(motion)) return {};
    const Section follow(motion.at("follow"), machine_keys::follow());
    for (const char* key : {"to", "during"})
        if (const auto place = motion.find(key))
            place->refuse("has no effect beside \"follow\", which has its own times");
    for (const auto& type : geometry::motion_types())
        if (const auto place = motion.find(type.name)) place->refuse("beside \"follow\": a motion is one of the two");
    const auto from = motion.find("from");
    const double start = from ? scope.number(*from, "s", no_negative_number) : 0;
    const Course course = follow.find("times") ? course_of_table(follow, scope) : course_of_expression(follow, scope);
    const std::size_t most = course.turns ? most_turns : most_pieces;
    if (course.times.size() > most + 1) follow.place().refuse(fmt::format("at most {} times are possible", most + 1));
    if (!course.turns)
        for (const char* key : {"axis", "through"})
            if (const auto place = follow.find(key)) place->refuse("belongs to angles");
    const Vec3 axis = course.turns ? scope.direction(needed_key(follow, "axis")) : Vec3{};
    const Vec3 through = scope.vector(follow, "through", "m");
    std::vector<machine::WallMotion> motions;
    for (std::size_t k = 1; k < course.times.size(); ++k) {
        const double begin = start + course.times[k - 1], end = start + course.times[k];
        const Vec3 rate = 1 / (course.times[k] - course.times[k - 1]) * (course.places[k] - course.places[k - 1]);
        if (rate == Vec3{}) continue;
        machine::WallMotion piece;
        if (course.turns)
            piece.motion = geometry::Rotation{through, axis, rate[0], begin, end};
        else
            piece.motion = geometry::Translation{rate, begin, end};
        if (const auto flaw = geometry::flaw(piece.motion); !flaw.empty()) follow.place().refuse(flaw);
        motions.push_back(std::move(piece));
    }
    return motions;
}

}  // namespace grainsweep::campaign

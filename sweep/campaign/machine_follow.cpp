// Courses of a wall over time, as a table or an expression of the time t. "follow" of a motion becomes motions of
// constant velocity from time to time, so that the wall is at the stated place at every stated time. The load of a
// press or a drive changes along straight lines between its values.
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/formula.hpp"
#include "sweep/campaign/machine_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace grainsweep::campaign {
namespace {

using geometry::operator*;
using geometry::norm;
using geometry::operator-;
using machine::Vec3;

constexpr std::size_t most_pieces = 2000;  // a step looks at each of them
constexpr std::size_t most_turns = 200;    // of angles: each turns the next
constexpr std::size_t most_loads = 100000;

/// Places or angles at times; angles are along x.
struct Course {
    std::vector<double> times;  ///< s
    std::vector<Vec3> places;   ///< m, or rad
    bool turns = false;
};

Cursor needed_key(const Section& section, std::string_view key) {
    if (const auto place = section.find(key)) return *place;
    throw input_error(section.place().path(), "", fmt::format("key '{}' is missing", key));
}

/// Returns the times of a table that has a value for each of them.
std::vector<double> times_of_table(const Section& section, const Cursor& values, const MachineScope& scope) {
    const auto places = needed_key(section, "times").elements();
    if (values.elements().size() != places.size() || places.size() < 2)
        values.refuse(fmt::format("must have two or more values, as many as \"times\": {}", places.size()));
    std::vector<double> times;
    for (const Cursor& place : places) {
        const double time = scope.number(place, "s", no_negative_number);
        if (!times.empty() && !(time > times.back())) place.refuse("times must rise");
        times.push_back(time);
    }
    return times;
}

/// Returns the times, "every" apart and up to "until", at which an expression of t is evaluated.
std::vector<double> times_of_expression(const Section& section, const Cursor& expression, const MachineScope& scope,
                                        std::size_t most) {
    if (scope.knows("t"))
        expression.refuse("'t' is the time here; give the parameter or \"let\" of this name another one");
    const double every = scope.number(needed_key(section, "every"), "s", positive_number);
    const double until = scope.number(needed_key(section, "until"), "s", positive_number);
    const double pieces = std::ceil(until / every * (1 - 1e-12));
    if (!(pieces <= static_cast<double>(most)))
        section.at("every").refuse(fmt::format("makes {:.4g} pieces, and at most {} are possible", pieces, most));
    std::vector<double> times;
    for (std::size_t k = 0; k <= static_cast<std::size_t>(pieces); ++k)
        times.push_back(std::min(static_cast<double>(k) * every, until));
    return times;
}

Course course_of_table(const Section& follow, const MachineScope& scope) {
    const auto positions = follow.find("positions"), angles = follow.find("angles");
    if (positions.has_value() == angles.has_value())
        throw input_error(follow.place().path(), "", "beside \"times\" it has \"positions\" or \"angles\"");
    Course course;
    course.turns = angles.has_value();
    const Cursor values = angles ? *angles : *positions;
    course.times = times_of_table(follow, values, scope);
    for (const Cursor& place : values.elements())
        course.places.push_back(angles ? Vec3{scope.number(place, "rad"), 0, 0} : scope.vector(place, "m"));
    return course;
}

Course course_of_expression(const Section& follow, const MachineScope& outer) {
    const auto position = follow.find("position"), angle = follow.find("angle");
    if (position.has_value() == angle.has_value())
        throw input_error(follow.place().path(), "",
                          "it follows \"times\", or an expression of t: \"position\" or \"angle\"");
    Course course;
    course.turns = angle.has_value();
    course.times = times_of_expression(follow, angle ? *angle : *position, outer, angle ? most_turns : most_pieces);
    MachineScope scope = outer;
    for (const double t : course.times) {
        scope.set("t", t);
        course.places.push_back(angle ? Vec3{scope.number(*angle, "rad"), 0, 0} : scope.vector(*position, "m"));
    }
    return course;
}

/// Returns whether an expression is sound if t is the time.
bool is_of_time(const Cursor& load, std::string_view unit, const MachineScope& scope) {
    if (!load.json().is_string()) return false;
    const auto text = value_text(load.text(), unit);
    const auto parsed =
        Formula::of(text->given, [&](std::string_view name) { return name == "t" || scope.has_number(name); });
    const auto* formula = std::get_if<Formula>(&parsed);
    return formula != nullptr && std::ranges::count(formula->names(), "t") > 0;
}

/// A wall starts where it is drawn.
void require_start(const Course& course, const Section& follow) {
    double largest = 0;
    for (const Vec3& place : course.places) largest = std::max(largest, norm(place));
    if (norm(course.places.front()) <= 1e-9 * largest) return;
    follow.place().refuse(fmt::format(
        "its first {} is {}, and must be 0: a wall starts where it is drawn; subtract the first value from all",
        course.turns ? "angle" : "position",
        course.turns ? shortest(course.places.front()[0])
                     : fmt::format("[{}, {}, {}]", shortest(course.places.front()[0]),
                                   shortest(course.places.front()[1]), shortest(course.places.front()[2]))));
}

}  // namespace

geometry::LoadCourse read_load(const Section& motion, std::string_view name, std::string_view unit,
                               const MachineScope& outer, double& constant) {
    const auto load = motion.find(name), values = motion.find(std::string(name) + "s"), times = motion.find("times"),
               every = motion.find("every"), until = motion.find("until");
    if (load.has_value() == values.has_value())
        throw input_error(motion.place().path(), "",
                          fmt::format("it has either a \"{0}\", or \"times\" and \"{0}s\"", name));
    for (const auto& place : {every, until})
        if (place && values) place->refuse(fmt::format("it belongs to an expression of t: \"{}\"", name));
    if (times && load) times->refuse(fmt::format("it belongs to \"{}s\"", name));
    if (load && !every && !until) {
        if (!outer.knows("t") && is_of_time(*load, unit, outer))
            load->refuse("an expression of the time t needs \"every\" and \"until\" beside it");
        constant = outer.number(*load, unit);
        return nullptr;
    }
    std::vector<geometry::LoadAt> course;
    if (values) {
        const auto places = values->elements();
        for (const double t : times_of_table(motion, *values, outer))
            course.push_back({t, outer.number(places[course.size()], unit)});
    } else {
        MachineScope scope = outer;
        for (const double t : times_of_expression(motion, *load, outer, most_loads)) {
            scope.set("t", t);
            course.push_back({t, scope.number(*load, unit)});
        }
    }
    constant = course.front().value;
    return std::make_shared<const std::vector<geometry::LoadAt>>(std::move(course));
}

std::vector<machine::WallMotion> read_follow(const Section& motion, MachineReading& reading) {
    const auto& scope = reading.scope;
    if (!scope.present(motion)) return {};
    const Section follow(motion.at("follow"), machine_keys::follow);
    for (const char* key : {"to", "during"})
        if (const auto place = motion.find(key))
            place->refuse("has no effect beside \"follow\", which has its own times");
    for (const auto& type : geometry::motion_types())
        if (const auto place = motion.find(type.name)) place->refuse("beside \"follow\": a motion is one of the two");
    const auto from = motion.find("from");
    if (from && from->json().is_string() && !scope.knows(from->text()) &&
        std::ranges::find(reading.phases, from->text()) != reading.phases.end())
        from->refuse("of \"follow\" it is a time, s, not a phase");
    const double start = from ? scope.number(*from, "s", no_negative_number) : 0;
    reading.timed.emplace_back(motion.place().path(), start);
    const Course course = follow.find("times") ? course_of_table(follow, scope) : course_of_expression(follow, scope);
    const std::size_t most = course.turns ? most_turns : most_pieces;
    if (course.times.size() > most + 1) follow.place().refuse(fmt::format("at most {} times are possible", most + 1));
    if (!course.turns)
        for (const char* key : {"axis", "through"})
            if (const auto place = follow.find(key)) place->refuse("belongs to angles");
    const Vec3 axis = course.turns ? scope.direction(needed_key(follow, "axis")) : Vec3{};
    const Vec3 through = scope.vector(follow, "through", "m");
    require_start(course, follow);
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

// "shape" of a species: a clump of spheres.
#include "sweep/campaign/csv_table.hpp"
#include "sweep/campaign/machine_reading.hpp"

#include "solver/machine/grain_shapes.hpp"
#include "solver/plain_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace grainsweep::campaign {
namespace {

constexpr double largest_error = 0.5;

using geometry::Ball;
using machine::GrainShape;

Ball listed_ball(const Cursor& place, const MachineReading& reading) {
    if (!place.json().is_array() || place.json().size() != 4)
        place.refuse("a sphere of a shape is [x, y, z, diameter]");
    const auto number = [&](std::size_t k) { return reading.scope.number(place[k], "m"); };
    const double diameter = number(3);
    if (!(diameter > 0)) place[3].refuse("a diameter must be above 0");
    return {{number(0), number(1), number(2)}, diameter / 2};
}

/// Returns the rows of a CSV file: x,y,z and diameter or radius.
std::vector<Ball> balls_in_file(const Cursor& place, const MachineReading& reading) {
    const auto refuse = [&](const std::string& rule) { place.refuse(rule); };
    CsvTable table(reading.contents(place), refuse);
    const auto& header = table.header();
    std::array<std::size_t, 4> column{};
    bool by_radius = false;
    const auto find = [&](std::string_view name) {
        return static_cast<std::size_t>(std::ranges::find(header, name) - header.begin());
    };
    for (std::size_t k = 0; k < 3; ++k) column[k] = find(std::string_view("xyz").substr(k, 1));
    column[3] = header.size();
    for (const auto& [name, radius] :
         {std::pair{"diameter", false}, std::pair{"d", false}, std::pair{"radius", true}, std::pair{"r", true}})
        if (const std::size_t at = find(name); at < header.size()) column[3] = at, by_radius = radius;
    if (std::ranges::any_of(column, [&](std::size_t at) { return at == header.size(); }))
        place.refuse("a file of spheres has the header x,y,z,diameter or x,y,z,radius");
    std::vector<Ball> balls;
    while (const auto row = table.next()) {
        const auto value = [&](std::size_t k) {
            const auto number = grainsweep::number_in((*row)[column[k]]);
            if (!number) place.refuse(fmt::format("line {}: '{}' is no number", table.number(), (*row)[column[k]]));
            return *number;
        };
        balls.push_back({{value(0), value(1), value(2)}, value(3) / (by_radius ? 1 : 2)});
    }
    return balls;
}

particles::CoverRequest cover_of(const Section& section, const MachineReading& reading) {
    particles::CoverRequest request;
    if (const auto spheres = section.find("spheres"))
        request.most =
            static_cast<std::size_t>(reading.scope.whole(*spheres, {2, static_cast<double>(particles::most_balls)}));
    if (const auto error = section.find("error")) {
        request.error = reading.scope.number(*error, "1", {0, largest_error, true, false});
        if (!section.find("spheres")) request.most = particles::most_balls;
    }
    return request;
}

/// Returns the shape that one of the keys describes; empty: a sphere, of aspect ratio 1.
std::optional<GrainShape> described_shape(const Section& section, const MachineReading& reading) {
    const auto ratio = section.find("aspect_ratio"), spheres = section.find("spheres"), stl = section.find("stl");
    if ((ratio ? 1 : 0) + (stl || spheres ? 1 : 0) != 1)
        throw input_error(section.place().path(), "", "a shape has one of \"aspect_ratio\", \"spheres\" and \"stl\"");
    if (const auto error = section.find("error"); error && !stl) error->refuse("it belongs to \"stl\"");
    const Cursor place = ratio ? *ratio : stl ? *stl : *spheres;
    try {
        if (ratio) {
            const double value = reading.scope.number(*ratio, "1", {1, longest_row});
            return value > 1 ? std::optional(machine::row_shape(value)) : std::nullopt;
        }
        if (stl) return machine::mesh_shape(reading.contents(*stl), cover_of(section, reading));
        std::vector<Ball> balls;
        if (spheres->json().is_string()) {
            balls = balls_in_file(*spheres, reading);
        } else if (spheres->json().is_array()) {
            for (const auto& one : spheres->elements()) balls.push_back(listed_ball(one, reading));
        } else {
            spheres->refuse(
                "must be a list of spheres [x, y, z, diameter], or the name of a CSV file; a number of "
                "spheres belongs to \"stl\"");
        }
        return machine::ball_shape(std::move(balls));
    } catch (const std::invalid_argument& why) {
        place.refuse(why.what());
    }
}

geometry::Inertia inertia_of(const Cursor& place, const MachineReading& reading) {
    if (!place.json().is_array() || place.json().size() != 6)
        place.refuse("must be a list of six numbers: xx, xy, xz, yy, yz, zz");
    geometry::Inertia inertia{};
    for (std::size_t k = 0; k < 6; ++k) inertia[k] = reading.scope.number(place[k], "kg m2");
    return inertia;
}

}  // namespace

void read_grain_shape(const Cursor& place, const MachineReading& reading, machine::Species& species) {
    const Section section(place, machine_keys::grain_shape);
    auto shape = described_shape(section, reading);
    constexpr std::array<std::string_view, 3> of_mass = {"mass", "inertia", "centre"};
    if (!shape) return;
    // Spheres in metres have a size of their own.
    if (!(species.diameter > 0) && section.find("spheres") && !section.find("stl"))
        species.diameter = shape->clump.diameter;
    if (!(species.diameter > 0))
        throw input_error(place.path(), "",
                          section.find("stl")
                              ? fmt::format("key 'diameter' of the species is missing: that of the sphere of equal "
                                            "volume, {0:.4g} in the unit of the file; \"{0:.4g} mm\" of a file in mm",
                                            shape->clump.diameter)
                              : "key 'diameter' of the species is missing");
    machine::OwnMass own;
    if (const auto mass = section.find("mass")) own.mass = reading.scope.number(*mass, "kg", positive_number);
    if (const auto inertia = section.find("inertia")) own.inertia = inertia_of(*inertia, reading);
    if (const auto centre = section.find("centre")) own.centre = reading.scope.vector(*centre, "m");
    try {
        machine::take_mass(*shape, own, species.diameter, reading.spec.densities[species.material]);
    } catch (const std::invalid_argument& why) {
        const auto key = std::ranges::find_if(of_mass, [&](std::string_view k) { return section.find(k).has_value(); });
        section.find(*key)->refuse(why.what());
    }
    const auto words =
        std::ranges::find(machine_keys::grain_shape, std::string_view("damping_mass"), &Field::name)->words;
    species.damping_mass = reading.scope.word(section, "damping_mass", words, "contact") == "body"
                               ? dem::DampingMass::body
                               : dem::DampingMass::contact;
    species.cover = shape->overlap;
    species.shape = std::move(shape->clump);
}

void settle_rolling_of_shapes(const Section& top, MachineReading& reading) {
    double left_out = 0;
    for (const machine::Species& species : reading.spec.species) {
        if (!species.shape) continue;
        const bool of_its_own = top.at("species")[species.name].json().contains("shape");
        const std::size_t own = reading.of_particles[species.material];
        for (std::size_t other = 0; other < reading.materials.size(); ++other) {
            double& rolling = reading.contacts[own][other].rolling_friction;
            if (of_its_own && rolling > 0)
                throw input_error(
                    top.find("contacts")->path(), "",
                    fmt::format("'rolling_friction' between {} and {} must be 0: {} has a shape, which resists rolling",
                                reading.materials[own], reading.materials[other], species.name));
            left_out = std::max(left_out, rolling);
            rolling = reading.contacts[other][own].rolling_friction = 0;
        }
        if (reading.spec.glued.rolling_friction) reading.spec.glued.rolling_friction = 0;
    }
    if (left_out > 0)
        reading.spec.warnings.push_back(
            {"elongated grains without rolling friction",
             fmt::format("at an aspect ratio of {:.4g} the shape resists rolling, so the rolling friction of {:.4g} is "
                         "left out",
                         reading.aspect_ratio, left_out)});
}

}  // namespace grainsweep::campaign

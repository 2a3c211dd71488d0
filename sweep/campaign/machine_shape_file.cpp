#include "sweep/campaign/machine_shape_file.hpp"
#include "sweep/campaign/file_contents.hpp"

#include "solver/machine/grain_shapes.hpp"
#include "solver/machine/spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainsweep::campaign {

ShapeFile shape_of_stl(std::string_view contents, std::optional<std::int64_t> spheres, std::optional<double> error) {
    particles::CoverRequest request{.error = error};
    constexpr auto most = static_cast<std::int64_t>(particles::most_balls);
    if (spheres && (*spheres < 2 || *spheres > most))
        throw std::invalid_argument(fmt::format("a shape has 2 to {} spheres", most));
    if (error && !(*error > 0 && *error <= 0.5))
        throw std::invalid_argument("an error must be above 0 and at most 0.5");
    if (spheres || error) request.most = static_cast<std::size_t>(spheres.value_or(most));
    const machine::GrainShape shape = machine::mesh_shape(contents, request);
    ShapeFile file;
    file.csv = "x,y,z,diameter\n";
    for (const auto& ball : shape.balls)
        file.csv += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}\n", ball.centre[0], ball.centre[1], ball.centre[2],
                                2 * ball.radius);
    file.spheres = shape.balls.size();
    file.overlap = shape.overlap.value_or(0);
    file.volume = shape.solid.volume;
    file.diameter = shape.clump.diameter;
    file.smallest = 2 * shape.clump.smallest();
    file.cost = machine::cost_of_clump(file.spheres) / file.smallest;
    geometry::Vec3 of_spheres = geometry::solid_of(shape.balls).inertia, of_body = shape.solid.inertia;
    std::ranges::sort(of_spheres), std::ranges::sort(of_body);
    for (std::size_t k = 0; k < 3; ++k)
        file.inertia_error = std::max(file.inertia_error, std::abs(of_spheres[k] / of_body[k] - 1));
    return file;
}

std::vector<Grain> grains_of(const Machine& machine, const Inputs& inputs) {
    std::vector<Grain> grains;
    const auto files = std::get<Files>(files_named(inputs));
    for (const auto& species : machine_spec(machine, inputs, files).species) {
        if (!species.shape) continue;
        const std::size_t spheres = species.shape->balls.size();
        const double smallest = 2 * species.shape->smallest();
        grains.push_back({species.name, spheres, species.cover, smallest, machine::cost_of_clump(spheres) / smallest});
    }
    return grains;
}

}  // namespace grainsweep::campaign

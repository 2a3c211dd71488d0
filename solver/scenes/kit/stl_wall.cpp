#include "solver/scenes/kit/stl_wall.hpp"

#include "solver/geometry/stl.hpp"

#include <numbers>
#include <stdexcept>
#include <string>

namespace grainsweep::kit {

geometry::Mesh mesh_of(std::string_view parameter, std::string_view contents, double scale, double facet_angle) {
    try {
        return geometry::Mesh(geometry::read_stl(contents, scale).surface, facet_angle * std::numbers::pi / 180);
    } catch (const std::invalid_argument& reason) {
        throw std::invalid_argument(std::string(parameter) + ": " + reason.what());
    }
}

geometry::Mesh StlWall::mesh(const Inputs& inputs, const Files& files) const {
    return mesh_of(file.name, file.contents(inputs, files), scale(inputs), facet_angle(inputs));
}

void require_stl(std::string_view contents) {
    (void)geometry::read_stl(contents);
}

}  // namespace grainsweep::kit

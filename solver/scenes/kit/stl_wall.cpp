#include "solver/scenes/kit/stl_wall.hpp"

#include "solver/geometry/stl.hpp"

#include <numbers>
#include <stdexcept>
#include <string>

namespace grainsweep::kit {

geometry::Mesh StlWall::mesh(const Inputs& inputs, const Files& files) const {
    const std::string& contents = file.contents(inputs, files);
    try {
        return geometry::Mesh(geometry::read_stl(contents, scale(inputs)).surface,
                              facet_angle(inputs) * std::numbers::pi / 180);
    } catch (const std::invalid_argument& reason) {
        throw std::invalid_argument(std::string(file.name) + ": " + reason.what());
    }
}

void require_stl(std::string_view contents) {
    (void)geometry::read_stl(contents);
}

}  // namespace grainsweep::kit

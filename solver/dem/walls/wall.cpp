#include "solver/dem/walls/wall.hpp"

namespace grainsweep::dem {

Blade::operator Wall() const {
    Wall wall(Bar{.front = front, .thickness = thickness, .bottom = bottom, .top = top, .edge_radius = edge_radius});
    wall.motions = {Translation{.velocity = {speed, 0, 0}},
                    Vibration{.amplitude = {0, 0, amplitude}, .frequency = frequency}};
    return wall;
}

}  // namespace grainsweep::dem

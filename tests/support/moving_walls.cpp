#include "tests/support/moving_walls.hpp"

#include "tests/support/surfaces.hpp"

namespace grainsweep::tests {

using dem::Vec3;

dem::Setup one_sphere(const Vec3& x, const Vec3& v, std::vector<dem::Wall> walls) {
    dem::Setup s;
    s.domain = {{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}, {}};
    s.material = {.youngs_modulus = 21e6, .density = 2500, .restitution = 0.5, .friction = 0.3};
    s.gravity = {};
    s.time_step = 1e-6;
    s.spheres = {{x, v, {}, sphere_at_walls, true}};
    s.walls = std::move(walls);
    return s;
}

std::vector<Moving> moving_walls() {
    const dem::Plane floor;
    const dem::Cylinder drum{.point = {}, .axis = {0, 1, 0}, .radius = 0.01, .side = dem::Side::inside};
    const dem::Cylinder roller{
        .point = {}, .axis = {0, 1, 0}, .radius = 0.01, .side = dem::Side::outside, .length = 0.02};
    const dem::Cone funnel{.base = {0, 0, -0.01}, .base_radius = 0.002, .end_radius = 0.012, .length = 0.02};
    const dem::Tube tube{.base = {0, 0, -0.01}, .inner = 0.005, .outer = 0.0055, .length = 0.02};
    const Vec3 above{0.002, 0.001, 1.01e-3}, down{0.05, 0.02, -0.3};
    return {
        {"translation", {floor, {dem::Translation{.velocity = {0.1, -0.05, 0.2}}}}, above, down},
        {"vibration",
         {floor, {dem::Vibration{.amplitude = {1e-4, 0, 2e-4}, .frequency = 400, .phase = 0.7}}},
         above,
         down},
        {"flap", {floor, {dem::Rotation{.point = {-0.02, 0, 0}, .axis = {0, -1, 0}, .speed = 8}}}, above, down},
        {"turntable", {floor, {dem::Rotation{.speed = 40}}}, above, down},
        {"flap on a carriage",
         {floor,
          {dem::Translation{.velocity = {0.3, 0, 0.1}},
           dem::Rotation{.point = {-0.02, 0, 0}, .axis = {0, -1, 0}, .speed = 8},
           dem::Rotation{.axis = {0, 0, 1}, .speed = 20}}},
         above,
         down},
        {"drum", {drum, {dem::Rotation{.axis = {0, 1, 0}, .speed = 30}}}, {0, 0, -0.00899}, down},
        {"roller that travels",
         {roller, {dem::Rotation{.axis = {0, 1, 0}, .speed = -30}, dem::Translation{.velocity = {0.2, 0, 0}}}},
         {0.0005, 0.002, 0.01101},
         down},
        {"cone about another axis",
         {funnel, {dem::Rotation{.point = {0.001, 0, 0}, .axis = {0, 0, 1}, .speed = 50}}},
         {0.0058, 0, 0},
         {0.4, 0.1, 0}},
        {"tube that is lifted and turns",
         {tube, {dem::Translation{.velocity = {0, 0, 0.3}}, dem::Rotation{.axis = {0, 0, 1}, .speed = 30}}},
         {0.00399, 0, 0},
         {0.4, 0.1, 0}},
    };
}

std::vector<Moving> moving_meshes() {
    const dem::Mesh floor(surface_of(plate(0.02, 4))), block(surface_of(box(0.004, 0.004)));
    const Vec3 above{0.002, 0.001, 1.01e-3}, down{0.05, 0.02, -0.3};
    const dem::Rotation about_z{.axis = {0, 0, 1}, .speed = 40};
    return {
        {"plate that rises", {floor, {dem::Translation{.velocity = {0.1, -0.05, 0.2}}}}, above, down},
        {"plate that vibrates",
         {floor, {dem::Vibration{.amplitude = {1e-4, 0, 2e-4}, .frequency = 400, .phase = 0.7}}},
         above,
         down},
        {"turntable of triangles", {floor, {about_z}}, above, down},
        {"edge of a block on a carriage",
         {block, {about_z, dem::Translation{.velocity = {0.3, 0, 0.1}}}},
         {0.0043, 0.001, 1.01e-3},
         down},
        {"vertex of a block that tips",
         {block, {dem::Rotation{.point = {-0.02, 0, 0}, .axis = {0, -1, 0}, .speed = 8}}},
         {0.0043, 0.0042, 1.01e-3},
         down},
    };
}

std::vector<Moving> all_moving_walls() {
    std::vector<Moving> all = moving_walls();
    for (Moving& mesh : moving_meshes()) all.push_back(std::move(mesh));
    return all;
}

}  // namespace grainsweep::tests

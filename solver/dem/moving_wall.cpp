#include "solver/dem/moving_wall.hpp"

#include <cmath>
#include <numbers>

namespace grainsweep::dem {
namespace {

double pulsation(const Blade& b) {
    return 2 * std::numbers::pi * b.frequency;
}

Vec3 displacement(const Plane&, double) {
    return {};
}
Vec3 displacement(const Blade& b, double t) {
    return {b.speed * t, 0, b.amplitude * std::sin(pulsation(b) * t)};
}

Vec3 velocity(const Plane&, double) {
    return {};
}
Vec3 velocity(const Blade& b, double t) {
    return {b.speed, 0, b.amplitude * pulsation(b) * std::cos(pulsation(b) * t)};
}

double fastest_of(const Plane&) {
    return 0;
}
double fastest_of(const Blade& b) {
    return std::hypot(b.speed, b.amplitude * pulsation(b));
}

}  // namespace

geometry::Plane shape_at(const Plane& plane, double) {
    return {plane.point, plane.normal};
}

geometry::Bar shape_at(const Blade& b, double t) {
    const Vec3 d = displacement(b, t);
    const double front = b.front + d[0];
    return {.rear = front - b.thickness,
            .front = front,
            .bottom = b.bottom + d[2],
            .top = b.top + d[2],
            .edge_radius = b.edge_radius};
}

Vec3 displacement_at(const Wall& wall, double time) {
    return std::visit([time](const auto& w) { return displacement(w, time); }, wall);
}

Vec3 velocity_at(const Wall& wall, double time) {
    return std::visit([time](const auto& w) { return velocity(w, time); }, wall);
}

double fastest(const Wall& wall) {
    return std::visit([](const auto& w) { return fastest_of(w); }, wall);
}

}  // namespace grainsweep::dem

#include "solver/particles/clump.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

namespace grainsweep::particles {

using namespace geometry;

namespace {

constexpr double touching = 1e-6;       ///< gap of two spheres that touch, divided by the smaller radius
constexpr double least_radius = 1e-3;   ///< divided by the largest one
constexpr double most_mass_ratio = 20;  ///< of a given mass and that of the spheres

std::string number_text(const char* form, double a) {
    char text[160];
    std::snprintf(text, sizeof text, form, a);
    return text;
}

/// Counts the spheres that a chain of contacts joins to the first one.
std::size_t joined(std::span<const Ball> balls) {
    std::vector<bool> reached(balls.size(), false);
    std::vector<std::size_t> open{0};
    reached[0] = true;
    std::size_t count = 1;
    while (!open.empty()) {
        const Ball a = balls[open.back()];
        open.pop_back();
        for (std::size_t j = 0; j < balls.size(); ++j) {
            const double gap = norm(balls[j].centre - a.centre) - a.radius - balls[j].radius;
            if (reached[j] || gap > touching * std::min(a.radius, balls[j].radius)) continue;
            reached[j] = true;
            ++count;
            open.push_back(j);
        }
    }
    return count;
}

}  // namespace

double Clump::reach() const {
    double farthest = 0;
    for (const Ball& ball : balls) farthest = std::max(farthest, norm(ball.centre) + ball.radius);
    return farthest;
}

double Clump::smallest() const {
    return std::ranges::min_element(balls, {}, &Ball::radius)->radius;
}

std::size_t Clump::long_axis() const {
    return static_cast<std::size_t>(std::ranges::min_element(inertia) - inertia.begin());
}

std::string flaw_of(std::span<const Ball> balls) {
    if (balls.size() < 2)
        return balls.empty() ? "a shape needs spheres" : "a shape of one sphere is a sphere: leave \"shape\" out";
    if (balls.size() > most_balls)
        return number_text("a shape has at most 200 spheres, and these are %.0f: a few already move like the body",
                           static_cast<double>(balls.size()));
    double largest = 0;
    for (const Ball& ball : balls) {
        if (!finite(ball.centre) || !std::isfinite(ball.radius)) return "places and diameters must be finite";
        if (!(ball.radius > 0)) return "every sphere must have a diameter above 0";
        largest = std::max(largest, ball.radius);
    }
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const std::string sphere = number_text("sphere %.0f", static_cast<double>(i + 1));
        if (balls[i].radius < least_radius * largest)
            return sphere + " has less than a thousandth of the largest diameter: give all in one unit";
        for (std::size_t j = 0; j < balls.size(); ++j)
            if (j != i && norm(balls[i].centre - balls[j].centre) <= balls[j].radius - balls[i].radius &&
                (balls[i].radius < balls[j].radius || j < i))
                return sphere + number_text(" lies within sphere %.0f and changes nothing: leave it out",
                                            static_cast<double>(j + 1));
    }
    if (const std::size_t count = joined(balls); count < balls.size())
        return number_text("the spheres fall into pieces: %.0f", static_cast<double>(count)) +
               number_text(" of %.0f hang together, the others do not touch these", static_cast<double>(balls.size()));
    return {};
}

std::string flaw_of(std::span<const Ball> balls, const Solid& solid, double density, double mass, const Inertia& given,
                    const Vec3& centre) {
    const double filled = density * solid.volume;
    if (!(mass <= most_mass_ratio * filled && mass >= filled / most_mass_ratio))
        return number_text("its mass is %.3g times", mass / filled) +
               number_text(" the %.3g kg of its volume at the density of the material: check the units", filled);
    double farthest = 0;
    for (const Ball& ball : balls) farthest = std::max(farthest, norm(ball.centre - centre) + ball.radius);
    if (std::ranges::none_of(balls, [&](const Ball& ball) { return norm(ball.centre - centre) < ball.radius; }) &&
        norm(centre - solid.centre) > farthest / 2)
        return "its centre of mass lies outside of it";
    const Solid body = solid_of(solid.volume, centre, given);
    const auto [a, b, c] = body.inertia;
    if (!(a > 0 && b > 0 && c > 0)) return "no body has this inertia: a principal moment is not above 0";
    const double half = (a + b + c) / 2;
    if (std::max({a, b, c}) > half * (1 + 1e-9))
        return number_text("no body has this inertia: its largest principal moment is %.4g", std::max({a, b, c})) +
               number_text(" kg m2, and the sum of the others only %.4g", a + b + c - std::max({a, b, c}));
    if (half > mass * farthest * farthest)
        return number_text("no body of this size has this inertia: its radius of gyration is %.3g m",
                           std::sqrt(half / mass)) +
               number_text(", and no point is farther than %.3g m from its centre", farthest);
    if (half < 1e-3 * mass * farthest * farthest)
        return number_text("its inertia is that of a body of %.3g m", std::sqrt(half / mass)) +
               number_text(", and it reaches %.3g m from its centre: check the units", farthest);
    return {};
}

std::vector<Ball> row_of(double aspect_ratio) {
    const double length = 2 * (aspect_ratio - 1);  // between the outermost centres, in radii
    const std::size_t count = aspect_ratio <= 1.5 ? 2 : 1 + static_cast<std::size_t>(std::ceil(length - 1e-9));
    std::vector<Ball> balls;
    for (std::size_t k = 0; k < count; ++k)
        balls.push_back({{length * (static_cast<double>(k) / static_cast<double>(count - 1) - 0.5), 0, 0}, 1});
    return balls;
}

void take_mass(Clump& clump, double mass, const Vec3& inertia) {
    clump.mass = mass;
    clump.inertia = inertia;
    clump.lightness = 1;
    for (const Ball& ball : clump.balls) {
        // n . (A n) is what an impact along n on this sphere adds to 1/m: A = sum_k (x x e_k)(x x e_k)/I_k.
        Inertia added{};
        for (std::size_t k = 0; k < 3; ++k) {
            Vec3 axis{};
            axis[k] = 1;
            add_square(added, cross(ball.centre, axis), 1 / inertia[k]);
        }
        const double most = std::ranges::max(solid_of(0, {}, added).inertia);
        const double felt = 1 / (1 / mass + most), own = std::numbers::pi / 6 * std::pow(2 * ball.radius, 3);
        clump.lightness = std::min(clump.lightness, felt / own);
    }
}

Clump clump_of(std::span<const Ball> balls, const Solid& solid) {
    Clump clump;
    clump.diameter = std::cbrt(6 * solid.volume / std::numbers::pi);
    clump.centre = solid.centre;
    auto axes = solid.axes;
    if (dot(cross(axes[0], axes[1]), axes[2]) < 0) axes[2] = -axes[2];
    const double unit = 1 / clump.diameter;
    for (const Ball& ball : balls) {
        const Vec3 x = unit * (ball.centre - solid.centre);
        clump.balls.push_back({{dot(x, axes[0]), dot(x, axes[1]), dot(x, axes[2])}, unit * ball.radius});
    }
    clump.turn = orientation_of(axes);
    take_mass(clump, std::numbers::pi / 6, (unit * unit * unit * unit * unit) * solid.inertia);
    return clump;
}

}  // namespace grainsweep::particles

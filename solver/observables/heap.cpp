#include "solver/observables/heap.hpp"

#include "solver/observables/line_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace grainsweep::observables {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double foot = 0.2, shoulder = 0.8;  // of the height, between which the slope is fitted
constexpr std::size_t inner_rings = 3;
constexpr double thin = 0.5;     // D: a lower ring is none of the heap
constexpr double most_in = 0.9;  // of the spheres, within the run-out

struct Grain {
    double x, y, top, z, volume;
};

std::vector<Grain> about_their_centre(const dem::State& state) {
    std::vector<Grain> grains;
    double mass = 0, cx = 0, cy = 0;
    for (std::size_t i = 0; i < state.position.size(); ++i) {
        if (state.mobile[i] == 0) continue;
        const auto& x = state.position[i];
        const double r = state.radius[i];
        grains.push_back({x[0], x[1], x[2] + r, x[2], r * r * r});
        mass += grains.back().volume;
        cx += grains.back().volume * x[0];
        cy += grains.back().volume * x[1];
    }
    for (Grain& g : grains) g.x -= cx / mass, g.y -= cy / mass;
    return grains;
}

/// Columns of the width 1 with their middles nearer than `radius` to the axis. No middle is at a whole distance:
/// (2 i + 1)^2 + (2 j + 1)^2 is no multiple of 4.
double columns_within(std::int64_t radius) {
    const std::int64_t square = 4 * radius * radius;
    std::int64_t quarter = 0, j = radius;
    for (std::int64_t i = 0; i < radius; ++i) {
        while (j > 0 && (2 * i + 1) * (2 * i + 1) + (2 * j - 1) * (2 * j - 1) > square) --j;
        quarter += j;
    }
    return static_cast<double>(4 * quarter);
}

std::vector<double> outline_of(const std::vector<Grain>& grains, double d, std::int64_t rings) {
    std::map<std::pair<std::int64_t, std::int64_t>, double> top;
    for (const Grain& g : grains) {
        double& height =
            top[{static_cast<std::int64_t>(std::floor(g.x / d)), static_cast<std::int64_t>(std::floor(g.y / d))}];
        height = std::max(height, g.top);
    }
    std::vector<double> outline(static_cast<std::size_t>(rings), 0);
    for (const auto& [at, height] : top) {
        const auto ring = static_cast<std::size_t>(
            std::hypot(static_cast<double>(at.first) + 0.5, static_cast<double>(at.second) + 0.5));
        if (ring < outline.size()) outline[ring] += height;
    }
    for (std::int64_t k = 0; k < rings; ++k)
        if (double& height = outline[static_cast<std::size_t>(k)]; height != 0)
            height /= columns_within(k + 1) - columns_within(k);
    return outline;
}

double angle_by_moments(const std::vector<Grain>& grains, double within) {
    double mass = 0, z = 0, r = 0;
    for (const Grain& g : grains) {
        const double from_axis = std::hypot(g.x, g.y);
        if (from_axis > within) continue;
        mass += g.volume;
        z += g.volume * g.z;
        r += g.volume * from_axis;
    }
    return mass > 0 && r > 0 ? std::atan(2 * z / r) / degree : HeapShape::unknown;
}

}  // namespace

HeapShape heap_shape(const dem::State& state, double diameter, double reach) {
    HeapShape shape;
    const auto grains = about_their_centre(state);
    if (grains.empty()) return shape;
    const auto rings = std::max<std::int64_t>(static_cast<std::int64_t>(inner_rings), std::llround(reach / diameter));
    shape.outline = outline_of(grains, diameter, rings);
    const auto& h = shape.outline;
    const auto middle = [diameter](std::size_t k) { return (static_cast<double>(k) + 0.5) * diameter; };
    shape.height = *std::max_element(h.begin(), h.begin() + static_cast<std::ptrdiff_t>(inner_rings));

    std::vector<std::array<double, 2>> slope;
    for (std::size_t k = 0; k < h.size() && h[k] >= foot * shape.height; ++k)
        if (h[k] <= shoulder * shape.height) slope.push_back({middle(k), h[k]});
    const Line line = fitted_line(slope);
    shape.angle = std::atan(0 - line.slope) / degree;
    shape.residual = line.residual;

    std::size_t edge = 0;
    while (edge < h.size() && h[edge] >= thin * diameter) ++edge;
    shape.angle_moment =
        angle_by_moments(grains, edge < h.size() ? middle(edge) : std::numeric_limits<double>::infinity());

    std::vector<double> distance;
    for (const Grain& g : grains) distance.push_back(std::hypot(g.x, g.y));
    std::ranges::sort(distance);
    shape.run_out = distance[static_cast<std::size_t>(most_in * static_cast<double>(distance.size()))];
    return shape;
}

double rms_speed(const dem::State& state) {
    double squares = 0, seen = 0;
    for (std::size_t i = 0; i < state.velocity.size(); ++i) {
        if (state.mobile[i] == 0) continue;
        const auto& v = state.velocity[i];
        squares += v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        seen += 1;
    }
    return seen > 0 ? std::sqrt(squares / seen) : 0;
}

}  // namespace grainsweep::observables

#include "solver/observables/turned_bed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace grainsweep::observables {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double surface_level = 0.3;                    // solid fraction
constexpr double surface_reach = 0.4;                    // of the radius
constexpr double flow_cells_per_d = 5;                   // of SectionFlow
constexpr double strip = 2.5;                            // half-width of the flowing layer that is looked at, D
constexpr double layer = 0.5;                            // of the velocity profile, D
constexpr double profile_above = 2, profile_below = 14;  // ends of the velocity profile about the surface, D
constexpr double least_depth = 0.5;                      // D: a change of sign above is none of the layer
constexpr std::int64_t least_seen = 20;                  // centres that make a mean
constexpr double wall_layer = 0.1;                       // D

double cube(double r) {
    return r * r * r;
}

}  // namespace

SectionSphere SectionView::sphere(const dem::State& state, std::size_t i) const {
    using geometry::dot;
    const dem::Vec3 from_axis = geometry::operator-(state.position[i], through);
    const auto& v = state.velocity[i];
    return {dot(from_axis, across), dot(from_axis, up), dot(v, across), dot(v, up), state.radius[i]};
}

SectionGrid::SectionGrid(double radius, double its_cell)
    : cell(its_cell), count(2 * std::max<std::int64_t>(1, std::llround(std::ceil(radius / its_cell - 1e-9)))) {}

std::int64_t SectionGrid::column(double x) const {
    return static_cast<std::int64_t>(std::floor(x / cell)) + count / 2;
}

std::vector<std::array<double, 2>> falling_through(const SectionGrid& grid, std::span<const double> values,
                                                   double level, double reach) {
    std::vector<std::array<double, 2>> points;
    for (std::int64_t i = 0; i < grid.count; ++i) {
        if (std::abs(grid.centre(i)) > reach) continue;
        for (std::int64_t j = grid.count - 2; j >= 0; --j) {
            const double lower = values[grid.number(i, j)], upper = values[grid.number(i, j + 1)];
            if (!(lower >= level && level > upper)) continue;
            points.push_back({grid.centre(i), grid.centre(j) + grid.cell * (lower - level) / (lower - upper)});
            break;
        }
    }
    return points;
}

SolidFraction::SolidFraction(double radius, double length, double diameter)
    : grid_(radius, diameter), length_(length), volume_(grid_.cells(), 0) {}

void SolidFraction::add(std::span<const SectionSphere> spheres) {
    for (const auto& s : spheres) {
        const auto column = grid_.column(s.x), row = grid_.column(s.z);
        if (column < 0 || column >= grid_.count || row < 0 || row >= grid_.count) continue;
        volume_[grid_.number(column, row)] += 4.0 / 3 * std::numbers::pi * cube(s.radius);
    }
    ++frames_;
}

std::vector<double> SolidFraction::mean() const {
    std::vector<double> fraction = volume_;
    const double space = grid_.cell * grid_.cell * length_ * static_cast<double>(std::max<std::int64_t>(1, frames_));
    for (double& f : fraction) f /= space;
    return fraction;
}

Line SolidFraction::surface_line(double radius) const {
    return fitted_line(falling_through(grid_, mean(), surface_level, surface_reach * radius));
}

SectionFlow::SectionFlow(double radius, double diameter)
    : grid_(radius, diameter / flow_cells_per_d),
      diameter_(diameter),
      vx_(grid_.cells(), 0),
      vz_(grid_.cells(), 0),
      centres_(grid_.cells(), 0) {}

void SectionFlow::add(std::span<const SectionSphere> spheres) {
    for (const auto& s : spheres) {
        const auto column = grid_.column(s.x), row = grid_.column(s.z);
        if (column < 0 || column >= grid_.count || row < 0 || row >= grid_.count) continue;
        const std::size_t at = grid_.number(column, row);
        vx_[at] += s.vx;
        vz_[at] += s.vz;
        ++centres_[at];
    }
}

SectionFlow::DownhillProfile SectionFlow::below(const Line& surface) const {
    if (std::isnan(surface.slope)) return {nan, nan};
    const double cosine = 1 / std::hypot(1, surface.slope), sine = -surface.slope * cosine;  // of the angle
    const auto layers = static_cast<std::size_t>((profile_above + profile_below) / layer);
    std::vector<double> speed(layers, 0);
    std::vector<std::int64_t> seen(layers, 0);
    double top_speed = 0;
    std::int64_t top_seen = 0;
    const double end = grid_.cell * static_cast<double>(grid_.count);
    for (std::int64_t j = 0; j < grid_.count; ++j) {
        const double z = grid_.centre(j);
        const auto near = [&](double side) {  // the column where the strip ends
            return grid_.column(std::clamp((z * sine + side * strip * diameter_) / cosine, -end, end));
        };
        const auto first = std::max<std::int64_t>(0, near(-1) - 1), last = std::min(grid_.count - 1, near(1) + 1);
        for (std::int64_t i = first; i <= last; ++i) {
            const std::size_t at = grid_.number(i, j);
            if (centres_[at] == 0) continue;
            const double x = grid_.centre(i);
            if (std::abs(x * cosine - z * sine) > strip * diameter_) continue;
            const double depth = (surface.height * cosine - x * sine - z * cosine) / diameter_;
            const double downhill = vx_[at] * cosine - vz_[at] * sine;
            if (depth > 0 && depth <= 1) top_speed += downhill, top_seen += centres_[at];
            const double place = std::floor((depth + profile_above) / layer);
            if (!(place >= 0 && place < static_cast<double>(layers))) continue;
            speed[static_cast<std::size_t>(place)] += downhill;
            seen[static_cast<std::size_t>(place)] += centres_[at];
        }
    }
    DownhillProfile profile{top_seen > 0 ? top_speed / static_cast<double>(top_seen) : nan, nan};
    for (std::size_t k = 0; k + 1 < layers; ++k) {
        const double middle = (static_cast<double>(k) + 0.5) * layer - profile_above;
        if (!(middle > least_depth) || seen[k] <= least_seen || seen[k + 1] == 0) continue;
        const double here = speed[k] / static_cast<double>(seen[k]);
        const double next = speed[k + 1] / static_cast<double>(seen[k + 1]);
        if (!(here > 0 && next <= 0)) continue;
        profile.depth = middle + layer * here / (here - next);
        break;
    }
    return profile;
}

Cover::Cover(double radius, double cell) : grid_(radius, cell), hidden_(grid_.cells(), 0) {}

std::span<const char> Cover::hidden_by(std::span<const SectionSphere> spheres) {
    now_.assign(grid_.cells(), 0);
    // Off by one where an edge lies between two cells, whose centres are half a cell away from it.
    const auto column_of = [middle = grid_.count / 2, per_cell = 1 / grid_.cell](double x) {
        return static_cast<std::int64_t>(std::floor(x * per_cell)) + middle;
    };
    for (const auto& [x, z, vx, vz, r] : spheres) {
        const auto first_row = std::max<std::int64_t>(0, column_of(z - r));
        const auto last_row = std::min(grid_.count - 1, column_of(z + r));
        for (auto row = first_row; row <= last_row; ++row) {
            const double dz = grid_.centre(row) - z, half = std::sqrt(std::max(0.0, r * r - dz * dz));
            const auto hides = [&, x = x, r = r](std::int64_t column) {
                const double dx = grid_.centre(column) - x;
                return dx * dx + dz * dz <= r * r;
            };
            auto first = std::max<std::int64_t>(0, column_of(x - half));
            auto last = std::min(grid_.count - 1, column_of(x + half));
            while (first <= last && !hides(first)) ++first;
            while (first <= last && !hides(last)) --last;
            if (first <= last) std::fill_n(&now_[grid_.number(first, row)], last - first + 1, char{1});
        }
    }
    return now_;
}

void Cover::add(std::span<const SectionSphere> spheres) {
    const auto now = hidden_by(spheres);
    for (std::size_t k = 0; k < now.size(); ++k) hidden_[k] += now[k];
    ++frames_;
}

std::vector<double> Cover::share() const {
    std::vector<double> share(hidden_.size(), 0);
    const auto frames = static_cast<double>(std::max<std::int64_t>(1, frames_));
    for (std::size_t k = 0; k < share.size(); ++k) share[k] = static_cast<double>(hidden_[k]) / frames;
    return share;
}

std::optional<double> wall_layer_speed(std::span<const SectionSphere> spheres, double radius, double diameter) {
    double speed = 0;
    std::int64_t seen = 0;
    for (const auto& s : spheres) {
        const double from_axis = std::hypot(s.x, s.z);
        if (!(s.z < 0 && from_axis > radius - s.radius - wall_layer * diameter)) continue;
        speed += (s.vx * s.z - s.vz * s.x) / from_axis;
        ++seen;
    }
    if (seen == 0) return std::nullopt;
    return speed / static_cast<double>(seen);
}

}  // namespace grainsweep::observables

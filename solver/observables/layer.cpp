#include "solver/observables/layer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace grainsweep::observables {

namespace {

double sphere(double r) {
    return 4.0 / 3.0 * std::numbers::pi * r * r * r;
}

}  // namespace

double solid_volume(const dem::State& state, double from, double to) {
    double volume = 0;
    for (std::size_t i = 0; i < state.position.size(); ++i)
        if (state.position[i][0] >= from && state.position[i][0] < to) volume += sphere(state.radius[i]);
    return volume;
}

double sphere_below(double z, double r) {
    const double t = std::clamp(z, -r, r);
    return std::numbers::pi * (2.0 / 3.0 * r * r * r + r * r * t - t * t * t / 3);
}

Patches::Patches(double from, double to, double width, double side) : from_(from), to_(to), width_(width) {
    const auto count = [side](double length) {
        return static_cast<std::size_t>(std::max(1.0, std::round(length / side)));
    };
    along_ = count(to - from);
    across_ = count(width);
    dx_ = (to - from) / static_cast<double>(along_);
    dy_ = width / static_cast<double>(across_);
}

void Patches::add(const dem::State& state, double sign) {
    for (std::size_t i = 0; i < state.position.size(); ++i) {
        const auto& x = state.position[i];
        if (!(x[0] >= from_ && x[0] < to_)) continue;
        const double y = x[1] - width_ * std::floor(x[1] / width_);
        const auto column = std::min(along_ - 1, static_cast<std::size_t>((x[0] - from_) / dx_));
        const auto row = std::min(across_ - 1, static_cast<std::size_t>(y / dy_));
        volume_[row * along_ + column] += sign * sphere(state.radius[i]);
    }
}

double Patches::deviation() const {
    if (size() < 4) return std::numeric_limits<double>::quiet_NaN();
    const auto count = static_cast<double>(size());
    double mean = 0, squares = 0;
    for (const auto& [patch, v] : volume_) mean += v / count;
    auto next = volume_.begin();
    for (std::size_t patch = 0; patch < size(); ++patch) {
        const double v = next != volume_.end() && next->first == patch ? (next++)->second : 0.0;
        squares += (v - mean) * (v - mean);
    }
    return std::sqrt(squares / count);
}

constexpr std::int64_t most_kept = 1 << 22;  // points of a grid of which few are covered
constexpr std::int64_t most_rows = std::numeric_limits<std::int64_t>::max();

Relief::Relief(const dem::State& state, double from, double to, double width, double pitch, bool repeats) {
    const auto count = [pitch](double length) {
        return std::max<std::int64_t>(1, std::llround(std::ceil(length / pitch)));
    };
    const std::int64_t nx = count(to - from);
    const std::int64_t ny = count(width);
    const double dx = (to - from) / static_cast<double>(nx);
    const double dy = width / static_cast<double>(ny);
    points_ = nx * ny;
    double most = 0;  // points that the spheres can cover
    for (const double r : state.radius) most += (2 * r / dx + 1) * (2 * r / dy + 1);
    if (points_ <= most_kept || 2 * most >= static_cast<double>(points_))
        heights_.assign(static_cast<std::size_t>(points_), 0);
    for (std::size_t i = 0; i < state.position.size(); ++i) {
        const auto& x = state.position[i];
        const double r = state.radius[i];
        const auto first = [](double q, double step) -> std::int64_t {
            return std::llround(std::ceil(q / step - 0.5));
        };
        // Points lie at the centres of the grid's squares; rows in y are counted beyond the period and wrapped.
        const std::int64_t ix_end = std::min<std::int64_t>(nx, first(x[0] + r - from, dx));
        for (std::int64_t ix = std::max<std::int64_t>(0, first(x[0] - r - from, dx)); ix < ix_end; ++ix) {
            const double px = from + (static_cast<double>(ix) + 0.5) * dx - x[0];
            const std::int64_t iy_end = std::min(first(x[1] + r, dy), repeats ? most_rows : ny);
            for (std::int64_t iy = std::max(first(x[1] - r, dy), repeats ? -most_rows : 0); iy < iy_end; ++iy) {
                const double py = (static_cast<double>(iy) + 0.5) * dy - x[1];
                const double rest = r * r - px * px - py * py;
                if (rest <= 0) continue;
                const std::int64_t point = ix * ny + ((iy % ny) + ny) % ny;
                if (heights_.empty()) {
                    covered_.insert(point);
                    continue;
                }
                double& height = heights_[static_cast<std::size_t>(point)];
                height = std::max(height, x[2] + std::sqrt(rest));
            }
        }
    }
}

double Relief::roughness() const {
    if (heights_.empty()) return std::numeric_limits<double>::quiet_NaN();
    double mean = 0;
    for (const double h : heights_) mean += h;
    mean /= static_cast<double>(heights_.size());
    double squares = 0;
    for (const double h : heights_) squares += (h - mean) * (h - mean);
    return std::sqrt(squares / static_cast<double>(heights_.size()));
}

double Relief::empty_share() const {
    const auto empty = heights_.empty() ? points_ - static_cast<std::int64_t>(covered_.size())
                                        : static_cast<std::int64_t>(std::ranges::count(heights_, 0.0));
    return static_cast<double>(empty) / static_cast<double>(points_);
}

void VelocityProfile::add(const dem::State& state, double from, double to, double bottom, double thickness) {
    for (std::size_t i = 0; i < state.position.size(); ++i) {
        const auto& x = state.position[i];
        if (x[0] <= from || x[0] >= to || x[2] < bottom) continue;
        const double layer = std::floor((x[2] - bottom) / thickness);
        if (layer >= static_cast<double>(sum.size())) continue;
        sum[static_cast<std::size_t>(layer)] += state.velocity[i][0];
        ++samples[static_cast<std::size_t>(layer)];
    }
}

double unevenness(std::span<const double> profile) {
    double squares = 0;
    int places = 0;
    for (std::size_t k = 1; k + 1 < profile.size(); ++k) {
        const double bend = profile[k - 1] - 2 * profile[k] + profile[k + 1];
        if (std::isnan(bend)) continue;
        squares += bend * bend;
        ++places;
    }
    return places > 0 ? std::sqrt(squares / places) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace grainsweep::observables

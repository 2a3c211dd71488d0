#include "solver/scenes/thermovibration/runs.hpp"

#include "solver/observables/flow_state.hpp"
#include "solver/own_cores.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

namespace grainsweep::thermovibration {
namespace {

constexpr std::int64_t judged_every = 20;  // periods
constexpr double give_up = 1.0;            // L^2/alpha: ten thermal times

std::string text(const char* format, double a, double b, double c, double d, double e) {
    std::array<char, 256> line{};
    std::snprintf(line.data(), line.size(), format, a, b, c, d, e);
    return line.data();
}

// Root of the mean square over the volume.
double size_of(const flow::Grid& grid, const flow::FaceVectors& field) {
    return std::sqrt(2 * observables::kinetic_energy(grid, field));
}

}  // namespace

std::string fault(const flow::Flow<flow::Boussinesq>& fluid, double time) {
    const auto fastest = fluid.fastest();
    const auto& x = fastest.position;
    if (!std::isfinite(fastest.courant))
        return text("the fluid velocity is no number at (%.4g, %.4g, %.4g), t = %.6g L^2/alpha", x[0], x[1], x[2], time,
                    0);
    if (fastest.courant > 1)
        return text("the Courant number of the fluid is %.3g, above 1, at (%.4g, %.4g, %.4g), t = %.6g L^2/alpha",
                    fastest.courant, x[0], x[1], x[2], time);
    return {};
}

std::string fault(const coupling::Cloud& cloud, double time_step, double cell, double time) {
    double fastest = 0;  // squared
    double any = 0;      // no number if one of them is none
    for (std::size_t p = 0; p < cloud.size(); ++p) {
        const auto& v = cloud.velocity[p];
        const auto& x = cloud.position[p];
        const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        fastest = std::max(fastest, square);
        any += square + x[0] + x[1] + x[2];
    }
    if (std::isfinite(any) && time_step * std::sqrt(fastest) <= cell) return {};
    for (std::size_t p = 0; p < cloud.size(); ++p) {
        const auto& v = cloud.velocity[p];
        const auto& x = cloud.position[p];
        const double way = time_step * std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        if (way <= cell && std::isfinite(x[0] + x[1] + x[2])) continue;
        return "particle " + std::to_string(p) +
               text(" crosses %.3g cells in a step at (%.4g, %.4g, %.4g), t = %.6g L^2/alpha", way / cell, x[0], x[1],
                    x[2], time);
    }
    return {};
}

std::string fault(const coupling::SolidsVolume& solids, const flow::Grid& grid, double time) {
    constexpr double densest = 0.7405;  // of equal spheres: pi/sqrt(18)
    if (solids.largest_fraction() <= densest) return {};
    const flow::Field& fraction = solids.fraction();
    for (int k = 1; k <= grid.cells(2); ++k)
        for (int j = 1; j <= grid.cells(1); ++j)
            for (int i = 1; i <= grid.cells(0); ++i)
                if (!(fraction(i, j, k) <= densest))
                    return text("particles fill %.3g of the cell at (%.4g, %.4g, %.4g), t = %.6g L^2/alpha",
                                fraction(i, j, k), grid[0].centre(i), grid[1].centre(j), grid[2].centre(k), time);
    return {};
}

int threads_for(const flow::Grid& grid, int count) {
    constexpr std::size_t least_cells = 10'000;
    const auto most = static_cast<std::size_t>(count > 0 ? count : own_cores());
    return static_cast<int>(std::clamp<std::size_t>(grid.total_cells() / least_cells, 1, most));
}

std::int64_t watch_interval(std::int64_t steps_per_period) {
    std::int64_t steps = 7;
    while (std::gcd(steps, steps_per_period) != 1) ++steps;
    return steps;
}

SpinUp::SpinUp(const Question& question)
    : question_(question),
      fluid_(question.fluid()),
      velocity_(flow::face_vectors(fluid_.grid())),
      acceleration_(velocity_),
      mean_(velocity_),
      previous_mean_(velocity_),
      stored_(fluid_.grid()) {}

void SpinUp::step() {
    const std::int64_t per_period = question_.steps_per_period;
    const std::int64_t in_period = fluid_.steps() % per_period;
    const bool judged = (fluid_.steps() / per_period) % judged_every == judged_every - 1;
    fluid_.step();
    if (fluid_.steps() % watch_interval(per_period) == 0) {
        fault_ = thermovibration::fault(fluid_, time());
        if (!fault_.empty()) return;
    }
    if (stage_ == Stage::storing) {
        fluid_.midpoint(velocity_, acceleration_);
        const double phase = question_.frequency * (static_cast<double>(in_period) + 0.5) * fluid_.time_step();
        stored_.add(phase, static_cast<int>(per_period), velocity_, acceleration_);
        means_.add(fluid_, per_period);
        if (in_period == per_period - 1) stage_ = Stage::stored;
    } else if (judged) {
        const double share = 1 / static_cast<double>(per_period);
        for (std::size_t d = 0; d < 3; ++d)
            for (std::size_t m = 0; m < mean_[d].size(); ++m)
                mean_[d].values()[m] += share * fluid_.velocity()[d].values()[m];
        mean_square_ += share * 2 * observables::kinetic_energy(fluid_.grid(), fluid_.velocity());
        if (in_period == per_period - 1) compare();
    }
}

void SpinUp::compare() {
    for (std::size_t d = 0; d < 3; ++d)
        for (std::size_t m = 0; m < mean_[d].size(); ++m) previous_mean_[d].values()[m] -= mean_[d].values()[m];
    const double change = size_of(fluid_.grid(), previous_mean_);
    const double size = size_of(fluid_.grid(), mean_);
    const double relaxation_over_interval =
        1 / (std::numbers::pi * std::numbers::pi * question_.period() * static_cast<double>(judged_every));
    const double to_come = change * std::max(1.0, relaxation_over_interval);
    const bool settled = to_come <= 0.02 * size || to_come <= 1e-5 * std::sqrt(mean_square_);
    passes_ = settled ? passes_ + 1 : 0;
    std::swap(mean_, previous_mean_);
    for (auto& component : mean_) std::fill(component.values().begin(), component.values().end(), 0.0);
    mean_square_ = 0;
    if (passes_ >= 2)
        stage_ = Stage::storing;
    else if (time() > give_up)
        fault_ = text(
            "the flow had not become periodic by t = %.4g L^2/alpha (mean velocity still to change by %.2g of "
            "its size); release the particles with the flow instead (particle_start)",
            time(), to_come / size, 0, 0, 0);
}

void SpinUp::save(std::vector<std::byte>& into) const {
    fluid_.save(into);
    for (std::size_t d = 0; d < 3; ++d) {
        append_bytes<double>(into, mean_[d].values());
        append_bytes<double>(into, previous_mean_[d].values());
    }
    append_bytes(into, mean_square_);
    append_bytes(into, passes_);
    append_bytes(into, stage_);
    append_bytes(into, means_);
    if (stage_ != Stage::settling) stored_.save(into);
}

void SpinUp::restore(std::span<const std::byte>& from) {
    fluid_.restore(from);
    for (std::size_t d = 0; d < 3; ++d) {
        take_bytes<double>(from, mean_[d].values());
        take_bytes<double>(from, previous_mean_[d].values());
    }
    take_bytes(from, mean_square_);
    take_bytes(from, passes_);
    take_bytes(from, stage_);
    take_bytes(from, means_);
    require_possible(stage_ == Stage::settling || stage_ == Stage::storing || stage_ == Stage::stored);
    require_possible(passes_ >= 0 && passes_ <= 2 && thermovibration::fault(fluid_, time()).empty());
    if (stage_ != Stage::settling) stored_.restore(from);
}

}  // namespace grainsweep::thermovibration

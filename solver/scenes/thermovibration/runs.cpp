#include "solver/scenes/thermovibration/runs.hpp"

#include "solver/own_cores.hpp"
#include "solver/scenes/thermovibration/picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

namespace grainsweep::thermovibration {
namespace {

std::string text(const char* format, double a, double b, double c, double d, double e) {
    std::array<char, 256> line{};
    std::snprintf(line.data(), line.size(), format, a, b, c, d, e);
    return line.data();
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

Live::Live(const Question& question, std::uint64_t seed)
    : question_(question),
      record_(question),
      coupled_(question.level->make(question, seed)),
      watch_(watch_interval(question.window())) {
    record_.sample(0, coupled_->cloud());
}

void Live::advance(double until) {
    while (time() < until && !finished() && fault_.empty()) step();
}

int Live::use_threads(int count) {
    const int wanted = threads_for(coupled_->fluid().grid(), count);
    if (wanted != slabs_.count()) coupled_->use(slabs_ = Slabs(wanted));
    return wanted;
}

void Live::save(Bytes& into) const {
    into.clear();
    coupled_->save(into);
    append_bytes(into, means_);
    append_bytes(into, budget_);
    record_.save(into);
}

void Live::restore(std::span<const std::byte> from) {
    coupled_->restore(from);
    take_bytes(from, means_);
    take_bytes(from, budget_);
    record_.restore(from);
    require_possible(from.empty() && steps() <= question_.total_steps());
    const auto& fluid = coupled_->fluid();
    require_possible(fault(fluid, time()).empty());
    require_possible(
        fault(coupled_->cloud(), fluid.time_step(), 1.0 / static_cast<double>(question_.cells), time()).empty());
}

Snapshot Live::snapshot() const {
    Snapshot now = picture(question_, coupled_->cloud());
    const auto& fluid = coupled_->fluid();
    now.fields.push_back(drawn_flow(question_, fluid.velocity(), &fluid.temperature()));
    return now;
}

void Live::step() {
    coupled_->step();
    const auto& fluid = coupled_->fluid();
    const bool sampled = steps() % question_.sample_steps() == 0 || finished();
    std::string thrown =
        fault(coupled_->cloud(), fluid.time_step(), 1.0 / static_cast<double>(question_.cells), time());
    if (sampled || steps() % watch_ == 0 || !thrown.empty()) {  // it may be the fluid that threw the particle
        fault_ = fault(fluid, time());
        if (const auto* solids = coupled_->solids(); solids && fault_.empty())
            fault_ = fault(*solids, fluid.grid(), time());
        if (fault_.empty()) fault_ = std::move(thrown);
        if (!fault_.empty()) return;
    }
    const bool counted = steps() > question_.total_steps() - question_.window();
    if (counted) means_.add(fluid, question_.window());
    if (finished()) record_.set_flow(means_);
    if (const auto* budget = coupled_->budget()) {
        if (counted) budget_.add(*budget, question_.window());
        if (finished()) record_.set_budget(budget_);
    }
    if (const auto limited = coupled_->limited_steps())
        record_.set_limited_share(static_cast<double>(*limited) / static_cast<double>(steps()));
    if (sampled) record_.sample(time(), coupled_->cloud());
}

}  // namespace grainsweep::thermovibration

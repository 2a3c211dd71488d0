#include "solver/scenes/thermovibration/record.hpp"

#include "solver/bytes.hpp"
#include "solver/observables/accumulation.hpp"
#include "solver/observables/flow_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grainsweep::thermovibration {
namespace {

const observables::Box cube{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};

void add_series(Observations& into, const char* name, const std::vector<double>& times,
                const std::vector<double>& values) {
    auto& series = into.series[name];
    for (std::size_t m = 0; m < times.size(); ++m) {
        Sample sample;
        sample.time = times[m];
        sample.value = values[m];
        series.push_back(sample);
    }
}

void add_profile(Observations& into, const char* name, std::span<const coupling::Vec3> positions, int n, int d) {
    auto& series = into.series[name];
    const auto profile = observables::density_profile(positions, cube, n, d);
    for (int m = 0; m < n; ++m) {
        Sample sample;
        sample.bin = (m + 0.5) / n - 0.5;
        sample.value = profile[static_cast<std::size_t>(m)];
        series.push_back(sample);
    }
}

template <class T>
void save_if_any(std::vector<std::byte>& into, const std::optional<T>& value) {
    append_bytes(into, static_cast<std::int64_t>(value.has_value()));
    if (value) append_bytes(into, *value);
}

template <class T>
void restore_if_any(std::span<const std::byte>& from, std::optional<T>& value) {
    std::int64_t any = 0;
    take_bytes(from, any);
    value.reset();
    if (any != 0) take_bytes(from, value.emplace());
}

template <class T>
void restore_column(std::span<const std::byte>& from, std::vector<T>& column) {
    column.resize(take_count(from, sizeof(T)));
    take_bytes<T>(from, column);
}

}  // namespace

void FlowMeans::add(const flow::Flow<flow::Boussinesq>& fluid, std::int64_t window) {
    const auto share = 1 / static_cast<double>(window);
    energy += share * observables::kinetic_energy(fluid.grid(), fluid.velocity());
    nusselt += share * observables::nusselt(fluid.grid(), fluid.temperature(), 2, 1, 0.5);
    peak = std::max(peak, observables::peak_velocity(fluid.grid(), fluid.velocity()));
}

Record::Record(const Question& question) : question_(question) {}

std::size_t Record::sampling_total() const {
    const auto n = static_cast<std::size_t>(question_.sampling_cells);
    return n * n * n;
}

void Record::sample(double t, const coupling::Cloud& cloud) {
    if (cloud.size() < 2) return;
    const auto k = [&](std::int64_t n) {
        return observables::accumulation(observables::cell_counts(cloud.position, cube, static_cast<int>(n)));
    };
    times_.push_back(t);
    k_.push_back(k(question_.sampling_cells));
    k5_.push_back(k(5));
    k20_.push_back(k(20));
    k40_.push_back(k(40));
    k_cells_.push_back(k(question_.cells));
    last_ = cloud.position;
}

void Record::observe(Observations& into) const {
    if (!question_.steady_force())
        into.scalars["gershuni"] = observables::gershuni(question_.prandtl, question_.rayleigh, question_.frequency);
    if (flow_) {
        into.scalars["kinetic_energy"] = flow_->energy;
        into.scalars["nusselt"] = flow_->nusselt;
        into.scalars["peak_velocity"] = flow_->peak;
    }
    if (budget_) {
        into.scalars["force_on_fluid"] = std::sqrt(budget_->given);
        into.scalars["vibrational_force"] = std::sqrt(budget_->drive);
    }
    if (limited_share_) into.scalars["packing_limited"] = *limited_share_;
    if (times_.empty()) return;
    const auto n = static_cast<int>(question_.sampling_cells);
    const double random = observables::random_accumulation(last_.size(), sampling_total());
    into.scalars["accumulation"] = k_.back();
    into.scalars["accumulation_excess"] = (k_.back() - random) / (1 - random);
    const double structures = observables::structures(observables::cell_counts(last_, cube, n), n);
    if (!std::isnan(structures)) into.scalars["structures"] = structures;
    const double scatter = observables::random_accumulation_deviation(last_.size(), sampling_total());
    const double formation = observables::formation_time(times_, k_, scatter);
    if (std::isfinite(formation)) into.scalars["formation_time"] = formation;
    add_series(into, "accumulation_series", times_, k_);
    add_series(into, "accumulation_5", times_, k5_);
    add_series(into, "accumulation_20", times_, k20_);
    add_series(into, "accumulation_40", times_, k40_);
    add_series(into, "accumulation_cells", times_, k_cells_);
    add_profile(into, "density_y", last_, n, 1);
    add_profile(into, "density_z", last_, n, 2);
}

void Record::save(std::vector<std::byte>& into) const {
    save_if_any(into, flow_);
    save_if_any(into, budget_);
    save_if_any(into, limited_share_);
    for (const auto* column : {&times_, &k_, &k5_, &k20_, &k40_, &k_cells_}) ByteWriter(into).put(*column);
    ByteWriter(into).put(last_);
}

void Record::restore(std::span<const std::byte>& from) {
    restore_if_any(from, flow_);
    restore_if_any(from, budget_);
    restore_if_any(from, limited_share_);
    for (auto* column : {&times_, &k_, &k5_, &k20_, &k40_, &k_cells_}) restore_column(from, *column);
    restore_column(from, last_);
    for (const auto* column : {&k_, &k5_, &k20_, &k40_, &k_cells_}) require_possible(column->size() == times_.size());
    require_possible(last_.size() == (times_.empty() ? 0 : static_cast<std::size_t>(question_.particles)));
}

}  // namespace grainsweep::thermovibration

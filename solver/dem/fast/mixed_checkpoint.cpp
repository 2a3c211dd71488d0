#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "solver/dem/fast/mixed_stepping.hpp"

namespace grainsweep::dem::fast {

/// Everything that changes, in one order for writing and reading.
template <class Self, class Archive>
void MixedEngine::pass(Self& self, Archive& archive) {
    archive.value(self.field_.count);
    archive.value(self.field_.inner_count);
    archive.value(self.field_.outer_count);
    archive.value(self.drift_);
    archive.value(self.inner_skin_);
    archive.value(self.space_.skin);
    archive.value(self.tally_);
    archive.value(self.peak_overlap_);
    Watch::pass(self.watch_, archive);
    archive.value(self.wall_steps_);
    archive.value(self.mobile_);
    archive.value(self.work_.steps);
    archive.value(self.work_.particle_steps);
    archive.value(self.work_.resting_steps);
    archive.value(self.work_.pair_visits);
    archive.value(self.work_.rebuilds);
    archive.text(self.fault_);
    archive.list(self.walls_);
    if (self.resting_.wanted()) Resting::pass(self.resting_, archive);
    auto& c = self.columns_;
    const auto particles = static_cast<std::size_t>(self.field_.count) + 3 + self.walls_.size();
    archive.column(c.records, particles);
    archive.column(c.residuals, particles);
    archive.column(c.forces, particles);
    archive.column(c.id, particles);
    const auto outer = static_cast<std::size_t>(self.field_.outer_count) + spare;
    archive.column(c.outer_first, outer);
    archive.column(c.outer_second, outer);
    archive.column(c.outer_reach, outer);
    const auto inner = static_cast<std::size_t>(self.field_.inner_count) + spare;
    archive.column(c.inner_first, inner);
    archive.column(c.inner_second, inner);
    archive.column(c.inner_source, inner);
    archive.column(c.inner_reach, inner);
    archive.column(c.touching, inner / 4);
    for (int a = 0; a < c.histories; ++a) archive.column(c.history[a], inner);
    archive.column(c.segments, self.walls_.size());
    const auto near_walls = self.walls_.empty() ? 0 : static_cast<std::size_t>(c.segments[self.walls_.size() - 1].end);
    archive.column(c.wall_particle, near_walls);
    for (int a = 0; a < c.histories; ++a) archive.column(c.wall_history[a], near_walls);
}

/// Of the case, the same at every step.
Seal MixedEngine::seal() const {
    Constants constants = field_.constants;
    for (std::size_t a = 0; a < 3; ++a) constants.gravity[a] = gravity_in_steps(gravity_[a], space_.scale);
    return make_seal(constants, *kernels_, needs_, shaking_, rest_speed_);
}

void MixedEngine::save(std::vector<std::byte>& into) const {
    Writer writer(into);
    writer.value(seal());
    pass(*this, writer);
}

void MixedEngine::restore(std::span<const std::byte> from) {
    Reader reader(from);
    Seal theirs;
    reader.value(theirs);
    const Seal own = seal();
    if (std::memcmp(&theirs, &own, sizeof own) != 0)
        throw std::invalid_argument("the checkpoint belongs to another setup, instruction path or version");
    pass(*this, reader);
    if (!reader.finished()) throw std::invalid_argument("the checkpoint is longer than its state");
    columns_.hold_particles(size(), walls_.size());
    columns_.hold_pairs(static_cast<std::size_t>(std::max(field_.outer_count, field_.inner_count)) + spare);
    columns_.hold_wall_contacts(size());
    columns_.bind(field_);
    list_advanced();
    place_walls(field_, walls_, space_, wall_time());
    if (shaken_) shake();
}

}  // namespace grainsweep::dem::fast

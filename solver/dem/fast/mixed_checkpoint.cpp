#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "solver/dem/fast/listed_pairs.hpp"
#include "solver/dem/fast/mixed_stepping.hpp"

namespace grainsweep::dem::fast {

/// Everything that changes, in one order for writing and reading.
template <class Self, class Archive>
void MixedEngine::pass(Self& self, Archive& archive) {
    archive.list(self.added_);
    if (self.clumps_.shapes() > 0) {
        Clumps::for_each_column(self.clumps_, [&archive](auto& column) { archive.list(column); });
        archive.list(self.clumps_.fallen);
    }
    archive.value(self.field_.count);
    archive.value(self.field_.inner_count);
    archive.value(self.field_.outer_count);
    archive.value(self.drift_);
    archive.value(self.inner_skin_);
    archive.value(self.space_.skin);
    archive.value(self.tally_);
    archive.value(self.peak_overlap_);
    archive.value(self.peak_wall_overlap_);
    archive.value(self.recent_overlap_);
    archive.value(self.part_);
    Watch::pass(self.watch_, archive);
    archive.value(self.wall_steps_);
    archive.value(self.mobile_);
    archive.value(self.work_.steps);
    archive.value(self.work_.particle_steps);
    archive.value(self.work_.resting_steps);
    archive.value(self.work_.pair_visits);
    archive.value(self.work_.rebuilds);
    archive.text(self.fault_);
    pass_walls(self, archive);
    if (self.resting_.wanted()) Resting::pass(self.resting_, archive);
    auto& c = self.columns_;
    const auto particles = static_cast<std::size_t>(self.field_.count) + fillers;
    archive.column(c.records, particles);
    if (c.residuals_apart) archive.column(c.residuals, particles);
    archive.column(c.forces, particles);
    archive.column(c.id, particles);
    archive.column(c.kind, particles);
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
    archive.column(c.segments, self.walls_.count());
    const auto near_walls =
        self.walls_.count() == 0 ? 0 : static_cast<std::size_t>(c.segments[self.walls_.count() - 1].end);
    archive.column(c.wall_particle, near_walls);
    for (int a = 0; a < c.histories; ++a) archive.column(c.wall_history[a], near_walls);
    WallTouches::pass(self.touches_, archive, c);
}

void MixedEngine::pass_walls(const MixedEngine& self, Writer& archive) {
    self.walls_.save(archive);
}

void MixedEngine::pass_walls(MixedEngine& self, Reader& archive) {
    self.walls_ = Walls::restored(archive, self.space_.domain, self.space_.scale, self.needs_.combination, self.table_,
                                  self.materials_);
}

/// Of the case, the same at every step.
Seal MixedEngine::seal() const {
    Seal s;
    std::memset(static_cast<void*>(&s), 0, sizeof s);
    s.format = checkpoint_format;
    s.width = kernels_->width;
    s.needs.combination = needs_.combination;
    s.needs.unequal = needs_.unequal, s.needs.frozen = needs_.frozen, s.needs.resting = needs_.resting;
    s.needs.skips = needs_.skips, s.needs.several = needs_.several, s.needs.clumps = needs_.clumps;
    std::memcpy(static_cast<void*>(&s.constants), &start_constants_, sizeof s.constants);
    s.shaking = shaking_;
    s.rest_speed = rest_speed_;
    return s;
}

/// Clears unused entries, so that the bytes of a checkpoint depend only on the state. Unused are the entries behind the
/// ends of lists and histories, and the forces on records that pad vectors.
void MixedEngine::clear_spare_entries() const {
    const auto width = static_cast<std::size_t>(kernels_->width), n = static_cast<std::size_t>(field_.inner_count);
    std::size_t contacts = 0;
    for (std::size_t b = 0; b < n / width; ++b) contacts += static_cast<std::size_t>(std::popcount(field_.touching[b]));
    std::size_t k = n;
    while (k > 0 && field_.inner_first[k - 1] >= static_cast<Place>(field_.count * places_per_index)) --k;
    for (; k < n + spare; ++k) {
        field_.inner_first[k] = static_cast<Place>(field_.count * places_per_index);
        field_.inner_second[k] = static_cast<Place>((field_.count + 1) * places_per_index);
        field_.inner_source[k] = 0;
        field_.inner_reach[k] = 0;
    }
    std::fill(field_.touching + n / width, field_.touching + (n + spare) / 4, std::uint16_t{0});
    for (int a = 0; a < columns_.histories; ++a)
        std::fill(field_.history[a] + contacts, field_.history[a] + n + spare, 0.0F);
    std::fill_n(field_.forces + field_.count, 4, Force{});
}

void MixedEngine::save(std::vector<std::byte>& into) const {
    join_lists();
    clear_spare_entries();
    Writer writer(into);
    writer.value(seal());
    writer.list(start_laws_);
    writer.value(control_.state());
    writer.list(control_.lasting());
    pass(*this, writer);
}

/// Refuses impossible states, for any bytes: every index must be valid, and every count must agree with its column. Too
/// fast particles and too large overlaps are found later, by the steps.
void MixedEngine::require_possible() const {
    constexpr auto require = ByteReader::require;
    constexpr std::int64_t most_steps = std::int64_t{1} << 53U;
    const std::int32_t n = field_.count, width = kernels_->width;
    const Columns& c = columns_;
    require(n >= 0 && n <= ids());
    for (const std::uint8_t kind : added_) require(std::ranges::count(to_come_, kind, &ToCome::kind) > 0);
    require(field_.outer_count >= 0 && field_.inner_count >= 0 && field_.inner_count % width == 0);
    require(space_.skin > 0 && space_.skin <= largest_skin_ && (!adapts_skin_ || space_.skin <= 1));
    require(drift_.steps >= 0 && drift_.steps < most_steps && wall_steps_ >= 0 && wall_steps_ < most_steps);
    require(work_.steps >= 0 && work_.steps < most_steps && part_ >= 0 && part_ < control_.parts());
    require(watch_.spheres() == static_cast<std::size_t>(ids()));
    require(touches_.fits(c, walls_.count(), n));
    require(!resting_.wanted() || resting_.fits(n));

    constexpr float rounding = 1e-5F;
    std::vector<bool> known(static_cast<std::size_t>(ids()), false);
    for (std::int32_t i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const std::int32_t id = c.id[k];
        require(id >= 0 && id < ids() && !known[static_cast<std::size_t>(id)]);
        known[static_cast<std::size_t>(id)] = true;
        require(c.kind[k] == (id < spheres_at_start_ ? kinds_[static_cast<std::size_t>(id)]
                                                     : added_[static_cast<std::size_t>(id - spheres_at_start_)]));
        const Record& r = c.records[k];
        require(r.radius >= 0.5F * smallest_diameter_ * (1 - rounding) && r.radius <= 0.5F + rounding);
        require(r.inverse_mass >= 0 &&
                (clumps_.shapes() > 0 ||
                 r.inverse_mass <= (1 + rounding) * lightest_ / (8 * r.radius * r.radius * r.radius)));
    }

    // A list is sorted by its first particles; behind the particles two more fill vectors up.
    const auto listed = [&](const Column<Place>& first, const Column<Place>& second, std::int32_t count) {
        const auto known_place = [&](Place place) {
            return place % places_per_index == 0 && place / places_per_index < static_cast<Place>(n) + 2;
        };
        Place before = 0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
            require(known_place(first[k]) && known_place(second[k]) && first[k] >= before && second[k] > first[k]);
            before = first[k];
        }
    };
    listed(c.outer_first, c.outer_second, field_.outer_count);
    listed(c.inner_first, c.inner_second, field_.inner_count);
    std::int32_t source = -1;
    for (std::size_t k = 0; k < static_cast<std::size_t>(field_.inner_count); ++k) {
        if (c.inner_first[k] == static_cast<Place>(n * places_per_index)) break;  // fills the list up
        require(c.inner_source[k] > source && c.inner_source[k] < field_.outer_count);
        source = c.inner_source[k];
        const auto o = static_cast<std::size_t>(source);
        require(c.inner_first[k] == c.outer_first[o] && c.inner_second[k] == c.outer_second[o]);
    }
    for (std::size_t b = 0; b < static_cast<std::size_t>(field_.inner_count / width); ++b) {
        require(static_cast<std::uint32_t>(c.touching[b]) >> static_cast<unsigned>(width) == 0);
        for (unsigned m = c.touching[b]; m != 0; m &= m - 1) {
            const auto k = b * static_cast<std::size_t>(width) + static_cast<std::size_t>(std::countr_zero(m));
            require(c.inner_source[k] >= 0 && c.inner_source[k] < field_.outer_count);
        }
    }
    std::int32_t end = 0;
    for (std::size_t w = 0; w < walls_.count(); ++w) {
        const WallSegment& s = c.segments[w];
        require(s.begin >= 0 && s.begin <= s.end && s.end >= end && (s.end - s.begin) % width == 0);
        end = s.end;
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(end); ++k)
        require(c.wall_particle[k] % places_per_index == 0 &&
                c.wall_particle[k] / places_per_index < static_cast<Place>(n) + fillers);
}

/// Finds the members of all clumps, and refuses bodies that no step makes.
void MixedEngine::restore_clumps() {
    constexpr auto require = ByteReader::require;
    require(clumps_.possible() && clumps_.fallen.size() == clumps_.size());
    clumps_.derive();
    require(clumps_.map(field_, columns_, *kernels_, static_cast<std::size_t>(ids()), space_.scale));
    for (std::size_t b = 0; b < clumps_.size(); ++b)
        for (const std::int32_t i : clumps_.members(b))
            require(field_.records[i].inverse_mass == static_cast<float>(space_.scale.mass / clumps_.mass[b]));
}

/// Behind a list's end entries are read ahead and never count; let them lead to something, too.
void MixedEngine::tidy_spare_entries() {
    const auto tidy = [this](Column<Place>& places, std::int32_t count) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(spare); ++k) {
            Place& place = places[static_cast<std::size_t>(count) + k];
            if (place % places_per_index != 0 || place / places_per_index > static_cast<Place>(field_.count) + 1)
                place = static_cast<Place>(field_.count * places_per_index);
        }
    };
    for (auto* column : {&columns_.outer_first, &columns_.outer_second}) tidy(*column, field_.outer_count);
    for (auto* column : {&columns_.inner_first, &columns_.inner_second}) tidy(*column, field_.inner_count);
}

void MixedEngine::restore(std::span<const std::byte> from) {
    Reader reader(from);
    Seal theirs;
    reader.value(theirs);
    const Seal own = seal();
    if (std::memcmp(&theirs, &own, sizeof own) != 0)
        throw std::invalid_argument("the checkpoint belongs to another setup, instruction path or version");
    std::vector<double> constants;
    reader.list(constants);
    if (constants != start_laws_) throw std::invalid_argument("the checkpoint belongs to other materials");
    StepControl::State control;
    reader.value(control);
    std::vector<std::uint64_t> lasting;
    reader.list(lasting);
    ByteReader::require(control_.restore(control, std::move(lasting)));
    use_parts();
    subdomains_.drop();
    pass(*this, reader);
    reader.finish();
    require_possible();
    columns_.hold_particles(size(), walls_.count());
    columns_.hold_lists(static_cast<std::size_t>(std::max(field_.outer_count, field_.inner_count)) + spare);
    columns_.hold_wall_contacts(size());
    columns_.bind(field_);
    restore_clumps();
    suit_caches();
    tidy_spare_entries();
    place_fillers(field_);
    field_.fetch_ahead = distance_to_fetch(field_);
    list_advanced();
    stand_walls();
    touches_.restored(field_, columns_, walls_, space_.scale, static_cast<double>(space_.skin) - drift_.outer);
    crossings_.forget();
    if (crossings_.wanted()) list_crossings();
    if (shaken_) shake();
}

}  // namespace grainsweep::dem::fast

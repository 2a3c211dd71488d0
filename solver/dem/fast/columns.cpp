#include "solver/dem/fast/columns.hpp"

#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace grainsweep::dem::fast {

void* allocate(std::size_t bytes) {
    constexpr std::size_t large_page = std::size_t{1} << 21U;
    const std::size_t alignment = bytes >= large_page ? large_page : 64;
    const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
    void* memory = std::aligned_alloc(alignment, rounded);
    if (memory == nullptr) throw std::bad_alloc();
#ifdef __linux__
    if (bytes >= large_page) (void)madvise(memory, rounded, MADV_HUGEPAGE);  // a wish: refusal changes nothing
#endif
    return memory;
}

void give_back(void* memory) noexcept {
    std::free(memory);
}

void PairColumns::bind_pairs(Field& f) const {
    f.inner_first = inner_first.data();
    f.inner_second = inner_second.data();
    f.inner_source = inner_source.data();
    f.inner_reach = inner_reach.data();
    f.touching = touching.data();
    f.touching_next = touching_next.data();
    f.outer_first = outer_first.data();
    f.outer_second = outer_second.data();
    f.outer_reach = outer_reach.data();
    f.outer_touching = outer_touching.data();
    f.histories = histories;
    for (int a = 0; a < histories_at_most; ++a) {
        f.history[a] = history[a].data();
        f.history_next[a] = history_next[a].data();
    }
}

void Columns::bind(Field& f) const {
    bind_pairs(f);
    f.records = records.data();
    f.residuals = residuals.data();
    f.forces = forces.data();
    f.kind = kind.data();
    f.member = member.data();
    f.mobility = mobility.data();
    f.row = row.data();
    f.advanced = advanced.data();
    f.advanced_before = advanced_before.data();
    for (int a = 0; a < histories_at_most; ++a) {
        f.wall_history[a] = wall_history[a].data();
        f.touch_memory[a] = touch_memory[a].data();
    }
    for (int a = 0; a < 3; ++a) {
        f.column[a] = column[a].data();
        f.touch_normal[a] = touch_normal[a].data();
        f.touch_velocity[a] = touch_velocity[a].data();
        f.touch_lever[a] = touch_lever[a].data();
    }
    f.touched = touched.data();
    f.touch_particle = touch_particle.data();
    f.touch_overlap = touch_overlap.data();
    f.column_radius = column_radius.data();
    f.column_mobile = column_mobile.data();
    f.cell_start = cell_start.data();
    f.wall_sums = wall_sums.data();
    f.segments = segments.data();
    f.wall_particle = wall_particle.data();
}

void Columns::hold_particles(std::size_t particles, std::size_t wall_count) {
    const std::size_t n = particles + fillers + spare;
    records.hold(n), records_next.hold(n);
    forces.hold(n);
    if (residuals_apart)
        residuals.hold(n), residuals_next.hold(n);
    else
        forces_next.hold(n);
    id.hold(n), id_next.hold(n);
    kind.hold(n), kind_next.hold(n);
    row.hold(n);
    for (auto& c : column) c.hold(n);
    column_radius.hold(n), column_mobile.hold(n);
    cell_of.hold(n), place.hold(n);
    wall_sums.hold(wall_count), segments.hold(wall_count);
}

void PairColumns::hold_pairs(std::size_t pairs) {
    const std::size_t n = pairs + spare;
    hold_outer(pairs);
    inner_first.hold(n), inner_second.hold(n), inner_source.hold(n), inner_reach.hold(n);
    touching.hold(n), touching_next.hold(n);
    for (int a = 0; a < histories; ++a) history[a].hold(n), history_next[a].hold(n);
}

void PairColumns::hold_outer(std::size_t pairs) {
    const std::size_t n = pairs + spare;
    outer_first.hold(n), outer_second.hold(n), outer_reach.hold(n), outer_touching.hold(n);
}

void Columns::hold_lists(std::size_t pairs) {
    hold_pairs(pairs);
    owner.hold(pairs + spare);
}

void Columns::hold_wall_contacts(std::size_t contacts) {
    wall_particle.hold(contacts + spare);
    for (int a = 0; a < histories; ++a)
        wall_history[a].hold(contacts + spare), wall_history_next[a].hold(contacts + spare);
}

void Columns::hold_touches(std::size_t touches) {
    const std::size_t n = touches + spare;
    touch_particle.hold(n), touch_overlap.hold(n);
    for (int a = 0; a < 3; ++a) touch_normal[a].hold(n), touch_velocity[a].hold(n), touch_lever[a].hold(n);
    for (int a = 0; a < histories; ++a) touch_memory[a].hold(n), touch_memory_next[a].hold(n);
}

void PairColumns::swap_histories(Field& f) {
    touching.swap(touching_next);
    for (int a = 0; a < histories; ++a) history[a].swap(history_next[a]);
    bind_pairs(f);
}

}  // namespace grainsweep::dem::fast

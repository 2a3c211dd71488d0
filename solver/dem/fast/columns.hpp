// Memory of a Field: aligned columns that grow at list rebuilds only, named once for checkpoints.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "solver/dem/fast/layout.hpp"

namespace grainsweep::dem::fast {

/// Allocates memory on a page boundary, with large pages for large sizes if the system grants them. A sweep uses so
/// many columns that small pages would miss the translation buffers.
[[nodiscard]] void* allocate(std::size_t bytes);
void give_back(void* memory) noexcept;

/// Array of trivial values on a cache-line boundary. Growing keeps the entries; new ones are zero.
template <class T>
requires std::is_trivially_copyable_v<T>
class Column {
public:
    Column() = default;
    Column(const Column&) = delete;
    Column& operator=(const Column&) = delete;
    ~Column() { release(); }

    void hold(std::size_t count) {
        if (count <= capacity_) return;
        const std::size_t wanted = count + count / 4;
        auto* fresh = static_cast<T*>(allocate(wanted * sizeof(T)));
        if (data_ != nullptr) std::memcpy(static_cast<void*>(fresh), data_, capacity_ * sizeof(T));
        std::memset(static_cast<void*>(fresh + capacity_), 0, (wanted - capacity_) * sizeof(T));
        release();
        data_ = fresh;
        capacity_ = wanted;
    }
    void clear(std::size_t count) { std::memset(static_cast<void*>(data_), 0, count * sizeof(T)); }
    void swap(Column& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(capacity_, other.capacity_);
    }
    [[nodiscard]] T* data() const { return data_; }
    [[nodiscard]] std::size_t capacity() const { return capacity_; }
    T& operator[](std::size_t i) { return data_[i]; }
    const T& operator[](std::size_t i) const { return data_[i]; }

private:
    void release() { give_back(data_); }
    T* data_ = nullptr;
    std::size_t capacity_ = 0;
};

/// Inner list, outer list and contacts of one range of particles.
struct PairColumns {
    std::int32_t histories = 0;  ///< history columns in use; the others stay empty
    Column<Place> inner_first, inner_second;
    Column<std::int32_t> inner_source;
    Column<float> inner_reach;
    Column<std::uint16_t> touching, touching_next;
    Column<float> history[histories_at_most], history_next[histories_at_most];

    Column<Place> outer_first, outer_second;
    Column<float> outer_reach;
    Column<std::uint16_t> outer_touching;

    /// Points the lists of the field at these columns.
    void bind_pairs(Field& f) const;
    /// Makes room for `pairs` in both lists.
    void hold_pairs(std::size_t pairs);
    /// Makes room for `pairs` in the outer list alone.
    void hold_outer(std::size_t pairs);
    /// Makes the histories that a sweep wrote the input of the next sweep.
    void swap_histories(Field& f);
};

/// All columns of a Field, and those used only by a rebuild.
struct Columns : PairColumns {
    float exchanged[histories_at_most] = {};  ///< factors of histories when the two particles of a contact are
                                              ///< exchanged
    Column<Record> records, records_next;
    bool residuals_apart = true;  ///< true if radii differ; otherwise forces are sorted together with the records
    Column<Residual> residuals, residuals_next;
    Column<Force> forces, forces_next;
    Column<std::int32_t> id, id_next;
    Column<std::uint8_t> kind, kind_next;
    Column<std::int32_t> member;  ///< where there are clumps, see Field
    Column<Mobility> mobility;    ///< likewise

    Column<std::int32_t> row;
    Column<std::int32_t> column[3];
    Column<float> column_radius, column_mobile;
    Column<std::int32_t> cell_start, cell_of, place;  ///< place: where a particle went, -1: removed
    Column<std::int32_t> cell_counts;                 ///< of one part after the other
    Column<std::int32_t> advanced, advanced_before;   ///< used if some particles are held, see Field
    Column<std::int32_t> owner;  ///< old contact of an outer pair, plus one; negative: first and second were exchanged

    Column<WallSums> wall_sums;
    Column<WallSegment> segments;
    Column<Place> wall_particle;
    Column<float> wall_history[histories_at_most], wall_history_next[histories_at_most];
    Column<WallSegment> touched;
    Column<Place> touch_particle;
    Column<float> touch_overlap, touch_normal[3], touch_velocity[3], touch_lever[3];
    Column<float> touch_memory[histories_at_most], touch_memory_next[histories_at_most];

    /// Points the field at the columns.
    void bind(Field& f) const;
    /// Makes room for `particles` and `walls`.
    void hold_particles(std::size_t particles, std::size_t walls);
    /// Makes room for `pairs`, including the columns used only by a rebuild.
    void hold_lists(std::size_t pairs);
    void hold_wall_contacts(std::size_t contacts);
    void hold_touches(std::size_t touches);
    /// Lists the particles that are advanced: all except those with is_held(index).
    template <class IsHeld>
    void list_advanced(Field& f, IsHeld is_held) {
        const auto n = static_cast<std::size_t>(f.count);
        advanced.hold(n);
        advanced_before.hold(n + 1);
        std::int32_t count = 0;
        for (std::int32_t i = 0; i < f.count; ++i) {
            advanced_before[static_cast<std::size_t>(i)] = count;
            if (!is_held(i)) advanced[static_cast<std::size_t>(count++)] = i;
        }
        advanced_before[n] = count;
        bind(f);
    }
};

}  // namespace grainsweep::dem::fast

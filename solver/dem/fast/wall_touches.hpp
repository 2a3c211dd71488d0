// Contacts with walls that a particle may touch in several places at once: found one particle after the other in
// double precision, in the order of the lists. What they remember goes on by their normals
// (geometry/contact_memory.hpp). The laws are evaluated as at all other walls (wall_contacts.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "solver/dem/fast/checkpoint.hpp"
#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/walls.hpp"

namespace grainsweep::dem::fast {

class WallTouches {
public:
    /// New walls: nothing is touched yet.
    void begin(Field& field, Columns& columns, const Walls& walls);
    /// Where the walls are touched now, by the lists there are; contacts keep their memories.
    void find(Field& field, Columns& columns, const Walls& walls, const Scale& scale);
    /// A wall without an inside pushes on what has passed it. A centre that did so in the step that ended at `time`, by
    /// what find() found; one that did is no farther from the wall than they moved.
    struct Passage {
        std::int32_t particle, wall;
    };
    [[nodiscard]] std::optional<Passage> passage(const Field& field, const Walls& walls, const Scale& scale,
                                                 double time);
    /// After the particles were sorted: those of columns.place; contacts of removed ones end.
    void reorder(Field& field, Columns& columns);

    /// Everything that changes; the first of its memories in columns.touch_memory.
    template <class Archive>
    static void pass(auto& self, Archive& archive, auto& columns) {
        archive.list(self.segment_);
        archive.list(self.particle_);
        archive.list(self.normal_);
        for (int a = 0; a < columns.histories; ++a) archive.column(columns.touch_memory[a], self.particle_.size());
    }
    /// Whether this can be of `walls` walls and `particles` particles.
    [[nodiscard]] bool fits(std::size_t walls, std::int32_t particles) const;
    /// After a state was read.
    void restored(Field& field, Columns& columns) const;

private:
    void gather_near(const Field& field, std::size_t wall, const Scale& scale);
    void inherit(const MovingWall& wall, const WallSegment& old, Columns& columns);
    void write(Columns& columns, const MovingWall& wall, const Scale& scale);
    void publish(Field& field, Columns& columns) const;

    std::vector<WallSegment> segment_;    // of each wall, of the following
    std::vector<std::int32_t> particle_;  // ascending in a segment
    std::vector<Vec3> normal_;
    // Of one call.
    std::vector<std::int32_t> particle_before_;
    std::vector<Vec3> normal_before_;
    std::vector<std::uint32_t> near_;
    std::vector<Vec3> position_;
    std::vector<double> radius_;
    std::vector<WallTouch> now_, one_before_;
    std::vector<std::int32_t> from_;
};

}  // namespace grainsweep::dem::fast

// Clumps of the mixed engine: states of bodies in SI and double precision; members are records like others.
//
// A sweep adds the forces on the members and does not advance them. After it, every body sums its members' forces in
// the order of its shape, steps, and writes places, velocities and spins of its members: positions exact to a unit,
// with the rest as residual. A kernel does so for a batch of bodies at a time, one per lane (clump_lanes.hpp). Bodies
// do not depend on each other, so no bit depends on the number of threads.
#pragma once

#include "solver/dem/body_columns.hpp"
#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/parts.hpp"
#include "solver/dem/fast/scale.hpp"
#include "solver/dem/reading.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::dem::fast {

class Clumps : public BodyColumns {
public:
    using BodyColumns::BodyColumns;

    std::vector<double> fallen;  ///< by body: work of gravity since it was last taken, J

    /// Appends bodies whose `first` counts from this id.
    void append(std::span<const Body> bodies, std::size_t id);
    /// Finds the members among the records by their ids, all below `ids`, and writes their numbers to the columns.
    /// Returns whether all are there.
    [[nodiscard]] bool map(Field& field, Columns& columns, const Kernels& kernels, std::size_t ids, const Scale& scale);
    /// Sorts the bodies by their shapes, so that those of a batch have as many members, and by the records of their
    /// first members, so that neighbours in space are neighbours in memory.
    void sort(const Field& field, const Columns& columns, std::size_t ids);
    /// Removes the bodies of which members are among the removed spheres, or whose centres are beyond an open face.
    /// Appends the ids of all their members to `removed`. Moves centres by periods into the domain.
    void take_out(const geometry::Domain& domain, std::vector<std::int32_t>& removed);

    /// Returns the members of a body, as places in the records, in the order of its shape.
    [[nodiscard]] std::span<const std::int32_t> members(std::size_t body) const {
        return std::span(record_).subspan(static_cast<std::size_t>(begin_[body]),
                                          static_cast<std::size_t>(begin_[body + 1] - begin_[body]));
    }
    /// Returns the body of a record; -1: it is none's.
    [[nodiscard]] std::int32_t body_of(const Field& field, std::int32_t record) const {
        return field.member == nullptr || field.member[record] < 0
                   ? -1
                   : body_[static_cast<std::size_t>(field.member[record])];
    }
    [[nodiscard]] Vec3 lever_at(const Field& field, std::int32_t record) const {
        const auto member = static_cast<std::size_t>(field.member[record]);
        const auto body = static_cast<std::size_t>(body_[member]);
        return lever_of(body, member - static_cast<std::size_t>(begin_[body]));
    }

    /// Sums forces and torques of the members of all bodies.
    void gather(const Field& field, const Scale& scale);
    /// Steps all bodies by the forces on their members, which are cleared. Adds the extremes of the members' motions to
    /// the tally.
    void advance(Field& field, const Kernels& kernels, const Scale& scale, const Vec3& gravity,
                 const Vec3& acceleration, const Parts& parts, Tally& tally);
    /// Changes velocities by a share of a step's change, after gather(), and sets spins, which no step does.
    void shift(double share, double step, const Vec3& acceleration);
    /// Writes velocities and spins of all members.
    void write_motions(Field& field, const Scale& scale) const;

    /// Returns the motion of a member's body at the half step before (share 0) up to the full step (1).
    struct Motion {
        Vec3 velocity{}, momentum{}, spin{};
    };
    [[nodiscard]] Motion motion(const Field& field, const Scale& scale, std::size_t body, double share,
                                const Vec3& acceleration) const;

private:
    void batch_up(const Field& field, std::int32_t width, const Scale& scale);
    void append_lanes(const Field& field, const ClumpBatch& batch, std::int32_t width, const Scale& scale);
    [[nodiscard]] ClumpView view(const Scale& scale);
    [[nodiscard]] std::pair<Vec3, Vec3> sums(const Field& field, const Scale& scale, std::size_t body) const;

    std::vector<std::int32_t> begin_, record_, body_;  ///< of bodies; of members: their record, their body
    std::vector<ClumpBatch> batches_;
    // Columns by lane, and by member and lane, see ClumpView.
    std::vector<double> lane_mass_, lane_inverse_mass_, lane_inverse_inertia_[3], row_at_[3];
    std::vector<float> lane_turning_[3], lane_reach_, lane_single_mass_;
    std::vector<float> row_single_at_[3], row_radius_, row_inverse_radius_;
    std::vector<Place> slot_place_;
    std::vector<Tally> tallies_;
};

}  // namespace grainsweep::dem::fast

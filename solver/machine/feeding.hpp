// Particles added while a machine runs, in batches at equal times.
//
// What a feed owes is rate times time; a batch adds particles, each at a random place in the region where it overlaps
// no other one and no wall, until the owed mass is reached. A particle that finds no place waits, so a blocked feed
// adds less than it owes and the difference shows. Draws are addressed by (seed, feed, number of the particle, try).
#pragma once

#include "solver/bytes.hpp"
#include "solver/machine/filling.hpp"
#include "solver/machine/spec.hpp"

#include <cstdint>
#include <vector>

namespace grainsweep::machine {

class Feeder {
public:
    Feeder(const Spec& spec, std::size_t feed, std::uint64_t seed);

    /// Throws std::invalid_argument with one sentence where its largest particle has no place in the region, because of
    /// the domain or of walls that stay where they are in all phases of the feed.
    void require_room() const;
    /// Adds `seconds` of its rate to what it owes; less than none where a phase ends before its time.
    void owe(double seconds) { owed_ += feed().rate * seconds; }
    /// Returns the particles that find a place among the present particles, among walls as they stand at a time, and
    /// before one another.
    [[nodiscard]] Filled batch(const dem::State& state, const std::vector<dem::Wall>& walls, double time);
    [[nodiscard]] double fed() const { return fed_; }              ///< kg
    [[nodiscard]] double waiting() const { return owed_ - fed_; }  ///< kg; up to one particle below 0

    void save(ByteWriter& out) const { out.put(owed_), out.put(fed_), out.put(number_); }
    void restore(ByteReader& in) { in.get(owed_), in.get(fed_), in.get(number_); }

private:
    [[nodiscard]] const Feed& feed() const { return spec_.feeds[feed_]; }
    /// The n-th place of a series of random ones.
    [[nodiscard]] Vec3 place(const Draws& draws, std::uint64_t series, std::uint64_t n) const;
    /// Whether a sphere there lies in the region, its centre in the domain, and touches no wall.
    [[nodiscard]] bool fits(const Obstacles& obstacles, const Vec3& centre, double radius) const;

    const Spec& spec_;
    std::size_t feed_;
    std::uint64_t seed_;
    double largest_ = 0;
    double owed_ = 0, fed_ = 0;
    std::uint64_t number_ = 0;  // of the next particle
};

}  // namespace grainsweep::machine

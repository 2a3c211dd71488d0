// Feeds: particles added while a machine runs, in batches at equal times.
//
// The target mass of a feed is rate times time. A batch adds particles until the target is reached, each at a random
// place in the region without overlap with a particle or a wall. A particle without a place waits, so a blocked feed
// adds less than its target; the difference is reported. Draws are addressed by (seed, feed, number of the particle,
// try).
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

    /// Throws std::invalid_argument with one sentence if its largest particle has no place in the region. Considered
    /// are the domain and the walls that never move and are present in all phases of the feed.
    void require_room() const;
    /// Adds `seconds` times its rate to the target mass; negative if a phase ends before its time.
    void owe(double seconds) { owed_ += feed().rate * seconds; }
    /// Returns the particles that find a place between the present particles, the walls at a time, and each other.
    [[nodiscard]] Filled batch(const dem::State& state, const std::vector<dem::Wall>& walls, double time);
    [[nodiscard]] double fed() const { return fed_; }              ///< kg
    [[nodiscard]] double waiting() const { return owed_ - fed_; }  ///< kg; up to one particle below 0

    void save(ByteWriter& out) const { out.put(owed_), out.put(fed_), out.put(number_); }
    void restore(ByteReader& in) { in.get(owed_), in.get(fed_), in.get(number_); }

private:
    [[nodiscard]] const Feed& feed() const { return spec_.feeds[feed_]; }
    /// Returns the n-th place of a random series.
    [[nodiscard]] Vec3 place(const Draws& draws, std::uint64_t series, std::uint64_t n) const;
    /// Returns whether a sphere lies in the region, has its centre in the domain, and touches no wall.
    [[nodiscard]] bool fits(const Obstacles& obstacles, const Vec3& centre, double radius) const;

    const Spec& spec_;
    std::size_t feed_;
    std::uint64_t seed_;
    double largest_ = 0;
    double owed_ = 0, fed_ = 0;
    std::uint64_t number_ = 0;  // of the next particle
};

}  // namespace grainsweep::machine

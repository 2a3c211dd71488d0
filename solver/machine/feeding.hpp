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

    /// Adds `seconds` of its rate to what it owes.
    void owe(double seconds) { owed_ += feed().rate * seconds; }
    /// Returns the particles that find a place among those of the state and before one another.
    [[nodiscard]] Filled batch(const dem::State& state);
    [[nodiscard]] double fed() const { return fed_; }              ///< kg
    [[nodiscard]] double waiting() const { return owed_ - fed_; }  ///< kg; up to one particle below 0

    void save(ByteWriter& out) const { out.put(owed_), out.put(fed_), out.put(number_); }
    void restore(ByteReader& in) { in.get(owed_), in.get(fed_), in.get(number_); }

private:
    [[nodiscard]] const Feed& feed() const { return spec_.feeds[feed_]; }

    const Spec& spec_;
    std::size_t feed_;
    std::uint64_t seed_;
    double largest_ = 0;
    double owed_ = 0, fed_ = 0;
    std::uint64_t number_ = 0;  // of the next particle
};

}  // namespace grainsweep::machine

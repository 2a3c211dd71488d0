// Particles that a probe counts: by species, and by the region that contains the centre; of a passage through a plane,
// the place where the centre passes. Glued particles are part of a wall.
#pragma once

#include "solver/machine/probe.hpp"

#include <algorithm>
#include <array>

namespace grainsweep::machine {

inline constexpr Field of_option = option("of", Field::Kind::species, "", "the species that count; default: all");
inline constexpr Field in_option =
    option("in", Field::Kind::region, "", "the region in which centres count; default: everywhere");

class Selection {
public:
    explicit Selection(const Options& options) : of_(options.numbers("of")), in_(options.region("in")) {}

    [[nodiscard]] bool species_counts(const Frame& frame, std::size_t i) const {
        return of_.empty() || std::ranges::find(of_, frame.species_of(i)) != of_.end();
    }
    [[nodiscard]] bool holds(const Frame& frame, std::size_t i) const {
        return frame.state.mobile[i] != 0 && species_counts(frame, i) &&
               (!in_ || in_->contains(frame.state.position[i]));
    }
    [[nodiscard]] bool holds(const Frame& frame, const Passage& passage) const {
        return (of_.empty() || std::ranges::find(of_, frame.species[passage.id]) != of_.end()) &&
               (!in_ || in_->contains(passage.position));
    }
    /// Calls visit(i) for every particle that counts.
    template <class Visit>
    void each(const Frame& frame, Visit&& visit) const {
        for (std::size_t i = 0; i < frame.size(); ++i)
            if (holds(frame, i)) visit(i);
    }
    [[nodiscard]] const std::optional<Region>& region() const { return in_; }

private:
    std::vector<std::size_t> of_;
    std::optional<Region> in_;
};

}  // namespace grainsweep::machine

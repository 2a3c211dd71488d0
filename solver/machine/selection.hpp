// Species, walls and particles that a probe counts. Particles are selected by species or name, and by the region that
// contains the centre; of a passage through a plane, the place where the centre passes. Glued particles are part of a
// wall, unless they are selected by name.
#pragma once

#include "solver/machine/probe.hpp"

#include <algorithm>
#include <array>

namespace grainsweep::machine {

inline constexpr Field species_option = option("of", Field::Kind::species, "", "the species that count; default: all");
inline constexpr Field of_option =
    option("of", Field::Kind::particles, "", "the species, or single particles by name, that count; default: all");
inline constexpr Field in_option =
    option("in", Field::Kind::region, "", "the region in which centres count; default: everywhere");

inline constexpr Field walls_option = option("wall", Field::Kind::walls, "", "the wall, or a list of walls", true);
inline constexpr Field only_walls_option =
    option("wall", Field::Kind::walls, "", "only contacts with this wall, or these; default: all contacts");

/// Species of the option "of"; none given: all.
class SelectedSpecies {
public:
    explicit SelectedSpecies(const Options& options) : of_(options.numbers("of")) {}
    [[nodiscard]] bool hold(const Frame& frame, std::size_t id) const {
        return of_.empty() || std::ranges::find(of_, frame.species[id]) != of_.end();
    }
    [[nodiscard]] bool hold(const Frame& frame, std::int32_t sphere) const {
        return hold(frame, static_cast<std::size_t>(sphere));
    }

private:
    std::vector<std::size_t> of_;
};

/// Walls of the option "wall".
class SelectedWalls {
public:
    explicit SelectedWalls(const Options& options) : numbers_(options.numbers("wall")), given_(options.has("wall")) {}

    /// Returns whether a case has none of the walls: each may be left out by its "when".
    [[nodiscard]] bool none() const { return numbers_.empty(); }
    /// Returns whether a contact is with one of the walls.
    [[nodiscard]] bool touch(const dem::ContactForce& contact) const {
        return contact.second < 0 &&
               std::ranges::find(numbers_, static_cast<std::size_t>(-1 - contact.second)) != numbers_.end();
    }
    /// Returns the same; where the option is left out, every contact counts.
    [[nodiscard]] bool admit(const dem::ContactForce& contact) const { return !given_ || touch(contact); }
    /// Returns the sum of value(w) over their numbers; undefined without any.
    template <class Value>
    [[nodiscard]] double sum(Value&& value) const {
        double total = none() ? undefined : 0;
        for (const std::size_t w : numbers_) total += value(w);
        return total;
    }

private:
    std::vector<std::size_t> numbers_;
    bool given_;
};

class Selection {
public:
    explicit Selection(const Options& options) : of_(options.particles("of")), in_(options.region("in")) {}

    /// Returns whether a particle counts by its species or name.
    [[nodiscard]] bool is_of(const Frame& frame, std::size_t id) const {
        if (of_.species.empty() && of_.named.empty()) return true;
        if (std::ranges::find(of_.species, frame.species[id]) != of_.species.end()) return true;
        return is_named(frame, id);
    }
    /// Returns holds(frame, i) as a function of i, for many particles of one frame.
    [[nodiscard]] auto at(const Frame& frame) const {
        return [this, &frame, all = of_.species.empty() && of_.named.empty(), in = now(in_)](std::size_t i) {
            if (in && !in->contains(frame.state.position[i])) return false;
            if (frame.state.mobile[i] != 0) return all || is_of(frame, frame.id(i));
            return !of_.named.empty() && is_named(frame, frame.id(i));
        };
    }
    [[nodiscard]] bool holds(const Frame& frame, std::size_t i) const { return at(frame)(i); }
    [[nodiscard]] bool holds(const Frame& frame, const Passage& passage) const {
        return is_of(frame, passage.id) && (!in_ || in_->contains(passage.position));
    }
    /// Calls visit(i) for every particle that counts.
    template <class Visit>
    void each(const Frame& frame, Visit&& visit) const {
        const auto here = at(frame);
        for (std::size_t i = 0; i < frame.size(); ++i)
            if (here(i)) visit(i);
    }
    /// Returns the mean of value(i) over the particles that count, weighted by volume; undefined: there are none.
    template <class Value>
    [[nodiscard]] double mean_by_volume(const Frame& frame, Value&& value) const {
        double moment = 0, volume = 0;
        each(frame, [&](std::size_t i) {
            moment += frame.volume(i) * value(i);
            volume += frame.volume(i);
        });
        return volume > 0 ? moment / volume : undefined;
    }
    [[nodiscard]] const std::optional<Region>& region() const { return in_; }

private:
    [[nodiscard]] bool is_named(const Frame& frame, std::size_t id) const {
        return std::ranges::any_of(of_.named, [&](std::size_t name) {
            return frame.particle_of(static_cast<std::int32_t>(id)) == frame.named[name];
        });
    }

    SelectedParticles of_;
    std::optional<Region> in_;
};

/// Probe whose value is a function of the frame and of the particles in it that count.
template <double (*value)(const Frame&, const Selection&)>
class SelectionProbe final : public Probe {
public:
    explicit SelectionProbe(const Options& options) : selection_(options) {}
    double look(const Frame& frame) override { return value(frame, selection_); }

private:
    Selection selection_;
};

}  // namespace grainsweep::machine

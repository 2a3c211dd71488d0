// Parallel addition of the contributions of many particles to one field. Each thread owns some planes of the field,
// visits all particles and adds to its own planes. So every value is summed in the order of the particles, with any
// number of threads. The planes are divided so that each thread has about the same number of particles.
#pragma once

#include "solver/coupling/each.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace grainsweep::coupling {

class PlaneCuts {
public:
    /// Makes the division. touched(p): planes to which particle p adds, in a field of `planes` planes.
    template <class Touched>
    void make(std::size_t particles, int planes, const Slabs& slabs, Touched touched) {
        particles_ = particles;
        if (slabs.count() == 1) return;
        touched_.resize(particles);
        each_of(particles, slabs, [&](std::size_t p) { touched_[p] = touched(p); });
        counts_.assign(static_cast<std::size_t>(planes), 0);
        for (const auto& range : touched_) ++counts_[static_cast<std::size_t>(std::clamp(range.first, 0, planes - 1))];
        const auto parts = static_cast<std::size_t>(slabs.count());
        cuts_.assign(parts + 1, planes);
        cuts_[0] = 0;
        std::size_t before = 0, part = 1;
        for (int k = 0; k < planes && part < parts; ++k) {
            before += counts_[static_cast<std::size_t>(k)];
            while (part < parts && before * parts >= particles * part) cuts_[part++] = k + 1;
        }
    }

    /// Calls add(p, own) for particles in their order; `add` must add only to the planes `own`.
    template <class Add>
    void each(const Slabs& slabs, Add add) const {
        if (slabs.count() == 1) {
            for (std::size_t p = 0; p < particles_; ++p) add(p, flow::Planes{});
            return;
        }
        slabs.each([&](int slab) {
            const auto s = static_cast<std::size_t>(slab);
            const flow::Planes own{cuts_[s], cuts_[s + 1] - 1};
            for (std::size_t p = 0; p < particles_; ++p)
                if (touched_[p].first <= own.last && touched_[p].last >= own.first) add(p, own);
        });
    }

private:
    std::size_t particles_ = 0;
    std::vector<flow::Planes> touched_;
    std::vector<std::size_t> counts_;  // particles by their first plane
    std::vector<int> cuts_;            // first plane of each slab, and the end
};

}  // namespace grainsweep::coupling

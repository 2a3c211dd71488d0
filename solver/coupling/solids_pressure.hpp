// Particles as a dense phase: their interaction is a solids pressure (DDPM).
//
// Force per volume of a sphere, in addition to the force of the fluid:
//   a = -(1/phi_p) grad p_s,   p_s = xi phi_p Theta (1 + 2 (1 + e) phi_p g0)                 (granular.hpp)
// (Popoff & Braun 2007, "A Lagrangian approach to dense particulate flows", ICMF). The packing limit applies in
// addition (packing_limit.hpp). The type of Theta is a template argument: granular_temperature.hpp. Below the fraction
// of two particles at one place, far from walls, there are no collisions and no stress. The displacement by the stress
// in one step is limited to a tenth of a cell.
#pragma once

#include "solver/coupling/each.hpp"
#include "solver/coupling/granular_temperature.hpp"
#include "solver/coupling/march.hpp"
#include "solver/coupling/packing_limit.hpp"

#include <algorithm>
#include <cstdint>

namespace grainsweep::coupling {

/// Advances particles without contacts, stores their reaction in `transmitted`, and reflects them at walls. push(p):
/// force per volume in addition to the force of the fluid.
template <class Motion, class Around, class Push>
void advance_free(Cloud& cloud, const Motion& motion, const Walls& walls, const Around& around, Push push,
                  std::vector<Vec3>& transmitted, const Slabs& slabs) {
    const double inertia = motion.sphere().density_ratio / motion.time_step();
    const auto pushed = [&](std::size_t p) {
        Surroundings here = around(p);
        here.other = transmitted[p] = push(p);
        return here;
    };
    const auto moved = [&](std::size_t p, const Vec3& before) {
        Vec3& v = cloud.velocity[p];
        for (std::size_t d = 0; d < 3; ++d) transmitted[p][d] -= inertia * (v[d] - before[d]);
        walls.apply(cloud.position[p], v);
    };
    march_all(cloud, motion, around.vibration, pushed, moved, slabs);
}

template <class Temperature>
class SolidsPressure {
public:
    SolidsPressure(const flow::Grid& grid, const flow::Sides& sides, const Sphere& sphere, const Granular& grains,
                   double least_temperature, double kernel_width, Hats hats = Hats::linear)
        : grid_(grid),
          grains_(grains),
          thinnest_(2 * lone_fraction(grid, sphere.volume(), kernel_width)),
          volume_(sphere.volume()),
          deposit_(grid, sides, kernel_width, hats),
          mobility_(sphere.stokes / sphere.prandtl),
          limit_(grid, sides, grains.packing_limit),
          packed_(grid, sides, sphere.volume(), 2 * sphere.radius()),
          temperature_(grid, grains, {least_temperature, 1e12, thinnest_}),
          straining_(grid),
          mean_velocity_{flow::Field(grid), flow::Field(grid), flow::Field(grid)},
          pressure_(grid),
          stress_(flow::face_vectors(grid)) {
        smallest_ = 1;
        for (int d = 0; d < 3; ++d)
            for (int i = 1; i <= grid.cells(d); ++i) smallest_ = std::min(smallest_, grid[d].width(i));
    }

    /// Sets the threads that compute; no bit depends on their number.
    void use(const Slabs& slabs) {
        slabs_ = slabs;
        deposit_.use(slabs);
        limit_.use(slabs);
        packed_.use(slabs);
        temperature_.use(slabs);
        straining_.use(slabs);
    }

    /// Advances every particle; `around(p)` is the fluid at stencils[p]. transmitted[p]: stress minus inertia of the
    /// particle, per volume.
    template <class Motion, class Stencils, class Around>
    void move(Cloud& cloud, const Motion& motion, const Walls& walls, SolidsVolume& solids, const Stencils& stencils,
              const Around& around, std::vector<Vec3>& transmitted) {
        stepped_ = true;
        find_stress(cloud, solids, stencils, motion.time_step());
        const double most = 0.1 * smallest_ / (mobility_ * motion.time_step());
        const auto push = [&](std::size_t p) {
            if (!stressed_) return Vec3{};
            Vec3 force = stencils[p].gather(stress_);
            for (double& component : force) component = std::clamp(component, -most, most);
            return force;
        };
        advance_free(cloud, motion, walls, around, push, transmitted, slabs_);
    }

    /// Applies the packing limit after walls. `solids` then has the final positions.
    void settle(Cloud& cloud, const Walls& walls, SolidsVolume& solids) {
        packed_.place(cloud.position);
        if (limit_.restore(cloud.position, walls, packed_) == 0) return;
        solids.place(cloud.position);
        if (stepped_) ++limited_;
    }

    /// Returns the number of steps in which the packing limit moved particles.
    [[nodiscard]] std::int64_t limited_steps() const { return limited_; }

    void save(std::vector<std::byte>& into) const {
        temperature_.save(into);
        append_bytes(into, limited_);
    }
    void restore(std::span<const std::byte>& from) {
        temperature_.restore(from);
        take_bytes(from, limited_);
    }

private:
    // Computes the stress. It is divided by the particles' own fraction on a face, and spread and gathered in the same
    // way as this fraction was deposited. So the sum over the particles equals the sum of -grad p_s over the faces.
    template <class Stencils>
    void find_stress(const Cloud& cloud, SolidsVolume& solids, const Stencils& stencils, double dt) {
        stressed_ = solids.largest_fraction() > thinnest_;
        if (!stressed_) {
            temperature_.rest(solids);
            return;
        }
        solids.mean(cloud.velocity, mean_velocity_);
        straining_.measure(grid_, solids.fraction(), mean_velocity_, thinnest_);
        temperature_.advance(solids, straining_, dt);
        const flow::Field& fraction = solids.fraction();
        each_of(fraction.size(), slabs_, [&](std::size_t m) {
            const double a = fraction.data()[m];
            pressure_.data()[m] = a > thinnest_ ? grains_.pressure(a) * temperature_.values().data()[m] : 0;
        });
        FaceDeposit::clear(stress_, slabs_);
        cuts_.make(stencils.size(), grid_.cells(2) + 2, slabs_, [&](std::size_t p) { return stencils[p].planes(); });
        cuts_.each(slabs_, [&](std::size_t p, const flow::Planes& own) {
            stencils[p].scatter({volume_, volume_, volume_}, stress_, own);
        });
        deposit_.spread(stress_);
        for (int d = 0; d < 3; ++d) find_stress_along(d);
        deposit_.spread_transposed(stress_);
    }
    // Computes component d from the fraction on the faces in stress_.
    void find_stress_along(int d) {
        flow::Field& stress = stress_[static_cast<std::size_t>(d)];
        const auto stride = stress.stride(d);
        each_cell(grid_, slabs_, [&, stride](int i, int j, int k) {
            const auto here = stress.index(i, j, k);
            const double difference = pressure_.data()[here] - pressure_.data()[here - stride];
            const int face = d == 0 ? i : d == 1 ? j : k;
            double& value = stress.data()[here];
            value = difference == 0 || !(value > 0) ? 0 : -difference / (grid_[d].spacing(face) * value);
        });
    }

    flow::Grid grid_;
    Granular grains_;
    double thinnest_;
    double volume_;
    FaceDeposit deposit_;
    double mobility_;
    double smallest_ = 1;
    PackingLimit limit_;
    SolidsVolume packed_;  // used by the limit only
    Temperature temperature_;
    Straining straining_;
    std::array<flow::Field, 3> mean_velocity_;
    flow::Field pressure_;
    flow::FaceVectors stress_;
    PlaneCuts cuts_;
    Slabs slabs_;
    bool stressed_ = false;
    bool stepped_ = false;  // false at the start, which does not count as a step
    std::int64_t limited_ = 0;
};

}  // namespace grainsweep::coupling

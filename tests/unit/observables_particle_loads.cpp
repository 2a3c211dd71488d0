#include "solver/observables/particle_loads.hpp"

#include <gtest/gtest.h>

namespace grainsweep::tests::observables_particle_loads_test {

TEST(ParticleLoads, AddUpPerParticleAndCancelOverall) {
    dem::State state;
    state.id = {2, 5, 9};  // those with other ids have left
    const std::vector<dem::ContactForce> contacts = {
        {2, 5, 1e-6, {1, 0, 0}, 3, {0, 4, 0}},
        {9, 5, 2e-6, {0, 0, 1}, -1, {}},
        {9, -1, 5e-7, {0, 0, 1}, 2, {}},
    };
    const auto loads = observables::particle_loads(state, contacts);
    EXPECT_EQ(loads.force[0], (dem::Vec3{3, 4, 0}));
    EXPECT_EQ(loads.force[1], (dem::Vec3{-3, -4, 1}));
    EXPECT_EQ(loads.force[2], (dem::Vec3{0, 0, 1}));
    EXPECT_EQ(loads.largest, (std::vector<double>{5, 5, 2}));
    EXPECT_EQ(loads.overlap, (std::vector<double>{1e-6, 2e-6, 2e-6}));
    EXPECT_EQ(loads.coordination, (std::vector<double>{1, 2, 2}));
    EXPECT_TRUE(observables::particle_loads({}, {}).force.empty());
}

}  // namespace grainsweep::tests::observables_particle_loads_test

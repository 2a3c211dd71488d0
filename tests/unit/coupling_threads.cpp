// However many threads compute flow and particles, their state has the same bytes after every step.
#include "solver/coupling/dense_suspension.hpp"
#include "solver/coupling/projected_contacts.hpp"
#include "solver/coupling/self_disturbance.hpp"
#include "solver/coupling/solids_pressure.hpp"
#include "solver/coupling/spring_contacts.hpp"
#include "solver/coupling/suspension.hpp"
#include "solver/scenes/scene.hpp"
#include "tests/support/flow_boxes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::tests::coupling_threads_test {

using namespace flow_boxes;

using namespace flow;

using State = std::vector<std::byte>;
constexpr int steps = 4;

template <class System>
State state_of(const System& system) {
    State state;
    system.save(state);
    return state;
}

template <class System>
void advance(System& system, int count) {
    for (int k = 0; k < count; ++k) system.step();
}

/// More slabs than planes, cuts that do not come out even, changes on the way, checkpoints taken and restored.
template <class Make>
void expect_same_bits(const std::string& what, Make make) {
    SCOPED_TRACE(what);
    auto one = make();
    advance(one, steps);
    const State expected = state_of(one);
    for (const int threads : {2, 3, 7}) {
        auto several = make();
        several.use(Slabs(threads));
        advance(several, steps);
        EXPECT_TRUE(state_of(several) == expected) << threads << " threads";
    }
    auto changing = make();
    for (const int threads : {3, 1, 2, 7}) {
        changing.use(Slabs(threads));
        changing.step();
    }
    EXPECT_TRUE(state_of(changing) == expected) << "changed on the way";
    auto before = make(), after = make();
    before.use(Slabs(3));
    advance(before, 2);
    const State checkpoint = state_of(before);
    std::span<const std::byte> from = checkpoint;
    after.restore(from);
    after.use(Slabs(2));
    advance(after, steps - 2);
    EXPECT_TRUE(state_of(after) == expected) << "restored";
}

/// A cube, closed or periodic along y and z, with particles that fill a part of it densely.
struct Box {
    bool closed;
    Grid grid;
    Sides sides;
    coupling::Walls walls;

    explicit Box(bool is_closed)
        : closed(is_closed),
          grid{{axis(true), axis(is_closed), axis(is_closed)}},
          walls{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {false, !is_closed, !is_closed}, sphere().radius(), 1} {
        const std::array<Side, 2> wall{NoSlip{}, NoSlip{}}, round{Periodic{}, Periodic{}};
        sides = {wall, closed ? wall : round, closed ? wall : round};
    }
    static Axis axis(bool clustered) {
        return clustered ? Axis::clustered(8, -0.5, 0.5, 1.5) : Axis::uniform(8, -0.5, 0.5);
    }
    static coupling::Sphere sphere() { return {1.65, 2e-4, 18, 1.72e7, 1}; }
    static double time_step() { return 2 * std::numbers::pi / 2.33e4 / 16; }
    static Vibration vibration() { return {2.33e4, 0.3}; }

    [[nodiscard]] Flow<Boussinesq> fluid() const {
        Boussinesq heat;
        heat.sides[0] = {Isothermal{-0.5}, Isothermal{0.5}};
        heat.buoyancy = -18 * 3.04e6;
        heat.vibration = vibration();
        Flow<Boussinesq> flow({grid, sides, 18, time_step()}, heat);
        flow.set_temperature([](double x, double y, double z) { return x + 0.1 * y - 0.2 * z * z; });
        return flow;
    }
    [[nodiscard]] coupling::Cloud cloud() const {
        auto all = coupling::random_cloud(170, walls, stats::Stream(3, 1));
        for (std::size_t p = 0; p < 80; ++p)  // as dense as the packing limit
            for (std::size_t d = 0; d < 3; ++d) all.position[p][d] = 0.15 * all.position[p][d] - 0.3;
        for (auto& v : all.velocity) v = {40, -60, 300};
        return all;
    }
    template <class Level>
    [[nodiscard]] auto dilute(Level level) const {
        return coupling::Suspension<Boussinesq, Level, coupling::Trilinear, coupling::SchillerNaumann>(
            fluid(), vibration(), {sphere(), time_step()}, walls, cloud(), std::move(level));
    }
    template <class Interaction>
    [[nodiscard]] auto dense(Interaction interaction) const {
        return coupling::DenseSuspension<Boussinesq, Interaction, coupling::Trilinear, coupling::SchillerNaumann>(
            fluid(), vibration(), {sphere(), time_step()}, walls, cloud(), std::move(interaction), 0.12);
    }
};

class CouplingThreads : public testing::TestWithParam<bool> {
protected:
    Box box{GetParam()};
};

TEST_P(CouplingThreads, FlowWithAndWithoutHeat) {
    expect_same_bits("heat", [&] { return box.fluid(); });
    expect_same_bits("no heat", [&] {
        Flow<NoHeat> flow({box.grid, box.sides, 0.02, 0.01}, NoHeat{});
        flow.set_velocity([](double x, double y, double z) {
            return std::array<double, 3>{std::sin(6 * y), std::cos(5 * z + x), std::sin(6 * x) * y};
        });
        return flow;
    });
}

TEST_P(CouplingThreads, FromTheFluidToTheParticlesAlone) {
    expect_same_bits("trilinear", [&] { return box.dilute(coupling::OneWay{}); });
}

TEST_P(CouplingThreads, BothWays) {
    expect_same_bits("force", [&] {
        return box.dilute(coupling::TwoWay(box.grid, box.sides, Box::sphere(), box.cloud().size(), 0.12));
    });
    expect_same_bits("without own wake", [&] {
        return box.dilute(
            coupling::TwoWayWithoutOwnWake(box.grid, box.sides, Box::sphere(), box.cloud().size(), 0.12, 0.01));
    });
}

TEST_P(CouplingThreads, DenseParticles) {
    using namespace coupling;
    const auto grains = Granular::of(Box::sphere(), 0.9, 0.63);
    const auto pressed = [&]<class Temperature>(std::type_identity<Temperature>) {
        return box.dense(SolidsPressure<Temperature>(box.grid, box.sides, Box::sphere(), grains, 1e-3, 0.12));
    };
    expect_same_bits("ddpm", [&] { return pressed(std::type_identity<AlgebraicTemperature>{}); });
    expect_same_bits("ddpm_ktgf", [&] { return pressed(std::type_identity<TransportedTemperature>{}); });
    const double stiffness = SpringContacts::stiffness(Box::sphere(), 0.01, Box::time_step());
    expect_same_bits("springs", [&] {
        return box.dense(SpringContacts(Box::sphere(), box.walls, {stiffness, 0.9, 0.3}, box.cloud().size()));
    });
    expect_same_bits("projection", [&] { return box.dense(ProjectedContacts(Box::sphere(), box.walls)); });
    expect_same_bits("volume alone", [&] { return box.dense(NoInteraction{}); });
}

INSTANTIATE_TEST_SUITE_P(Boxes, CouplingThreads, testing::Bool(),
                         [](const auto& box) { return box.param ? "closed" : "periodic"; });

TEST(CouplingThreadsScene, ACaseHasTheBitsOfOneThreadHoweverManyItHas) {
    const SceneInfo& info = *find_scene("thermovibration");
    for (const std::string coupling : {"one_way", "ddpm"}) {
        Inputs inputs = info.defaults();
        inputs["coupling"] = coupling;
        inputs["particles"] = std::int64_t{100};
        inputs["end_time"] = 5e-4;
        NoArtefacts none;
        const auto run = [&](std::initializer_list<int> threads) {
            const auto scene = info.make(inputs, 1, none);
            for (const int count : threads) {
                EXPECT_EQ(scene->use_threads(count), std::min(count, 2)) << "28^3 cells are enough for two";
                scene->advance(scene->time() + 1e-9);
            }
            Bytes bytes;
            scene->save(bytes);
            return bytes;
        };
        const auto expected = run({1, 1, 1});
        EXPECT_TRUE(run({2, 2, 2}) == expected) << coupling;
        EXPECT_TRUE(run({2, 1, 7}) == expected) << coupling;
    }
}

}  // namespace grainsweep::tests::coupling_threads_test

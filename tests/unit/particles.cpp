#include "solver/particles/particles.hpp"

#include "solver/bytes.hpp"
#include "solver/particles/neighbour_list.hpp"
#include "solver/particles/pair_memory.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <tuple>

namespace grainsweep::tests::particles_test {

using namespace geometry;
using namespace particles;

struct Cloud {
    Domain domain;
    double skin = 0;
    std::vector<Vec3> position;
    std::vector<double> radius;
};

using Pair = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;

std::set<Pair> pairs(const NeighbourList& list) {
    std::set<Pair> result;
    for (std::uint32_t i = 0; i < list.particles(); ++i)
        for (auto k = list.begin(i); k < list.end(i); ++k) {
            EXPECT_GT(list[k].j(), i);
            EXPECT_TRUE(result.insert({i, list[k].j(), list[k].image()}).second) << "listed twice";
        }
    return result;
}

/// Returns the list from all pairs, for any order of particles; partners ascending.
NeighbourList listed_by_brute_force(std::span<const Vec3> position, const Radii& radii, double skin,
                                    const Domain& domain) {
    const auto n = static_cast<std::uint32_t>(position.size());
    const auto shifts = domain.image_shifts();
    std::vector<std::uint32_t> first(n + 1U, 0);
    std::vector<Neighbour> entries;
    for (std::uint32_t i = 0; i < n; ++i) {
        first[i] = static_cast<std::uint32_t>(entries.size());
        for (std::uint32_t j = i + 1; j < n; ++j) {
            for (std::uint32_t image = 0; image < 27; ++image) {
                const std::array<std::uint32_t, 3> digit = {image % 3, image / 3 % 3, image / 9};
                bool exists = true;
                for (std::size_t k = 0; k < 3; ++k) exists = exists && (domain.periodic[k] || digit[k] == 1);
                if (!exists) continue;
                const Vec3 d = position[i] - shifts[image] - position[j];
                const double reach = radii[i] + radii[j] + skin;
                if (dot(d, d) < reach * reach) entries.push_back(Neighbour::of(j, image));
            }
        }
    }
    first[n] = static_cast<std::uint32_t>(entries.size());
    std::vector<std::byte> bytes;
    ByteWriter out(bytes);
    out.put(first), out.put(entries);
    ByteReader in(bytes);
    NeighbourList list;
    list.restore(in, n);
    return list;
}

/// Sorts the cloud, lists it both ways and returns the number of pairs.
std::size_t compare_with_brute_force(const Cloud& cloud) {
    Cells cells;
    std::vector<std::uint32_t> all(cloud.position.size());
    for (std::uint32_t k = 0; k < all.size(); ++k) all[k] = k;
    const bool equal = std::ranges::all_of(cloud.radius, [&](double r) { return r == cloud.radius[0]; });
    const Radii radii = equal ? Radii{cloud.radius[0], {}} : Radii{0, cloud.radius};
    cells.sort(cloud.position, all, radii, cloud.skin, cloud.domain);
    std::vector<Vec3> position;
    std::vector<double> radius;
    for (const auto i : cells.order()) {
        position.push_back(cloud.position[i]);
        radius.push_back(cloud.radius[i]);
    }
    EXPECT_EQ(position.size(), cloud.position.size());
    const Radii sorted = equal ? radii : Radii{0, radius};
    NeighbourList fast;
    fast.build(cells, position, sorted, cloud.skin, cloud.domain, [](std::size_t, std::size_t) { return true; });
    const NeighbourList plain = listed_by_brute_force(position, sorted, cloud.skin, cloud.domain);
    EXPECT_EQ(pairs(fast), pairs(plain));
    return plain.size();
}

Cloud cloud(std::size_t n, double ratio, std::array<bool, 3> periodic, double clustering, std::uint64_t seed) {
    Cloud c;
    c.domain = {{-1, 0, 2}, {1, 1, 4}, periodic};
    c.skin = 0.02;
    const stats::Stream random(seed, 3);
    for (std::uint64_t k = 0; k < n; ++k) {
        Vec3 x{};
        for (std::size_t a = 0; a < 3; ++a) {
            double u = random.uniform(4 * k + a);
            if (clustering > 0) u = 0.5 + 0.5 * clustering * (u - 0.5) * (k % 3 == 0 ? 1 : 0.1);
            x[a] = c.domain.low[a] + u * c.domain.length(a);
        }
        c.position.push_back(x);
        c.radius.push_back(ratio == 1 ? 0.08 : 0.2 * std::pow(ratio, -random.uniform(4 * k + 3)));
    }
    return c;
}

TEST(NeighbourList, EqualsBruteForce) {
    for (const auto& periodic : {std::array{false, false, false}, std::array{true, true, true},
                                 std::array{false, true, false}, std::array{true, false, true}})
        for (const double ratio : {1.0, 20.0})
            for (const double clustering : {0.0, 0.4}) {
                SCOPED_TRACE(testing::Message() << "ratio " << ratio << " clustering " << clustering);
                EXPECT_GT(compare_with_brute_force(cloud(250, ratio, periodic, clustering, 11)), 100U);
            }
}

TEST(NeighbourList, EqualsBruteForceInPeriodsOfOneToThreeCells) {
    for (const double width : {0.45, 0.6, 0.8}) {
        Cloud c = cloud(60, 1, {true, true, true}, 0, 5);
        c.domain = {{0, 0, 0}, {width, 0.45, 2}, {true, true, true}};
        c.radius.assign(60, 0.1);
        for (auto& x : c.position) x = {(x[0] + 1) / 2 * width, x[1] * 0.45, x[2] - 2};
        EXPECT_GT(compare_with_brute_force(c), 50U);
    }
}

TEST(NeighbourList, HoldsNobodyAndOne) {
    for (const std::size_t n : {0U, 1U}) {
        Cells cells;
        const std::vector<Vec3> position(n, Vec3{0.5, 0.5, 0.5});
        const std::vector<std::uint32_t> all(n, 0);
        const Domain domain{{0, 0, 0}, {1, 1, 1}, {false, true, false}};
        cells.sort(position, all, {0.1, {}}, 0.01, domain);
        NeighbourList list;
        list.build(cells, position, {0.1, {}}, 0.01, domain, [](std::size_t, std::size_t) { return true; });
        EXPECT_EQ(list.particles(), n);
        EXPECT_EQ(list.size(), 0U);
    }
}

TEST(PairMemory, FollowsItsPairAndTurnsWithIt) {
    // Three in a row touch their neighbours; then the order is reversed, and the middle pair's memory must turn.
    const Domain domain{{-9, -9, -9}, {9, 9, 9}, {}};
    const std::vector<Vec3> before = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    const NeighbourList old = listed_by_brute_force(before, {0.5, {}}, 0.2, domain);
    ASSERT_EQ(old.size(), 3U);
    PairMemory memory({-1, -1, -1});
    memory.value = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    memory.live = {1, 1, 0};
    // 0 -> 2, 1 -> 1, 2 -> 0, 3 leaves.
    const std::vector<Vec3> after = {{2, 0, 0}, {1, 0, 0}, {0, 0, 0}};
    const std::vector<std::uint32_t> fresh_index = {2, 1, 0, gone};
    const NeighbourList fresh = listed_by_brute_force(after, {0.5, {}}, 0.2, domain);
    memory.carry(old, fresh, fresh_index);
    // Pair (0, 1) was (2, 1), pair (1, 2) was (1, 0).
    EXPECT_EQ(memory.value, (std::vector<double>{-4, -5, -6, -1, -2, -3}));
    EXPECT_EQ(memory.live, (std::vector<std::uint8_t>{1, 1}));
}

TEST(PairMemory, ExchangedParticlesFlipWhatIsMeasuredFromOneToTheOther) {
    const Domain domain{{-9, -9, -9}, {9, 9, 9}, {}};
    const NeighbourList old = listed_by_brute_force(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}, {0.5, {}}, 0.2, domain);
    PairMemory memory({-1, -1, -1, 1});
    memory.value = {1, 2, 3, 4};
    memory.live = {1};
    const NeighbourList fresh = listed_by_brute_force(std::vector<Vec3>{{1, 0, 0}, {0, 0, 0}}, {0.5, {}}, 0.2, domain);
    memory.carry(old, fresh, std::vector<std::uint32_t>{1, 0});
    EXPECT_EQ(memory.value, (std::vector<double>{-1, -2, -3, 4}));
}

TEST(Bytes, ReturnWhatWasWrittenAndRefuseLess) {
    std::vector<std::byte> bytes;
    ByteWriter out(bytes);
    out.put(3.25);
    out.put(std::vector<std::int32_t>{4, 5, 6});
    out.put(std::string("seven"));
    double a = 0;
    std::vector<std::int32_t> b;
    std::string c;
    ByteReader in(bytes);
    in.get(a);
    in.get(b);
    in.get(c);
    in.finish();
    EXPECT_EQ(a, 3.25);
    EXPECT_EQ(b, (std::vector<std::int32_t>{4, 5, 6}));
    EXPECT_EQ(c, "seven");
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        ByteReader cut(std::span<const std::byte>(bytes).first(length));
        EXPECT_THROW((cut.get(a), cut.get(b), cut.get(c)), std::invalid_argument) << length;
    }
    ByteReader longer(bytes);
    longer.get(a);
    EXPECT_THROW(longer.finish(), std::invalid_argument);
}

}  // namespace grainsweep::tests::particles_test

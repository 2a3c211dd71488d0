// A case has the same bits however many threads compute it, and whenever their number changes.
#include "solver/scenes/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string>

using namespace grainsweep;

namespace {

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

}  // namespace
